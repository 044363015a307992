#pragma once
// All programs of a renderer, made from the embedded shaders, from those that plugins add, or from a folder that is
// watched.

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "gl/embedded_shaders.h"
#include "gl/program.h"
#include "gl/shader_variants.h"

namespace tyndall::gl {

struct ShaderLibraryOptions {
    std::span<const EmbeddedShader> embedded = engineShaders();
    /// Files here come before embedded ones of the same path, and are watched. Empty: the environment variable
    /// TYNDALL_SHADER_DIR, if set.
    std::filesystem::path folder{};
    /// Least time between two looks at the files' times.
    std::chrono::milliseconds pollInterval{250};
};

/// Owns programs; a `const Program*` stays good as long as the library, also when the program behind it is made anew.
class ShaderLibrary {
public:
    explicit ShaderLibrary(ShaderLibraryOptions options = {});
    ~ShaderLibrary();
    ShaderLibrary(ShaderLibrary&&) noexcept;
    ShaderLibrary& operator=(ShaderLibrary&&) noexcept;

    /// Adds or replaces the source `path` (as "gi/octaves/march.comp"); `text` is copied. Programs that use it are made
    /// anew at the next pollChanges().
    void addSource(const std::string& path, std::string text);

    /// The program, made on first use. Errors: the messages of the driver with files and lines; the same at every call
    /// until a file changes.
    Result<const Program*> program(const ProgramRequest& request);
    Result<const Program*> compute(const std::string& path, std::vector<ShaderDefine> defines = {});
    Result<const Program*> raster(const std::string& vertex, const std::string& fragment,
                                  std::vector<ShaderDefine> defines = {});

    /// True when variants.txt has it, or when one of its files was added at run time.
    [[nodiscard]] bool isListed(const ProgramRequest& request) const;
    /// variants.txt of the folder, else of the embedded sources. CHECKs that it can be read.
    [[nodiscard]] const VariantList& variants() const;

    /// Looks for changed files and makes the programs that use them anew. One that fails keeps its last good program,
    /// and the message is logged once. Returns the number of programs that were replaced. Cheap enough for every frame.
    int pollChanges();
    /// Grows whenever a program is replaced: who caches what a program drew compares.
    [[nodiscard]] uint64_t generation() const;
    /// Messages of the programs that fail now, in order of their names.
    [[nodiscard]] std::vector<std::string> failures() const;
    [[nodiscard]] size_t programCount() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace tyndall::gl
