// Converts fixed-point deposits to the sources of a step.
#include "gi/lpv/lattice.glsl"

layout(local_size_x = 64) in;

layout(std140) uniform Inject { LpvInjectParams inject; };
layout(std430) readonly buffer LpvDeposits { int deposits[]; };
layout(std430) writeonly buffer LpvSources { vec4 sources[]; };

void main() {
    uint cells = cellCount();
    uint self = gl_GlobalInvocationID.x;
    if (self >= cells) return;
    vec3 unit = 1.0 / max(inject.scale.rgb, vec3(1e-30));
    for (uint c = 0u; c < 3u; ++c)
        sources[(kLpvEntering + c) * cells + self] = unit[c] * vec4(deposits[(4u * c) * cells + self], deposits[(4u * c + 1u) * cells + self],
                                                                   deposits[(4u * c + 2u) * cells + self], deposits[(4u * c + 3u) * cells + self]);
    sources[kLpvEmission * cells + self] =
        vec4(unit * vec3(deposits[12u * cells + self], deposits[13u * cells + self], deposits[14u * cells + self]), 0.0);
}
