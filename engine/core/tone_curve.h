#pragma once
// From light to display, as shaders/post/tonemap.comp does it, for what looks at pictures without a GPU.

#include <cstdint>
#include <string_view>

#include "core/image.h"
#include "core/math.h"

namespace tyndall {

enum class ToneCurve : int32_t { Linear = 0, Aces = 1, Agx = 2, Neutral = 3 };
inline constexpr const char* kToneCurveNames[] = {"linear", "aces", "agx", "neutral"};
inline constexpr ToneCurve kDefaultToneCurve = ToneCurve::Agx;

/// Errors name the curves that there are.
Result<ToneCurve> parseToneCurve(std::string_view name);

/// From exposed linear sRGB (1 is display white, no value negative) to display-referred linear sRGB in [0,1].
dvec3 applyToneCurve(ToneCurve curve, const dvec3& exposed);
/// IEC 61966-2-1: the encoding of a display's linear light in [0,1].
double srgbFromLinear(double linear);
double linearFromSrgb(double encoded);

/// `nits` (RGB, more channels are left out; or one channel, which is grey) as shown at EV100 `ev100`: 1.2·2^EV100 nits are
/// display white. RGB in [0,1], sRGB-encoded, without dithering. Invalid values are black, as in the display pass.
Image displayImage(const Image& nits, double ev100, ToneCurve curve);

} // namespace tyndall
