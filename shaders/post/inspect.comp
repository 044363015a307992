// Any texture of the frame as a picture: a channel or RGB, a range, a slice. Non-finite values are magenta.

#include "shared/post.h"

layout(local_size_x = 8, local_size_y = 8) in;

#if KIND == 0
uniform sampler2D shown;
#elif KIND == 1
uniform sampler2DArray shown;
#else
uniform sampler3D shown;
#endif
layout(rgba8) uniform writeonly image2D display;
layout(std140) uniform Params { InspectParams params; };

vec4 fetch(ivec2 p) {
#if KIND == 0
    return texelFetch(shown, p, params.mip);
#else
    return texelFetch(shown, ivec3(p, params.slice), params.mip);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), pixels = imageSize(display);
    if (any(greaterThanEqual(pixel, pixels))) return;
    ivec2 size = textureSize(shown, params.mip).xy;
    vec4 value = fetch(min(pixel * size / pixels, size - 1));
    vec3 c = params.channel == 0u ? value.rgb : vec3(value[params.channel - 1u]);
    bool finite = all(lessThanEqual(abs(c), vec3(3.4e38)));
    c = finite ? clamp((c - params.minimum) / max(params.maximum - params.minimum, 1e-30), 0.0, 1.0) : vec3(1.0, 0.0, 1.0);
    imageStore(display, pixel, vec4(c, 1.0));
}
