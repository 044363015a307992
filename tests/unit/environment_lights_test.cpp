#include "renderer/environment_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/content.h"

namespace tyndall {
namespace {

void expectNear(const dvec3& value, const dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << "component " << i;
}

Environment constant(const vec3& radiance) {
    Environment environment;
    environment.radiance = radiance;
    return environment;
}

template <typename Radiance> Environment painted(int width, int height, Radiance&& radiance) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const vec3 value = radiance(x, y);
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = value[c];
        }
    Environment environment;
    environment.image = std::make_shared<const Image>(std::move(image));
    return environment;
}

/// Some noise, a sun of four pixels, a coloured band.
Environment sunnySky(int width, int height) {
    auto random = std::make_shared<std::mt19937>(uint32_t(test::seed()));
    return painted(width, height, [=](int x, int y) {
        std::uniform_real_distribution<float> noise(0.0f, 1.0f);
        vec3 value(noise(*random), noise(*random), noise(*random));
        if (y > height / 2) value *= vec3(0.1f, 0.05f, 0.0f);
        if ((x == width / 3 || x == width / 3 + 1) && (y == height / 4 || y == height / 4 + 1))
            value += vec3(5e4f, 4e4f, 3e4f);
        return value;
    });
}

/// ∫ L f dω by the midpoint rule over each pixel's exact solid angle.
template <typename Weight> dvec3 integrate(const Environment& environment, Weight&& weight) {
    const Image& image = *environment.image;
    dvec3 sum(0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double solidAngle =
                2 * kPi / image.width *
                (std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height));
            const float* p = image.at(x, y);
            sum += dvec3(double(p[0]), double(p[1]), double(p[2])) * solidAngle *
                   weight(environmentDirection((x + 0.5) / image.width, (y + 0.5) / image.height,
                                               double(environment.rotation)));
        }
    return sum;
}

template <typename Weight>
dvec3 meanOverFrames(const EnvironmentSampler& sampler, int lights, uint32_t frames,
                     Weight&& weight) {
    dvec3 sum(0);
    for (uint32_t frame = 0; frame < frames; ++frame)
        for (const EnvironmentLight& light : sampler.sample(lights, frame, uint32_t(test::seed())))
            sum += light.illuminance * weight(light.toLight);
    return sum / double(frames);
}

TEST(EnvironmentDirection, FollowsTheSceneFormat) {
    expectNear(environmentDirection(0.5, 0.5, 0), {0, 0, -1}, 1e-15);
    expectNear(environmentDirection(0.75, 0.5, 0), {1, 0, 0}, 1e-15);
    expectNear(environmentDirection(0.25, 0.5, 0), {-1, 0, 0}, 1e-15);
    expectNear(environmentDirection(0.3, 0.0, 0), {0, 1, 0}, 1e-15);
    // A quarter turn, right-handed about +Y, takes -Z to -X and +X to -Z.
    expectNear(environmentDirection(0.5, 0.5, kPi / 2), {-1, 0, 0}, 1e-15);
    expectNear(environmentDirection(0.75, 0.5, kPi / 2), {0, 0, -1}, 1e-15);
}

TEST(EnvironmentLights, OfAConstantSkySumToFourPi) {
    const EnvironmentSampler sampler(constant({1.0f, 2.0f, 0.5f}));
    for (const int count : {1, 2, 7, 16, 64}) {
        const auto lights = sampler.lights(count);
        ASSERT_EQ(int(lights.size()), count);
        dvec3 sum(0), mean(0);
        for (const EnvironmentLight& light : lights) {
            EXPECT_NEAR(glm::length(light.toLight), 1.0, 1e-12);
            sum += light.illuminance;
            mean += light.toLight * light.illuminance.x;
        }
        expectNear(sum, dvec3(4 * kPi, 8 * kPi, 2 * kPi), 1e-9);
        if (count < 16) continue;
        EXPECT_LT(glm::length(mean), 0.1 * 4 * kPi) << "the lights lie around evenly";
    }
}

TEST(EnvironmentLights, SumToTheIntegralInEveryChannel) {
    for (const auto& [width, height] :
         {std::pair(200, 100), std::pair(2, 1), std::pair(1, 1), std::pair(31, 17)}) {
        const Environment environment = sunnySky(width, height);
        const dvec3 integral = integrate(environment, [](const dvec3&) { return 1.0; });
        const EnvironmentSampler sampler(environment);
        for (const int count : {1, 5, 16, 100}) {
            dvec3 sum(0);
            for (const EnvironmentLight& light : sampler.lights(count)) sum += light.illuminance;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum[c] / integral[c], 1.0, 1e-6)
                    << width << "x" << height << ", " << count << " lights";
        }
    }
}

