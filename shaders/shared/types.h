// Makes the shared headers compile as C++ and as GLSL. Only structs and constants; no vec3, no bool; pads are named;
// C++ members have the std140/std430 layout because everything is made of 4- and 16-byte pieces.
#ifndef TYNDALL_SHARED_TYPES_H
#define TYNDALL_SHARED_TYPES_H

#ifdef __cplusplus
#include "core/math.h"
#define TYNDALL_SHARED_BEGIN namespace tyndall::gpu {
#define TYNDALL_SHARED_END }
#define TYNDALL_CONST inline constexpr
TYNDALL_SHARED_BEGIN
using uint = uint32_t;
using tyndall::ivec2; using tyndall::ivec4; using tyndall::mat4;
using tyndall::uvec2; using tyndall::uvec4; using tyndall::vec2; using tyndall::vec4;
TYNDALL_SHARED_END
#else
#define TYNDALL_SHARED_BEGIN
#define TYNDALL_SHARED_END
#define TYNDALL_CONST const
#endif

#endif
