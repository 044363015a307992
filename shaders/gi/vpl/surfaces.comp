// Light of virtual point lights on surfaces, before the media between them and the eye: of a pixel in each square, the
// parts of SurfaceLight side by side; or of pixels that upsampling leaves open, their sum.
#include "gi/vpl/gather_surface.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D gathered; // with kMarchFill: the upsampled image; w: 0 where a pixel is open
layout(rgba32f) writeonly uniform image2D surfaceLight; // three parts; or nits

SurfaceLight lightAt(ivec2 pixel, uvec2 number, out Receiver r) {
    SurfaceLight light = kDark;
    if (!receiverAt(pixel, vpl.leastRoughness, r)) return light;
    uint first = uint(pixelNoise(number, 20u) * float(vpl.surfaceSubsets)) % vpl.surfaceSubsets;
    return gatherSurface(r, first, vpl.surfaceSubsets, number);
}

void main() {
    ivec2 square = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(surfaceLight);
    bool fills = (params.flags & kMarchFill) != 0u;
    if (!fills) size.x /= 3;
    if (any(greaterThanEqual(square, size))) return;
    vec4 there = fills ? texelFetch(gathered, square, 0) : vec4(0.0);
    Receiver r;
    SurfaceLight light;
    if (there.w == 0.0) light = lightAt(fills ? square : marchedPixel(square, params, textureSize(gbufferDepth, 0)), uvec2(square), r);
    if (fills) {
        if (there.w == 0.0) there = vec4(there.rgb + coloured(r, light), 1.0);
        imageStore(surfaceLight, square, there);
    } else {
        imageStore(surfaceLight, square, vec4(light.diffuse, 1.0));
        imageStore(surfaceLight, square + ivec2(size.x, 0), vec4(light.specular, 1.0));
        imageStore(surfaceLight, square + ivec2(2 * size.x, 0), vec4(light.grazing, 1.0));
    }
}
