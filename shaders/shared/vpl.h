// Virtual point lights: buffers `VplLights`, `VplWalks` and `VplMaps`, and the parameters of the passes that gather them.
#ifndef TYNDALL_SHARED_VPL_H
#define TYNDALL_SHARED_VPL_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kVplDepthSteps = 16u;      // distances of a map of optical depth

struct VplData {
    vec4 position; // render space; w: -1 on a surface; else the phase function's kind
    vec4 normal;   // of the facet, unit, on the side that light came from; w: roughness
    vec4 shading;  // shading normal, unit; w: weight of the dielectric's coat
    vec4 travel;   // unit, of the light that arrives; w: parameter g of the phase function
    vec4 power;    // watts over all walks: on a surface what arrives, in a medium what is scattered; w: kVplOfSurfaces and so on
    vec4 base;     // base colour; w: metallic
};

/// Position of a light: its map depends on nothing else.
struct VplPlace {
    vec4 position; // as VplData's
    vec4 normal;
};

/// A point of a surface that is splatted into maps.
struct VplPoint {
    vec3 position; // render space
    uint triangle;
};

/// Points are in sets, each spread over all surfaces; lights use them in turn.
struct VplPointParams {
    vec4 around;  // centre of the lights; w: m², mean square of their distance from it
    float spread; // a point's radius over its distance from there, √(|p - around|² + w)
    uint setSize; // points
    uint setCount;
    uint padding;
};

struct VplParams {
    uint lightCount;
    uint walkCount;
    uint
        subsets; // interleaved subsets: walks with equal number modulo this are gathered at one point of a ray; 1: all
    uint surfaceSubsets; // the same for a surface
    uint mapSide;        // texels along an edge of a visibility map; 0: no occlusion
    uint compensation;   // kVplClamped and so on
    uint lightsOfScene;  // that compensation gathers
    float relaxed; // clamp distance over that with which compensation gathers
    float clampSquared;        // m²: 1/b in the content if light or receiver is in a medium
    float surfaceClampSquared; // m²: 1/b in the content from surface to surface
    float leastRoughness;      // of virtual lights and of receivers
    uint depthSide; // texels along an edge of a light's map of optical depth; 0: grids are marched
    vec4 gridsMinimum; // of the box around all grids, render space
    vec4 gridsMaximum;
    vec4
        content; // middle of the box around what is in the scene, render space; w: 1/m², of half its diagonal, 0: the clamp distance is the same everywhere
    uint samples;     // points at which a ray through media gathers
    uint mediaInView; // 0: no medium is in view
    uint lost;        // 1: lights give only the light that clamping removes
    float mediumClampSquared; // m²: 1/b in the content from surface to medium
    uint pathLight; // kVplPathsOnSurfaces and so on: light of compensation paths is in `VplPathLight`
    // Which lights count on surfaces and in media, a bit for each of kVplOfSurfaces and so on: each is the light of one term there.
    uint surfaceTerms, mediaTerms;
    uint upToFreePath; // 1: in a medium 1/b reaches no farther than the free path there
    uint firstPoint, endPoint; // of a ray's points those at which this turn gathers: what earlier turns found is in the picture
    uint padding0, padding1;
};

// By the last scattering of a light's power, and by whether that was its first.
TYNDALL_CONST uint kVplOfSurfaces = 0u, kVplOfMedia = 1u;           // LSSE, LSVE; LVSE, LVVE
TYNDALL_CONST uint kVplLaterOfSurfaces = 2u, kVplLaterOfMedia = 3u; // LXSSE, LXSVE; LXVSE, LXVVE
TYNDALL_CONST uint kVplAllTerms = 15u;

TYNDALL_CONST uint kVplPathsOnSurfaces = 1u;
TYNDALL_CONST uint kVplPathsInMedia = 2u;

TYNDALL_CONST uint kVplAllPoints = 0xffffffffu; // endPoint of the last turn

struct VplShowParams {
    uint what;                                    // kVplShowLights and so on
    uint light;                                   // whose map
    float radius;                                 // of a ball in the content, metres
    float white;                                  // nits
    uint hasTransmittance, hasSurfaces, hasMedia; // 0: the texture is not there
    uint padding;
};
TYNDALL_CONST uint kVplShowLights = 1u;
TYNDALL_CONST uint kVplShowMap = 2u;
TYNDALL_CONST uint kVplShowAtlas = 3u;
TYNDALL_CONST uint kVplShowLost = 4u;

TYNDALL_CONST uint kVplClamped = 0u;    // clamped light is left out
TYNDALL_CONST uint kVplClosedForm = 1u; // as if light were even
TYNDALL_CONST uint kVplTraced = 2u;     // from one point near each gathering point

TYNDALL_SHARED_END
#endif
