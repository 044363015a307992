// The media of each cell of the lattice: means over 27 points.
//
// Light is propagated in two bands, for which scattering by a mean cosine of g is isotropic scattering (1 - g) as strong
// (the transport approximation; exact in two bands). Propagation uses that.
#include "gi/lpv/lattice.glsl"
#if MEDIA
#include "common/phase_function.glsl"
#include "media/density.glsl"
#endif

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) writeonly buffer LpvMedium { vec4 medium[]; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    vec3 extinction = vec3(0.0);
    vec3 scattering = vec3(0.0);
    vec3 forward = vec3(0.0); // scattering times mean cosine
#if MEDIA
    const int kAcross = 3;
    for (int i = 0; i < kAcross * kAcross * kAcross; ++i) {
        vec3 within = (vec3(i % kAcross, i / kAcross % kAcross, i / (kAcross * kAcross)) + 0.5) / float(kAcross);
        vec3 position = params.grid.lowest.xyz + (vec3(at) + within) * params.grid.lowest.w;
        for (uint m = 0u; m < mediumCount(); ++m) {
            float density = mediumDensity(m, position) / float(kAcross * kAcross * kAcross);
            extinction += density * media[m].extinction.rgb;
            scattering += density * media[m].scattering.rgb;
            forward += density * media[m].scattering.rgb * phaseMeanCosine(media[m].phase, media[m].scattering.w);
        }
    }
#endif
    float cosine = meanOf(forward) / max(meanOf(scattering), 1e-30);
    medium[kLpvTrueDepth * cells + self] = vec4(extinction * params.grid.lowest.w, cosine);
    medium[kLpvTrueAlbedo * cells + self] = vec4(clamp(scattering / max(extinction, vec3(1e-30)), 0.0, 1.0), 0.0);
    if (params.onward == 0.0) { // scattered light is lost, also forwards
        scattering = vec3(0.0);
        forward = vec3(0.0);
    }
    vec3 transport = max(extinction - forward, vec3(0.0));
    vec3 depth = transport * params.grid.lowest.w;
    for (uint c = 0u; c < kLpvClasses; ++c) medium[(kLpvPassed + c) * cells + self] = vec4(exp(-depth * sqrt(float(c + 1u))), 0.0);
    medium[kLpvDepth * cells + self] = vec4(depth, 0.0);
    medium[kLpvAlbedo * cells + self] = vec4(clamp((scattering - forward) / max(transport, vec3(1e-30)), 0.0, 1.0), 0.0);
}
