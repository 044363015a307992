// post/tone_curves.glsl against the same curves in C++ in double precision, which `tyndall compare` shows pictures with.

#include <cmath>
#include <random>

#include "core/tone_curve.h"
#include "gl/gl_fixture.h"
#include "shaders/table_compute.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

using ToneCurveShader = GlTest;
TYNDALL_GL_TESTS(ToneCurveShader);

TEST_P(ToneCurveShader, EqualsTheCurvesInDouble) {
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> exponent(-14, 12);
    std::vector<vec4> inputs;
    for (uint32_t i = 0; i < 4096; ++i) // all colours of light from black to far beyond white
        inputs.emplace_back(vec3(dvec3(std::exp2(exponent(random)), std::exp2(exponent(random)),
                                       std::exp2(exponent(random)))),
                            float(i % 4));
    const std::vector<vec4> outputs =
        runOnGpu({"post/tone_curves.glsl"},
                 "vec3 shown = toneCurve(uint(inputs[id].w), inputs[id].rgb);\n"
                 "outputs[id] = vec4(srgbFromLinear(clamp(shown, 0.0, 1.0)), 0.0);",
                 inputs, inputs.size(), uint32_t(inputs.size()));
    for (size_t i = 0; i < inputs.size(); ++i) {
        const dvec3 shown = applyToneCurve(ToneCurve(int(inputs[i].w)),
                                           dvec3(inputs[i].x, inputs[i].y, inputs[i].z));
        for (int c = 0; c < 3; ++c)
            // A quarter of an 8-bit step: llvmpipe's log2 and pow are good to some 1e-5, which sRGB's slope near black stretches.
            ASSERT_NEAR(double(outputs[i][c]), srgbFromLinear(shown[c]), 1e-3)
                << kToneCurveNames[int(inputs[i].w)] << " of " << inputs[i].x << ", " << inputs[i].y
                << ", " << inputs[i].z << " in channel " << c << ", seed " << seed();
    }
}

} // namespace
} // namespace tyndall::test
