#include "reference/picture_cache.h"

#include <cctype>
#include <cstdlib>

#include <fmt/format.h>

#include "tracing/sampler.h"

namespace tyndall::reference {

std::string pictureName(const Scene& scene, const std::filesystem::path& scenePath, int cameraNode,
                        const RenderSettings& settings) {
    std::string name = scenePath.filename().string();
    name = name.substr(0, name.find('.'));
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    uint64_t key = sceneHash(scene, cameraNode);
    for (const uint64_t part :
         {uint64_t(settings.path.terms), uint64_t(int64_t(settings.path.maxScatterings)),
          uint64_t(kReferenceVersion)})
        key = mixBits(key ^ part);
    return fmt::format("{}-{}x{}-{:016x}.exr", name, settings.width, settings.height, key);
}

std::optional<KeptPicture> findPicture(const std::filesystem::path& folder,
                                       const std::string& name) {
    KeptPicture picture{folder / name};
    std::error_code error;
    if (!std::filesystem::exists(picture.path, error)) return {};
    const Result<ExrFile> file = readExr(picture.path);
    if (!file.ok()) return {};
    const auto number = [&file](const char* key) {
        const auto found = file->metadata.find(key);
        return found == file->metadata.end() ? 0.0 : std::strtod(found->second.c_str(), nullptr);
    };
    picture.samples = uint64_t(number("tyndall.samples"));
    picture.estimatedRelmse = number("tyndall.estimatedRelmse");
    if (picture.samples == 0) return {};
    return picture;
}

} // namespace tyndall::reference
