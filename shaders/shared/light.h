// Lights as shaders see them: storage buffer `Lights`, one struct a light; environment samples are directional lights here.
#ifndef TYNDALL_SHARED_LIGHT_H
#define TYNDALL_SHARED_LIGHT_H
#include "shared/shadow.h"
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kLightDirectional = 0u;
TYNDALL_CONST uint kLightPoint = 1u;
TYNDALL_CONST uint kLightSpot = 2u;
TYNDALL_CONST uint kLightRect = 3u;

TYNDALL_CONST uint kLightFromEnvironment = 1u; // its specular part comes from the environment map instead
TYNDALL_CONST uint kLightFromMedium = 2u;      // stands for a glowing medium, but for what is closer than intensity.w

struct LightData {
    vec4 position;      // render space: point, spot, rect (centre); w: range in metres, 0 unbounded
    vec4 direction;     // unit, the way the light travels (the node's -Z); w: sphere radius (m) or angular radius (rad)
    vec4 intensity;     // candela (point, spot), lux (directional), nits (rect); w: rect: area in m²; point, spot: distances
                        // below this one (m) count as this one, so that nothing is infinite
    vec4 axisX;         // rect: half extent vector along the node's X; w: cos(inner cone)
    vec4 axisY;         // rect: half extent vector along the node's Y; w: cos(outer cone)
    vec4 samplePoint;   // converge: this frame's point on the light (position, or for directional: direction it travels); w: 1 where set
    uint type;
    uint flags;
    int shadowIndex;    // first entry of this light in `ShadowViews`, -1: casts no shadow
    int padding0;
};

TYNDALL_SHARED_END
#endif
