// The transmittance interval map against closed forms along the rays: what intervals weigh, and
// where
// their points lie.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "framegraph/gl/executor.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "media/brick_grid.h"
#include "renderer/media_system.h"
#include "renderer/view.h"
#include "unit/media_dense_field.h"
#include "volumetric_gi/surfels/interval_map.h"

namespace tyndall::test {
namespace {

using namespace volumetric_gi;

constexpr int kSide = 8;
constexpr double kCodes = 65535, kCodeRatio = 1e4; // shaders/gi/surfels/interval_map.glsl
constexpr double kNear = 0.1;

struct Box {
    dvec3 minimum, maximum;
    dvec3 scattering, absorption;
    float anisotropy = 0;
};

struct Request {
    uint32_t count = 16;
    bool jitter = false;
    int factor = 1;
    double surface = 0; // metres before the eye's plane at which a wall stands; 0: none
    std::vector<std::string> settings;
};

/// The map, decoded.
struct Way {
    double start = 0, length = 0, opacity = 0;
    std::vector<double> distances;           // of the intervals' points
    std::vector<std::vector<dvec3>> weights; // of phase functions and intervals
    std::vector<ivec3> shares;               // summed over the intervals, of each phase function
    dvec3 origin{0}, direction{0};
    double end = 1e30; // of the ray
    [[nodiscard]] dvec3 sum(size_t group) const {
        dvec3 result(0);
        for (const dvec3& weight : weights[group]) result += weight;
        return result;
    }
    /// Metres by which rounding moves a point: half a code, and digits of single precision.
    [[nodiscard]] double resolution(double distance) const {
        const double step =
            std::log(1 + kCodeRatio) / kCodes * (distance - start + length / kCodeRatio);
        return 0.5 * step + 2.4e-7 * distance + 1e-30; // four halves of a float's last digit
    }
};

/// A part of a ray with the same media all along.
struct Stretch {
    double start, end;
    dvec3 extinction;
    std::vector<dvec3> scattering; // of each box
};

/// Cuts a ray at the borders of boxes.
std::vector<Stretch> stretchesOf(const std::vector<Box>& boxes, const Way& way) {
    std::vector<double> borders = {0, way.end};
    std::vector<std::pair<double, double>> spans;
    for (const Box& box : boxes) {
        double t0 = 0, t1 = way.end;
        for (int axis = 0; axis < 3; ++axis) {
            double a = (box.minimum[axis] - way.origin[axis]) / way.direction[axis],
                   b = (box.maximum[axis] - way.origin[axis]) / way.direction[axis];
            if (a > b) std::swap(a, b);
            t0 = std::max(t0, a);
            t1 = std::min(t1, b);
        }
        spans.emplace_back(t0, t1);
        if (t0 >= t1) continue;
        borders.push_back(t0);
        borders.push_back(t1);
    }
    std::sort(borders.begin(), borders.end());
    std::vector<Stretch> result;
    for (size_t i = 0; i + 1 < borders.size(); ++i) {
        Stretch stretch{borders[i], borders[i + 1], dvec3(0), {}};
        const double middle = 0.5 * (stretch.start + stretch.end);
        for (size_t box = 0; box < boxes.size(); ++box) {
            const bool in = middle > spans[box].first && middle < spans[box].second;
            stretch.scattering.push_back(in ? boxes[box].scattering : dvec3(0));
            if (in) stretch.extinction += boxes[box].scattering + boxes[box].absorption;
        }
        if (stretch.extinction != dvec3(0)) result.push_back(stretch);
    }
    return result;
}

/// ∫ T σs dt of each box, and what gets through to `distance`.
struct Expected {
    std::vector<dvec3> light;
    dvec3 through{1};
};
Expected expectedOf(const std::vector<Stretch>& stretches, size_t boxes, double distance = 1e30) {
    Expected result;
    result.light.assign(boxes, dvec3(0));
    for (const Stretch& stretch : stretches) {
        const double length =
            std::clamp(distance - stretch.start, 0.0, stretch.end - stretch.start);
        for (int c = 0; c < 3; ++c) {
            const double depth = stretch.extinction[c] * length;
            const double seen = depth > 0 ? -std::expm1(-depth) / stretch.extinction[c] : length;
            for (size_t box = 0; box < boxes; ++box)
                result.light[box][c] += result.through[c] * stretch.scattering[box][c] * seen;
        }
        for (int c = 0; c < 3; ++c) result.through[c] *= std::exp(-stretch.extinction[c] * length);
    }
    return result;
}

double meanOf(const dvec3& v) { return (v.x + v.y + v.z) / 3; }

Medium mediumOf(const Box& box) {
    Medium medium;
    medium.name = "fog";
    medium.kind = MediumKind::Box;
    medium.size = box.maximum - box.minimum;
    medium.scattering = vec3(box.scattering);
    medium.absorption = vec3(box.absorption);
    medium.anisotropy = box.anisotropy;
    return medium;
}

class SurfelIntervalsTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        library_.emplace();
        executor_.emplace(*library_);
        media_.emplace(*executor_);
        media_->registerSettings(registry_);
        registry_.applyPreset(Quality::High);
    }
    void TearDown() override {
        media_.reset();
        executor_.reset();
        library_.reset();
        GlTest::TearDown();
    }

