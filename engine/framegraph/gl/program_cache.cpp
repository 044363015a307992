#include "framegraph/gl/program_cache.h"

#include <fmt/format.h>

#include "core/check.h"
#include "framegraph/hash.h"

namespace tyndall::fg {

Result<const gl::Program*> ProgramCache::find(std::string_view pass,
                                              std::span<const char* const> files,
                                              std::span<const Define> defines) {
    uint64_t key = files.size();
    for (const char* file : files) key = mixHash(key, hashName(file));
    for (const Define& define : defines)
        key = mixHash(mixHash(key, hashName(define.name)), uint32_t(define.value));
    // The library keeps a program's address when it is made anew, so what was found once stays good.
    if (const auto found = programs_.find(key); found != programs_.end()) return found->second;

    gl::ProgramRequest request;
    request.files.assign(files.begin(), files.end());
    for (const Define& define : defines) request.defines.push_back({define.name, define.value});
    CHECK(library_.isListed(request),
          fmt::format("pass '{}' asks for '{}', which shaders/variants.txt does not list", pass,
                      request.describe()));
    Result<const gl::Program*> program = library_.program(request);
    if (program.ok()) programs_.emplace(key, *program);
    return program;
}

} // namespace tyndall::fg
