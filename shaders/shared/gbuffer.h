// Flags of a pixel of the G-buffer: gbuffer.material.w is flags / 65535.
#ifndef TYNDALL_SHARED_GBUFFER_H
#define TYNDALL_SHARED_GBUFFER_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kGBufferUnlit = 1u; // reflects nothing: its colour is in the emission

TYNDALL_SHARED_END
#endif
