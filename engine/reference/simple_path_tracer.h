#pragma once
// The path tracer to check the other one by: short, and right by inspection. It follows light particles backwards, one channel
// at a time, as they would really go: they fly, are absorbed or scattered by chance, and bring home what they run into. There is
// no next-event estimation, so lights without extent stay dark, and it is slow.

#include "reference/path_settings.h"

namespace tyndall::reference {

class SimplePathTracer {
public:
    SimplePathTracer(const TracerScene& scene, const PathSettings& settings)
        : scene_(scene), settings_(settings) {}

    void trace(const CameraRays::CameraRay& start, Sampler& sampler, TermLight& light) const;

private:
    void traceChannel(int channel, const CameraRays::CameraRay& start, Sampler& sampler,
                      TermLight& light) const;
    const TracerScene& scene_;
    PathSettings settings_;
};

} // namespace tyndall::reference
