#include "media/particles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "support/content.h"

namespace tyndall {
namespace {

std::string refusal(std::string_view csv) {
    const Result<ParticleSet> set = parseParticles(csv, "cloud.csv");
    return set.ok() ? "taken" : set.message();
}

TEST(Particles, ReadsBothHeaders) {
    const Result<ParticleSet> plain =
        parseParticles("x,y,z,radius,density\n1,2,3,0.5,0.25\n-1e1, 0 ,0.5,1,0\n", "cloud.csv");
    ASSERT_TRUE(plain.ok());
    ASSERT_EQ(plain->particles.size(), 2u);
    EXPECT_FALSE(plain->hasTemperature);
    EXPECT_EQ(plain->particles[0].position, vec3(1, 2, 3));
    EXPECT_EQ(plain->particles[0].radius, 0.5f);
    EXPECT_EQ(plain->particles[0].density, 0.25f);
    EXPECT_EQ(plain->particles[1].position, vec3(-10, 0, 0.5f));
    EXPECT_EQ(plain->bounds().minimum, dvec3(-11, -1, -0.5));
    EXPECT_EQ(plain->bounds().maximum, dvec3(1.5, 2.5, 3.5));

    const Result<ParticleSet> hot = parseParticles(
        "\xef\xbb\xbfx,y,z,radius,density,temperature\r\n\r\n0,0,0,1,1,1500\r\n", "fire.csv");
    ASSERT_TRUE(hot.ok()) << hot.message();
    EXPECT_TRUE(hot->hasTemperature);
    EXPECT_EQ(hot->particles[0].temperature, 1500.0f);
}

TEST(Particles, RefusalsNameTheLineAndWhatWouldBeRight) {
    const std::string header = "x,y,z,radius,density\n";
    EXPECT_EQ(refusal(header + "0,0,0,1,1\n0,0,0,1,one\n"),
              "'cloud.csv', line 3: density is 'one'; a finite number is needed");
    EXPECT_EQ(refusal(header + "\n0,0,0,1\n"), "'cloud.csv', line 3: 4 values; the header has 5");
    EXPECT_EQ(refusal(header + "0,0,0,1,1,1\n"), "'cloud.csv', line 2: 6 values; the header has 5");
    EXPECT_EQ(refusal(header + "0,0,0,0,1\n"),
              "'cloud.csv', line 2: radius is 0; it must be greater than 0");
    EXPECT_EQ(refusal(header + "0,0,0,1,-1\n"),
              "'cloud.csv', line 2: density is -1; it must not be negative");
    EXPECT_EQ(refusal("x,y,z,radius,density,temperature\n0,0,0,1,1,-1\n"),
              "'cloud.csv', line 2: temperature is -1; it must not be negative");
    EXPECT_NE(refusal("x,y,radius\n").find("line 1: the header is 'x,y,radius'; it must be"),
              std::string::npos);
    EXPECT_EQ(refusal(header), "'cloud.csv' holds no particles, only a header");
    EXPECT_NE(refusal("").find("is empty"), std::string::npos);
    for (const char* bad : {"nan", "inf", "1e99", "1x", "", " ", "0x10", "1 2"})
        EXPECT_NE(refusal(header + bad + ",0,0,1,1\n").find("line 2: x is '"), std::string::npos)
            << bad;
}

TEST(Particles, RubbishIsRefusedInOnePrintableSentence) {
    std::string rubbish = "x,y,z,radius,density\n";
    for (int i = 0; i < 3000; ++i) rubbish += char(i * 37 % 256);
    for (const std::string& text :
         {rubbish, std::string(100000, ','), std::string(1000, '\0'),
          std::string("x,y,z,radius,density\n") + std::string(50000, '9')}) {
        const std::string message = refusal(text);
        EXPECT_NE(message, "taken");
        EXPECT_LT(message.size(), 250u);
        for (const char c : message) EXPECT_TRUE(c < 0 || c >= 0x20) << message;
    }
}

TEST(Particles, FilesAreReadAndMissingOnesNamed) {
    const std::filesystem::path folder = test::scratchDir("particles");
    std::ofstream(folder / "one.csv") << "x,y,z,radius,density\n0,0,0,1,1\n";
    EXPECT_TRUE(readParticles(folder / "one.csv").ok());
    const Result<ParticleSet> missing = readParticles(folder / "none.csv");
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.message().find("none.csv"), std::string::npos);
}

TEST(Particles, GeneratedCloudIsReproducibleAndStaysWithinItsRadius) {
    for (const int64_t count : {1, 2, 64, 1024, 20000}) {
        const Result<ParticleSet> cloud = generateParticles("cloud", count, 7, 2.5);
        ASSERT_TRUE(cloud.ok());
        ASSERT_EQ(cloud->particles.size(), size_t(count));
        for (const Particle& p : cloud->particles) {
            ASSERT_LE(double(glm::length(p.position)) + double(p.radius), 2.5 * (1 + 1e-6));
            ASSERT_GT(p.radius, 0.0f);
            ASSERT_GT(p.density, 0.0f);
        }
        const Result<ParticleSet> again = generateParticles("cloud", count, 7, 2.5),
                                  other = generateParticles("cloud", count, 8, 2.5);
        EXPECT_EQ(again->particles.back().position, cloud->particles.back().position);
        EXPECT_NE(other->particles.back().position, cloud->particles.back().position);
    }
}

TEST(Particles, GenerateRefusesWhatMakesNoSense) {
    EXPECT_NE(generateParticles("tree", 10, 1, 1).message().find("'cloud'"), std::string::npos);
    EXPECT_FALSE(generateParticles("cloud", 0, 1, 1).ok());
    EXPECT_FALSE(generateParticles("cloud", 2'000'000, 1, 1).ok());
    EXPECT_FALSE(generateParticles("cloud", 10, 1, 0).ok());
    EXPECT_FALSE(generateParticles("cloud", 10, 1, std::numeric_limits<double>::infinity()).ok());
}

} // namespace
} // namespace tyndall
