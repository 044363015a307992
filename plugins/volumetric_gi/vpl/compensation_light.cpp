#include "volumetric_gi/vpl/compensation_light.h"

#include <algorithm>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace tyndall::volumetric_gi {
namespace {

constexpr double kDielectricF0 = 0.04;
/// Lower limit of the reflectance of black surfaces.
constexpr double kLeastReflectance = 1e-3;

dvec3 reflectance(const tracing::Surface& surface) {
    const dvec3 base(surface.baseColor);
    const double metallic = surface.metallic, coat = kDielectricF0 * surface.specular;
    return glm::max((1 - metallic) * (base + coat) + metallic * base, dvec3(kLeastReflectance));
}

using Tracers = tbb::enumerable_thread_specific<BiasCompensation>;
/// Light that a path adds to an eye ray.
using Trace = dvec3 (*)(BiasCompensation&, const tracing::CameraRays::CameraRay&,
                        tracing::Sampler&);

dvec3 missedOnSurface(BiasCompensation& tracer,
                      const tracing::CameraRays::CameraRay& eye, tracing::Sampler& sampler) {
    tracing::TermLight light;
    const tracing::Surface* seen = tracer.traceOnSurface(eye, sampler, light);
    return seen ? light.sum() / reflectance(*seen) : dvec3(0);
}

dvec3 missedInMedia(BiasCompensation& tracer,
                    const tracing::CameraRays::CameraRay& eye, tracing::Sampler& sampler) {
    tracing::TermLight light;
    tracer.traceInMedia(eye, sampler, light);
    return light.sum();
}

/// Mean over a square's paths, square by square. `kind` separates the random numbers.
std::vector<vec4> missed(Trace trace, Tracers& tracers, const gpu::ViewData& view, int edge,
                         uint64_t kind, const CompensationOrder& order) {
    const auto size = uvec2(view.size.x, view.size.y);
    const auto factor = uint32_t(edge);
    const uvec2 squares = (size + factor - 1u) / factor;
    std::vector<vec4> light(size_t(squares.x) * squares.y);
    tbb::parallel_for(uint32_t(0), squares.y, [&](uint32_t y) {
        BiasCompensation& tracer = tracers.local();
        for (uint32_t x = 0; x < squares.x; ++x) {
            const size_t square = size_t(y) * squares.x + x;
            const uvec2 pixel = glm::min(uvec2(x, y) * factor + factor / 2, size - 1u);
            const auto eye = eyeRay(view, (dvec2(pixel) + 0.5) * 2.0 / dvec2(size) - 1.0);
            dvec3 sum(0);
            for (uint32_t i = 0; i < order.paths; ++i) {
                tracing::Sampler sampler(view.seed, 2 * square + kind, order.first + i);
                sum += trace(tracer, eye, sampler);
            }
            light[square] = vec4(vec3(sum / double(order.paths)), 0);
        }
    });
    return light;
}

} // namespace

tracing::CameraRays::CameraRay eyeRay(const gpu::ViewData& view, const dvec2& ndc) {
    const dmat4 renderFromClip(view.renderFromClip);
    const dvec3 eye(view.cameraPosition), forward(view.cameraForward);
    if (view.flags & gpu::kViewOrthographic) {
        const dvec4 point = renderFromClip * dvec4(ndc, 1, 1);
        const dvec3 fromEye = dvec3(point) / point.w - eye;
        return {{eye + fromEye - forward * glm::dot(fromEye, forward), forward},
                double(view.cameraPosition.w)};
    }
    const dvec3 direction = glm::normalize(dvec3(renderFromClip * dvec4(ndc, 0, 1)));
    return {{eye, direction}, double(view.cameraPosition.w) / glm::dot(direction, forward)};
}

CompensationLight compensationLight(const gpu::ViewData& view, const tracing::TracerScene& scene,
                      const tracing::LightEmission& emission, const CompensationOrder& order) {
    Tracers tracers([&] { return BiasCompensation(scene, emission, order.path, order.clamps); });
    CompensationLight light;
    if (order.onSurfaces)
        light.onSurfaces = missed(missedOnSurface, tracers, view, order.surfaceFactor, 0, order);
    if (order.inMedia)
        light.inMedia = missed(missedInMedia, tracers, view, order.mediaFactor, 1, order);
    for (const BiasCompensation& tracer : tracers)
        light.nonFinite += tracer.counts().nonFinite;
    return light;
}

} // namespace tyndall::volumetric_gi
