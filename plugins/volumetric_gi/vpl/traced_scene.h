#pragma once
// The scene as random walks see it, made anew where it has changed.

#include <string>

#include "plugin/plugin_api.h"
#include "tracing/light_walk.h"
#include "tracing/triangle_tree.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

/// As shaders read it.
gpu::VplTriangle packTriangle(const tracing::SceneTriangle& triangle);

class TracedScene {
public:
    /// `guessed`: walks are to go through media that small changes of the media do not change.
    /// Errors: the surfaces do not fit into memory.
    Result<void> update(const plugin::FrameInputs& inputs, bool guessed);

    /// What walks go through.
    [[nodiscard]] const tracing::TracerScene& scene() const { return scene_; }
    [[nodiscard]] const tracing::LightEmission& emission() const { return *emission_; }
    /// Around what is in the scene, without the landscape that it stands in; render space.
    [[nodiscard]] const Bounds& content() const { return content_; }
    /// Are the media there guessed?
    [[nodiscard]] bool guessed() const { return media_ != nullptr; }
    /// The media as they are.
    [[nodiscard]] const tracing::MediaField& media() const {
        return guessed() ? *media_ : *scene_.media;
    }
    /// All triangles, and a tree over them, as shaders read them.
    [[nodiscard]] const std::vector<gpu::VplTriangle>& triangles() const { return triangles_; }
    [[nodiscard]] const std::vector<tracing::TreeNode>& tree() const { return tree_; }
    /// Are there triangles that rays pass parts of?
    [[nodiscard]] bool hasHoles() const { return hasHoles_; }
    /// Of everything that walks' courses follow from, of what they carry, and of the surfaces alone.
    [[nodiscard]] uint64_t walksKey() const { return walksKey_; }
    [[nodiscard]] uint64_t key() const { return key_; }
    [[nodiscard]] uint64_t surfacesKey() const { return surfacesKey_; }

private:
    Result<void> updateSurfaces(const Scene& scene, const dvec3& origin);
    bool moveSurfaces(const Scene& scene, const dvec3& origin);
    void updateMedia(const Scene& scene, const dvec3& origin, bool guessed);

    tracing::TracerScene scene_;
    std::unique_ptr<tracing::MediaField> media_; // where those in scene_ are guessed
    std::unique_ptr<tracing::LightEmission> emission_;
    Bounds content_;
    std::vector<gpu::VplTriangle> triangles_;
    std::vector<tracing::TreeNode> tree_;
    bool hasHoles_ = false;
    const Scene* whole_ = nullptr;
    uint64_t changesKey_ = 0, key_ = 0, walksKey_ = 0, guessHash_ = 0, surfacesKey_ = 0,
             shapesKey_ = 0;
};

} // namespace tyndall::volumetric_gi
