#include "media/blackbody.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace tyndall {

namespace {

constexpr double kPlanck = 6.62607015e-34;  // J s
constexpr double kLight = 299792458.0;      // m/s
constexpr double kBoltzmann = 1.380649e-23; // J/K
constexpr double kLumensPerWatt = 683.0;

/// A bell with one width below and another above its centre; the widths are given as their inverses, per nanometre.
double lobe(double nanometres, double centre, double inverseBelow, double inverseAbove) {
    const double x = (nanometres - centre) * (nanometres < centre ? inverseBelow : inverseAbove);
    return std::exp(-0.5 * x * x);
}

/// Wyman et al. 2013, section 2.2.
dvec3 colourMatching(double nm) {
    return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
                0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
            0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
            1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

/// Spectral radiance, W/(m² sr nm).
double planck(double nm, double kelvin) {
    const double wavelength = nm * 1e-9;
    const double exponent = kPlanck * kLight / (wavelength * kBoltzmann * kelvin);
    return 2 * kPlanck * kLight * kLight / std::pow(wavelength, 5) / std::expm1(exponent) * 1e-9;
}

/// IEC 61966-2-1, linear part, D65.
dvec3 srgbFromXyz(const dvec3& c) {
    return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
            -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
            0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

} // namespace

dvec3 blackbodyXyz(double kelvin) {
    if (!(kelvin > 0)) return dvec3(0);
    dvec3 sum(0);
    for (int nm = 360; nm <= 830; ++nm)
        sum += colourMatching(nm) * planck(nm, kelvin); // the ends contribute nothing: trapezoid
    return kLumensPerWatt * sum;
}

dvec3 blackbodyRadiance(double kelvin) {
    const dvec3 xyz = blackbodyXyz(kelvin);
    dvec3 rgb = srgbFromXyz(xyz);
    const double lowest = std::min({rgb.x, rgb.y, rgb.z});
    if (lowest < 0)
        rgb = glm::max(dvec3(xyz.y) + (rgb - xyz.y) * (xyz.y / (xyz.y - lowest)),
                       dvec3(0)); // max: rounding
    return rgb;
}

double BlackbodyTable::position(double kelvin) const {
    const double t = std::clamp(kelvin, kCoolest, kHottest);
    return double(entries.size() - 1) * (1 / kCoolest - 1 / t) / (1 / kCoolest - 1 / kHottest);
}

dvec3 BlackbodyTable::radiance(double kelvin) const {
    if (!(kelvin >= kCoolest)) return dvec3(0);
    const double where = position(kelvin);
    const size_t below = std::min(size_t(where), entries.size() - 2);
    const dvec4 entry =
        glm::mix(dvec4(entries[below]), dvec4(entries[below + 1]), where - double(below));
    return dvec3(entry) * std::exp2(entry.w);
}

BlackbodyTable makeBlackbodyTable(int entries) {
    CHECK(entries >= 2, "a table to interpolate in has at least two entries");
    BlackbodyTable table;
    for (int i = 0; i < entries; ++i) {
        const double inverse = glm::mix(1 / BlackbodyTable::kCoolest, 1 / BlackbodyTable::kHottest,
                                        double(i) / (entries - 1));
        const dvec3 rgb = blackbodyRadiance(1 / inverse);
        const double luminance = blackbodyXyz(1 / inverse).y;
        table.entries.emplace_back(vec4(vec3(rgb / luminance), float(std::log2(luminance))));
    }
    return table;
}

} // namespace tyndall
