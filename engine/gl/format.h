#pragma once
// What the wrappers need to know about a sized internal format.

#include <cstdint>

#include "gl/api.h"

namespace tyndall::gl {

enum class FormatClass : uint32_t {
    Float = 0,
    UnsignedInt = 1,
    SignedInt = 2,
    Depth = 3
}; // Float: also normalised ones

struct FormatInfo {
    GLenum internalFormat;
    const char* name;      // "RGBA32F"
    GLenum transferFormat; // GL_RGBA, GL_RED_INTEGER, GL_DEPTH_COMPONENT …
    GLenum transferType;   // the type that holds its texels without conversion
    uint32_t channels;
    uint32_t bytesPerTexel;
    FormatClass formatClass;
};

/// CHECKs that the format is one that the engine uses (the table in format.cpp).
const FormatInfo& formatInfo(GLenum internalFormat);

} // namespace tyndall::gl
