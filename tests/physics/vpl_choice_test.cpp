// The choice of virtual lights that matter to a picture: no light is lost on average, and less is left to chance.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "volumetric_gi/vpl/vpl_choice.h"

namespace tyndall::volumetric_gi {
namespace {

/// Lights in a thin isotropic medium in a box of 20 m; what is seen is in a corner of it.
class VplChoice : public ::testing::Test {
protected:
    VplChoice() {
        Medium& medium = scene_.media.emplace_back();
        medium.kind = MediumKind::Box;
        medium.size = dvec3(20);
        medium.scattering = vec3(0.05f);
        Node& node = scene_.nodes.emplace_back();
        node.medium = 0;
        media_ = std::make_unique<tracing::MediaField>(scene_, dvec3(0));
        surfaces_ = std::move(tracing::SurfaceScene::build(scene_, dvec3(0), 1).value());
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> in(-10, 10), unit(0, 1);
        all_.vertices.resize(200);
        for (auto& walk : all_.vertices)
            for (int k = 0; k < 4; ++k) {
                tracing::WalkVertex& light = walk.emplace_back();
                light.position = {in(random), in(random), in(random)};
                light.travel = {0, 0, 1};
                light.power = dvec3(unit(random) * unit(random), 0.2, 0.1);
                light.medium = &media_->media()[0];
            }
        for (int p = 0; p < 32; ++p)
            seen_.push_back({{-9 + unit(random), -9 + unit(random), -9 + unit(random)}});
    }

    /// What a point that is seen gets from lights, but for transmittance.
    static double given(const Walks& walks, const dvec3& at) {
        double sum = 0;
        for (const auto& walk : walks.vertices)
            for (const tracing::WalkVertex& light : walk) {
                const dvec3 way = light.position - at;
                sum += light.power.x / std::max(glm::dot(way, way), 1.0);
            }
        return sum;
    }

    struct Spread {
        double mean = 0, variance = 0, count = 0;
    };
    Spread choose(const std::vector<SeenPoint>& seen, const dvec3& at) const {
        constexpr int kTimes = 400;
        Spread spread;
        double squares = 0;
        for (int i = 0; i < kTimes; ++i) {
            Walks walks = all_;
            chooseLights(walks, seen, *surfaces_, *media_, 100, 1, uint64_t(i));
            const double one = given(walks, at);
            spread.mean += one / kTimes;
            squares += one * one / kTimes;
            for (const auto& walk : walks.vertices) spread.count += double(walk.size()) / kTimes;
        }
        spread.variance = squares - spread.mean * spread.mean;
        return spread;
    }

    Scene scene_;
    std::unique_ptr<tracing::MediaField> media_;
    std::unique_ptr<tracing::SurfaceScene> surfaces_;
    Walks all_;
    std::vector<SeenPoint> seen_;
};

TEST_F(VplChoice, LosesNothingOnAverage) {
    for (const dvec3& at : {dvec3(-8.5), dvec3(0), dvec3(9, -3, 2)}) {
        const Spread spread = choose(seen_, at);
        EXPECT_NEAR(spread.mean, given(all_, at), 4 * std::sqrt(spread.variance / 400));
        EXPECT_NEAR(spread.count, 100, 2); // a sum of 800 chances, 400 times: 0.4
    }
}

TEST_F(VplChoice, LeavesLessToChanceWhereItIsSeen) {
    const double chosen = choose(seen_, dvec3(-8.5)).variance,
                 even = choose({}, dvec3(-8.5)).variance;
    printf("variance with a choice over that without: %.3f\n", chosen / even);
    EXPECT_LT(chosen, 0.3 * even);
}

TEST_F(VplChoice, KeepsAllWhereAllAreWanted) {
    Walks walks = all_;
    chooseLights(walks, seen_, *surfaces_, *media_, 1000, 1, 0);
    EXPECT_EQ(given(walks, dvec3(0)), given(all_, dvec3(0)));
    Walks none;
    chooseLights(none, seen_, *surfaces_, *media_, 10, 1, 0);
    EXPECT_TRUE(none.vertices.empty());
}

} // namespace
} // namespace tyndall::volumetric_gi
