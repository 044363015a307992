// Light of one surfel on the surface of one pixel, where that lies inside a shell around it: over the surface's reflectance, which neighbours do not share. MEDIA: media take light
// away. RAYS: surfaces block it.
#include "gi/surfels/splat.glsl"
#include "gi/shared/surface_light.glsl"
#include "gi/surfels/kernel.glsl"
#if RAYS
#include "gi/shared/visibility.glsl"
#endif
#if MEDIA
#include "media/optical_depth.glsl"
#endif

flat in uint surfelNumber;
flat in uint subBuffer;
flat in vec2 shell;

layout(location = 0) out vec4 light; // w: 1 for each surfel that has come to the pixel

const float kCoplanar = 1e-4; // cosine that rounding alone may have: surfels of the plane itself
const float kLeastRoughness = 0.4; // smoother surfaces would show single surfels as spots

void main() {
    light = vec4(0.0);
    ivec2 cell = ivec2(gl_FragCoord.xy) - subBufferCorner(splat.level, subBuffer, splat.size);
    ivec2 pixel = rayOf(splat.level, subBuffer, cell);
    Receiver r;
    if (any(greaterThanEqual(pixel, splat.size)) || !receiverAt(pixel, kLeastRoughness, r)) return;
    LitSurfel s = lit[surfelNumber];
    vec3 way = s.position.xyz - r.position;
    float squared = dot(way, way);
    if (squared < shell.x * shell.x || squared >= shell.y * shell.y) return;
    light.w = 1.0;
    float distance = sqrt(squared);
    vec3 direction = way / max(distance, 1e-30);
    float cosine = dot(r.normal, direction);
    float height = -dot(way, s.normal.xyz);
    vec3 radiance = height > 0.0 ? s.front.rgb : s.back.rgb;
    if (!(min(cosine, dot(r.facet, direction)) > kCoplanar) || !(maximumOf(radiance) > 0.0)) return;
#if RAYS
    if (splat.visibility != 0u && triangleBetween(r.position, s.position.xyz)) return;
#endif
    BrdfValue value = evaluateBrdf(r.brdf, r.normal, r.toEye, direction);
    vec3 sum = radiance * (value.diffuse + value.specular) / reflectance(r) * (kernel(s.position.w, height, squared) * cosine);
#if MEDIA
    if (splat.attenuation != 0u) sum *= exp(-opticalDepthAlong(r.position, direction, distance));
#endif
    light.rgb = sum * float(1u << (2u * splat.level));
}