    /// The rays of an eye at the origin that looks along -Z over 60 degrees.
    std::vector<Way> mapOf(const Scene& scene, const Request& request = {}) {
        registry_.resetAll();
        registry_.applyPreset(Quality::High);
        // The whole way counts, as in closed forms.
        EXPECT_TRUE(registry_.assign("media.march.minTransmittance=0").ok());
        EXPECT_TRUE(registry_.assign("media.integration=exact").ok());
        for (const std::string& setting : request.settings)
            EXPECT_TRUE(registry_.assign(setting).ok());
        Camera camera;
        camera.yfov = kPi / 3;
        camera.znear = kNear;
        ViewRequest viewRequest;
        viewRequest.camera = &camera;
        viewRequest.sceneRadius = 100;
        viewRequest.width = viewRequest.height = kSide;
        const ViewResources view = makeView(viewRequest);
        EXPECT_TRUE(media_->update(scene, dvec3(0)).ok());
        fg::FrameGraph& graph = executor_->beginFrame();
        const MediaFrame media = media_->beginFrame(graph, {&view, {}, {}, true});
        EXPECT_GT(media.resources.count, 0u);
        plugin::FrameInputs inputs{};
        inputs.view = view;
        inputs.media = media.resources;
        inputs.march.media = ~0u;
        inputs.gbuffer.depth = addDepth(graph, request.surface);
        const SurfelIntervals map =
            addSurfelIntervals(graph, inputs, intervalsOf(request));
        for (const fg::TextureHandle texture : {map.ways, map.totals, map.shares})
            graph.markOutput(texture);
        graph.markOutput(map.places);
        const Result<void> done = executor_->execute();
        if (!done) throw std::runtime_error(done.message());
        return decode(map, request);
    }
    std::vector<Way> mapOf(const std::vector<Box>& boxes, const Request& request = {}) {
        Scene scene;
        for (const Box& box : boxes)
            addMedium(scene, mediumOf(box),
                      glm::translate(dmat4(1), 0.5 * (box.minimum + box.maximum)));
        return mapOf(scene, request);
    }
    static void addMedium(Scene& scene, const Medium& medium, const dmat4& transform) {
        scene.media.push_back(medium);
        Node node;
        node.matrix = transform;
        node.medium = int(scene.media.size()) - 1;
        scene.nodes.push_back(node);
        SceneVersions& v = scene.versions;
        v.structure = v.transforms = v.media = nextVersion();
    }

private:
    static IntervalRequest intervalsOf(const Request& request) {
        IntervalRequest made;
        made.factor = request.factor;
        made.count = request.count;
        made.jitter = request.jitter;
        return made;
    }
    static fg::TextureHandle addDepth(fg::FrameGraph& graph, double surface) {
        struct Data {
            fg::TextureHandle depth;
            float value;
        };
        return graph
            .addPass<Data>(
                "depth",
                [&](fg::Builder& builder, Data& data) {
                    data.depth =
                        builder.create("depth", fg::texture2D(fg::Format::R32F, kSide, kSide),
                                       fg::Access::ColorTarget);
                    data.value = surface > 0 ? float(kNear / surface) : 0;
                },
                [](const Data& data, fg::PassContext& context) {
                    const float texel[4] = {data.value, 0, 0, 0};
                    context.clearTexture(data.depth, texel);
                })
            .depth;
    }

