#include "app/options.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace tyndall {
namespace fs = std::filesystem;
namespace {

constexpr int kLargestSide = 16384; // the least that OpenGL 4.5 guarantees for a texture

bool parseSide(std::string_view text, int& side) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    return error == std::errc() && end == text.data() + text.size() && side >= 1 &&
           side <= kLargestSide;
}

/// A file, or the name of a plugin in one of the folders.
Result<fs::path> findPlugin(const std::string& nameOrFile) {
    if (nameOrFile.find('/') != std::string::npos || nameOrFile.ends_with(".so"))
        return fs::path(nameOrFile);
    std::string places;
    for (const fs::path& folder : pluginFolders()) {
        const fs::path file = folder / (nameOrFile + ".so");
        if (fs::exists(file)) return file;
        places += (places.empty() ? "'" : ", '") + folder.string() + "'";
    }
    return Error{
        fmt::format("--plugin {}: there is no {}.so in {}", nameOrFile, nameOrFile, places)};
}

} // namespace

std::vector<fs::path> pluginFolders() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
    return {(program / "../lib/tyndall/plugins").lexically_normal(),
            (program / "../lib/plugins").lexically_normal()};
}

Result<void> parseSize(const char* option, const std::string& text, int& width, int& height) {
    const size_t middle = text.find('x');
    if (middle != std::string::npos && parseSide(std::string_view(text).substr(0, middle), width) &&
        parseSide(std::string_view(text).substr(middle + 1), height))
        return {};
    return Error{fmt::format("{} {}: it takes WIDTHxHEIGHT, each 1 to {}, such as 1280x720", option,
                             text, kLargestSide)};
}

Result<PoseOption> parsePose(const std::string& text) {
    std::vector<double> numbers;
    const Error wrong{fmt::format(
        "--pose {}: it takes x,y,z,qx,qy,qz,qw (metres and a quaternion), and perhaps ,yfov in radians",
        text)};
    for (const char *at = text.data(), *end = at + text.size();; ++at) {
        double number = 0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc() || !std::isfinite(number)) return wrong;
        numbers.push_back(number);
        at = next;
        if (at == end) break;
        if (*at != ',') return wrong;
    }
    if (numbers.size() != 7 && numbers.size() != 8) return wrong;
    PoseOption pose;
    pose.position = {numbers[0], numbers[1], numbers[2]};
    pose.rotation = dquat(numbers[6], numbers[3], numbers[4], numbers[5]);
    const double length = glm::length(pose.rotation);
    if (!(length > 1e-6))
        return Error{fmt::format(
            "--pose {}: its quaternion is zero; 0,0,0,1 does not turn the camera", text)};
    // One that is unit but for rounding stays as it is: the picture is then the same to the last bit.
    if (std::abs(length - 1) > 1e-12) pose.rotation /= length;
    if (numbers.size() == 8) {
        if (!(numbers[7] > 0 && numbers[7] < kPi))
            return Error{fmt::format(
                "--pose {}: the last number, yfov, must lie between 0 and pi radians", text)};
        pose.yfov = numbers[7];
    }
    return pose;
}

std::string poseText(const PoseOption& pose) {
    const dquat& q = pose.rotation;
    std::string text = fmt::format("{},{},{},{},{},{},{}", pose.position.x, pose.position.y,
                                   pose.position.z, q.x, q.y, q.z, q.w);
    return pose.yfov ? fmt::format("{},{}", text, *pose.yfov) : text;
}

Result<ViewPlan> understandView(const ViewOptions& options) {
    ViewPlan plan;
    if (Result<void> size = parseSize("--size", options.size, plan.width, plan.height); !size.ok())
        return size.error();
    if (!std::isfinite(options.time))
        return Error{fmt::format(
            "--time {}: it takes a finite number of seconds of the scene's clock", options.time)};
    if (options.terms.empty()) return plan;
    const Result<TermSet> terms = parseTerms(options.terms);
    if (!terms.ok()) return Error{"--terms " + options.terms + ": " + terms.message()};
    plan.terms = *terms;
    return plan;
}

Result<RenderPlan> understand(const RenderOptions& options) {
    RenderPlan plan;
    const Result<ViewPlan> view = understandView(options);
    if (!view.ok()) return view.error();
    static_cast<ViewPlan&>(plan) = *view;
    if (options.seed > UINT32_MAX) // more than shaders take; the reference does
        return Error{fmt::format("--seed {}: it takes 0 to {}", options.seed, UINT32_MAX)};
    const Result<gl::Backend> backend = gl::parseBackend(options.backend);
    if (!backend.ok()) return Error{"--backend " + options.backend + ": " + backend.message()};
    plan.backend = *backend;
    if (!options.quality.empty()) {
        const Result<Quality> quality = parseQuality(options.quality);
        if (!quality.ok()) return Error{"--quality: " + quality.message()};
        plan.quality = *quality;
    }
    if (!options.pose.empty()) {
        Result<PoseOption> pose = parsePose(options.pose);
        if (!pose.ok()) return pose.error();
        plan.pose = *pose;
    }
    if (options.device < -1)
        return Error{fmt::format(
            "--device {}: devices are numbered from 0; 'tyndall info' lists them", options.device)};
    for (const std::string& name : options.plugins) {
        Result<fs::path> file = findPlugin(name);
        if (!file.ok()) return file.error();
        plan.plugins.push_back(std::move(*file));
    }
    return plan;
}

} // namespace tyndall
