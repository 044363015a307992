// Propagation of light in the lattice: the compute shader against the slow model in double precision, and against laws.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "gl/api.h"
#include "gl/buffer.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "physics/lattice_model.h"
#include "shared/lpv.h"
#include "support/content.h"
#include "volumetric_gi/lpv/lattice_params.h"

namespace tyndall::test {
namespace {

using LpvPropagation = GlTest;
TYNDALL_GL_TESTS(LpvPropagation);

/// A lattice of the model's on the GPU. Green has half of red's light, blue three times red's.
class GpuLattice {
public:
    GpuLattice(LatticeModel& model, const ivec3& size, int repeats)
        : size_(size), cells_(size_t(size.x * size.y * size.z)) {
        Result<const gl::Program*> found = library_.compute("gi/lpv/propagate.comp");
        if (!found) throw std::runtime_error(found.message());
        program_ = *found;
        std::vector<vec4> medium(cells_ * gpu::kLpvMediumVectors),
            sources(cells_ * gpu::kLpvSourceVectors);
        std::vector<uint32_t> links(cells_ * gpu::kLpvLinkPlanes);
        for (size_t i = 0; i < cells_; ++i) {
            const int n = int(i);
            const LatticeCell& cell =
                model.cell({n % size.x, n / size.x % size.y, n / size.x / size.y});
            for (uint32_t c = 0; c < gpu::kLpvClasses; ++c)
                medium[(gpu::kLpvPassed + c) * cells_ + i] =
                    vec4(float(std::exp(-cell.depth * std::sqrt(c + 1.0))));
            medium[gpu::kLpvDepth * cells_ + i] = vec4(float(cell.depth));
            medium[gpu::kLpvAlbedo * cells_ + i] = vec4(float(cell.albedo));
            for (uint32_t c = 0; c < 3; ++c)
                sources[(gpu::kLpvEntering + c) * cells_ + i] =
                    kShares[c] * vec4(vec3(cell.entering.moment), float(cell.entering.power));
            sources[gpu::kLpvEmission * cells_ + i] =
                float(cell.emission) * vec4(kShares[0], kShares[1], kShares[2], 0);
            links[gpu::kLpvBlocked * cells_ + i] = cell.blocked;
            for (uint32_t j = 0; j < gpu::kLpvDirections; ++j)
                links[(gpu::kLpvSurface + j) * cells_ + i] =
                    0x010101u * uint32_t(std::lround(255 * cell.reflectance[j]));
        }
        medium_ = gl::Buffer("medium", std::as_bytes(std::span(medium)));
        sources_ = gl::Buffer("sources", std::as_bytes(std::span(sources)));
        links_ = gl::Buffer("links", std::as_bytes(std::span(links)));
        for (gl::Buffer& state : states_) {
            state = gl::Buffer("state", cells_ * gpu::kLpvFluxPlanes * sizeof(float));
            state.clear();
        }
        gpu::LpvParams params = volumetric_gi::latticeParams(size, repeats);
        params_ = gl::Buffer("params", std::as_bytes(std::span(&params, 1)));
        params.grid.place.w = 1;
        allParams_ = gl::Buffer("params", std::as_bytes(std::span(&params, 1)));
        const ivec3 blocks = volumetric_gi::blocksOf(size);
        lit_ = gl::Buffer("lit", size_t(blocks.x * blocks.y * blocks.z) * sizeof(uint32_t));
        lit_.clear();
    }

