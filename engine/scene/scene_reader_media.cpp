// Media of a scene file.
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "media/grid_import.h"
#include "media/particle_grids.h"
#include "scene/json_convert.h"
#include "scene/scene_reader.h"

namespace tyndall {
namespace {

constexpr std::string_view kShapes[] = {"everywhere", "box", "sphere", "height"};
constexpr std::string_view kPhases[] = {"henyey-greenstein", "rayleigh", "cornette-shanks"};
constexpr std::string_view kTemperatureColumn = "temperature"; // of particles

Result<ParticleSet> generated(const ParticleGenerator& rule) {
    return generateParticles(rule.kind, rule.count, uint64_t(rule.seed), rule.radius);
}

} // namespace

bool isFramePattern(const std::string& file) { return file.find('%') != std::string::npos; }

Result<std::string> frameFile(const std::string& pattern, int frame) {
    const size_t percent = pattern.find('%');
    size_t end = percent + 1, width = 0;
    const Error wrong{
        fmt::format("'{}' is not a file pattern: exactly one %d, %4d or %04d is wanted", pattern)};
    if (percent == std::string::npos || pattern.find('%', end) != std::string::npos) return wrong;
    const bool zeros = end < pattern.size() && pattern[end] == '0';
    for (; end < pattern.size() && pattern[end] >= '0' && pattern[end] <= '9'; ++end) {
        width = width * 10 + size_t(pattern[end] - '0');
        if (width > 32) return wrong;
    }
    if (end >= pattern.size() || pattern[end] != 'd') return wrong;
    std::string number = std::to_string(frame);
    if (number.size() < width) number.insert(0, width - number.size(), zeros ? '0' : ' ');
    return pattern.substr(0, percent) + number + pattern.substr(end + 1);
}

Result<void> SceneReader::readMedium(const Json& json, const std::string& pointer, Node& node) {
    Medium medium;
    medium.name = node.name;
    medium.scattering = colorOr(json, "scattering", medium.scattering);
    medium.absorption = colorOr(json, "absorption", medium.absorption);
    medium.anisotropy = floatOr(json, "anisotropy", medium.anisotropy);
    medium.phase =
        PhaseFunction(indexOf(kPhases, json.value("phase", std::string("henyey-greenstein"))));
    const auto emission = json.find("emission");
    if (emission != json.end() && emission->is_array()) medium.emission = vec3(toVector(*emission));
    const std::string type = json.at("type").get<std::string>();
    if (emission != json.end() && emission->is_object()) {
        if (type == "homogeneous")
            return at(pointer + "/emission",
                      "names a temperatureGrid, but a homogeneous medium has no grids");
        medium.temperatureGridName = emission->at("temperatureGrid").get<std::string>();
        medium.temperatureScale = floatOr(*emission, "scale", 1.0f);
    }
    Result<void> read;
    if (type == "grid")
        read = readGrid(json, pointer, node, medium);
    else if (type == "particles")
        read = readParticles(json, pointer, node, medium);
    else {
        const auto shape = json.find("shape");
        if (shape == json.end())
            return at(
                pointer,
                "lacks the key 'shape', which a homogeneous medium needs: everywhere, box, sphere or height");
        medium.kind = MediumKind(indexOf(kShapes, shape->get<std::string>()));
        const bool bounded = medium.kind == MediumKind::Box || medium.kind == MediumKind::Sphere;
        if (json.contains("size") && !bounded)
            return at(pointer + "/size",
                      fmt::format("does not apply to the shape {}", shape->get<std::string>()));
        if (json.contains("scaleHeight") && medium.kind != MediumKind::Height)
            return at(pointer + "/scaleHeight",
                      fmt::format("does not apply to the shape {}", shape->get<std::string>()));
        read = onlyKeys(json, pointer, "a homogeneous medium",
                        {"type", "shape", "size", "scaleHeight", "scattering", "absorption",
                         "anisotropy", "phase", "emission"});
        if (const auto size = json.find("size"); size != json.end()) medium.size = toVector(*size);
        medium.scaleHeight = json.value("scaleHeight", medium.scaleHeight);
    }
    if (!read) return read;
    node.medium = int(scene_.media.size());
    scene_.media.push_back(std::move(medium));
    return {};
}

Result<void> SceneReader::readGrid(const Json& json, const std::string& pointer, Node& node,
                                   Medium& medium) {
    medium.kind = MediumKind::Grid;
    if (auto keys = onlyKeys(json, pointer, "a medium of type grid",
                             {"type", "file", "grid", "frames", "fps", "loop", "scattering",
                              "absorption", "anisotropy", "phase", "emission"});
        !keys)
        return keys;
    if (!json.contains("file"))
        return at(pointer,
                  "lacks the key 'file', which a medium of type grid needs: a .vdb or .nvdb file");
    medium.file = json.at("file").get<std::string>();
    medium.gridName = json.value("grid", std::string());
    std::string file = medium.file;
    if (isFramePattern(file) || json.contains("frames")) {
        const auto frames = json.find("frames");
        if (frames == json.end())
            return at(
                pointer,
                "lacks the key 'frames', which a file name with a % pattern needs: [first, last]");
        GridSequence sequence;
        sequence.first = (*frames)[0].get<int>();
        sequence.last = (*frames)[1].get<int>();
        sequence.fps = json.value("fps", sequence.fps);
        sequence.loop = json.value("loop", sequence.loop);
        if (sequence.last < sequence.first) return at(pointer + "/frames", "ends before it begins");
        const auto first = frameFile(file, sequence.first);
        if (!first) return at(pointer + "/file:", first.message());
        file = *first;
        node.sequence = sequence;
    } else if (json.contains("fps") || json.contains("loop")) {
        return at(pointer, "has 'fps' or 'loop' but no 'frames'");
    }
    const std::string key = file + '\n' + medium.gridName + '\n' + medium.temperatureGridName;
    auto found = grids_.find(key);
    if (found == grids_.end()) {
        if (auto goOn = progress(fraction_, file); !goOn) return goOn;
        GridRequest request;
        request.density = medium.gridName;
        request.temperature = medium.temperatureGridName;
        auto grids = importGrid(resolved(file), request);
        if (!grids) return at(pointer + ":", grids.message());
        for (const std::string& note : grids->notes) loaded_.notes.push_back(note);
        Medium shared;
        shared.density = grids->density;
        shared.temperature = grids->temperature;
        found = grids_.emplace(key, std::move(shared)).first;
    }
    medium.density = found->second.density;
    medium.temperature = found->second.temperature;
    return {};
}

Result<void> SceneReader::readParticles(const Json& json, const std::string& pointer, Node& node,
                                        Medium& medium) {
    if (auto keys = onlyKeys(json, pointer, "a medium of type particles",
                             {"type", "file", "generate", "scattering", "absorption", "anisotropy",
                              "phase", "emission"});
        !keys)
        return keys;
    if (json.contains("file") == json.contains("generate"))
        return at(pointer,
                  "needs either a 'file' or a rule to 'generate' its particles, one of the two");
    medium.file = json.value("file", std::string());
    std::string key = "particles\n" + medium.file;
    if (const auto generate = json.find("generate"); generate != json.end()) {
        ParticleGenerator rule;
        rule.kind = generate->at("kind").get<std::string>();
        rule.count = generate->value("count", rule.count);
        rule.seed = generate->value("seed", rule.seed);
        rule.radius = generate->value("radius", rule.radius);
        node.particles = rule;
        key += '\n' + generate->dump();
    }
    auto found = grids_.find(key);
    if (found == grids_.end()) {
        if (auto goOn = progress(fraction_, medium.file.empty() ? "particles" : medium.file); !goOn)
            return goOn;
        Result<ParticleSet> set = medium.file.empty()
                                      ? generated(*node.particles)
                                      : tyndall::readParticles(resolved(medium.file));
        if (!set) return at(pointer + ":", set.message());
        Medium shared;
        const auto notes =
            setParticles(shared, std::make_shared<const ParticleSet>(std::move(*set)));
        if (!notes) return at(pointer + ":", notes.message());
        for (const std::string& note : *notes)
            loaded_.notes.push_back(at(pointer + ":", note).message);
        found = grids_.emplace(key, std::move(shared)).first;
    }
    medium.kind = found->second.kind;
    medium.density = found->second.density;
    medium.temperature = found->second.temperature;
    medium.particles = found->second.particles;
    const std::string& wanted = medium.temperatureGridName;
    if (!wanted.empty() && (wanted != kTemperatureColumn || !medium.temperature))
        return at(pointer + "/emission/temperatureGrid",
                  fmt::format("is '{}', but {}", wanted,
                              medium.temperature
                                  ? "the temperature of particles is their column 'temperature'"
                                  : "its particles have no column 'temperature'"));
    return {};
}

} // namespace tyndall
