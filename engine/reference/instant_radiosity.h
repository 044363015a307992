#pragma once
// Instant radiosity without bias, in surfaces and media: the ground truth of virtual point lights, and slow. Of each path from the eye the
// first vertex gathers the virtual point lights of one walk, with a clamped geometry term; what clamping takes away comes from following
// the path on to nearby vertices that gather in the same way, and so on (tracing/virtual_light_path.h). The mean is the same for every clamp distance.

#include "reference/volume_path_tracer.h"
#include "tracing/virtual_light_path.h"

namespace tyndall::reference {

struct InstantRadiositySettings {
    TermSet terms = kAllTerms;
    double clampDistance = 0.1; // metres: b = 1/clampDistance²; 0: not clamped
    bool compensate = true;     // false: what clamping takes away is missing
};

class InstantRadiosity {
public:
    InstantRadiosity(const TracerScene& scene, const LightEmission& emission,
                     const InstantRadiositySettings& settings);

    void trace(const CameraRays::CameraRay& start, Sampler& sampler, TermLight& light);
    [[nodiscard]] PathCounts counts() const;

private:
    InstantRadiositySettings settings_;
    VolumePathTracer direct_; // the terms that no virtual light makes
    VirtualLightPath path_;
};

} // namespace tyndall::reference
