#pragma once
// The shader sources that were put into the program when it was built (cmake/embed_shaders.cmake).

#include <span>

namespace tyndall::gl {

/// One file below shaders/: its path relative to that folder, and its text. Both point to static storage.
struct EmbeddedShader {
    const char* path;
    const char* text;
};

/// Every file of the engine's own shaders/ folder, variants.txt included, sorted by path.
std::span<const EmbeddedShader> engineShaders();

} // namespace tyndall::gl
