#include "core/phase_function.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/math.h"

namespace tyndall {

namespace {

void checkAnisotropy(double g) {
    CHECK(g > -1 && g < 1, "the anisotropy g must lie between -1 and 1");
}

template <typename Real> Real sampleHenyeyGreensteinImpl(Real u, Real g) {
    const Real a = std::abs(g);
    const Real v = g < 0 ? 1 - u : u; // p(cos; -g) = p(-cos; g)
    const Real denominator = 1 - a + 2 * a * v;
    const Real cosine =
        1 - 2 * (1 - a) * (1 - a) * (1 - v) * (1 + a * v) / (denominator * denominator);
    return std::clamp(g < 0 ? -cosine : cosine, Real(-1), Real(1));
}

/// ∫₀^v of the ratio Cornette–Shanks / Henyey–Greenstein over the latter's own primary variable, |g| small: smooth, so
/// that ten Gauss–Legendre points are exact to rounding.
double ratioIntegral(double v, double g) {
    constexpr std::array<double, 5> kNode = {0.1488743389816312, 0.4333953941292472,
                                             0.6794095682990244, 0.8650633666889845,
                                             0.9739065285171717};
    constexpr std::array<double, 5> kWeight = {0.2955242247147529, 0.2692667193099963,
                                               0.2190863625159820, 0.1494513491505806,
                                               0.0666713443086881};
    const auto ratio = [&](double x) {
        const double cosine = sampleHenyeyGreensteinImpl(x, g);
        return 1.5 * (1 + cosine * cosine) / (2 + g * g);
    };
    double sum = 0;
    for (size_t i = 0; i < kNode.size(); ++i)
        sum += kWeight[i] * (ratio(v / 2 * (1 + kNode[i])) + ratio(v / 2 * (1 - kNode[i])));
    return sum * v / 2;
}

/// The share of Cornette–Shanks below `cosine`, 0 < g < 1: elementary in k = (1+g²-2g·cosθ)^½.
double cumulativeCornetteShanks(double cosine, double g) {
    const double c = 1 + g * g, q = 1 / (4 * g * g);
    const auto antiderivative = [&](double k) {
        return -(1 + c * c * q) / k - 2 * c * q * k + q * k * k * k / 3;
    };
    const double k = std::sqrt((1 - g) * (1 - g) + 2 * g * (1 - cosine));
    return 0.75 * (1 - g * g) / ((2 + g * g) * g) * (antiderivative(1 + g) - antiderivative(k));
}

/// The x in [low,high] where the rising function reaches u: Newton steps, halving where they leave the bracket.
template <typename Function, typename Derivative>
double invert(double u, double low, double high, Function function, Derivative derivative) {
    double x = 0.5 * (low + high);
    for (int i = 0; i < 100 && high - low > 1e-15; ++i) {
        const double difference = function(x) - u;
        (difference > 0 ? high : low) = x;
        const double step = difference / derivative(x);
        const double next = x - step;
        if (std::abs(step) < 1e-15) break;
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return x;
}

} // namespace

double henyeyGreenstein(double cosTheta, double g) {
    checkAnisotropy(g);
    const double a = std::abs(g);
    const double versine = g < 0 ? 1 + cosTheta : 1 - cosTheta;
    const double d = (1 - a) * (1 - a) + 2 * a * versine;
    return (1 - a) * (1 + a) / (4 * kPi * d * std::sqrt(d));
}

double henyeyGreensteinFromVersine(double oneMinusCos, double g) {
    checkAnisotropy(g);
    const double d = (1 - g) * (1 - g) + 2 * g * oneMinusCos;
    return (1 - g) * (1 + g) / (4 * kPi * d * std::sqrt(d));
}

double sampleHenyeyGreenstein(double u, double g) {
    checkAnisotropy(g);
    return sampleHenyeyGreensteinImpl(u, g);
}

float sampleHenyeyGreenstein(float u, float g) {
    checkAnisotropy(double(g));
    return sampleHenyeyGreensteinImpl(u, g);
}

double henyeyGreensteinBackFraction(double g) {
    checkAnisotropy(g);
    if (std::abs(g) < 1e-4) return 0.5 - 0.75 * g; // the quotient is 0/0 at 0; next term O(g³)
    return (1 - g) / (2 * g) * ((1 + g) / std::sqrt(1 + g * g) - 1);
}

double rayleigh(double cosTheta) { return 3 / (16 * kPi) * (1 + cosTheta * cosTheta); }

double sampleRayleigh(double u) {
    // cos³ + 3cos = 8u - 4, whose one real root needs no difference of cube roots in this form.
    return std::clamp(2 * std::sinh(std::asinh(4 * u - 2) / 3), -1.0, 1.0);
}

double cornetteShanks(double cosTheta, double g) {
    return henyeyGreenstein(cosTheta, g) * 1.5 * (1 + cosTheta * cosTheta) / (2 + g * g);
}

double sampleCornetteShanks(double u, double g) {
    checkAnisotropy(g);
    if (g < 0) return -sampleCornetteShanks(1 - u, -g);
    if (g < 0.1) { // the closed form cancels like 1/g³
        const auto ratio = [&](double v) {
            return (1 + std::pow(sampleHenyeyGreensteinImpl(v, g), 2)) * 1.5 / (2 + g * g);
        };
        const double v = invert(
            u, 0, 1, [&](double x) { return ratioIntegral(x, g); }, ratio);
        return sampleHenyeyGreensteinImpl(v, g);
    }
    return invert(
        u, -1, 1, [&](double x) { return cumulativeCornetteShanks(x, g); },
        [&](double x) { return 2 * kPi * cornetteShanks(x, g); });
}

double cornetteShanksMeanCosine(double g) { return 3 * g * (4 + g * g) / (5 * (2 + g * g)); }

} // namespace tyndall
