#pragma once
// GLM with the conventions of this engine: right-handed, Y up, metres, radians; reversed depth in [0,1].
// Transforms are named to-from: `clipFromWorld * positionWorld`.

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_XYZW_ONLY
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <limits>

namespace tyndall {

using glm::dmat3;
using glm::dmat4;
using glm::dquat;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat3;
using glm::mat4;
using glm::quat;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline float maximumOf(const vec3& v) { return glm::max(v.x, glm::max(v.y, v.z)); }

/// Axis-aligned box; empty when minimum > maximum (the default).
struct Bounds {
    dvec3 minimum{kInfinity};
    dvec3 maximum{-kInfinity};
    [[nodiscard]] bool empty() const {
        return !(minimum.x <= maximum.x && minimum.y <= maximum.y && minimum.z <= maximum.z);
    }
    void include(const dvec3& p) {
        minimum = glm::min(minimum, p);
        maximum = glm::max(maximum, p);
    }
    void include(const Bounds& b) {
        minimum = glm::min(minimum, b.minimum);
        maximum = glm::max(maximum, b.maximum);
    }
    [[nodiscard]] bool contains(const dvec3& p) const {
        return glm::all(glm::lessThanEqual(minimum, p)) && glm::all(glm::lessThanEqual(p, maximum));
    }
    [[nodiscard]] dvec3 centre() const { return 0.5 * (minimum + maximum); }
    [[nodiscard]] dvec3 extent() const { return maximum - minimum; }
    /// The box around this box's eight corners after `transform`.
    [[nodiscard]] Bounds transformed(const dmat4& transform) const {
        Bounds result;
        if (empty()) return result;
        for (int i = 0; i < 8; ++i)
            result.include(dvec3(transform * dvec4((i & 1) ? maximum.x : minimum.x,
                                                   (i & 2) ? maximum.y : minimum.y,
                                                   (i & 4) ? maximum.z : minimum.z, 1.0)));
        return result;
    }
};

/// What both have; empty where they do not meet.
inline Bounds intersection(const Bounds& a, const Bounds& b) {
    return {glm::max(a.minimum, b.minimum), glm::min(a.maximum, b.maximum)};
}

} // namespace tyndall
