// Shadow maps as shaders see them: storage buffer `ShadowViews`, one struct a view, and the depth array `shadowAtlas`.
#ifndef TYNDALL_SHARED_SHADOW_H
#define TYNDALL_SHARED_SHADOW_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

/// One square of the shadow atlas. A directional light has one a cascade, the finest first; a light that shines to all sides
/// has six, looking along +X -X +Y -Y +Z -Z of render space; a narrow spot has one.
///
/// Depth is reversed, so that single precision suffices far from the light: parallel views hold 1 at the side of the light
/// and 0 at the far end; perspective views hold near/distance along the view's axis. 0 is also "nothing here".
struct ShadowView {
    mat4 shadowFromRender; // after division: x, y in [0,1] over the square, z the depth above
    vec4 atlas;            // x, y: lower left corner in texels; z: side in texels (0: nothing here can be lit); w: texels in the whole layer's side
    vec4 bias;             // x: size of a texel in metres, at distance 1 (perspective) or anywhere (parallel); y: 1 if perspective, else 0;
                           // z: depth range (parallel) or near distance (perspective), metres; w: border in texels that is
                           // there for filtering only
    int layer;             // of the shadow atlas array
    int count;             // views of this light from this one on
    int taps;              // lookups a filtered surface point takes
    int searchTaps;        // lookups that look for what casts a soft shadow; 0: the light is as good as a point
};

/// Block `Params` of shadow.vert and shadow.frag.
struct ShadowDrawParams {
    mat4 clipFromRender;
    vec4 ball; // BALL: centre in render space and radius; what is inside casts no shadow
};

TYNDALL_SHARED_END
#endif
