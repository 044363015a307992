// Scalar helpers and phase functions against double precision.
#include <cmath>

#include "core/phase_function.h"
#include "gl/gl_fixture.h"
#include "shaders/media_compute.h"

namespace tyndall::test {
namespace {

using MediaFunctions = GlTest;
TYNDALL_GL_TESTS(MediaFunctions);

std::vector<vec4> runOnly(const std::vector<std::string>& includes, std::string_view body,
                          const std::vector<vec4>& inputs) {
    gl::ShaderLibrary library;
    const Scene scene;
    MediaCompute compute(scene, {});
    return compute.run(library, includes, body, inputs, uint32_t(inputs.size()));
}

TEST_P(MediaFunctions, OneMinusExpOverXIsAccurateFromZeroToOpaque) {
    std::vector<vec4> inputs{vec4(0)};
    for (double x = 1e-12; x < 1e30; x *= 1.07) inputs.emplace_back(float(x));
    const auto outputs = runOnly(
        {"common/math.glsl"},
        "outputs[id] = vec4(oneMinusExpOverX(inputs[id].x), oneMinusExp(inputs[id].x), 0, 0);",
        inputs);
    EXPECT_EQ(outputs[0].x, 1.0f);
    EXPECT_EQ(outputs[0].y, 0.0f);
    for (size_t i = 1; i < inputs.size(); ++i) {
        const double x = double(inputs[i].x), exact = -std::expm1(-x) / x;
        EXPECT_NEAR(double(outputs[i].x) / exact, 1.0, 1e-6) << "x = " << x;
        EXPECT_NEAR(double(outputs[i].y) / -std::expm1(-x), 1.0, 2e-6) << "x = " << x;
    }
}

TEST_P(MediaFunctions, MinusLogOneMinusOverZHasNoCancellation) {
    std::vector<vec4> inputs{vec4(0)};
    for (double z = 1e-9; z < 0.99999; z *= 1.05) inputs.emplace_back(float(z));
    for (double z = 1e-9; z < 1e20; z *= 1.2) inputs.emplace_back(float(-z));
    const auto outputs = runOnly(
        {"common/math.glsl"}, "outputs[id] = vec4(minusLogOneMinusOverZ(inputs[id].x));", inputs);
    EXPECT_EQ(outputs[0].x, 1.0f);
    for (size_t i = 1; i < inputs.size(); ++i) {
        const double z = double(inputs[i].x);
        EXPECT_NEAR(double(outputs[i].x) / (-std::log1p(-z) / z), 1.0, 3e-6) << "z = " << z;
    }
}

TEST_P(MediaFunctions, TruncatedExponentialInvertsItsDistribution) {
    std::vector<vec4> inputs;
    for (const float tau :
         {0.0f, 1e-7f, 1e-4f, 9e-4f, 1.1e-3f, 0.1f, 1.0f, 10.0f, 80.0f, 1e4f, 1e30f})
        for (float u = 0; u < 1.0f; u += 0.03f) inputs.emplace_back(tau, u, 0, 0);
    const auto outputs =
        runOnly({"common/math.glsl"},
                "outputs[id] = vec4(truncatedExponential(inputs[id].x, inputs[id].y));", inputs);
    for (size_t i = 0; i < inputs.size(); ++i) {
        const double tau = double(inputs[i].x), u = double(inputs[i].y), x = double(outputs[i].x);
        ASSERT_GE(x, 0.0);
        ASSERT_LE(x, 1.0);
        // The distribution's value there is u again.
        const double cumulative = tau > 0 ? std::expm1(-tau * x) / std::expm1(-tau) : x;
        EXPECT_NEAR(cumulative, u, 2e-6 + 1e-6 * std::min(tau, 1.0)) << "tau " << tau << " u " << u;
    }
}

TEST_P(MediaFunctions, PhaseFunctionsAgreeWithDoublePrecision) {
    std::vector<vec4> inputs;
    for (const float g :
         {-0.999f, -0.9f, -0.5f, -1e-7f, 0.0f, 1e-7f, 0.3f, 0.5f, 0.9f, 0.99f, 0.999f})
        for (int i = 0; i <= 200; ++i) inputs.emplace_back(g, -1.0f + 0.01f * float(i), 0, 0);
    const auto outputs = runOnly(
        {"common/phase_function.glsl"},
        "outputs[id] = vec4(phaseFunction(0u, inputs[id].x, inputs[id].y), phaseFunction(1u, inputs[id].x, inputs[id].y),"
        " phaseFunction(2u, inputs[id].x, inputs[id].y), 0);",
        inputs);
    for (size_t i = 0; i < inputs.size(); ++i) {
        const double g = double(inputs[i].x), c = double(inputs[i].y);
        // Near the peak 1 - cos carries single precision's rounding of the cosine itself.
        const double tolerance =
            2e-6 + 3e-7 / std::max(1e-3, (1 - std::abs(g)) * (1 - std::abs(g)) +
                                             2 * std::abs(g) * (1 - (g < 0 ? -c : c)));
        EXPECT_NEAR(double(outputs[i].x) / henyeyGreenstein(c, g), 1.0, tolerance)
            << "g " << g << " cos " << c;
        EXPECT_NEAR(double(outputs[i].y) / rayleigh(c), 1.0, 2e-6);
        EXPECT_NEAR(double(outputs[i].z) / cornetteShanks(c, g), 1.0, tolerance)
            << "g " << g << " cos " << c;
    }
}

TEST_P(MediaFunctions, PhaseFunctionsIntegrateToOneOverTheSphere) {
    // Simpson's rule over t with 1 - cos = 2t⁴: panels are fine at the peak.
    constexpr int kPanels = 4000;
    for (const float g : {-0.99f, -0.7f, 0.0f, 0.4f, 0.9f, 0.99f}) {
        std::vector<vec4> inputs;
        for (int i = 0; i <= 2 * kPanels; ++i) {
            const double t = double(i) / (2 * kPanels), versine = 2 * t * t * t * t;
            inputs.emplace_back(g, float(g < 0 ? versine - 1 : 1 - versine), 0, 0);
        }
        const auto outputs = runOnly(
            {"common/phase_function.glsl"},
            "outputs[id] = vec4(phaseFunction(0u, inputs[id].x, inputs[id].y), phaseFunction(1u, inputs[id].x, inputs[id].y),"
            " phaseFunction(2u, inputs[id].x, inputs[id].y), 0);",
            inputs);
        dvec3 sum(0);
        for (int i = 0; i <= 2 * kPanels; ++i) {
            const double t = double(i) / (2 * kPanels);
            const double weight = i == 0 || i == 2 * kPanels ? 1 : (i % 2 ? 4 : 2);
            sum += dvec3(outputs[size_t(i)]) * weight * 8.0 * t * t * t;
        }
        const dvec3 integral = sum * (2 * kPi / (6.0 * kPanels));
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(integral[k], 1.0, 1e-3) << "g " << g << " kind " << k;
    }
}

TEST_P(MediaFunctions, CosinesDrawnFromAPhaseFunctionAreItsOwn) {
    // For even u the drawn cosines are quantiles: between two of them lies an equal part of the function (times its weight).
    constexpr int kCount = 4096;
    for (const auto& [kind, g] : {std::pair{0, -0.9f},
                                  {0, -0.3f},
                                  {0, 0.0f},
                                  {0, 1e-6f},
                                  {0, 0.5f},
                                  {0, 0.97f},
                                  {1, 0.0f},
                                  {2, 0.0f},
                                  {2, 0.6f},
                                  {2, -0.8f}}) {
        std::vector<vec4> inputs;
        for (int i = 0; i < kCount; ++i)
            inputs.emplace_back(g, (float(i) + 0.5f) / float(kCount), float(kind), 0);
        const auto outputs = runOnly(
            {"common/phase_function.glsl"},
            "float weight; float c = samplePhaseFunction(uint(inputs[id].z), inputs[id].x, inputs[id].y, weight);"
            " outputs[id] = vec4(c, weight, 0, 0);",
            inputs);
        double total = 0, mean = 0, second = 0;
        for (const vec4& drawn : outputs) {
            ASSERT_GE(drawn.x, -1.0f);
            ASSERT_LE(drawn.x, 1.0f);
            const double c = double(drawn.x), weight = double(drawn.y) / kCount;
            total += weight;
            mean += weight * c;
            second += weight * c * c;
        }
        const double exactMean = kind == 0   ? double(g)
                                 : kind == 1 ? 0
                                             : cornetteShanksMeanCosine(double(g));
        // Middles of 4,096 equal parts: a part is 2.4e-4, and the peaks' ends take up some of them.
        EXPECT_NEAR(total, 1, 2e-3) << kind << ' ' << g;
        EXPECT_NEAR(mean, exactMean, 2e-3) << kind << ' ' << g;
        // Second moments: (1 + 2g²)/3 of Henyey and Greenstein, 2/5 of Rayleigh.
        if (kind == 2) continue;
        const double exactSecond = kind == 1 ? 0.4 : (1 + 2 * double(g) * double(g)) / 3;
        EXPECT_NEAR(second, exactSecond, 2e-3) << kind << ' ' << g;
    }
}

TEST_P(MediaFunctions, TheBoundTakesAwayWhatFindingSevenSays) {
    // transport.md 4.1, finding 7 and validation 1.7: of the energy of a virtual light in a medium of extinction 1.
    const std::pair<double, double> rows[] = {
        {0.1, 0.0642320}, {0.5, 0.2783679}, {1, 0.4715178}, {2, 0.7030029}, {5, 0.9232342}};
    for (const auto& [x, lost] : rows) {
        // ∫ 4π r² e⁻ʳ min(1/r², b)/4π dr by Simpson's rule, from the shader's own bound.
        constexpr int kPanels = 20000;
        constexpr double kFarthest = 40;
        std::vector<vec4> inputs;
        for (int i = 0; i <= 2 * kPanels; ++i) {
            const double r = kFarthest * i / (2.0 * kPanels);
            inputs.emplace_back(float(r * r), 1.0f, float(x * x), float(x));
        }
        const auto outputs = runOnly(
            {"gi/vpl/clamping.glsl"},
            "outputs[id] = vec4(clampedInverseSquare(inputs[id].x, inputs[id].y, inputs[id].z),"
            " clampLoss(vec3(inputs[id].w)).x, 0, 0);",
            inputs);
        double kept = 0;
        for (int i = 0; i <= 2 * kPanels; ++i) {
            const double r = kFarthest * i / (2.0 * kPanels);
            const double weight = i == 0 || i == 2 * kPanels ? 1 : (i % 2 ? 4 : 2);
            kept += weight * r * r * std::exp(-r) * double(outputs[size_t(i)].x) * kFarthest /
                    (6.0 * kPanels);
        }
        EXPECT_NEAR(1 - kept, lost, 5e-4) << x;
        EXPECT_NEAR(double(outputs[0].y), lost, 1e-6) << x;
    }
}

} // namespace
} // namespace tyndall::test
