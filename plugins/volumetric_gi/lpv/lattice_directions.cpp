#include "volumetric_gi/lpv/lattice_directions.h"

#include <cmath>

namespace tyndall::volumetric_gi {
namespace {

constexpr int kClassSize[kLengthClasses] = {6, 12, 8};

/// One weight a class: means of 1, of x⁴ and of x²y²z² over the sphere are 1, 1/5 and 1/105; odd powers vanish by symmetry, and the
/// other moments up to degree 7 follow from these.
std::array<double, kLengthClasses> solveWeights() {
    // Rows: the three means; columns: classes. Directions of class c have c+1 components of size 1/sqrt(c+1), the others 0.
    dmat3 moments(0.0); // [column][row]
    for (int c = 0; c < kLengthClasses; ++c) {
        const double square = 1.0 / (c + 1), count = kClassSize[c];
        moments[c][0] = count;
        moments[c][1] = count * (c + 1) / 3.0 * square * square; // of three axes c+1 take part
        moments[c][2] = c == 2 ? count * square * square * square : 0.0;
    }
    const dvec3 weights = glm::inverse(moments) * dvec3(1, 1.0 / 5, 1.0 / 105);
    return {weights.x, weights.y, weights.z};
}

std::array<LatticeDirection, kLatticeDirections> makeDirections() {
    const std::array<double, kLengthClasses> weights = solveWeights();
    std::array<LatticeDirection, kLatticeDirections> result;
    for (int i = 0, cell = 0; cell < 27; ++cell) {
        if (cell == 13) continue; // the centre
        LatticeDirection& d = result[size_t(i++)];
        d.offset = {cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
        d.lengthClass = std::abs(d.offset.x) + std::abs(d.offset.y) + std::abs(d.offset.z) - 1;
        d.length = std::sqrt(1.0 + d.lengthClass);
        d.unit = dvec3(d.offset) / d.length;
        d.weight = weights[size_t(d.lengthClass)];
    }
    return result;
}

/// Of directions (x, y, 1), x in [x0, x1], y in [y0, y1]: their solid angle (w) and the integral of the unit vector over it.
dvec4 rectangle(double x0, double x1, double y0, double y1) {
    const auto angle = [](double x, double y) {
        return std::atan(x * y / std::sqrt(1 + x * x + y * y));
    };
    // ∫ x dω = ∫ x / (1+x²+y²)² dx dy, and likewise y and 1; from antiderivatives.
    const auto across = [](double a, double b) { // -½ ∫ db / (1+a²+b²)
        const double s = std::sqrt(1 + a * a);
        return -0.5 * std::atan(b / s) / s;
    };
    const auto along = [](double a, double b) {
        const double sa = std::sqrt(1 + a * a), sb = std::sqrt(1 + b * b);
        return 0.5 * (a / sa * std::atan(b / sa) + b / sb * std::atan(a / sb));
    };
    dvec4 sum(0);
    for (const auto& [x, signX] : {std::pair{x1, 1.0}, std::pair{x0, -1.0}})
        for (const auto& [y, signY] : {std::pair{y1, 1.0}, std::pair{y0, -1.0}})
            sum += signX * signY * dvec4(across(x, y), across(y, x), along(x, y), angle(x, y));
    return sum;
}

/// Each of the six faces of a cube around the centre shows nine of the neighbours, bounded by lines at a third of the half edge.
std::array<TransferFunction, kLatticeDirections> makeTransferFunctions() {
    std::array<dvec4, kLatticeDirections> integrals{}; // of the unit vector, and solid angles
    constexpr double kLines[] = {-1, -1.0 / 3, 1.0 / 3, 1};
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2)
            for (int v = -1; v <= 1; ++v)
                for (int u = -1; u <= 1; ++u) {
                    const dvec4 part =
                        rectangle(kLines[u + 1], kLines[u + 2], kLines[v + 1], kLines[v + 2]);
                    ivec3 offset(0);
                    offset[axis] = side;
                    offset[(axis + 1) % 3] = u;
                    offset[(axis + 2) % 3] = v;
                    const int cell = offset.x + 1 + 3 * (offset.y + 1) + 9 * (offset.z + 1);
                    dvec4& sum = integrals[size_t(cell < 13 ? cell : cell - 1)];
                    sum[axis] += side * part.z;
                    sum[(axis + 1) % 3] += part.x;
                    sum[(axis + 2) % 3] += part.y;
                    sum.w += part.w;
                }
    std::array<TransferFunction, kLatticeDirections> result;
    double roots = 0;
    for (const dvec4& part : integrals) roots += std::sqrt(part.w);
    const double y0 = std::sqrt(1 / (4 * kPi)), y1 = std::sqrt(3 / (4 * kPi));
    for (size_t i = 0; i < result.size(); ++i) {
        const dvec4& part = integrals[i];
        const double root = std::sqrt(part.w);
        result[i].solidAngle = part.w;
        result[i].harmonics = {y0 * root, y1 * part.y / root, y1 * part.z / root,
                               y1 * part.x / root};
        result[i].printedShare = root / roots;
    }
    return result;
}

} // namespace

const std::array<LatticeDirection, kLatticeDirections>& latticeDirections() {
    static const auto directions = makeDirections();
    return directions;
}

const std::array<TransferFunction, kLatticeDirections>& transferFunctions() {
    static const auto functions = makeTransferFunctions();
    return functions;
}

} // namespace tyndall::volumetric_gi
