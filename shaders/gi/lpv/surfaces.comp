// Indirect light of surfaces from the lattice, before the media between them and the eye. Two bands give the reflection of a coat or a metal
// a mean direction, not an image.
#include "common/receiver.glsl"
#include "gi/lpv/reflection.glsl"
#include "gi/lpv/lookup.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f) writeonly uniform image2D surfaceRadiance;

/// Diffuse light that arrives on a surface, from the flux towards it (`towards`) and away from it (`away`) at optical depth `depth` before it: two
/// streams, S' = -3/2 D and D' = -2 (1 - albedo) S for their sum S and the difference D = away - towards (diffusion, with Marshak's
/// conditions). Never negative; equal to `towards` without a medium, and never more than there is.
vec3 arrivingThrough(vec3 towards, vec3 away, float depth, float albedo) {
    float loss = 2.0 * (1.0 - albedo);
    float x = min(sqrt(1.5 * loss) * depth, 40.0);
    float sinhOverX = x < 0.01 ? 1.0 + x * x / 6.0 : sinh(x) / x;
    float transmitted = 1.0 / (cosh(x) + 0.5 * (1.5 + loss) * depth * sinhOverX);
    float reflected = max(0.5 * (1.5 - loss) * depth * sinhOverX * transmitted, 0.0);
    vec3 leaving = clamp((away - reflected * towards) / transmitted, vec3(0.0), towards + away);
    return transmitted * towards + reflected * leaving;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surfaceRadiance)))) return;
    vec3 radiance = vec3(0.0);
    Receiver r;
    if (receiverAt(texel, r)) {
        // Off the surface, so that cells behind it give it no light. A little towards the eye: a point on an edge is on neither side of the
        // other surface there, but the eye is.
        vec3 offSurface = kOffSurface * r.facet + 0.01 * r.toEye;
        LatticeLight light = latticeLight(r.position, offSurface);
        // Radiance (Φ + 3 F·ω)/4π has the fluxes Φ/4 ∓ F·n/2 through a plane, one for each side.
        vec3 each = 0.25 * fluence(light);
        vec3 net = 0.5 * fluxAlong(light, r.normal);
        vec2 medium = latticeMedium(r.position, offSurface);
        vec3 irradiance = arrivingThrough(max(each - net, vec3(0.0)), max(each + net, vec3(0.0)), kOffSurface * medium.x, medium.y);
        Reflection reflection = reflectionOf(r.brdf, r.roughness);
        vec3 lobe = meanOfLobe(reflect(-r.toEye, r.normal), r.normal, r.roughness);
        vec3 mirrored = max(fluence(light) - 3.0 * fluxAlong(light, lobe), vec3(0.0)) / (4.0 * kPi);
        radiance = reflection.even * irradiance / kPi + reflection.mirrored * mirrored;
    }
    imageStore(surfaceRadiance, texel, vec4(radiance, 1.0));
}