    std::vector<Way> decode(const SurfelIntervals& map, const Request& request) {
        const int side = map.params.size.x;
        EXPECT_EQ(side, (kSide + request.factor - 1) / request.factor);
        const Image ways = executor_->readImage(map.ways);
        std::vector<Image> totals, shares;
        const std::vector<std::byte> bytes = executor_->readBuffer(map.places);
        std::vector<uint16_t> places(bytes.size() / sizeof(uint16_t));
        std::memcpy(places.data(), bytes.data(), bytes.size());
        for (uint32_t group = 0; group < map.params.groups; ++group)
            totals.push_back(executor_->readImage(map.totals, int(group)));
        for (uint32_t layer = 0; layer < map.params.groups * request.count; ++layer)
            shares.push_back(executor_->readImage(map.shares, int(layer)));
        std::vector<Way> result;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const int row = side - 1 - y; // pictures begin at the top
                const float* way = ways.at(x, row);
                Way& made = result.emplace_back();
                made.start = double(way[0]);
                made.length = double(way[1]);
                made.opacity = double(way[2]);
                const auto pixel = [&](int i) {
                    return std::min(i * request.factor + request.factor / 2, kSide - 1);
                };
                const double slope = std::tan(kPi / 6);
                made.direction =
                    glm::normalize(dvec3(((pixel(x) + 0.5) / kSide * 2 - 1) * slope,
                                         ((pixel(y) + 0.5) / kSide * 2 - 1) * slope, -1));
                if (request.surface > 0) made.end = request.surface / -made.direction.z;
                made.weights.resize(map.params.groups);
                made.shares.assign(map.params.groups, ivec3(0));
                if (!(made.length > 0)) continue;
                for (uint32_t i = 0; i < request.count; ++i)
                    for (uint32_t group = 0; group < map.params.groups; ++group) {
                        const float* texel = shares[i * map.params.groups + group].at(x, row);
                        const double code =
                            places[(size_t(y) * size_t(side) + size_t(x)) * request.count + i];
                        const double at =
                            made.start + made.length *
                                             (std::pow(1 + kCodeRatio, code / kCodes) - 1) /
                                             kCodeRatio;
                        if (group == 0) made.distances.push_back(at);
                        dvec3 weight;
                        for (int c = 0; c < 3; ++c) {
                            const double share = std::round(double(texel[c]) * kCodes);
                            made.shares[group][c] += int(share);
                            weight[c] = share / kCodes * double(totals[group].at(x, row)[c]);
                        }
                        made.weights[group].push_back(weight);
                    }
            }
        return result;
    }

    std::optional<gl::ShaderLibrary> library_;
    std::optional<fg::Executor> executor_;
    std::optional<MediaSystem> media_;
    SettingsRegistry registry_;
};
TYNDALL_GL_TESTS(SurfelIntervalsTest);

// Sums of single precision over up to a few hundred segments.
constexpr double kSum = 1e-6;

void expectOrder(const Way& way) {
    for (size_t i = 0; i < way.distances.size(); ++i) {
        EXPECT_GE(way.distances[i], i > 0 ? way.distances[i - 1] : way.start);
        EXPECT_LE(way.distances[i], (way.start + way.length) * (1 + 1e-7));
    }
}

/// Weights, and points without jitter, of rays through boxes. Returns how many rays have a medium.
int expectBoxes(const std::vector<Way>& ways, const std::vector<Box>& boxes, uint32_t count,
                bool ofPoints = true) {
    int filled = 0, fewest = int(kCodes), most = 0;
    for (const Way& way : ways) {
        const std::vector<Stretch> stretches = stretchesOf(boxes, way);
        const Expected all = expectedOf(stretches, boxes.size());
        if (stretches.empty()) {
            EXPECT_EQ(way.length, 0);
            continue;
        }
        ++filled;
        const double opacity = 1 - meanOf(all.through);
        EXPECT_NEAR(way.opacity, opacity, kSum);
        EXPECT_NEAR(way.start, stretches.front().start, 1e-6 * way.start);
        EXPECT_NEAR(way.start + way.length, stretches.back().end, 1e-6 * stretches.back().end);
        for (size_t box = 0; box < boxes.size(); ++box)
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(way.sum(box)[c], all.light[box][c], kSum) << "medium " << box;
                if (all.light[box][c] > 1e-30) fewest = std::min(fewest, way.shares[box][c]);
                most = std::max(most, way.shares[box][c]);
            }
        expectOrder(way);
        if (way.distances.size() != count) {
            ADD_FAILURE() << way.distances.size() << " intervals";
            continue;
        }
        for (uint32_t i = 0; ofPoints && i < count; ++i) {
            const double target = (i + 0.5) / count * opacity;
            const double at = way.distances[i], off = way.resolution(at);
            // The opacity grows along the ray: the wanted one is met within the
            // resolution, and where it is a matter of rounding.
            const double before = 1 - meanOf(expectedOf(stretches, 1, at - off).through),
                         behind = 1 - meanOf(expectedOf(stretches, 1, at + off).through);
            EXPECT_GE(target, before - kSum)
                << "interval " << i << " at " << at << ", opacity " << opacity;
            EXPECT_LE(target, behind + kSum)
                << "interval " << i << " at " << at << ", opacity " << opacity;
        }
    }
    EXPECT_EQ(fewest, int(kCodes)) << "shares do not sum to all of the light";
    EXPECT_EQ(most, int(kCodes));
    return filled;
}

