#pragma once
// Instant radiosity without bias, in surfaces and media: the ground truth of virtual point lights, and slow. Of each path from the eye the
// first vertex gathers the virtual point lights of one walk, with the geometry term held at a bound; what the bound takes away is
// had by following the path on to nearby vertices that gather in the same way, and so on (Kollig and Keller 2004; Raab, Seibert and
// Keller 2006; Engelhardt, Novák and Dachsbacher 2010, section 4.3). The mean is the same for every bound.
//
// Light between vertices x and y: G = D_x D_y / |x - y|², D the facet's cosine on a surface and 1 in a medium. The part min(1, b/G) of it comes
// from virtual lights at y, the part max(0, 1 - b/G) from following.

#include "reference/light_walk.h"
#include "reference/volume_path_tracer.h"

namespace tyndall::reference {

/// Bounds with which someone else gathers, who follows what they take away in media one step, to a point that gathers in turn. Metres in the ball of the
/// settings, by where light comes from and who receives it; in media a bound reaches no farther than the free path at the receiver.
struct HeldElsewhere {
    double betweenSurfaces = 0, ofMedia = 0;
    double fromSurfacesToMedia = 0; // where it is less than ofMedia
    double relaxed = 1; // of the bound's distance over that with which the step's end gathers
};

struct InstantRadiositySettings {
    TermSet terms = kAllTerms;
    double clampDistance =
        0.1; // metres: b = 1/clampDistance²; 0: no bound; infinite: nothing is left to virtual lights
    bool compensate = true; // false: what the bound takes away is missing
    // Outside of a ball the bound's distance grows in proportion to that from its middle.
    dvec3 middle{0};
    double radius = kInfinity; // metres
    double leastRoughness = 0; // smoother surfaces are taken for as rough as that
    HeldElsewhere elsewhere{}; // for what they miss
};

class InstantRadiosity {
public:
    InstantRadiosity(const TracerScene& scene, const LightEmission& emission,
                     const InstantRadiositySettings& settings);

    void trace(const CameraRays::CameraRay& start, Sampler& sampler, TermLight& light);
    /// Nothing but what HeldElsewhere misses, of light that leaves the surface that an eye ray meets first towards the eye, without media on that way.
    /// Surfaces of partial coverage (BLEND) are passed by the eye ray.
    /// Returns that surface, good until the next path; null where there is none.
    const Surface* traceMissedOnSurface(const CameraRays::CameraRay& start, Sampler& sampler,
                                        TermLight& light);
    /// The same of light that media before that surface scatter to the eye, as it arrives there.
    void traceMissedInMedia(const CameraRays::CameraRay& start, Sampler& sampler, TermLight& light);
    [[nodiscard]] PathCounts counts() const;

private:
    struct Vertex;
    /// Metres within which light is held, from surfaces and from media.
    struct Reach {
        double ofSurfaces = 0, ofMedia = 0;
    };
    void begin(Sampler& sampler, TermLight& light);
    void traceWalk();
    void enter(const Ray& ray, const RayHit& hit, Vertex& vertex) const;
    bool nextVertex(Ray& ray, double nearest, RayKind kind, Vertex& vertex);
    bool nearVertex(Vertex& vertex, const Reach& reach);
    RayHit opaqueHit(const CameraRays::CameraRay& start);
    void followMissed(Vertex& vertex);
    bool survives();
    void gatherWalk(const Vertex& vertex);
    void gatherLights(const Vertex& vertex);
    void see(PathHistory history, const dvec3& light);
    [[nodiscard]] double scaleAt(const dvec3& position) const;
    [[nodiscard]] Reach reachAt(const dvec3& position) const;
    [[nodiscard]] Reach reachElsewhere(const Vertex& vertex) const;

    const TracerScene& scene_;
    InstantRadiositySettings settings_;
    VolumePathTracer direct_; // the terms that no virtual light makes
    LightWalker walker_;
    MediaSegment segment_;
    PathCounts counts_;
    std::vector<WalkVertex> walk_;
    // Of the present path.
    Sampler* sampler_ = nullptr;
    TermLight* light_ = nullptr;
    PathWeights weights_;
    PathHistory history_;
    Surface seen_; // that the eye ray met
    MediumPoint mediumPoint_;
    std::vector<EmittedLight> emitted_;
    LightChoice choice_;
};

} // namespace tyndall::reference
