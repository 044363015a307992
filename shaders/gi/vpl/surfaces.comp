// Light of virtual point lights on surfaces, before the media between them and the eye: of a pixel in each square, and of all walks; or, where
// squares are single pixels, of one class of walks.
#include "gi/vpl/gather_surface.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
layout(rgba32f) writeonly uniform image2D diffuse;  // over the base colour
layout(rgba32f) writeonly uniform image2D specular;

void main() {
    ivec2 square = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(square, imageSize(diffuse)))) return;
    ivec2 pixel = marchedPixel(square, params, textureSize(gbufferDepth, 0));
    Receiver r;
    SurfaceLight light = SurfaceLight(vec3(0.0), vec3(0.0));
    if (receiverAt(pixel, r)) {
        uint number = uint(pixelNoise(uvec2(square), 20u) * float(vpl.surfaceClasses));
        light = gatherSurface(r, number % vpl.surfaceClasses, vpl.surfaceClasses, uvec2(square));
    }
    imageStore(diffuse, square, vec4(light.diffuse, 1.0));
    imageStore(specular, square, vec4(light.specular, 1.0));
}
