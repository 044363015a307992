// Fills the light-space volume of one light: each thread walks one ray away from the light and stores the grids' optical
// depth (not transmittance) at every slice, from 0 where the volume begins.
#include "media/optical_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { OpticalDepthParams params; };
layout(rgba16f) uniform writeonly image3D volume;

const float kLargestStored = 60000.0; // what half precision holds; as opaque as any more

void main() {
    OpticalDepthView v = opticalDepthViews[params.light];
    int size = v.block.w;
    ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(column, ivec2(size)))) return;
    vec2 uv = vec2(column) / float(size - 1);
    vec3 origin;
    vec3 direction;
    float first = v.radial.x;
    float last = v.radial.y;
    if (v.kind == kDepthViewParallel) {
        origin = (v.renderFromVolume * vec4(uv, 0.0, 1.0)).xyz;
        direction = normalize(mat3(v.renderFromVolume) * vec3(0.0, 0.0, 1.0));
    } else {
        origin = v.origin.xyz;
        direction = v.kind == kDepthViewCone ? normalize(mat3(v.renderFromVolume) * vec3(uv * 2.0 - 1.0, 1.0)) : octahedralDecode(uv * 2.0 - 1.0);
    }
    float width = (last - first) / float(size - 1);
    vec3 depth = vec3(0.0);
    for (int slice = 0; slice < size; ++slice) {
        // Positions from the slice's number, not summed up: no rounding piles up.
        if (slice > 0) depth += gridOpticalDepth(origin, direction, first + float(slice - 1) * width, first + float(slice) * width);
        imageStore(volume, v.block.xyz + ivec3(column, slice), vec4(min(depth, vec3(kLargestStored)), 1.0));
    }
}
