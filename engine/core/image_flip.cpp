// LDR-FLIP (see display_metrics.h). Sections and equations are those of the paper. The filters of the paper are sums of
// products of a row and a column, which is how they are applied here.

#include "core/display_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math.h"
#include "core/separable_filter.h"
#include "core/tone_curve.h"

namespace tyndall {
namespace {

// Section 4.1.1: contrast sensitivity as a sum of two Gaussians a·sqrt(π/b)·exp(-π²x²/b), x in degrees (table 1).
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1}, kRedGreen{1, 0.0053, 0, 1},
    kBlueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double kWidestB =
    0.04; // all filters reach as far as the widest: three standard deviations

constexpr double kColourExponent = 0.7;  // q_c, section 4.1.3
constexpr double kBreak = 0.4;           // p_c: below this share of the largest error …
constexpr double kErrorAtBreak = 0.95;   // … p_t, is most of the range
constexpr double kFeatureExponent = 0.5; // q_f, section 4.2.2
constexpr double kFeatureWidthDegrees =
    0.082; // w, section 4.2.1: from peak to trough of the edge detector

/// Linear sRGB to XYZ of D65, from the primaries and the white of IEC 61966-2-1 in exact fractions. Columns, as in GLM.
dmat3 xyzFromRgb() {
    return {{10135552.0 / 24577794.0, 2613072.0 / 12288897.0, 1425312.0 / 73733382.0},
            {8788810.0 / 24577794.0, 8788810.0 / 12288897.0, 8788810.0 / 73733382.0},
            {4435075.0 / 24577794.0, 887015.0 / 12288897.0, 70074185.0 / 73733382.0}};
}

struct Colours {
    dmat3 xyz = xyzFromRgb();
    dmat3 rgb = glm::inverse(xyz);
    dvec3 white = xyz * dvec3(1);

