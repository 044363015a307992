#pragma once
// Glowing media as lights, so that a fire lights what is around it. Direct light is had from lamps alone: here the light that leaves
// a medium's volume is given to a few of them. GL-free and in double.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "media/blackbody.h"
#include "scene/scene.h"

namespace tyndall {

/// A part of a glowing medium as a point light or a ball.
struct MediumLight {
    dvec3 position{0};  // world
    dvec3 intensity{0}; // candela, the same in every direction; before extinction
    double radius = 0;  // metres: as wide as the part; 0: a point
};

/// What one medium emits, ordered in space: bricks of 8³ cells with their light, grouped into parts of about equal power.
class MediumEmitter {
public:
    /// `medium` (box, sphere or grid) is kept by reference and placed by its node's transform. At most `parts` parts.
    MediumEmitter(const Medium& medium, const dmat4& worldFromNode, int parts);

    /// ∫ ε dV, candela: what the intensities of lights() sum to.
    [[nodiscard]] dvec3 intensity() const;

    /// One light for each part, in the middle of its glow.
    [[nodiscard]] std::vector<MediumLight> lights() const;
    /// One point of each part, drawn in proportion to the light of the cells and weighted by 1/probability: the mean over frames
    /// of any sum over these lights tends to the integral over the medium. Frames step through low-discrepancy sequences that
    /// `key` tells apart.
    [[nodiscard]] std::vector<MediumLight> sample(uint32_t frame, uint64_t key) const;
    /// Metres, small beside the parts: a point of sample() stands for its part only from that far on. 0: nothing glows.
    [[nodiscard]] double nearDistance() const;

private:
    struct Brick {
        ivec3 index{0};
        dvec3 intensity{0}; // candela
        dvec3 middle{0};    // of the glow, cells
        double spread = 0;  // mean square distance of the glow from the middle, m²
        double power = 0;   // mean of the intensity's channels
        size_t cells = 0;   // of its 512 cells: place in powers_
    };
    struct Part {
        size_t first = 0, last = 0; // bricks, half open
        double power = 0;
    };
    [[nodiscard]] dvec3 emission(const dvec3& cell) const; // nits per metre
    [[nodiscard]] dvec3 cellEmission(const ivec3& cell) const;
    [[nodiscard]] double distance(const dvec3& cells) const; // metres
    [[nodiscard]] Brick measure(const ivec3& index);
    [[nodiscard]] dvec3 emittedFrom(const Part& part, double u, const dvec3& inCell,
                                    dvec3& cell) const;
    [[nodiscard]] size_t halve(size_t first, size_t last);
    void orderBricks(size_t first, size_t last);
    void splitInto(int parts);

    const Medium& medium_;
    BlackbodyTable blackbody_;
    dmat4 worldFromCell_{1.0}, densityFromCell_{1.0}, temperatureFromCell_{1.0};
    double cellVolume_ = 0; // m³
    dvec3 edges_{0};        // of a cell, metres
    std::vector<Brick> bricks_;
    std::vector<float> powers_; // of cells, in each brick along Morton's curve
    std::vector<Part> parts_;
};

struct MediumEmitters {
    std::vector<MediumEmitter> emitters;
    std::vector<int> nodes;                                        // of each
    double nearDistance = std::numeric_limits<double>::infinity(); // the least of all that glow
    std::vector<std::string>
        notes; // a sentence for each medium that glows and lights nothing, and why
};

/// Of all visible glowing media, `parts` lights for each. The scene's media must outlive the emitters.
MediumEmitters findMediumEmitters(const Scene& scene, const std::vector<dmat4>& world,
                                  const std::vector<bool>& visible, int parts);

} // namespace tyndall
