#include "gl/format.h"

#include <fmt/format.h>

#include "core/check.h"

namespace tyndall::gl {
namespace {

constexpr auto kF = FormatClass::Float;
constexpr auto kU = FormatClass::UnsignedInt;
constexpr auto kI = FormatClass::SignedInt;
constexpr auto kD = FormatClass::Depth;

constexpr FormatInfo kFormats[] = {
    {GL_R8, "R8", GL_RED, GL_UNSIGNED_BYTE, 1, 1, kF},
    {GL_RG8, "RG8", GL_RG, GL_UNSIGNED_BYTE, 2, 2, kF},
    {GL_RGBA8, "RGBA8", GL_RGBA, GL_UNSIGNED_BYTE, 4, 4, kF},
    {GL_SRGB8_ALPHA8, "SRGB8_ALPHA8", GL_RGBA, GL_UNSIGNED_BYTE, 4, 4, kF},
    {GL_R16, "R16", GL_RED, GL_UNSIGNED_SHORT, 1, 2, kF},
    {GL_RG16, "RG16", GL_RG, GL_UNSIGNED_SHORT, 2, 4, kF},
    {GL_RGBA16, "RGBA16", GL_RGBA, GL_UNSIGNED_SHORT, 4, 8, kF},
    {GL_RG16_SNORM, "RG16_SNORM", GL_RG, GL_SHORT, 2, 4, kF},
    {GL_RGBA16_SNORM, "RGBA16_SNORM", GL_RGBA, GL_SHORT, 4, 8, kF},
    {GL_R16F, "R16F", GL_RED, GL_HALF_FLOAT, 1, 2, kF},
    {GL_RG16F, "RG16F", GL_RG, GL_HALF_FLOAT, 2, 4, kF},
    {GL_RGBA16F, "RGBA16F", GL_RGBA, GL_HALF_FLOAT, 4, 8, kF},
    {GL_R32F, "R32F", GL_RED, GL_FLOAT, 1, 4, kF},
    {GL_RG32F, "RG32F", GL_RG, GL_FLOAT, 2, 8, kF},
    {GL_RGB32F, "RGB32F", GL_RGB, GL_FLOAT, 3, 12, kF},
    {GL_RGBA32F, "RGBA32F", GL_RGBA, GL_FLOAT, 4, 16, kF},
    {GL_R11F_G11F_B10F, "R11F_G11F_B10F", GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, 3, 4, kF},
    {GL_R8UI, "R8UI", GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1, 1, kU},
    {GL_R16UI, "R16UI", GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1, 2, kU},
    {GL_R32UI, "R32UI", GL_RED_INTEGER, GL_UNSIGNED_INT, 1, 4, kU},
    {GL_RG32UI, "RG32UI", GL_RG_INTEGER, GL_UNSIGNED_INT, 2, 8, kU},
    {GL_RGBA32UI, "RGBA32UI", GL_RGBA_INTEGER, GL_UNSIGNED_INT, 4, 16, kU},
    {GL_R32I, "R32I", GL_RED_INTEGER, GL_INT, 1, 4, kI},
    {GL_RGBA32I, "RGBA32I", GL_RGBA_INTEGER, GL_INT, 4, 16, kI},
    {GL_DEPTH_COMPONENT32F, "DEPTH_COMPONENT32F", GL_DEPTH_COMPONENT, GL_FLOAT, 1, 4, kD},
};

} // namespace

const FormatInfo& formatInfo(GLenum internalFormat) {
    for (const FormatInfo& info : kFormats)
        if (info.internalFormat == internalFormat) return info;
    CHECK(false,
          fmt::format("internal format {:#x} is not in the table of format.cpp", internalFormat));
    return kFormats[0];
}

} // namespace tyndall::gl
