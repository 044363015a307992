// Walks that are kept while media change, against walks that follow the media.

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "agreement_scenes.h"
#include "tracing/proxy_media.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

/// What virtual lights of N walks sum up to: power on surfaces and in media, after one, two, and more scatterings; and the moment of power about
/// a plane, which tells where they are.
struct Sums {
    static constexpr int kCount = 12;
    std::array<double, kCount> mean{}, variance{}; // of the mean
};

template <typename MakeWalk> Sums sumsOf(uint32_t walks, MakeWalk&& make) {
    std::vector<tracing::WalkVertex> walk;
    std::array<double, Sums::kCount> sum{}, squares{};
    for (uint32_t i = 0; i < walks; ++i) {
        make(i, walk);
        std::array<double, Sums::kCount> one{};
        for (const tracing::WalkVertex& vertex : walk) {
            const int at = (vertex.medium ? 6 : 0) + 2 * std::min(vertex.scatterings - 1, 2);
            const double power = vertex.power.x + vertex.power.y + vertex.power.z;
            EXPECT_TRUE(std::isfinite(power) && power >= 0);
            one[size_t(at)] += power;
            one[size_t(at + 1)] +=
                power * glm::dot(vertex.position, dvec3(0.3, 0.7, 0.6)) + power * vertex.travel.x;
        }
        for (size_t k = 0; k < one.size(); ++k) {
            sum[k] += one[k];
            squares[k] += one[k] * one[k];
        }
    }
    Sums result;
    const double n = walks;
    for (size_t k = 0; k < sum.size(); ++k) {
        result.mean[k] = sum[k] / n;
        result.variance[k] = (squares[k] / n - result.mean[k] * result.mean[k]) / n;
    }
    return result;
}

tracing::TracerScene traced(const Scene& scene) {
    auto result = tracing::TracerScene::build(scene, dvec3(0), 1);
    if (!result.ok()) throw std::runtime_error(result.message());
    return std::move(*result);
}

/// Walks through proxy media, carrying what they carry in the true ones.
class Kept {
public:
    explicit Kept(const Scene& scene)
        : proxy_(tracing::makeProxyMedia(scene, dvec3(0))), truth_(scene, dvec3(0)) {
        traced_ = traced(scene);
        // Lights know the media that glow.
        traced_.lights.reset();
        *traced_.media = std::move(proxy_.field);
        traced_.lights =
            std::make_unique<tracing::Lights>(scene, dvec3(0), *traced_.surfaces, *traced_.media);
        emission_.emplace(traced_);
        walker_.emplace(traced_, *emission_, tracing::WalkSettings{});
    }
    [[nodiscard]] uint64_t hash() const { return proxy_.hash; }
    void trace(tracing::Sampler& sampler, std::vector<tracing::WalkVertex>& walk) {
        walker_->trace(sampler, walk);
    }
    void weigh(std::vector<tracing::WalkVertex>& walk) const {
        tracing::reweigh(walker_->start(), walk, *traced_.media, truth_);
    }

private:
    tracing::ProxyMedia proxy_;
    tracing::MediaField truth_;
    tracing::TracerScene traced_;
    std::optional<tracing::LightEmission> emission_;
    std::optional<tracing::LightWalker> walker_;
};

class KeptWalks : public ::testing::TestWithParam<int> {};

TEST_P(KeptWalks, HaveTheMeanOfWalksThatFollowTheMedia) {
    const AgreementScene made = agreementScene(GetParam());
    const tracing::TracerScene scene = traced(made.scene);
    const tracing::LightEmission emission(scene);
    tracing::LightWalker follower(scene, emission, {});
    Kept kept(made.scene);
    constexpr uint32_t kWalks = 200000;
    const Sums expected = sumsOf(kWalks, [&](uint32_t i, auto& vertices) {
        tracing::Sampler sampler(11, 1, i);
        follower.trace(sampler, vertices);
    });
    const Sums found = sumsOf(kWalks, [&](uint32_t i, auto& vertices) {
        tracing::Sampler sampler(12, 2, i);
        kept.trace(sampler, vertices);
        kept.weigh(vertices);
    });
    int compared = 0;
    double worst = 0, more = 0;
    for (size_t k = 0; k < Sums::kCount; ++k) {
        const double error = std::sqrt(expected.variance[k] + found.variance[k]);
        if (!(error > 0)) {
            EXPECT_EQ(expected.mean[k], found.mean[k]);
            continue;
        }
        ++compared;
        const double off = (found.mean[k] - expected.mean[k]) / error;
        worst = std::max(worst, std::abs(off));
        more = std::max(more, found.variance[k] / expected.variance[k]);
        // Of some hundred sums one is off by 2.6; tails are heavier than a normal distribution's.
        EXPECT_LE(std::abs(off), 4.5) << made.name << ", sum " << k << ": " << found.mean[k]
                                      << " against " << expected.mean[k];
    }
    printf("%s: worst %.2f standard errors of %d sums; up to %.1f times the variance\n", made.name,
           worst, compared, more);
    EXPECT_GE(compared, 4);
}

INSTANTIATE_TEST_SUITE_P(TenScenes, KeptWalks, ::testing::Range(0, kAgreementScenes));

TEST(KeptWalks, GoWhereTheyWentWhenMediaChangeALittle) {
    const auto make = [](float density, double place) {
        SceneMaker maker;
        Medium smoke;
        smoke.kind = MediumKind::Grid;
        smoke.scattering = vec3(density);
        smoke.absorption = vec3(0.2f);
        smoke.density = lumpyGrid(1.0, 2, 3);
        dmat4 at(1.0);
        at[3].x = place;
        maker.addMedium(smoke, at);
        maker.addPrimitive(PrimitiveShape::Box, {4, 0.1, 4}, matt({0.7f, 0.6f, 0.5f}));
        maker.addPointLight({0.5, 1.1, 0.4}, 10, 0.2);
        return maker.take();
    };
    const Scene one = make(1.0f, 0.01), other = make(1.03f, 0.03), more = make(2.0f, 0.01),
                away = make(1.0f, 0.4);
    Kept a(one), b(other);
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_NE(a.hash(), Kept(more).hash());
    EXPECT_NE(a.hash(), Kept(away).hash());
    std::vector<tracing::WalkVertex> before, anew;
    double change = 0, all = 0;
    for (uint32_t i = 0; i < 500; ++i) {
        tracing::Sampler sampler(3, 0, i), same(3, 0, i);
        a.trace(sampler, before);
        b.trace(same, anew);
        ASSERT_EQ(before.size(), anew.size());
        for (size_t k = 0; k < anew.size(); ++k) {
            EXPECT_EQ(before[k].position, anew[k].position);
            EXPECT_EQ(before[k].power, anew[k].power);
        }
        a.weigh(before);
        b.weigh(anew);
        for (size_t k = 0; k < anew.size(); ++k) {
            change += std::abs(anew[k].power.x - before[k].power.x);
            all += before[k].power.x;
        }
    }
    EXPECT_GT(change, 0.001 * all) << "the media did not change";
}

} // namespace
} // namespace tyndall::validation