const dvec3 kWideMinimum(-20, -20, -6), kWideMaximum(20, 20, -2);

TEST_P(SurfelIntervalsTest, WeightsSumToOneMinusTransmittance) {
    for (const double depth : {1e-4, 0.01, 0.1, 1.0, 10.0, 100.0}) {
        SCOPED_TRACE(depth);
        const std::vector<Box> boxes = {{kWideMinimum, kWideMaximum, dvec3(depth / 4), dvec3(0)}};
        for (const uint32_t count : {8u, 16u, 32u}) {
            Request request;
            request.count = count;
            const std::vector<Way> ways = mapOf(boxes, request);
            EXPECT_EQ(expectBoxes(ways, boxes, count), kSide * kSide);
            for (const Way& way : ways) // albedo 1: what is not scattered gets through
                EXPECT_NEAR(way.sum(0).x, -std::expm1(-depth / -way.direction.z), kSum);
        }
    }
}

TEST_P(SurfelIntervalsTest, NoMediumIsTooThinForItsLight) {
    // However thin, it is cut into equal lengths: lights are as bright as they like.
    for (const char* steps : {"media.march.steps=32", "media.march.steps=2"})
        for (const double depth : {1e-3, 1e-4, 1e-5, 1e-6, 1e-8}) {
            const std::vector<Box> boxes = {
                {kWideMinimum, kWideMaximum, dvec3(depth / 4), dvec3(0)}};
            Request request;
            request.settings = {steps};
            double least = 1, farthest = 0;
            for (const Way& way : mapOf(boxes, request)) {
                ASSERT_EQ(way.distances.size(), 16u);
                least = std::min(least, way.sum(0).x / -std::expm1(-depth / -way.direction.z));
                for (size_t i = 0; i < 16; ++i)
                    farthest =
                        std::max(farthest, std::abs((way.distances[i] - way.start) / way.length -
                                                    (double(i) + 0.5) / 16));
            }
            printf("depth %.0e, %s: at least %.6f of the light, points within %.1e of the way\n",
                   depth, steps, least, farthest);
            EXPECT_NEAR(least, 1, 1e-5) << depth;
            // What a code resolves, and at 1e-3 the medium's own 1e-3/8.
            EXPECT_LT(farthest, 3e-4) << depth;
        }
}

TEST_P(SurfelIntervalsTest, IntervalsOfOneMediumWeighTheSame) {
    // A homogeneous medium of one colour: equal parts of opacity are equal parts of light.
    const std::vector<Box> boxes = {{kWideMinimum, kWideMaximum, dvec3(0.3), dvec3(0.2)}};
    for (const Way& way : mapOf(boxes))
        for (const dvec3& weight : way.weights[0])
            EXPECT_NEAR(weight.x * 16 / way.sum(0).x, 1,
                        16 / kCodes + 1e-5); // a code is 1/65535 of all
}

TEST_P(SurfelIntervalsTest, AColouredMediumHasTheLightOfEachChannel) {
    for (const double scale : {0.01, 1.0, 20.0}) {
        SCOPED_TRACE(scale);
        const std::vector<Box> boxes = {{kWideMinimum, kWideMaximum, scale * dvec3(0.1, 0.5, 1.1),
                                         scale * dvec3(0.02, 0, 0.3)}};
        for (const uint32_t count : {8u, 32u}) {
            Request request;
            request.count = count;
            EXPECT_EQ(expectBoxes(mapOf(boxes, request), boxes, count), kSide * kSide);
        }
    }
}

