#include "live_picture.h"

#include <cmath>

#include <fmt/format.h>

#include "core/log.h"
#include "gl/read_back.h"
#include "gl/screen.h"

namespace tyndall::editor {
namespace {

/// Is it a setting ("KEY=VALUE") of the last pass, which turns light into what is displayed?
bool isTone(const std::string& setting) { return setting.starts_with("post."); }

} // namespace

std::string LivePicture::keyOf(Renderer& renderer, const Scene& scene,
                               const FrameRequest& request) {
    const SceneVersions& v = scene.versions;
    std::string key = fmt::format("{} {} {} {} {} {} {} {} {} | {}x{} {} {} {} {} {} {} | ",
                                  v.structure, v.transforms, v.meshes, v.materials, v.textures,
                                  v.lights, v.media, v.cameras, v.environment, request.width,
                                  request.height, request.cameraNode, scene.activeCamera,
                                  request.terms, request.time, request.seed, request.converge);
    if (request.pose) {
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                key += fmt::format("{} ", request.pose->worldFromCamera[c][r]);
        key += fmt::format("{} {} ", request.pose->camera.yfov, request.pose->camera.ymag);
    }
    key += request.inspect;
    for (const std::string& setting : renderer.settings().differences())
        if (!isTone(setting)) key += " " + setting;
    return key;
}

std::string LivePicture::toneKeyOf(Renderer& renderer, const Scene& scene) {
    std::string key = fmt::format("{}", scene.ev100);
    for (const std::string& setting : renderer.settings().differences())
        if (isTone(setting)) key += " " + setting;
    return key;
}

bool LivePicture::update(Renderer& renderer, const Scene& scene, FrameRequest request) {
    std::string key = keyOf(renderer, scene, request), toneKey = toneKeyOf(renderer, scene);
    const bool changed = key != key_, toneChanged = toneKey != toneKey_;
    if (!changed && !toneChanged && atRest_) return false;
    toneKey_ = std::move(toneKey);
    // At once, also while frames are averaged: the average goes on afterwards.
    if (!changed && toneChanged && showTone(renderer, request)) return true;
    if (changed) averaged_ = 0;
    key_ = std::move(key);
    return renderFrame(renderer, std::move(request));
}

/// The last frame with another exposure or tone curve. False where that takes a whole frame.
bool LivePicture::showTone(Renderer& renderer, const FrameRequest& request) {
    const Result<bool> done = renderer.toneMapAgain();
    if (!done.ok() || !*done) return false;
    gl::copyPicture(renderer.displayTexture(), request.width, request.height, texture_);
    return true;
}

bool LivePicture::renderFrame(Renderer& renderer, FrameRequest request) {
    request.frameIndex = request.converge ? averaged_ : 0;
    request.restart = request.converge && averaged_ == 0;
    ++frames_;
    Result<FrameResult> result = renderer.renderFrame(request);
    if (!result.ok()) {
        if (failure_ != result.message()) log::error(result.message());
        failure_ = result.message();
        atRest_ = true; // the same request would fail the same way
        return false;
    }
    failure_.clear();
    result_ = std::move(*result);
    ++averaged_;
    atRest_ = !request.converge || result_->converged;
    gl::copyPicture(renderer.displayTexture(), request.width, request.height, texture_);
    return true;
}

std::vector<uint8_t> LivePicture::read() const {
    if (!texture_) return {};
    const Image image = gl::readImage(texture_);
    std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * 3);
    for (size_t i = 0; i < bytes.size(); ++i)
        bytes[i] =
            uint8_t(std::lround(image.pixels[i / 3 * size_t(image.channels) + i % 3] * 255.0f));
    return bytes;
}

} // namespace tyndall::editor