    /// The linear opponent space YCxCz.
    [[nodiscard]] dvec3 opponentFromLinear(const dvec3& linear) const {
        const dvec3 t = (xyz * linear) / white;
        return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
    }
    [[nodiscard]] dvec3 linearFromOpponent(const dvec3& c) const {
        const double y = (c.x + 16) / 116;
        return rgb * (dvec3(y + c.y / 500, y, y - c.z / 200) * white);
    }
    /// CIELAB with a and b scaled by L/100, as colourfulness falls with luminance (Hunt's effect, section 4.1.2).
    [[nodiscard]] dvec3 huntLabFromLinear(const dvec3& linear) const {
        const dvec3 t = (xyz * linear) / white;
        constexpr double kDelta = 6.0 / 29;
        const auto root = [](double v) {
            return v > kDelta * kDelta * kDelta ? std::cbrt(v)
                                                : v / (3 * kDelta * kDelta) + 4.0 / 29;
        };
        const double x = root(t.x), y = root(t.y), z = root(t.z);
        const double lightness = 116 * y - 16;
        return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
    }
};

/// HyAB (Abasi, Tehran, Fairchild 2020): lightness by the city-block distance, colour by the Euclidean one.
double hyab(const dvec3& a, const dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

using Opponent = std::array<Plane, 3>;

Opponent opponentPlanes(const Image& display, const Colours& colours) {
    const Plane empty(display.width, display.height);
    Opponent planes = {empty, empty, empty};
    for (size_t i = 0; i < empty.values.size(); ++i) {
        const float* rgb = display.pixels.data() + i * 3;
        const dvec3 linear(linearFromSrgb(double(rgb[0])), linearFromSrgb(double(rgb[1])),
                           linearFromSrgb(double(rgb[2])));
        const dvec3 opponent = colours.opponentFromLinear(linear);
        for (int c = 0; c < 3; ++c) planes[size_t(c)].values[i] = opponent[c];
    }
    return planes;
}

/// Section 4.1.1, equations 1 to 5: what the eye resolves of one opponent channel. The filter's weights sum to 1.
Plane filterBySensitivity(const Plane& plane, const Sensitivity& s, double pixelsPerDegree) {
    const int radius = int(std::ceil(3 * std::sqrt(kWidestB / (2 * kPi * kPi)) * pixelsPerDegree));
    const auto bell = [&](double b) {
        return gaussianKernel(std::sqrt(b / (2 * kPi * kPi)) * pixelsPerDegree, radius);
    };
    const auto weight = [](double a, double b) { return a * std::sqrt(kPi / b); };
    const Kernel first = bell(s.b1), second = bell(s.b2);
    const double first2 = sumOf(first) * sumOf(first), second2 = sumOf(second) * sumOf(second);
    const double total = weight(s.a1, s.b1) * first2 + weight(s.a2, s.b2) * second2;
    Plane out = filterDown(filterAcross(plane, scaled(first, weight(s.a1, s.b1) / total)), first);
    if (s.a2 == 0) return out;
    const Plane more =
        filterDown(filterAcross(plane, scaled(second, weight(s.a2, s.b2) / total)), second);
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] += more.values[i];
    return out;
}

/// Section 4.1: what is left of the picture after the eye, in Hunt-adjusted CIELAB.
std::vector<dvec3> perceivedColours(const Opponent& planes, const Colours& colours,
                                    double pixelsPerDegree) {
    const Plane y = filterBySensitivity(planes[0], kAchromatic, pixelsPerDegree);
    const Plane cx = filterBySensitivity(planes[1], kRedGreen, pixelsPerDegree);
    const Plane cz = filterBySensitivity(planes[2], kBlueYellow, pixelsPerDegree);
    std::vector<dvec3> out(y.values.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const dvec3 linear = colours.linearFromOpponent({y.values[i], cx.values[i], cz.values[i]});
        out[i] = colours.huntLabFromLinear(glm::clamp(linear, 0.0, 1.0));
    }
    return out;
}

/// Section 4.1.3, equation 6: the distance compressed, and most of the range given to what is below the break.
double colourError(double distance, double largest) {
    const double power = std::pow(distance, kColourExponent), knee = kBreak * largest;
    if (power < knee) return kErrorAtBreak * power / knee;
    return std::min(1.0, kErrorAtBreak + (power - knee) / (largest - knee) * (1 - kErrorAtBreak));
}

/// Weights whose positive ones sum to 1 and whose negative ones to -1.
Kernel balanced(Kernel kernel) {
    double positive = 0, negative = 0;
    for (double weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
    for (double& weight : kernel) weight /= weight > 0 ? positive : negative;
    return kernel;
}

struct Features {
    Plane edges, points; // lengths of the responses across and down
};

Plane lengths(const Plane& a, const Plane& b) {
    Plane out(a.width, a.height);
    for (size_t i = 0; i < out.values.size(); ++i)
        out.values[i] = std::hypot(a.values[i], b.values[i]);
    return out;
}

/// Section 4.2.1: first and second derivatives of a Gaussian, on luminance in [0,1].
Features features(const Plane& achromatic, double pixelsPerDegree) {
    const double deviation = 0.5 * kFeatureWidthDegrees * pixelsPerDegree;
    const int radius = int(std::ceil(3 * deviation));
    Kernel bell = gaussianKernel(deviation, radius);
    Kernel edge = bell, point = bell;
    for (int x = -radius; x <= radius; ++x) {
        const size_t i = size_t(x + radius);
        edge[i] *= -x;
        point[i] *= double(x) * x / (deviation * deviation) - 1;
    }
    bell = scaled(bell, 1 / sumOf(bell));
    edge = balanced(edge);
    point = balanced(point);
    Plane normalised = achromatic;
    for (double& value : normalised.values) value = (value + 16) / 116;
    const Plane smoothAcross = filterAcross(normalised, bell),
                smoothDown = filterDown(normalised, bell);
    return {lengths(filterAcross(smoothDown, edge), filterDown(smoothAcross, edge)),
            lengths(filterAcross(smoothDown, point), filterDown(smoothAcross, point))};
}

/// Section 4.2.2, equation 7.
double featureError(double edges, double points) {
    return std::pow(std::max(edges, points) / std::sqrt(2.0), kFeatureExponent);
}

} // namespace

Image flipMap(const Image& display, const Image& reference, double pixelsPerDegree) {
    CHECK(display.width == reference.width && display.height == reference.height &&
              display.channels == 3 && reference.channels == 3 && !display.pixels.empty(),
          "RGB pictures of one size");
    CHECK(pixelsPerDegree > 0, "pixels per degree");
    const Colours colours;
    const Opponent ofDisplay = opponentPlanes(display, colours),
                   ofReference = opponentPlanes(reference, colours);
    const std::vector<dvec3> seen = perceivedColours(ofDisplay, colours, pixelsPerDegree),
                             wanted = perceivedColours(ofReference, colours, pixelsPerDegree);
    const Features has = features(ofDisplay[0], pixelsPerDegree),
                   wants = features(ofReference[0], pixelsPerDegree);
    // Of all colours in sRGB, green and blue are farthest apart.
    const double largest =
        std::pow(hyab(colours.huntLabFromLinear({0, 1, 0}), colours.huntLabFromLinear({0, 0, 1})),
                 kColourExponent);
    Image map(display.width, display.height, 1);
    for (size_t i = 0; i < map.pixels.size(); ++i) {
        const double colour = colourError(hyab(seen[i], wanted[i]), largest);
        const double feature =
            featureError(std::abs(has.edges.values[i] - wants.edges.values[i]),
                         std::abs(has.points.values[i] - wants.points.values[i]));
        map.pixels[i] = float(std::pow(colour, 1 - feature)); // equation 8
    }
    return map;
}

double flip(const Image& display, const Image& reference, double pixelsPerDegree) {
    double sum = 0;
    const Image map = flipMap(display, reference, pixelsPerDegree);
    for (float value : map.pixels) sum += double(value);
    return sum / double(map.pixels.size());
}

} // namespace tyndall
