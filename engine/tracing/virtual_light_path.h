#pragma once
// The steps of a path from the eye whose vertices gather virtual point lights with a clamped geometry term. A path continues to vertices
// so near that clamping removed light, with the removed part: bias compensation (Kollig and Keller 2004; Raab, Seibert
// and Keller 2006; Engelhardt, Novák and Dachsbacher 2010, section 4.3).
//
// Light between vertices x and y: G = D_x D_y / |x - y|², D the facet's cosine on a surface and 1 in a medium. The part min(1, b/G) of it comes
// from virtual lights at y, the part max(0, 1 - b/G) from continuing the path to y.

#include <optional>

#include "tracing/light_walk.h"
#include "tracing/path_counts.h"

namespace tyndall::tracing {

struct VirtualLightPathSettings {
    TermSet terms = kAllTerms;
    double clampDistance =
        0.1; // metres: b = 1/clampDistance²; 0: not clamped; infinite: virtual lights give nothing
    // Outside of a ball it grows in proportion to the distance from its centre.
    dvec3 middle{0};
    double radius = kInfinity; // metres
    double leastRoughness = 0; // smoother surfaces count as this rough
};

/// One for each thread: it keeps its scratch memory from path to path. `scene` and `emission` must outlive it.
class VirtualLightPath {
public:
    /// A vertex of a path.
    struct Vertex {
        dvec3 position{0};
        dvec3 before{0};          // direction in which the path came
        std::optional<Bsdf> bsdf; // of a surface
        SurfacePoint point;
        [[nodiscard]] bool onSurface() const { return bsdf.has_value(); }
        /// D of the geometry term.
        [[nodiscard]] double cosine(const dvec3& direction) const;
        [[nodiscard]] Ray rayTowards(const dvec3& direction) const;
    };
    /// Metres within which light is clamped, from surfaces and from media.
    struct ClampDistances {
        double ofSurfaces = 0, ofMedia = 0;
    };

    VirtualLightPath(const TracerScene& scene, const LightEmission& emission,
                     const VirtualLightPathSettings& settings);

    /// Starts a path; what it gathers is added to `light`. Both must last until the next begin().
    void begin(Sampler& sampler, TermLight& light);
    /// Makes the virtual lights that the path gathers: those of one walk.
    void traceWalk();
    /// Draws the channel that the path follows, where media have colours.
    void chooseHero();
    /// The vertex where a ray meets a surface. Does not count it among the path's scatterings.
    void enterSurface(const Ray& ray, const RayHit& hit, Vertex& vertex) const;
    /// Counts a scattering at the vertex; the term of the light depends on it.
    void addScattering(Scattering kind) { history_.add(kind); }
    /// Follows the ray to where it is scattered. False where it leaves the scene.
    bool nextVertex(Ray& ray, double nearest, RayKind kind, Vertex& vertex);
    /// Flies from a ray's start to at most `distance` metres. True where a medium scatters it: `vertex` is there.
    bool nextVertexInMedia(const Ray& ray, double distance, Vertex& vertex);
    /// Continues to where clamped light comes from, with the clamped part. False if there is none.
    bool nearVertex(Vertex& vertex, const ClampDistances& clamped);
    /// Russian roulette, from the third vertex on.
    bool survives();
    /// Adds light of all vertices of the walk, with the geometry term clamped.
    void gatherWalk(const Vertex& vertex);
    /// Adds direct light: no vertex of a walk represents it.
    void gatherLights(const Vertex& vertex);

    /// Factor of the clamp distance here.
    [[nodiscard]] double scaleAt(const dvec3& position) const;
    [[nodiscard]] ClampDistances clampedAt(const dvec3& position) const;
    /// Of the last vertex in a medium.
    [[nodiscard]] const MediumPoint& mediumPoint() const { return mediumPoint_; }
    [[nodiscard]] const TracerScene& scene() const { return scene_; }
    [[nodiscard]] PathCounts counts() const;

private:
    void see(PathHistory history, const dvec3& light);

    const TracerScene& scene_;
    VirtualLightPathSettings settings_;
    LightWalker walker_;
    MediaSegment segment_;
    PathCounts counts_;
    std::vector<WalkVertex> walk_;
    // Of the present path.
    Sampler* sampler_ = nullptr;
    TermLight* light_ = nullptr;
    PathWeights weights_;
    PathHistory history_;
    MediumPoint mediumPoint_;
    std::vector<EmittedLight> emitted_;
    LightChoice choice_;
};

} // namespace tyndall::tracing
