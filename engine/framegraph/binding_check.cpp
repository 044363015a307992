#include "framegraph/binding_check.h"

#include <fmt/format.h>

#include "core/check.h"

namespace tyndall::fg {
namespace {

bool allows(Access declared, Touch touch) {
    switch (touch) {
    case Touch::Sample: return declared == Access::Sampled;
    case Touch::ReadStorage:
        return declared == Access::StorageRead || declared == Access::StorageWrite;
    case Touch::WriteStorage: return declared == Access::StorageWrite;
    case Touch::UniformBlock: return declared == Access::Uniform;
    // A pass may write its own arguments.
    case Touch::Indirect:
        return declared == Access::Indirect || declared == Access::StorageWrite ||
               declared == Access::Capture;
    case Touch::ColorAttachment: return declared == Access::ColorTarget;
    case Touch::DepthAttachment: return declared == Access::DepthTarget;
    case Touch::DepthTest: return declared == Access::DepthTarget || declared == Access::DepthRead;
    case Touch::TransferRead: return declared == Access::TransferRead;
    case Touch::TransferWrite: return isWrite(declared);
    case Touch::Capture: return declared == Access::Capture;
    }
    return false;
}

const char* wanted(Touch touch) {
    switch (touch) {
    case Touch::Sample: return "a read as sampled";
    case Touch::ReadStorage: return "a read as storage read";
    case Touch::WriteStorage: return "a write as storage write";
    case Touch::UniformBlock: return "a read as uniform";
    case Touch::Indirect: return "a read as indirect";
    case Touch::ColorAttachment: return "a write as color target";
    case Touch::DepthAttachment: return "a write as depth target";
    case Touch::DepthTest: return "a read as depth read";
    case Touch::TransferRead: return "a read as transfer read";
    case Touch::TransferWrite: return "a write";
    case Touch::Capture: return "a write as capture";
    }
    return "";
}

} // namespace

std::string checkTouch(const FrameGraphImpl& graph, uint32_t passIndex, uint32_t resource,
                       uint32_t version, Touch touch, std::string_view place) {
    const PassRecord& pass = graph.passes()[passIndex];
    if (resource == 0)
        return fmt::format("pass '{}' binds a null handle to '{}': nothing has produced it",
                           pass.name, place);
    const uint32_t bound = graph.versionOf(resource, version);
    if (bound == kNoIndex)
        return fmt::format(
            "pass '{}' binds a handle to '{}' that this frame does not have: handles end with their frame",
            pass.name, place);
    const std::string_view name = graph.resources()[resource].name;
    bool declared = false, declaredVersion = false;
    for (uint32_t i = pass.uses.first; i < pass.uses.first + pass.uses.count; ++i) {
        const UseRecord& use = graph.uses()[i];
        const VersionRecord& used = graph.versions()[use.version];
        if (used.resource != resource) continue;
        declared = true;
        // A write may be bound by the handle that went into it or by the one that came out: it is the same storage.
        const bool sameVersion =
            use.version == bound || (isWrite(use.access) && used.previous == bound);
        declaredVersion |= sameVersion;
        if (sameVersion && allows(use.access, touch)) return {};
    }
    if (!declared)
        return fmt::format(
            "pass '{}' binds '{}' to '{}' without having declared it: its setup needs {}",
            pass.name, name, place, wanted(touch));
    if (!declaredVersion)
        return fmt::format(
            "pass '{}' binds version {} of '{}' to '{}' but declared another version: keep the handle that the setup "
            "returned",
            pass.name, version, name, place);
    return fmt::format("pass '{}' binds '{}' to '{}', which needs {}, but declared it otherwise",
                       pass.name, name, place, wanted(touch));
}

} // namespace tyndall::fg
