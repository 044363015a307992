#include "core/sampling.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace tyndall {

template <typename Real> Real oneMinusExpOverX(Real x) {
    // Below this, 1 - x/2 is exact to the last digit; it also covers 0, where the quotient is 0/0.
    if (x < Real(1e-8)) return Real(1) - x / 2;
    return -std::expm1(-x) / x;
}

template <typename Real> DistanceSample<Real> sampleExponential(Real u, Real sigma) {
    const Real depth = -std::log1p(-u); // finite for every u < 1
    return {depth / sigma, sigma * std::exp(-depth)};
}

template <typename Real>
DistanceSample<Real> sampleTruncatedExponential(Real u, Real sigma, Real length) {
    const Real depth = sigma * length;
    Real distance;
    if (depth < Real(1e-6)) // 0/0 at 0; the next term of the series is below the last digit
        distance = u * length * (1 - (1 - u) * depth / 2);
    else
        distance = -std::log1p(u * std::expm1(-depth)) / sigma;
    distance = std::clamp(distance, Real(0), length);
    return {distance, truncatedExponentialDensity(distance, sigma, length)};
}

template <typename Real> Real truncatedExponentialDensity(Real distance, Real sigma, Real length) {
    if (!(length > 0)) return 0;
    return std::exp(-sigma * distance) / (length * oneMinusExpOverX(sigma * length));
}

namespace {

/// The interval as angles about the light: begin plus [0,span].
template <typename Real> struct Angles {
    Real height, begin, span;
    bool uniform;
};

template <typename Real> Angles<Real> anglesOf(Real nearest, Real height, Real length) {
    const Real h = std::max(height, Real(1e-4) * length);
    if (!(h > 0)) return {h, 0, 0, true};
    const Real a = -nearest, b = length - nearest;
    // The difference of two arctangents cancels when both ends are far; this form of it does not.
    const Real span = std::atan2(h * length, h * h + a * b);
    return {h, std::atan2(a, h), span, span < Real(1e-5)};
}

} // namespace

template <typename Real>
DistanceSample<Real> sampleEquiangular(Real u, Real nearest, Real height, Real length) {
    const Angles<Real> angles = anglesOf(nearest, height, length);
    Real distance = u * length;
    if (!angles.uniform)
        distance = nearest + angles.height * std::tan(angles.begin + u * angles.span);
    distance = std::clamp(distance, Real(0), length);
    return {distance, equiangularDensity(distance, nearest, height, length)};
}

template <typename Real>
Real equiangularDensity(Real distance, Real nearest, Real height, Real length) {
    if (!(length > 0)) return 0;
    const Angles<Real> angles = anglesOf(nearest, height, length);
    if (angles.uniform) return 1 / length;
    const Real along = distance - nearest;
    return angles.height / (angles.span * (angles.height * angles.height + along * along));
}

#define TYNDALL_INSTANTIATE(REAL)                                                                  \
    template REAL oneMinusExpOverX(REAL);                                                          \
    template DistanceSample<REAL> sampleExponential(REAL, REAL);                                   \
    template DistanceSample<REAL> sampleTruncatedExponential(REAL, REAL, REAL);                    \
    template REAL truncatedExponentialDensity(REAL, REAL, REAL);                                   \
    template DistanceSample<REAL> sampleEquiangular(REAL, REAL, REAL, REAL);                       \
    template REAL equiangularDensity(REAL, REAL, REAL, REAL);
TYNDALL_INSTANTIATE(float)
TYNDALL_INSTANTIATE(double)
#undef TYNDALL_INSTANTIATE

} // namespace tyndall
