#include "app/output_file.h"

#include <filesystem>

#include <fmt/format.h>

namespace tyndall {
namespace fs = std::filesystem;

Result<void> checkOutputFolder(const char* option, const std::string& file) {
    if (file.empty()) return {};
    const fs::path folder = fs::path(file).parent_path();
    std::error_code error;
    if (!folder.empty() && !fs::is_directory(folder, error))
        return Error{fmt::format("{} {}: there is no folder '{}'; make it first", option, file,
                                 folder.string())};
    return {};
}

} // namespace tyndall
