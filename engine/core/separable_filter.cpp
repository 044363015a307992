#include "core/separable_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tyndall {

Plane filterAcross(const Plane& plane, const Kernel& kernel) {
    const int radius = int(kernel.size() / 2), width = plane.width;
    Plane out(width, plane.height);
    std::vector<double> padded(size_t(width + 2 * radius));
    for (int y = 0; y < plane.height; ++y) {
        const double* from = plane.row(y);
        std::fill_n(padded.begin(), radius, from[0]);
        std::copy_n(from, width, padded.begin() + radius);
        std::fill_n(padded.begin() + radius + width, radius, from[width - 1]);
        double* to = out.row(y);
        for (size_t i = 0; i < kernel.size(); ++i)
            for (int x = 0; x < width; ++x) to[x] += kernel[i] * padded[size_t(x) + i];
    }
    return out;
}

Plane filterDown(const Plane& plane, const Kernel& kernel) {
    const int radius = int(kernel.size() / 2);
    Plane out(plane.width, plane.height);
    for (int y = 0; y < plane.height; ++y) {
        double* to = out.row(y);
        for (int i = -radius; i <= radius; ++i) {
            const double* from = plane.row(std::clamp(y + i, 0, plane.height - 1));
            const double weight = kernel[size_t(i + radius)];
            for (int x = 0; x < plane.width; ++x) to[x] += weight * from[x];
        }
    }
    return out;
}

Kernel gaussianKernel(double deviation, int radius) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x)
        kernel.push_back(std::exp(-double(x) * x / (2 * deviation * deviation)));
    return kernel;
}

Kernel scaled(Kernel kernel, double factor) {
    for (double& weight : kernel) weight *= factor;
    return kernel;
}

double sumOf(const Kernel& kernel) { return std::accumulate(kernel.begin(), kernel.end(), 0.0); }

} // namespace tyndall