    void step(int count = 1) {
        glUseProgram(program_->id());
        for (int i = 0; i < count; ++i) {
            bind("LpvMedium", medium_);
            bind("LpvSources", sources_);
            bind("LpvLinks", links_);
            bind("LpvFlux", states_[0]);
            bind("LpvSent", states_[1]);
            bind("LpvLit", lit_);
            glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(program_->find("Params")->binding),
                             (steps_++ < 2 ? allParams_ : params_).id());
            glDispatchCompute(GLuint(size_.x + 7) / 8, GLuint(size_.y + 3) / 4,
                              GLuint(size_.z + 1) / 2);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
            std::swap(states_[0], states_[1]);
        }
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glUseProgram(0);
    }
    /// The sources' light stops.
    void darken() { sources_.clear(); }
    /// 1 for each block that has been stepped with light in it or about it.
    [[nodiscard]] std::vector<uint32_t> lit() const { return lit_.readAll<uint32_t>(); }
    [[nodiscard]] std::vector<float> flux() const { return states_[0].readAll<float>(); }
    /// Power of a channel that each cell sends out.
    [[nodiscard]] std::vector<double> powers(uint32_t channel) const {
        const std::vector<float> all = flux();
        std::vector<double> result(cells_);
        for (uint32_t j = 0; j < gpu::kLpvDirections; ++j)
            for (size_t i = 0; i < cells_; ++i)
                result[i] += double(all[(3 * j + channel) * cells_ + i]);
        return result;
    }
    static constexpr float kShares[3] = {1, 0.5f, 3};

private:
    void bind(const char* name, const gl::Buffer& buffer) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(program_->find(name)->binding),
                         buffer.id());
    }
    gl::ShaderLibrary library_;
    const gl::Program* program_ = nullptr;
    ivec3 size_;
    size_t cells_;
    int steps_ = 0;
    gl::Buffer medium_, sources_, links_, states_[2], params_, allParams_, lit_;
};

