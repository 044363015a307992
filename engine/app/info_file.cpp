#include "app/info_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "core/image.h"
#include "core/image_metrics.h"
#include "media/grid_import.h"
#include "media/particle_grids.h"
#include "scene/scene_file.h"

namespace tyndall {
namespace fs = std::filesystem;
namespace {

std::string vectorText(const dvec3& v) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string boundsText(const Bounds& bounds) {
    return bounds.empty()
               ? "nothing"
               : fmt::format("{} to {} m", vectorText(bounds.minimum), vectorText(bounds.maximum));
}

// Grids

std::string gridLines(const GridInfo& grid) {
    std::string text = fmt::format("grid '{}': {}, {}, {} active voxels", grid.name, grid.type,
                                   grid.gridClass, grid.activeVoxels);
    if (grid.last.x >= grid.first.x)
        text += fmt::format(" in ({}, {}, {}) to ({}, {}, {})", grid.first.x, grid.first.y,
                            grid.first.z, grid.last.x, grid.last.y, grid.last.z);
    text += '\n';
    if (grid.affine) {
        const dmat4& m = grid.worldFromIndex;
        const dvec3 edges(glm::length(dvec3(m[0])), glm::length(dvec3(m[1])),
                          glm::length(dvec3(m[2])));
        text += fmt::format("    voxels of {} m, voxel (0, 0, 0) at {} m\n", vectorText(edges),
                            vectorText(dvec3(m[3])));
    } else {
        text += "    a frustum transform, which is not rendered\n";
    }
    return text + (grid.importable ? "    understood: it can be a medium's density or temperature\n"
                                   : "    ignored: it cannot be a density\n");
}

Result<std::string> describeGrids(const fs::path& path) {
    const Result<GridFileInfo> info = gridInfo(path);
    if (!info.ok()) return info.error();
    std::string text =
        fmt::format("{}: {}, {} grids\n", path.string(), info->format, info->grids.size());
    for (const GridInfo& grid : info->grids) text += gridLines(grid);
    return text;
}

// Images

std::string imageLine(const std::string& name, const Image& image) {
    float smallest = INFINITY, largest = -INFINITY;
    double sum = 0;
    size_t finite = 0;
    for (float value : image.pixels) {
        if (!std::isfinite(value)) continue;
        smallest = std::min(smallest, value);
        largest = std::max(largest, value);
        sum += double(value);
        ++finite;
    }
    const ValueCounts counts = countValues(image);
    return fmt::format(
        "layer '{}': {} channels, {:.6g} to {:.6g}, mean {:.6g}, {} not finite, {} negative\n",
        name.empty() ? "(main)" : name, image.channels, finite ? smallest : 0.0f,
        finite ? largest : 0.0f, finite ? sum / double(finite) : 0.0, counts.nonFinite,
        counts.negative);
}

Result<std::string> describeExr(const fs::path& path) {
    const Result<ExrFile> file = readExr(path);
    if (!file.ok()) return file.error();
    std::string text = fmt::format("{}: OpenEXR, {}x{}, {} layers\n", path.string(),
                                   file->layers.front().image.width,
                                   file->layers.front().image.height, file->layers.size());
    for (const ImageLayer& layer : file->layers) text += imageLine(layer.name, layer.image);
    for (const auto& [key, value] : file->metadata) text += fmt::format("{}: {}\n", key, value);
    return text;
}

Result<std::string> describeHdr(const fs::path& path) {
    const Result<Image> image = readHdr(path);
    if (!image.ok()) return image.error();
    return fmt::format("{}: Radiance, {}x{}\n", path.string(), image->width, image->height) +
           imageLine("", *image);
}

// Scenes

/// The extensions that a glTF file uses. The loader has a note for each that it ignores.
std::string extensionLines(const LoadedScene& loaded) {
    std::string text;
    for (const std::string& extension : loaded.extensions) {
        const bool ignored =
            std::any_of(loaded.notes.begin(), loaded.notes.end(), [&](const std::string& note) {
                return note.find(extension) != std::string::npos;
            });
        text += fmt::format("extension {}: {}\n", extension, ignored ? "ignored" : "understood");
    }
    return text;
}

const char* kindName(MediumKind kind) {
    switch (kind) {
    case MediumKind::Everywhere: return "everywhere";
    case MediumKind::Box: return "box";
    case MediumKind::Sphere: return "sphere";
    case MediumKind::Height: return "height";
    case MediumKind::Grid: return "grid";
    }
    return "";
}

const char* kindName(LightType type) {
    switch (type) {
    case LightType::Directional: return "directional";
    case LightType::Point: return "point";
    case LightType::Spot: return "spot";
    case LightType::Rect: return "rect";
    }
    return "";
}

std::string mediumLine(const Medium& medium) {
    const std::string from = medium.file.empty() ? "" : " from '" + medium.file + "'";
    const char* kind = medium.particles ? "particles" : kindName(medium.kind);
    std::string line = fmt::format("medium '{}': {}{}\n", medium.name, kind, from);
    if (!medium.particles) return line;
    const BrickGrid& grid = *medium.density;
    return line +
           fmt::format(
               "    {} particles in {}; voxels of {:.6g} m in {} bricks, density {:.6g} to {:.6g}{}\n",
               medium.particles->particles.size(), boundsText(medium.particles->bounds()),
               grid.worldFromIndex[0][0], grid.slotCount(), grid.minimum, grid.maximum,
               medium.temperature ? fmt::format(", up to {:.6g} K", medium.temperature->maximum)
                                  : "");
}

std::string sceneLines(const Scene& scene) {
    size_t triangles = 0, lines = 0, points = 0;
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.topology == MeshTopology::Triangles)
            triangles += mesh.indices.size() / 3;
        else
            (mesh.topology == MeshTopology::Lines ? lines : points) +=
                mesh.indices.size() / (mesh.topology == MeshTopology::Lines ? 2 : 1);
    }
    std::string text = fmt::format(
        "{} nodes, {} meshes with {} triangles, {} lines and {} points, {} materials, {} textures\n",
        scene.nodes.size(), scene.meshes.size(), triangles, lines, points, scene.materials.size(),
        scene.textures.size());
    text += fmt::format("extent: {}\n", boundsText(scene.worldBounds()));
    for (const Light& light : scene.lights)
        text += fmt::format("light '{}': {}\n", light.name, kindName(light.type));
    for (const Medium& medium : scene.media) text += mediumLine(medium);
    for (const Camera& camera : scene.cameras)
        text +=
            fmt::format("camera '{}': {}\n", camera.name,
                        camera.type == CameraType::Perspective ? "perspective" : "orthographic");
    if (scene.environment.image) text += fmt::format("environment: '{}'\n", scene.environment.file);
    for (const std::string& setting : scene.settings) text += fmt::format("setting {}\n", setting);
    return text;
}

