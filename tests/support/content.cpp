#include "support/content.h"

#include <cstdlib>
#include <unistd.h>
#include <vector>

namespace tyndall::test {
namespace fs = std::filesystem;
namespace {

fs::path fromEnvironment(const char* name, const fs::path& otherwise) {
    const char* value = std::getenv(name);
    return value && *value ? fs::path(value) : otherwise;
}

struct ScratchFolders {
    std::vector<fs::path> folders;
    ~ScratchFolders() {
        std::error_code
            ignored; // Nothing useful can be done about a temporary folder that will not go.
        for (const fs::path& folder : folders) fs::remove_all(folder, ignored);
    }
};

} // namespace

fs::path sourceDir() { return fromEnvironment("TYNDALL_SOURCE_DIR", TYNDALL_SOURCE_DIR_DEFAULT); }
fs::path binDir() { return fromEnvironment("TYNDALL_BIN_DIR", TYNDALL_BIN_DIR_DEFAULT); }

std::optional<fs::path> sharedContent(const std::string& relative) {
    const fs::path root =
        fromEnvironment("TYNDALL_CONTENT", sourceDir().parent_path() / "shared" / "content");
    const fs::path path = root / relative;
    if (!fs::exists(path)) return std::nullopt;
    return path;
}

fs::path scratchDir(const std::string& name) {
    static ScratchFolders created;
    const fs::path folder =
        fs::temp_directory_path() / ("tyndall-test-" + name + "-" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    created.folders.push_back(folder);
    return folder;
}

uint64_t seed() {
    const char* value = std::getenv("TYNDALL_SEED");
    return value ? std::strtoull(value, nullptr, 10) : 1;
}

} // namespace tyndall::test
