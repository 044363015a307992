// A quad around the rays that a shell around a surfel can touch, in one sub-buffer of a level.
#include "gi/surfels/splat.glsl"

layout(std430) readonly buffer Brightness { SurfelBrightness brightness; };

flat out uint surfelNumber;
flat out uint subBuffer;
flat out vec2 shell; // inner and outer radius, metres

/// Radius within which a surfel counts at the finest level: there its light in the media is more than ε of the average.
/// The printed radius, r B/ε, has no root; B is taken over the average.
float reachOf(LitSurfel s) {
    float mean = brightness.weighted / max(brightness.total, 1e-37);
    float relative = s.normal.w / max(splat.threshold * mean, 1e-37);
    float radius = sqrt(s.position.w / 3.14159265);
    return min(radius * (splat.mode == kSurfelEncodingPaper ? relative : sqrt(0.5 * relative)), 0.5 * kEndless / 64.0);
}

/// Surfels in turn, with the digits of their numbers, base 4, in reverse: any four surfels in a row are in different quarters of the ranks. The paper chooses at random.
uint subBufferFor(uint surfel) {
    uint count = 1u << (2u * splat.level);
    if (splat.mode == kSurfelEncodingPaper) return hashUint(surfel + hashUint(splat.shift)) & (count - 1u);
    uint rank = 0u;
    for (uint digit = 0u; digit < splat.level; ++digit) rank = rank << 2u | ((surfel >> (2u * digit)) & 3u);
    return (rank + splat.shift) & (count - 1u);
}

/// Does the shell's ball touch the media?
bool touchesMedia(vec3 centre, float radius) {
    vec3 off = max(max(splat.mediaMinimum.xyz - centre, centre - splat.mediaMaximum.xyz), vec3(0.0));
    return dot(off, off) <= radius * radius;
}

/// Slopes x/z between which a ball is seen: `across` and `ahead` of the eye. Endless to a side where the ball reaches beside the eye.
vec2 slopes(float across, float ahead, float radius) {
    float squared = across * across + ahead * ahead - radius * radius;
    if (squared <= 0.0) return vec2(-kEndless, kEndless);
    float tangent = sqrt(squared);
    float low = ahead * tangent + across * radius;
    float high = ahead * tangent - across * radius;
    return vec2(low > 0.0 ? (across * tangent - ahead * radius) / low : -kEndless, high > 0.0 ? (across * tangent + ahead * radius) / high : kEndless);
}

/// The pixels of the ball, lowest and highest; false where no ray meets it.
bool pixelsOf(vec3 centre, float radius, out vec2 lowest, out vec2 highest) {
    lowest = vec2(0.0);
    highest = view.size.xy;
    vec3 c = (view.viewFromRender * vec4(centre, 1.0)).xyz;
    if (radius >= 0.25 * kEndless) return true;
    vec2 x, y;
    if (viewIsOrthographic()) {
        x = c.x + radius * vec2(-1.0, 1.0);
        y = c.y + radius * vec2(-1.0, 1.0);
    } else {
        if (-c.z <= -radius) return false;
        x = slopes(c.x, -c.z, radius);
        y = slopes(c.y, -c.z, radius);
    }
    // A pixel more on each side, for the frame's offset and for rounding.
    vec2 low = (clamp(vec2(x.x, y.x) * splat.focal.xy, -2.0, 2.0) * 0.5 + 0.5) * view.size.xy - 1.5;
    vec2 high = (clamp(vec2(x.y, y.y) * splat.focal.xy, -2.0, 2.0) * 0.5 + 0.5) * view.size.xy + 1.5;
    lowest = max(low, vec2(0.0));
    highest = min(high, view.size.xy);
    return all(lessThan(lowest, highest));
}

void main() {
    surfelNumber = uint(gl_VertexID) / 6u;
    uint corner = uint(gl_VertexID) % 6u;
    LitSurfel s = lit[surfelNumber];
    subBuffer = subBufferFor(surfelNumber);
    float reach = reachOf(s);
    bool tail = splat.tail != 0u && splat.level + 1u == splat.levels;
    shell = vec2(splat.level == 0u ? 0.0 : reach * exp2(float(splat.level) - 1.0), tail ? kEndless : reach * exp2(float(splat.level)));
    vec2 lowest, highest;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // nowhere
    if (!(s.position.w * s.normal.w > 0.0) || !touchesMedia(s.position.xyz, shell.y) || !pixelsOf(s.position.xyz, shell.y, lowest, highest)) return;
    ivec2 most = subBufferSize(splat.level, splat.size);
    float perRay = float(splat.factor << splat.level);
    // A ray stands for a square of pixels, of which its own is one.
    ivec2 first = clamp(ivec2(floor(lowest / perRay)), ivec2(0), most);
    ivec2 end = clamp(ivec2(floor(highest / perRay)) + 1, ivec2(0), most);
    ivec2 at = subBufferCorner(splat.level, subBuffer, splat.size) + ivec2((corner == 1u || corner >= 4u) ? end.x : first.x, (corner == 2u || corner == 3u || corner == 5u) ? end.y : first.y);
    gl_Position = vec4(vec2(at) / vec2(splat.textureSize) * 2.0 - 1.0, 0.0, 1.0);
}
