#pragma once
// Convolution of one channel with a kernel that is a product of a column and a row.

#include <cstddef>
#include <vector>

namespace tyndall {

/// One channel in double precision, top row first.
struct Plane {
    int width = 0, height = 0;
    std::vector<double> values;

    Plane(int columns, int rows)
        : width(columns), height(rows), values(size_t(columns) * size_t(rows), 0.0) {}
    [[nodiscard]] double* row(int y) { return values.data() + size_t(y) * size_t(width); }
    [[nodiscard]] const double* row(int y) const {
        return values.data() + size_t(y) * size_t(width);
    }
};

/// Weights at -radius … radius pixels; an odd number of them.
using Kernel = std::vector<double>;

/// out(x, y) = Σ across(i)·in(x+i, y) for every x; beyond the borders the outermost pixel goes on.
Plane filterAcross(const Plane& plane, const Kernel& kernel);
/// The same down the columns.
Plane filterDown(const Plane& plane, const Kernel& kernel);

/// exp(-x²/(2·deviation²)) at whole pixels; not normalised.
Kernel gaussianKernel(double deviation, int radius);
/// `kernel` times `factor`.
Kernel scaled(Kernel kernel, double factor);
double sumOf(const Kernel& kernel);

} // namespace tyndall
