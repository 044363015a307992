#pragma once
// The viewport's picture: rendered when something that it shows has changed, or until it has converged; the last good one
// stays when a frame fails.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "gl/texture.h"
#include "renderer/renderer.h"

namespace tyndall::editor {

class LivePicture {
public:
    /// Renders a frame if one is due, or the tone-mapping pass alone where only exposure or tone curve changed. `frameIndex` of
    /// the request is chosen here: 0 for still pictures, counting when they are averaged, as `tyndall capture` does. True when
    /// there is a new picture.
    bool update(Renderer& renderer, const Scene& scene, FrameRequest request);
    /// Would update() render a frame? A new exposure is not one.
    [[nodiscard]] bool isDue(Renderer& renderer, const Scene& scene,
                             const FrameRequest& request) const {
        return !atRest_ || keyOf(renderer, scene, request) != key_;
    }
    /// Renders again though nothing changed, such as after shaders were reloaded.
    void invalidate() { key_.clear(); }

    /// Is there nothing to draw until something changes?
    [[nodiscard]] bool atRest() const { return atRest_; }
    [[nodiscard]] bool converged() const { return result_ && result_->converged; }
    /// Why the last frame failed; empty where it did not.
    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// Of the last good frame.
    [[nodiscard]] const std::optional<FrameResult>& result() const { return result_; }
    [[nodiscard]] uint32_t textureName() const { return texture_.id(); }
    [[nodiscard]] int width() const { return texture_ ? texture_.spec().width : 0; }
    [[nodiscard]] int height() const { return texture_ ? texture_.spec().height : 0; }
    /// Frames rendered since the start, good and bad.
    [[nodiscard]] uint64_t frames() const { return frames_; }

    /// RGB bytes as they are displayed, top row first.
    [[nodiscard]] std::vector<uint8_t> read() const;

private:
    [[nodiscard]] static std::string keyOf(Renderer& renderer, const Scene& scene,
                                           const FrameRequest& request);
    [[nodiscard]] static std::string toneKeyOf(Renderer& renderer, const Scene& scene);
    bool renderFrame(Renderer& renderer, FrameRequest request);
    bool showTone(Renderer& renderer, const FrameRequest& request);
    gl::Texture texture_;
    std::string key_, toneKey_; // of what the picture shows: its light, and how that is displayed
    std::string failure_;
    std::optional<FrameResult> result_;
    uint64_t frames_ = 0;
    uint32_t averaged_ = 0;
    bool atRest_ = false;
};

} // namespace tyndall::editor
