// The disk of a surfel that is seen, with the light that leaves it towards the eye; dark ones grey.
#include "common/view.glsl"
#include "shared/surfels.h"

layout(std430) readonly buffer LitSurfels { LitSurfel lit[]; };
layout(std140) uniform Show { SurfelShowParams show; };
uniform sampler2D depth;

in vec2 onDisk;
in vec3 position;
flat in uint surfelNumber;
layout(location = 0) out vec4 color;

void main() {
    if (dot(onDisk, onDisk) > 0.6) discard; // a little smaller than its area, so that neighbours are told apart
    LitSurfel s = lit[surfelNumber];
    vec3 toEye = directionToEye(position);
    float distance = rayDistanceFromDepth(gl_FragCoord.xy, texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r);
    float own = dot(position - cameraRay(gl_FragCoord.xy).origin, -toEye);
    if (own > distance * 1.01 + sqrt(s.position.w)) discard;
    vec3 radiance = dot(toEye, s.normal.xyz) > 0.0 ? s.front.rgb : s.back.rgb;
    color = vec4(max(radiance, vec3(0.02 * show.white)), 1.0);
}
