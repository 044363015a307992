// The printed scheme's light before the first step: light that surfaces reflect and media scatter once. Only the former counts in look-ups: the
// latter is single scattering, which is rendered already (section 4).
#include "gi/lpv/lattice.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer LpvSources { vec4 sources[]; };
layout(std430) writeonly buffer LpvNext { vec4 next[]; };
layout(std430) writeonly buffer LpvSum { vec4 sum[]; };

/// Harmonics of light of this power and first moment.
vec4 harmonicsOf(float power, vec3 moment) { return vec4(power / kLpvOne, moment.yzx * (sqrt(3.0) / kLpvOne)); }

void main() {
    uint cells = cellCount();
    uint self = gl_GlobalInvocationID.x;
    if (self >= cells) return;
    vec3 emission = sources[kLpvEmission * cells + self].rgb;
    for (uint c = 0u; c < 3u; ++c) {
        vec4 entering = sources[(kLpvEntering + c) * cells + self];
        next[c * cells + self] = harmonicsOf(entering.w + emission[c], entering.xyz);
        sum[c * cells + self] = harmonicsOf(entering.w, entering.xyz);
    }
}
