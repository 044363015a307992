#pragma once
// From the JSON of a scene file to a scene, step by step: schema, names, nodes with what they carry, then what belongs to the
// whole scene. Private to the folder.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/json_parse.h"
#include "scene/scene_file.h"
#include "scene/scene_mount.h"

namespace tyndall {

class SceneReader {
public:
    SceneReader(LoadedScene& loaded, const LoadOptions& options, std::filesystem::path file)
        : loaded_(loaded), scene_(loaded.scene), options_(options), file_(std::move(file)) {}

    /// Errors name the file and the JSON pointer.
    Result<void> read(std::string_view text);

private:
    struct Names {
        std::map<std::string, size_t> byName; // index in the file's `nodes`
        std::vector<size_t> order;            // the file's nodes, parents first
        std::vector<int> parentOf;            // in the file's indices, kNone for roots
    };

    Result<void> readChecked(const Json& json);
    Result<Names> readNames(const Json& nodes) const;
    Result<void> readNode(const Json& json, const std::string& pointer, int parent);
    Result<void> readTransform(const Json& json, const std::string& pointer, Node& node) const;
    Result<void> readPrimitive(const Json& json, const std::string& pointer, Node& node);
    Result<int> readMaterial(const Json& json, const std::string& pointer, const std::string& name);
    Result<int> readTexture(const std::string& file, const std::string& pointer);
    Result<int> readLight(const Json& json, const std::string& pointer, const std::string& name);
    Result<int> readCamera(const Json& json, const std::string& pointer, const std::string& name);
    Result<void> readMedium(const Json& json, const std::string& pointer, Node& node);
    Result<void> readGrid(const Json& json, const std::string& pointer, Node& node, Medium& medium);
    Result<void> readParticles(const Json& json, const std::string& pointer, Node& node,
                               Medium& medium);
    Result<void> readAnimations(const Json& json, const std::string& pointer, Node& node) const;
    Result<void> readEnvironment(const Json& json);
    Result<void> readWholeScene(const Json& json);
    Result<void> chooseCamera(const Json& json);

    /// Every key of `json` must be in `allowed`; `what` names the kind for the sentence ("a rect light").
    Result<void> onlyKeys(const Json& json, const std::string& pointer, std::string_view what,
                          std::initializer_list<std::string_view> allowed) const;
    [[nodiscard]] Error at(const std::string& pointer, const std::string& sentence) const;
    [[nodiscard]] std::filesystem::path resolved(const std::string& file) const;
    Result<void> progress(float fraction, const std::string& what) const;

    LoadedScene& loaded_;
    Scene& scene_;
    const LoadOptions& options_;
    std::filesystem::path file_;
    GltfMounts mounts_;
    std::map<std::string, int> textures_; // by file name as written
    std::map<std::string, Medium> grids_; // by file and grid names, or rule of particles
    float fraction_ = 0;
};

/// "smoke_%04d.vdb" with a number in it. Errors: not exactly one %d, %Nd or %0Nd.
Result<std::string> frameFile(const std::string& pattern, int frame);
/// Does the file name hold a % pattern?
bool isFramePattern(const std::string& file);

} // namespace tyndall
