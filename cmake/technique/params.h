// Parameters of the technique @name@.
#ifndef TYNDALL_SHARED_@NAME@_H
#define TYNDALL_SHARED_@NAME@_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

// Uniform block `Technique`.
struct @Name@Params {
    uint directions; // asked for the opacity around each segment
    uint padding0;
    uint padding1;
    uint padding2;
};

TYNDALL_SHARED_END
#endif
