#pragma once
// Light of hot matter: Planck's law seen by the CIE 1931 2° observer, as linear sRGB in nits.

#include <vector>

#include "core/math.h"

namespace tyndall {

/// CIE XYZ of a blackbody's radiance at `kelvin`, Y in nits (683 lm/W). 0 at and below 0 K. The colour matching
/// functions are the multi-lobe fits of Wyman, Sloan and Shirley (JCGT 2(2), 2013), integrated from 360 to 830 nm.
[[nodiscard]] dvec3 blackbodyXyz(double kelvin);

/// The same as linear sRGB (D65), luminance Y in nits kept. Below about 1,900 K the colour lies outside sRGB: it is
/// then moved towards the grey of its own luminance until no component is negative.
[[nodiscard]] dvec3 blackbodyRadiance(double kelvin);

/// Blackbody radiance over temperature for a GPU, entries evenly spaced in 1/T, where log luminance is nearly straight.
/// Interpolate linearly between entries: radiance = xyz · 2^w.
struct BlackbodyTable {
    static constexpr double kCoolest =
        400; // kelvin, entry 0; below, luminance is under 10⁻¹⁷ nits: 0
    static constexpr double kHottest =
        40000;                 // kelvin, last entry; hotter matter is shown as hot as this
    std::vector<vec4> entries; // xyz: linear sRGB for 1 nit; w: log2 of the luminance in nits

    /// Where `kelvin` falls among the entries: 0 at kCoolest, entries-1 at kHottest.
    [[nodiscard]] double position(double kelvin) const;
    /// The interpolated radiance, nits: what a shader computes.
    [[nodiscard]] dvec3 radiance(double kelvin) const;
};

/// CHECKs: at least 2 entries.
[[nodiscard]] BlackbodyTable makeBlackbodyTable(int entries = 1024);

} // namespace tyndall