TEST_P(SurfelIntervalsTest, TwoPhaseFunctionsHaveTheirOwnLight) {
    // One behind the other with a gap between, and over one another.
    for (const double nearest : {-4.0, -8.0}) {
        const std::vector<Box> boxes = {
            {kWideMinimum, kWideMaximum, dvec3(0.2, 0.1, 0.3), dvec3(0.1), 0},
            {{-30, -30, -12}, {30, 30, nearest}, dvec3(0.1, 0.3, 0.2), dvec3(0, 0.1, 0.2), 0.8f}};
        EXPECT_EQ(expectBoxes(mapOf(boxes), boxes, 16), kSide * kSide);
    }
}

TEST_P(SurfelIntervalsTest, RaysBesideAMediumHaveNoLength) {
    const std::vector<Box> boxes = {{{-0.5, -2, -6}, {2, 0.5, -4}, dvec3(1), dvec3(0)}};
    const std::vector<Way> ways = mapOf(boxes);
    const int filled = expectBoxes(ways, boxes, 16);
    EXPECT_GT(filled, 5);
    EXPECT_LT(filled, kSide * kSide / 2);
    // What takes light away and scatters none is no way for light either.
    for (const Way& way : mapOf(std::vector<Box>{{kWideMinimum, kWideMaximum, dvec3(0), dvec3(1)}}))
        EXPECT_EQ(way.length, 0);
}

TEST_P(SurfelIntervalsTest, AWallEndsTheWay) {
    const std::vector<Box> boxes = {{kWideMinimum, kWideMaximum, dvec3(0.3, 0.2, 0.1), dvec3(0)}};
    Request request;
    request.surface = 3.5;
    EXPECT_EQ(expectBoxes(mapOf(boxes, request), boxes, 16), kSide * kSide);
    request.surface = 1;
    for (const Way& way : mapOf(boxes, request)) EXPECT_EQ(way.length, 0);
}

TEST_P(SurfelIntervalsTest, AReducedPictureHasRaysOfPixels) {
    const std::vector<Box> boxes = {{{-0.5, -2, -6}, {2, 0.5, -4}, dvec3(1, 0.5, 0.1), dvec3(0)}};
    for (const int factor : {2, 3, 4}) {
        Request request;
        request.factor = factor;
        const std::vector<Way> ways = mapOf(boxes, request);
        ASSERT_GT(expectBoxes(ways, boxes, 16), 0) << factor;
    }
}

TEST_P(SurfelIntervalsTest, FarAndThinMediaKeepTheirPlaces) {
    // 1 cm behind a kilometre of nothing: the way begins where the medium does, and points
    // are told apart in it.
    const std::vector<Box> thin = {
        {{-1e4, -1e4, -1000.01}, {1e4, 1e4, -1000}, dvec3(100), dvec3(0)}};
    for (const Way& way : mapOf(thin)) {
        ASSERT_EQ(way.distances.size(), 16u);
        for (size_t i = 0; i < 16; ++i) {
            const double behind =
                -std::log1p(-(double(i) + 0.5) / 16 * -std::expm1(-1 / -way.direction.z)) / 100;
            const double expected = 1000 / -way.direction.z + behind;
            EXPECT_NEAR(way.distances[i] / expected, 1, 2e-4);
            EXPECT_NEAR(way.distances[i], expected,
                        5e-4); // four digits of a float above 1024, 1/20 of the slab
        }
        EXPECT_GT(way.distances[15] - way.distances[0],
                  0.007); // (ln 32/31 …) of a mean free path of 1 cm
        EXPECT_NEAR(way.sum(0).x, -std::expm1(-1 / -way.direction.z),
                    0.05); // rounding of 1000 m is 1 % of 1 cm
    }
    // Mist at a metre and a slab at 10⁴ m on one way: codes resolve 1.4e-4 of the distance.
    const std::vector<Box> far = {{{-2e4, -2e4, -2}, {2e4, 2e4, -1}, dvec3(0.2), dvec3(0)},
                                  {{-2e4, -2e4, -10010}, {2e4, 2e4, -10000}, dvec3(0.5), dvec3(0)}};
    for (const Way& way : mapOf(far)) {
        const std::vector<Stretch> stretches = stretchesOf(far, way);
        const Expected all = expectedOf(stretches, 1);
        ASSERT_EQ(way.distances.size(), 16u);
        int behind = 0;
        for (size_t i = 0; i < 16; ++i) {
            // Bisection in the closed form.
            double low = 0, high = stretches.back().end;
            for (int step = 0; step < 100; ++step) {
                const double middle = 0.5 * (low + high);
                const bool before = 1 - meanOf(expectedOf(stretches, 1, middle).through) <
                                    (double(i) + 0.5) / 16 * (1 - meanOf(all.through));
                (before ? low : high) = middle;
            }
            behind += low > 1e4;
            // Right behind the start a step is length/10⁴ · 1.4e-4.
            EXPECT_NEAR(way.distances[i], low, 2e-4 * low) << i;
        }
        EXPECT_GT(behind, 8);
        EXPECT_LT(behind, 16);
    }
}

