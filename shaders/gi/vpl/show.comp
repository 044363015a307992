// Virtual lights in the finished picture: as balls, green on surfaces and red in media; the visibility map of one or of all, a colour for each triangle's
// normal; or, in place of the picture, the light that clamping removes.
#include "gi/vpl/visibility.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Show { VplShowParams show; };
uniform sampler2D depth;
uniform sampler2D color;
uniform sampler2D transmittance;
uniform sampler2D lostOnSurfaces;
uniform sampler2D lostInMedia;
layout(rgba32f) writeonly uniform image2D shown;

vec3 balls(Ray ray, float distance, vec3 picture) {
    for (uint light = 0u; light < vpl.lightCount; ++light) {
        vec3 way = vplLights[light].position.xyz - ray.origin;
        float along = dot(way, ray.direction);
        vec3 off = way - along * ray.direction;
        float radius = show.radius * sqrt(vplClampScale(vplLights[light].position.xyz));
        float within = radius * radius - dot(off, off);
        if (!(within > 0.0)) continue;
        float t = along - sqrt(within);
        if (!(t > 0.0) || t > distance + radius) continue;
        distance = t;
        float facing = sqrt(within) / radius;
        picture = show.white * (0.2 + 0.6 * facing) * (vplLights[light].position.w < 0.0 ? vec3(0.1, 1.0, 0.1) : vec3(1.0, 0.1, 0.1));
    }
    return picture;
}

/// `at`: in the map, [0,1)².
vec3 mapAt(uint light, vec2 at) {
    uint id = vplTriangleAt(light, ivec2(at * float(vpl.mapSide)));
    if (id == kNoTriangle) return vec3(0.0);
    return show.white * (0.5 + 0.5 * tracedTriangles[id].plane.xyz);
}

/// The map in the lower left corner, half as high as the picture.
vec3 mapOf(uint light, ivec2 pixel, vec3 picture) {
    vec2 at = vec2(pixel) / (0.5 * view.size.y);
    if (vpl.mapSide == 0u || light >= vpl.lightCount || any(greaterThanEqual(at, vec2(1.0)))) return picture;
    return mapAt(light, at);
}

/// All maps, row by row from the lower left corner, as large as they fit in.
vec3 atlas(ivec2 pixel, vec3 picture) {
    if (vpl.mapSide == 0u || vpl.lightCount == 0u) return picture;
    float columns = ceil(sqrt(float(vpl.lightCount) * view.size.x / view.size.y));
    vec2 at = vec2(pixel) * columns / view.size.x;
    uint light = uint(at.y) * uint(columns) + uint(at.x);
    return light < vpl.lightCount ? mapAt(light, fract(at)) : picture;
}

vec3 lost(ivec2 pixel) {
    vec3 sum = vec3(0.0);
    if (show.hasSurfaces != 0u) sum = texelFetch(lostOnSurfaces, pixel, 0).rgb;
    if (show.hasTransmittance != 0u) sum *= texelFetch(transmittance, pixel, 0).rgb;
    if (show.hasMedia != 0u) sum += texelFetch(lostInMedia, pixel, 0).rgb;
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shown)))) return;
    vec2 centre = vec2(pixel) + 0.5;
    vec3 picture = texelFetch(color, pixel, 0).rgb;
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
    if (show.what == kVplShowLights) picture = balls(cameraRay(centre), distance, picture);
    if (show.what == kVplShowMap) picture = mapOf(show.light, pixel, picture);
    if (show.what == kVplShowAtlas) picture = atlas(pixel, picture);
    if (show.what == kVplShowLost) picture = lost(pixel);
    imageStore(shown, pixel, vec4(picture, 1.0));
}