Result<std::string> describeParticles(const fs::path& path) {
    Result<ParticleSet> set = readParticles(path);
    if (!set.ok()) return set.error();
    Medium medium;
    medium.name = path.stem().string();
    medium.file = path.filename().string();
    const auto notes = setParticles(medium, std::make_shared<const ParticleSet>(std::move(*set)));
    if (!notes.ok()) return Error{fmt::format("'{}': {}", path.string(), notes.message())};
    std::string text = mediumLine(medium);
    for (const std::string& note : *notes) text += "note: " + note + "\n";
    return text;
}

Result<std::string> describeScene(const fs::path& path, const std::string& extension,
                                  const JobControl& job) {
    const LoadOptions options{[&](float, const std::string&) { return !job.cancelled(); }};
    const Result<LoadedScene> loaded = loadScene(path, options);
    if (!loaded.ok()) return loaded.error();
    std::string text =
        fmt::format("{}: {}\n", path.string(), extension == ".json" ? "a scene file" : "glTF 2.0");
    text += sceneLines(loaded->scene);
    if (extension == ".gltf" || extension == ".glb") text += extensionLines(*loaded);
    for (const std::string& supplied : loaded->supplied) text += "supplied: " + supplied + "\n";
    for (const std::string& note : loaded->notes) text += "note: " + note + "\n";
    return text;
}

} // namespace

Result<std::string> describeFile(const fs::path& path, const JobControl& job) {
    const std::string extension = lowerExtension(path);
    if (extension == ".vdb" || extension == ".nvdb") return describeGrids(path);
    if (extension == ".csv") return describeParticles(path);
    if (extension == ".exr") return describeExr(path);
    if (extension == ".hdr") return describeHdr(path);
    if (extension == ".json" || extension == ".gltf" || extension == ".glb")
        return describeScene(path, extension, job);
    return Error{fmt::format(
        "'{}' is of no kind that is understood: scene files (.json), .gltf, .glb, .vdb, .nvdb, particles (.csv), .exr and .hdr are",
        path.string())};
}

} // namespace tyndall