/// Rays through a density field along which transmittance is summed up in double precision,
/// albedo 1.
void expectField(const std::vector<Way>& ways, const std::function<double(const dvec3&)>& density,
                 const dvec3& extinction, uint32_t count, double tolerance) {
    constexpr int kSteps = 40000;
    for (const Way& way : ways) {
        ASSERT_EQ(way.distances.size(), count);
        expectOrder(way);
        std::vector<double> depth(kSteps + 1);
        const double step = way.length / kSteps;
        for (int i = 0; i < kSteps; ++i)
            depth[size_t(i) + 1] =
                depth[size_t(i)] +
                step * density(way.origin + way.direction * (way.start + (i + 0.5) * step));
        const auto opacityAt = [&](double distance) {
            const double at = std::clamp((distance - way.start) / step, 0.0, double(kSteps));
            const auto i = std::min(size_t(at), size_t(kSteps - 1));
            const double d = depth[i] + (at - double(i)) * (depth[i + 1] - depth[i]);
            return 1 - meanOf(glm::exp(-extinction * d));
        };
        const dvec3 through = glm::exp(-extinction * depth.back());
        EXPECT_NEAR(way.opacity, 1 - meanOf(through), 2e-6);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(way.sum(0)[c], 1 - through[c], 2e-6);
            EXPECT_EQ(way.shares[0][c], int(kCodes));
        }
        for (uint32_t i = 0; i < count; ++i) {
            const double target = (i + 0.5) / count * way.opacity,
                         off = way.resolution(way.distances[i]);
            EXPECT_GE(target, opacityAt(way.distances[i] - off) - tolerance) << i;
            EXPECT_LE(target, opacityAt(way.distances[i] + off) + tolerance) << i;
        }
    }
}

TEST_P(SurfelIntervalsTest, HeightFogIsCutByItsTransmittance) {
    // Seen from 3 m above its ground, up and down: it thins out with a scale height of 2 m.
    Medium fog;
    fog.name = "fog";
    fog.kind = MediumKind::Height;
    fog.scaleHeight = 2;
    fog.scattering = vec3(0.2f, 0.3f, 0.4f);
    Scene scene;
    addMedium(scene, fog, glm::translate(dmat4(1), dvec3(0, -3, 0)));
    const auto density = [](const dvec3& p) { return std::exp(-std::max(p.y + 3, 0.0) / 2); };
    for (const uint32_t count : {8u, 16u, 32u}) {
        Request request;
        request.count = count;
        request.surface = 12;
        // Inside a segment extinction is taken to be linear: the chord of an exponential
        // over a step of 1/16 of the light is off by less than a hundredth of it.
        expectField(mapOf(scene, request), density, dvec3(0.2, 0.3, 0.4), count, 1e-3);
    }
}

