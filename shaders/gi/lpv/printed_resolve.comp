// The printed scheme's light for look-ups. Section 4 ray-marches the power of a cell as light that crosses it: over the mean distance of two
// neighbours.
#include "gi/lpv/printed.glsl" // LpvRadiance: the sum over all steps

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) writeonly buffer LpvSides { uint sides[]; };
layout(rgba32f) writeonly uniform image3D redLight;
layout(rgba32f) writeonly uniform image3D greenLight;
layout(rgba32f) writeonly uniform image3D blueLight;

/// xyz: vector flux, w: fluence. Coefficients of the sum may be negative where the scheme diverges; light is not.
vec4 lightOf(vec4 l, float unit) {
    return unit * vec4(l.w, l.y, l.z, 0.0) * (kLpvOne / sqrt(3.0)) + vec4(0.0, 0.0, 0.0, max(unit * kLpvOne * l.x, 0.0));
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    uint lookups = uint(params.grid.place.y) + self;
    for (uint p = 0u; p < kLpvSidePlanes; ++p) sides[lookups + p * cells] = links[p * cells + self];
    sides[lookups + kLpvCellMedium * cells] = 0u; // the paper uses a cell's light on a surface as it is
    float unit = transfer.meanLength / (params.grid.lowest.w * params.grid.lowest.w);
    ivec3 to = at + ivec3(0, 0, params.grid.place.x);
    imageStore(redLight, to, lightOf(radianceOf(self, cells, 0u), unit));
    imageStore(greenLight, to, lightOf(radianceOf(self, cells, 1u), unit));
    imageStore(blueLight, to, lightOf(radianceOf(self, cells, 2u), unit));
}
