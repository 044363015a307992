#include "app/output_file.h"

#include <filesystem>

#include <fmt/format.h>

namespace tyndall {
namespace fs = std::filesystem;
namespace {
constexpr size_t kLongestName = 255; // bytes, of all file systems of Linux
}

Result<void> checkOutputFolder(const char* option, const std::string& file) {
    if (file.empty()) return {};
    const size_t nameBytes = fs::path(file).filename().string().size();
    if (nameBytes > kLongestName)
        return Error{fmt::format("{} {}...: the file's name has {} bytes; it can have {}", option,
                                 file.substr(0, 40), nameBytes, kLongestName)};
    const fs::path folder = fs::path(file).parent_path();
    std::error_code error;
    if (!folder.empty() && !fs::is_directory(folder, error))
        return Error{fmt::format("{} {}: there is no folder '{}'; make it first", option, file,
                                 folder.string())};
    return {};
}

} // namespace tyndall