TEST(EnvironmentLights, OfAnImageTooWideKeepItsEnergy) {
    const Environment environment = sunnySky(2500, 40);
    const dvec3 integral = integrate(environment, [](const dvec3&) { return 1.0; });
    dvec3 sum(0);
    for (const EnvironmentLight& light : EnvironmentSampler(environment).lights(16))
        sum += light.illuminance;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c] / integral[c], 1.0,
                    2e-3); // rows are averaged over pixels of unequal solid angle
}

TEST(EnvironmentLights, PointToTheSun) {
    Environment environment =
        painted(64, 32, [](int x, int y) { return x == 50 && y == 5 ? vec3(1000) : vec3(0); });
    environment.rotation = 0.7f;
    const auto lights = EnvironmentSampler(environment).lights(16);
    const dvec3 sun = environmentDirection(50.5 / 64, 5.5 / 32, double(0.7f));
    ASSERT_FALSE(lights.empty());
    for (const EnvironmentLight& light : lights)
        EXPECT_GT(glm::dot(light.toLight, sun), std::cos(kPi / 32));
}

TEST(EnvironmentLights, OfABlackSkyAreNone) {
    const EnvironmentSampler black(constant(vec3(0)));
    EXPECT_TRUE(black.black());
    EXPECT_TRUE(black.lights(16).empty());
    EXPECT_TRUE(black.sample(16, 3, 1).empty());
    EXPECT_TRUE(EnvironmentSampler(constant(vec3(1))).lights(0).empty());
    EXPECT_TRUE(EnvironmentSampler().black());
}

TEST(EnvironmentLights, CountBrokenPixelsAsBlack) {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const EnvironmentSampler sampler(painted(64, 32, [&](int x, int y) {
        if (y != 16) return vec3(0);
        return x == 0   ? vec3(nan, 1, 1)
               : x == 1 ? vec3(1, infinity, 1)
               : x == 2 ? vec3(-1, 1, 1)
               : x == 3 ? vec3(1)
                        : vec3(0);
    }));
    EXPECT_EQ(sampler.brokenPixels(), 3u);
    const double solidAngle = 2 * kPi / 64 * (std::cos(kPi * 16 / 32) - std::cos(kPi * 17 / 32));
    expectNear(sampler.fluence(), dvec3(solidAngle), 1e-9);
}

TEST(EnvironmentSamples, AverageToTheCosineIntegralOfAConstantSky) {
    const EnvironmentSampler sampler(constant({1.0f, 0.5f, 2.0f}));
    const dvec3 normal = glm::normalize(dvec3(0.3, 0.8, -0.5));
    const dvec3 mean = meanOverFrames(
        sampler, 16, 1024, [&](const dvec3& d) { return std::max(0.0, glm::dot(d, normal)); });
    expectNear(mean, kPi * dvec3(1, 0.5, 2), 2e-3 * kPi); // irradiance of a uniform sky: πL
}

TEST(EnvironmentSamples, AverageToWhatAnOccluderLeaves) {
    // Everything but the cap of directions with x > 0.3 is hidden: solid angle 2π·0.7 of radiance 1.
    const EnvironmentSampler sampler(constant(vec3(1)));
    const dvec3 mean =
        meanOverFrames(sampler, 16, 4096, [](const dvec3& d) { return d.x > 0.3 ? 1.0 : 0.0; });
    expectNear(mean, dvec3(2 * kPi * 0.7), 4e-3 * 2 * kPi);
}

TEST(EnvironmentSamples, AreUnbiasedUnderASunInEveryChannel) {
    Environment environment = sunnySky(128, 64);
    environment.rotation = -1.1f;
    const EnvironmentSampler sampler(environment);
    for (const dvec3& normal :
         {dvec3(0, 1, 0), dvec3(1, 0, 0), glm::normalize(dvec3(-1, -0.2, 1))}) {
        const auto cosine = [&](const dvec3& d) { return std::max(0.0, glm::dot(d, normal)); };
        const dvec3 expected = integrate(environment, cosine);
        const dvec3 mean = meanOverFrames(sampler, 24, 2048, cosine);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c] / expected[c], 1.0, 5e-3) << "channel " << c;
    }
}

TEST(EnvironmentSamples, DifferBetweenFramesAndRepeatForOne) {
    const EnvironmentSampler sampler(constant(vec3(1)));
    const auto first = sampler.sample(16, 0, 1), again = sampler.sample(16, 0, 1),
               next = sampler.sample(16, 1, 1);
    ASSERT_EQ(first.size(), 16u);
    for (size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].toLight, again[i].toLight);
        EXPECT_NE(first[i].toLight, next[i].toLight);
    }
}

} // namespace
} // namespace tyndall
