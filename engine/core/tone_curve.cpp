#include "core/tone_curve.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace tyndall {
namespace {

// Stephen Hill's fit of the ACES reference rendering and output transforms (BakingLab, 2016). Columns, as in GLSL.
dvec3 toneAces(const dvec3& c) {
    const dmat3 input(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566,
                      0.83777);
    const dmat3 output(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605,
                       1.07602);
    const dvec3 v = input * c;
    const dvec3 a = v * (v + 0.0245786) - 0.000090537;
    const dvec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return output * (a / b);
}

// AgX (Troy Sobotka), base look, by Benjamin Wrensch's polynomial; see shaders/post/tone_curves.glsl.
dvec3 toneAgx(const dvec3& c) {
    const dmat3 rec2020FromSrgb(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0113,
                                0.8956);
    const dmat3 srgbFromRec2020(1.6605, -0.1246, -0.0182, -0.5876, 1.1329, -0.1006, -0.0728,
                                -0.0083, 1.1187);
    const dmat3 inset(0.856627153, 0.137318973, 0.111898213, 0.095121241, 0.761241991, 0.076799419,
                      0.048251606, 0.101439036, 0.811302368);
    const dmat3 outset(1.127100582, -0.141329763, -0.141329763, -0.110606643, 1.157823702,
                       -0.110606643, -0.016493939, -0.016493939, 1.251936407);
    constexpr double kMinimumEv = -12.47393, kMaximumEv = 4.026069;
    dvec3 v = inset * (rec2020FromSrgb * c);
    for (int i = 0; i < 3; ++i) {
        const double ev = std::log2(std::max(v[i], 1e-10));
        const double x = std::clamp((ev - kMinimumEv) / (kMaximumEv - kMinimumEv), 0.0, 1.0);
        v[i] = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x -
               0.00232;
    }
    v = outset * v;
    for (int i = 0; i < 3; ++i) v[i] = std::pow(std::max(v[i], 0.0), 2.2);
    return srgbFromRec2020 * v;
}

// Khronos PBR Neutral (specification of 2024).
dvec3 toneNeutral(dvec3 c) {
    constexpr double kStart = 0.8 - 0.04, kDesaturation = 0.15;
    const double least = std::min({c.x, c.y, c.z});
    c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    const double peak = std::max({c.x, c.y, c.z});
    if (peak < kStart) return c;
    const double room = 1.0 - kStart;
    const double newPeak = 1.0 - room * room / (peak + room - kStart);
    c *= newPeak / peak;
    return glm::mix(c, dvec3(newPeak), 1.0 - 1.0 / (kDesaturation * (peak - newPeak) + 1.0));
}

double validOrBlack(float value) { return value >= 0 && std::isfinite(value) ? double(value) : 0; }

} // namespace

Result<ToneCurve> parseToneCurve(std::string_view name) {
    for (size_t i = 0; i < std::size(kToneCurveNames); ++i)
        if (name == kToneCurveNames[i]) return ToneCurve(i);
    return Error{
        fmt::format("'{}' is no tone curve: there are linear, aces, agx and neutral", name)};
}

dvec3 applyToneCurve(ToneCurve curve, const dvec3& exposed) {
    dvec3 c = exposed;
    switch (curve) {
    case ToneCurve::Linear: break;
    case ToneCurve::Aces: c = toneAces(c); break;
    case ToneCurve::Agx: c = toneAgx(c); break;
    case ToneCurve::Neutral: c = toneNeutral(c); break;
    }
    return glm::clamp(c, 0.0, 1.0);
}

double srgbFromLinear(double linear) {
    return linear > 0.0031308 ? 1.055 * std::pow(linear, 1 / 2.4) - 0.055 : 12.92 * linear;
}

double linearFromSrgb(double encoded) {
    return encoded > 0.04045 ? std::pow((encoded + 0.055) / 1.055, 2.4) : encoded / 12.92;
}

Image displayImage(const Image& nits, double ev100, ToneCurve curve) {
    CHECK(nits.channels == 1 || nits.channels >= 3, "a picture is grey or RGB");
    const double exposure = std::exp2(-ev100) / 1.2;
    Image display(nits.width, nits.height, 3);
    const size_t stride = size_t(nits.channels);
    for (size_t i = 0; i < nits.pixels.size() / stride; ++i) {
        const float* from = nits.pixels.data() + i * stride;
        dvec3 light(validOrBlack(from[0]));
        if (stride >= 3) light = {light.x, validOrBlack(from[1]), validOrBlack(from[2])};
        // The display pass's bound: beyond it every curve is flat.
        const dvec3 shown = applyToneCurve(curve, glm::min(light * exposure, dvec3(1048576.0)));
        for (int c = 0; c < 3; ++c)
            display.pixels[i * 3 + size_t(c)] = float(srgbFromLinear(shown[c]));
    }
    return display;
}

} // namespace tyndall