/// Every cell with its own medium and sources; seeded.
LatticeModel randomLattice(const ivec3& size, bool repeats, double densest, double albedo,
                           double blocked) {
    LatticeModel lattice(size, {repeats, repeats, repeats});
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(0, 1);
    const auto& directions = volumetric_gi::latticeDirections();
    for (int i = 0; i < size.x * size.y * size.z; ++i) {
        const ivec3 at(i % size.x, i / size.x % size.y, i / size.x / size.y);
        LatticeCell& cell = lattice.cell(at);
        cell.depth = densest * std::pow(10, -6 * unit(random));
        cell.albedo = albedo < 0 ? unit(random) : albedo;
        cell.emission = unit(random);
        cell.entering.power = std::pow(10, 4 * unit(random) - 2);
        const dvec3 direction(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
        cell.entering.moment = glm::normalize(direction) * cell.entering.power * unit(random);
        for (double& reflectance : cell.reflectance)
            reflectance = std::round(unit(random) * 255) / 255;
        for (uint32_t j = 0; j < 13; ++j) { // each way once, and its other end with it
            const ivec3 to = at + directions[j].offset;
            if (unit(random) >= blocked || glm::any(glm::lessThan(to, ivec3(0))) ||
                glm::any(glm::greaterThanEqual(to, size)))
                continue;
            cell.blocked |= 1u << j;
            lattice.cell(to).blocked |= 1u << (25 - j);
        }
    }
    return lattice;
}

double sum(const std::vector<double>& values) {
    double result = 0;
    for (const double v : values) result += v;
    return result;
}

TEST_P(LpvPropagation, IsTheModels) {
    const ivec3 size(6, 5, 7);
    for (const bool repeats : {false, true})
        for (const double blocked : {0.0, 0.2}) {
            LatticeModel model = randomLattice(size, repeats, 5, -1, repeats ? 0 : blocked);
            GpuLattice lattice(model, size, repeats ? 7 : 0);
            // The shader makes up what is emitted at the end of a step, the model sends it within the step: one step apart.
            std::vector<double> emissions;
            for (int i = 0; i < 210; ++i)
                emissions.push_back(
                    std::exchange(model.cell({i % 6, i / 6 % 5, i / 30}).emission, 0));
            model.step();
            for (int i = 0; i < 210; ++i)
                model.cell({i % 6, i / 6 % 5, i / 30}).emission = emissions[size_t(i)];
            lattice.step();
            for (int step = 1; step <= 12; ++step) {
                const std::vector<float> flux = lattice.flux();
                for (int i = 0; i < 210; ++i) {
                    const auto sends = model.sends({i % 6, i / 6 % 5, i / 30});
                    const double most = *std::max_element(sends.begin(), sends.end());
                    for (uint32_t j = 0; j < gpu::kLpvDirections; ++j)
                        for (uint32_t channel = 0; channel < 3; ++channel) {
                            const double share = double(GpuLattice::kShares[channel]);
                            ASSERT_NEAR(double(flux[(3 * j + channel) * 210 + size_t(i)]),
                                        sends[j] * share, 1e-4 * most * share)
                                << "step " << step << ", cell " << i << ", direction " << j;
                        }
                }
                model.step();
                lattice.step();
            }
        }
}

TEST_P(LpvPropagation, ConservesPowerAtAnyOpticalDepth) {
    // 500 steps of an endless lattice of albedo 1: 26 additions and a division a step, each rounded to 6e-8 at random.
    const ivec3 size(8);
    for (const double depth : {0.0, 1e-8, 1e-4, 0.25, 2.095, 5.0, 50.0, 1e4}) {
        LatticeModel model = randomLattice(size, true, depth, 1, 0);
        GpuLattice lattice(model, size, 7);
        lattice.step(2);
        lattice.darken();
        lattice.step(); // what the sources still had on the way
        const double first = sum(lattice.powers(0));
        lattice.step(500);
        for (const float power : lattice.flux())
            ASSERT_TRUE(std::isfinite(power) && power >= 0) << power << " at " << depth;
        EXPECT_NEAR(sum(lattice.powers(0)) / first, 1, 1e-5) << depth;
    }
}

TEST_P(LpvPropagation, TotalFluxNeverGrows) {
    const ivec3 size(8);
    LatticeModel model = randomLattice(size, false, 10, -1, 0.1);
    GpuLattice lattice(model, size, 0);
    lattice.step(3);
    lattice.darken();
    lattice.step();
    double last = sum(lattice.powers(2));
    for (int i = 0; i < 100; ++i) {
        lattice.step();
        const double now = sum(lattice.powers(2));
        EXPECT_LE(now, last * (1 + 1e-6));
        last = now;
    }
}

TEST_P(LpvPropagation, DoublingTheLightDoublesItToTheLastBit) {
    const ivec3 size(6, 5, 7);
    LatticeModel model = randomLattice(size, false, 3, -1, 0.1), twice = model;
    for (int i = 0; i < 210; ++i) {
        LatticeCell& cell = twice.cell({i % 6, i / 6 % 5, i / 30});
        cell.emission *= 2;
        cell.entering.power *= 2;
        cell.entering.moment *= 2;
    }
    GpuLattice one(model, size, 0), two(twice, size, 0);
    one.step(20);
    two.step(20);
    const std::vector<double> a = one.powers(1), b = two.powers(1);
    for (size_t i = 0; i < a.size(); ++i) ASSERT_EQ(2 * a[i], b[i]);
}

TEST_P(LpvPropagation, IsTheSameInEveryRun) {
    const ivec3 size(8);
    LatticeModel model = randomLattice(size, false, 3, -1, 0.1);
    GpuLattice one(model, size, 0), two(model, size, 0);
    one.step(30);
    two.step(30);
    const std::vector<float> a = one.flux(), b = two.flux();
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

TEST_P(LpvPropagation, LeavesOutWhatIsDark) {
    // A lamp in one corner of a long hall; a wall across it keeps the rest dark. Where light goes it is that of the model.
    const ivec3 size(48, 8, 8);
    LatticeModel model(size, {false, false, false});
    const auto& directions = volumetric_gi::latticeDirections();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (uint32_t j = 0; j < kLatticeDirections; ++j) {
                if (directions[j].offset.x > 0) model.cell({19, y, z}).blocked |= 1u << j;
                if (directions[j].offset.x < 0) model.cell({20, y, z}).blocked |= 1u << j;
            }
    model.cell({2, 3, 4}).entering.power = 1;
    GpuLattice lattice(model, size, 0);
    const auto blocks = [&] {
        const std::vector<uint32_t> lit = lattice.lit();
        return std::count(lit.begin(), lit.end(), 1u);
    };
    lattice.step(2);
    EXPECT_LE(blocks(), 8) << "of 48 blocks those within two cells of the lamp";
    lattice.step(60);
    for (int i = 0; i < 62; ++i) model.step();
    const std::vector<double> powers = lattice.powers(0);
    double dark = 0;
    for (int i = 0; i < size.x * size.y * size.z; ++i) {
        const ivec3 at(i % 48, i / 48 % 8, i / 384);
        const auto sends = model.sends(at);
        double expected = 0;
        for (const double power : sends) expected += power;
        EXPECT_NEAR(powers[size_t(i)], expected, 1e-5);
        if (at.x >= 20) dark += powers[size_t(i)];
    }
    EXPECT_EQ(dark, 0);
    EXPECT_EQ(blocks(), 3 * 2 * 4) << "the half before the wall";
}

/// The printed scheme in an endless lattice of one medium, λ and λs as in equation 3.
class GpuPrinted {
public:
    GpuPrinted(int size, double lambda, double lambdaS,
               const std::vector<std::array<double, 4>>& start)
        : size_(size), cells_(start.size()) {
        Result<const gl::Program*> found = library_.compute("gi/lpv/printed_step.comp");
        if (!found) throw std::runtime_error(found.message());
        program_ = *found;
        const gpu::LpvParams params = volumetric_gi::latticeParams(ivec3(size), 7);
        const gpu::LpvTransfer transfer = volumetric_gi::latticeTransfer();
        std::vector<vec4> medium(cells_ * gpu::kLpvMediumVectors), state(cells_ * 3);
        for (size_t i = 0; i < cells_; ++i) {
            medium[gpu::kLpvTrueDepth * cells_ + i] =
                vec4(float(lambda / double(transfer.meanLength)));
            medium[gpu::kLpvTrueAlbedo * cells_ + i] = vec4(float(lambdaS / lambda));
            for (size_t c = 0; c < 3; ++c)
                for (int k = 0; k < 4; ++k)
                    state[c * cells_ + i][k] = float(start[i][size_t(k)]) * float(c + 1);
        }
        params_ = gl::Buffer("params", std::as_bytes(std::span(&params, 1)));
        transfer_ = gl::Buffer("transfer", std::as_bytes(std::span(&transfer, 1)));
        medium_ = gl::Buffer("medium", std::as_bytes(std::span(medium)));
        links_ = gl::Buffer("links", cells_ * gpu::kLpvLinkPlanes * sizeof(uint32_t));
        links_.clear();
        states_[0] = gl::Buffer("state", std::as_bytes(std::span(state)));
        states_[1] = gl::Buffer("state", cells_ * 3 * sizeof(vec4));
        sum_ = gl::Buffer("sum", cells_ * 3 * sizeof(vec4));
        sum_.clear();
    }
    void step() {
        glUseProgram(program_->id());
        const std::pair<const char*, const gl::Buffer*> storage[] = {{"LpvMedium", &medium_},
                                                                     {"LpvLinks", &links_},
                                                                     {"LpvRadiance", &states_[0]},
                                                                     {"LpvNext", &states_[1]},
                                                                     {"LpvSum", &sum_}};
        for (const auto& [name, buffer] : storage)
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(program_->find(name)->binding),
                             buffer->id());
        glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(program_->find("Params")->binding),
                         params_.id());
        glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(program_->find("Transfer")->binding),
                         transfer_.id());
        glDispatchCompute(GLuint(size_ + 7) / 8, GLuint(size_ + 3) / 4, GLuint(size_ + 1) / 2);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        std::swap(states_[0], states_[1]);
        glUseProgram(0);
    }
    [[nodiscard]] std::vector<vec4> state() const { return states_[0].readAll<vec4>(); }

