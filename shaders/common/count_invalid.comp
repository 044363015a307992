// Counts the texels of one level of a float texture that hold a component that is not finite, and those that hold a negative one.
// KIND: 0 2D, 1 array, 2 3D.
layout(local_size_x = 8, local_size_y = 8) in;

#if KIND == 0
uniform sampler2D image;
#elif KIND == 1
uniform sampler2DArray image;
#else
uniform sampler3D image;
#endif

layout(std430) buffer Counts { uint counts[]; }; // of each pass: not finite, negative

uniform int level;
uniform int passIndex;
uniform int countNegative;

shared uint groupCounts[2];

void main() {
    if (gl_LocalInvocationIndex < 2u) groupCounts[gl_LocalInvocationIndex] = 0u;
    barrier();
    ivec3 position = ivec3(gl_GlobalInvocationID);
#if KIND == 0
    ivec2 size = textureSize(image, level);
    vec4 texel = texelFetch(image, min(position.xy, size - 1), level);
#else
    ivec3 size = textureSize(image, level);
    vec4 texel = texelFetch(image, min(position, size - 1), level);
#endif
    bool inside = position.x < size.x && position.y < size.y;
    // By the bits: a compiler may assume that isnan() is never true.
    uvec4 bits = floatBitsToUint(texel);
    bool nonFinite = any(equal(bits & 0x7f800000u, uvec4(0x7f800000u)));
    bool negative = any(lessThan(texel, vec4(0.0)));
    if (inside && nonFinite) atomicAdd(groupCounts[0], 1u);
    if (inside && negative && countNegative != 0) atomicAdd(groupCounts[1], 1u);
    barrier();
    if (gl_LocalInvocationIndex < 2u && groupCounts[gl_LocalInvocationIndex] > 0u)
        atomicAdd(counts[2 * passIndex + int(gl_LocalInvocationIndex)], groupCounts[gl_LocalInvocationIndex]);
}
