#include "reference/instant_radiosity.h"

namespace tyndall::reference {
namespace {

PathSettings directOnly(TermSet terms) {
    PathSettings settings;
    settings.terms = terms & kDirectTerms;
    return settings;
}

VirtualLightPathSettings indirectOnly(const InstantRadiositySettings& from) {
    VirtualLightPathSettings settings;
    settings.terms = from.terms;
    settings.clampDistance = from.clampDistance;
    return settings;
}

} // namespace

InstantRadiosity::InstantRadiosity(const TracerScene& scene, const LightEmission& emission,
                                   const InstantRadiositySettings& settings)
    : settings_(settings), direct_(scene, directOnly(settings.terms)),
      path_(scene, emission, indirectOnly(settings)) {}

PathCounts InstantRadiosity::counts() const {
    PathCounts sum = path_.counts();
    sum.add(direct_.counts());
    return sum;
}

void InstantRadiosity::trace(const CameraRays::CameraRay& start, Sampler& sampler,
                             TermLight& light) {
    if (settings_.terms & kDirectTerms) {
        // Numbers of its own: the walk and the path below keep theirs.
        Sampler apart(sampler.bits(), 0, 0);
        direct_.trace(start, apart, light);
    }
    if (!(settings_.terms & ~kDirectTerms)) return;
    path_.begin(sampler, light);
    path_.traceWalk();
    path_.chooseHero();
    Ray ray = start.ray;
    VirtualLightPath::Vertex vertex;
    if (!path_.nextVertex(ray, start.nearest, RayKind::Camera, vertex)) return;
    path_.gatherWalk(vertex);
    if (!settings_.compensate || !(settings_.clampDistance > 0)) return;
    while (path_.nearVertex(vertex, path_.clampedAt(vertex.position))) {
        path_.gatherLights(vertex);
        if (!path_.survives()) return;
        path_.gatherWalk(vertex);
    }
}

} // namespace tyndall::reference