private:
    gl::ShaderLibrary library_;
    const gl::Program* program_ = nullptr;
    int size_;
    size_t cells_;
    gl::Buffer params_, transfer_, medium_, links_, states_[2], sum_;
};

TEST_P(LpvPropagation, AsPrintedIsThePrintedModels) {
    constexpr int kSize = 6;
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(0, 1);
    // One that loses power, one that diverges.
    for (const auto& [lambda, lambdaS] : {std::pair{0.5, 0.5}, std::pair{2.5, 0.3}}) {
        PrintedLatticeModel model(kSize, lambda, lambdaS);
        for (auto& cell : model.state()) {
            cell[0] = unit(random);
            for (size_t k = 1; k < 4; ++k) cell[k] = unit(random) - 0.5;
        }
        const double first = model.power();
        GpuPrinted printed(kSize, lambda, lambdaS, model.state());
        for (int i = 0; i < 30; ++i) {
            model.step();
            printed.step();
        }
        double most = 0;
        for (const auto& cell : model.state())
            for (const double v : cell) most = std::max(most, std::abs(v));
        const std::vector<vec4> state = printed.state();
        for (size_t i = 0; i < model.state().size(); ++i)
            for (int k = 0; k < 4; ++k)
                ASSERT_NEAR(double(state[i][k]), model.state()[i][size_t(k)], 1e-4 * most);
        // Power, the mean over the lattice, is multiplied by 1 - λ + 0.696 λs in each step.
        EXPECT_NEAR(model.power() / first / std::pow(1 - lambda + 0.6960 * lambdaS, 30), 1, 5e-3);
    }
}

} // namespace
} // namespace tyndall::test
