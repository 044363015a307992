#include "app/capture_options.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "app/output_file.h"

namespace tyndall {
namespace {

constexpr std::array<std::string_view, 5> kAovs = {"depth", "normal", "albedo", "transmittance",
                                                   "terms"};
constexpr int kConvergeLimit = 4096; // frames, where --frames does not say otherwise

/// `%d` or `%04d`: where it stands in the text, and its width.
struct FrameNumber {
    size_t at = std::string::npos, length = 0, width = 0;
};

FrameNumber findFrameNumber(const std::string& text) {
    for (size_t at = text.find('%'); at != std::string::npos; at = text.find('%', at + 1)) {
        size_t end = at + 1, width = 0;
        while (end < text.size() && text[end] >= '0' && text[end] <= '9' && width < 100)
            width = width * 10 + size_t(text[end++] - '0');
        if (end < text.size() && text[end] == 'd' && width <= 12) return {at, end + 1 - at, width};
    }
    return {};
}

} // namespace

bool CaptureOptions::wantsExr() const { return output.ends_with(".exr"); }
bool CaptureOptions::writesSequence() const { return findFrameNumber(output).length > 0; }
bool CaptureOptions::hasAov(std::string_view name) const {
    return std::find(aovs.begin(), aovs.end(), name) != aovs.end();
}
int CaptureOptions::frameLimit() const {
    return frames > 0 ? frames : converge ? kConvergeLimit : 1;
}

std::string CaptureOptions::outputOfFrame(int frame) const {
    const FrameNumber number = findFrameNumber(output);
    if (number.length == 0) return output;
    return fmt::format("{}{:0{}}{}", output.substr(0, number.at), frame, number.width,
                       output.substr(number.at + number.length));
}

Result<void> checkCaptureOptions(const CaptureOptions& options) {
    if (!options.wantsExr() && !options.output.ends_with(".png"))
        return Error{fmt::format("-o {}: the name must end in .exr or .png", options.output)};
    for (const std::string& aov : options.aovs) {
        if (std::find(kAovs.begin(), kAovs.end(), aov) == kAovs.end())
            return Error{fmt::format(
                "--aov {}: it takes depth, normal, albedo, transmittance and terms", aov)};
    }
    if (!options.aovs.empty() && !options.wantsExr())
        return Error{fmt::format("--aov: a PNG has no layers; let -o end in .exr instead of '{}'",
                                 options.output)};
    if (options.half && !options.wantsExr())
        return Error{"--half: a PNG has 8 bits a channel; let -o end in .exr"};
    if (options.converge && options.writesSequence())
        return Error{fmt::format(
            "--converge: it averages frames of a still scene into one picture; '{}' asks for one file a frame",
            options.output)};
    for (const auto& [option, file] :
         {std::pair("-o", &options.output), std::pair("--report", &options.report),
          std::pair("--trace", &options.trace)})
        if (Result<void> folder = checkOutputFolder(option, *file); !folder.ok()) return folder;
    return {};
}

} // namespace tyndall