TEST_P(SurfelIntervalsTest, AFieldThatJumpsFromVoxelToVoxelIsCutByItsTransmittance) {
    // 24³ voxels of 0.1 m, a third of them empty: no two alike.
    DenseField field({0, 0, 0}, {24, 24, 24});
    Draw draw(5);
    for (float& voxel : field.voxels)
        voxel = draw.uniform() < 0.33 ? 0.0f : float(draw.uniform(0, 3));
    const dmat4 worldFromIndex =
        glm::translate(dmat4(1), dvec3(-1.15, -1.15, -4.3)) * glm::scale(dmat4(1), dvec3(0.1));
    Medium smoke;
    smoke.name = "smoke";
    smoke.kind = MediumKind::Grid;
    smoke.scattering = vec3(1, 0.7f, 0.4f);
    smoke.density = std::make_shared<const BrickGrid>(
        makeBrickGrid(field.voxels, field.first, field.size, worldFromIndex));
    Scene scene;
    addMedium(scene, smoke, dmat4(1));
    const dmat4 indexFromWorld = glm::inverse(worldFromIndex);
    const auto density = [&](const dvec3& p) {
        return field.trilinear(dvec3(indexFromWorld * dvec4(p, 1)));
    };
    for (const uint32_t count : {8u, 32u}) {
        Request request;
        request.count = count;
        std::vector<Way> filled;
        for (const Way& way : mapOf(scene, request))
            if (way.length > 1) filled.push_back(way);
        ASSERT_GT(filled.size(), 20u);
        // In a cell extinction is linear between its ends, as the field is not: a part
        // of what a cell of 0.1 m with a density of up to 3 takes.
        expectField(filled, density, dvec3(1, dvec3(0.7f).x, dvec3(0.4f).x), count, 0.03);
    }
}

TEST_P(SurfelIntervalsTest, StepsThroughAFieldHaveOneTransmittance) {
    // Not cell by cell but in steps: both walks take the same, so distances rise and the
    // light is that of the opacity.
    DenseField field({0, 0, 0}, {24, 24, 24});
    Draw draw(6);
    for (float& voxel : field.voxels) voxel = float(draw.uniform(0, 3));
    Medium smoke;
    smoke.name = "smoke";
    smoke.kind = MediumKind::Grid;
    smoke.scattering = vec3(1);
    smoke.density = std::make_shared<const BrickGrid>(makeBrickGrid(
        field.voxels, field.first, field.size,
        glm::translate(dmat4(1), dvec3(-1.15, -1.15, -4.3)) * glm::scale(dmat4(1), dvec3(0.1))));
    Scene scene;
    addMedium(scene, smoke, dmat4(1));
    Request request;
    request.settings = {"media.integration=steps", "media.march.stepScale=3"};
    request.jitter = true;
    int filled = 0;
    for (const Way& way : mapOf(scene, request)) {
        if (!(way.length > 0)) continue;
        ++filled;
        expectOrder(way);
        EXPECT_NEAR(way.sum(0).x, way.opacity, 2e-6);
        for (const dvec3& weight : way.weights[0]) EXPECT_NEAR(weight.x, way.sum(0).x / 16, 2e-5);
    }
    EXPECT_GT(filled, 20);
}

TEST_P(SurfelIntervalsTest, JitterMovesAllPointsOfARayAlike) {
    const std::vector<Box> boxes = {{kWideMinimum, kWideMaximum, dvec3(0.5), dvec3(0)}};
    Request request;
    request.jitter = true;
    double sum = 0;
    std::vector<double> shifts;
    const std::vector<Way> ways = mapOf(boxes, request);
    expectBoxes(ways, boxes, 16, false);
    for (const Way& way : ways) {
        const std::vector<Stretch> stretches = stretchesOf(boxes, way);
        const double opacity = 1 - meanOf(expectedOf(stretches, 1).through);
        std::vector<double> here;
        for (size_t i = 0; i < way.distances.size(); ++i)
            here.push_back((1 - meanOf(expectedOf(stretches, 1, way.distances[i]).through)) /
                               opacity * 16 -
                           double(i));
        const auto [low, high] = std::minmax_element(here.begin(), here.end());
        EXPECT_GE(*low, -1e-3);
        EXPECT_LE(*high, 1 + 1e-3);
        EXPECT_LT(*high - *low, 5e-3)
            << "codes of 1e-4 of the distance are some thousandths of an interval";
        shifts.push_back(here[8]);
        sum += here[8];
    }
    // Spread over 0 to 1: 64 of them have a mean of 1/2 with a deviation of 0.29/8 at most.
    EXPECT_NEAR(sum / double(shifts.size()), 0.5, 3.5 * 0.29 / 8);
    const auto [least, most] = std::minmax_element(shifts.begin(), shifts.end());
    EXPECT_LT(*least, 0.15);
    EXPECT_GT(*most, 0.85);
}

} // namespace
} // namespace tyndall::test
