// Parameters of passes that gather virtual point lights.
#ifndef TYNDALL_GI_VPL_PARAMS
#define TYNDALL_GI_VPL_PARAMS
#include "shared/vpl.h"

layout(std140) uniform Vpl { VplParams vpl; };

#endif
