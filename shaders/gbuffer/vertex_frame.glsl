// A vertex of an object, from local to render space.
#ifndef TYNDALL_GBUFFER_VERTEX_FRAME
#define TYNDALL_GBUFFER_VERTEX_FRAME
#include "shared/object.h"

vec3 unitOr(vec3 v, vec3 otherwise) {
    float squared = dot(v, v);
    return squared > 0.0 && squared < 1e37 ? v * inversesqrt(squared) : otherwise;
}

vec3 renderNormal(ObjectData object, vec3 normal) {
    return unitOr(mat3(object.normalX.xyz, object.normalY.xyz, object.normalZ.xyz) * normal, vec3(0.0));
}

// Tangent and handedness. A mirroring transform swaps the hands: M(n × t) = -(Mn × Mt).
vec4 renderTangent(ObjectData object, vec4 tangent) {
    vec3 direction = unitOr(mat3(object.renderFromLocal) * tangent.xyz, vec3(0.0));
    return vec4(direction, (object.flags & kObjectMirrored) != 0u ? -tangent.w : tangent.w);
}

#endif
