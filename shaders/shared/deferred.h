// Parameters of light on surfaces (deferred and blended alike) and of the environment.
#ifndef TYNDALL_SHARED_DEFERRED_H
#define TYNDALL_SHARED_DEFERRED_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

// Uniform block `Surfaces`.
struct SurfaceLightParams {
    uint rectSamples;           // area samples of a rect light's specular part, in frames that are not averaged
    uint environmentSamples;    // directions of a pixel's specular environment
    float roughnessOfMap;       // up to this roughness the environment's reflection comes from its map,
    float roughnessOfLights;    // from this one on from its lights; in between from both, in shares that add to 1
    uint materialOcclusion;     // 1: occlusion textures darken the light of the environment
    uint padding0;
    uint padding1;
    uint padding2;
};

// Uniform block `Environment`; goes with the texture `environmentMap`.
struct EnvironmentData {
    vec4 rotation; // cosine and sine of the rotation about +Y; z: texels along the map's width, w: along its height
    vec4 levels;   // x: highest mip level; others unused
};

TYNDALL_SHARED_END
#endif
