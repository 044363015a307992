#pragma once
// Draws the shadow maps of a plan into the atlas. Only maps whose picture changed are drawn: each remembers what it
// was drawn from.

#include <cstdint>
#include <vector>

#include "core/version.h"
#include "plugin/frame_resources.h"
#include "renderer/shadow_views.h"

namespace tyndall {

class GpuScene;

struct ShadowResources {
    fg::BufferHandle views;  // ShadowView[]
    fg::TextureHandle atlas; // Depth32F array; absent where nothing casts a shadow
};

class ShadowPass {
public:
    /// `plan` and `scene` are read when the graph runs. One object draws for one executor. `wanted`: false where the
    /// frame renders no term that a shadow could fall on; the maps outlive the frame, so that the graph keeps
    /// their pass even where nobody reads it.
    ShadowResources addPasses(fg::FrameGraph& graph, const GpuScene& scene, const ShadowPlan& plan,
                              const ViewResources& view, bool wanted);
    [[nodiscard]] uint64_t mapsDrawn() const { return mapsDrawn_; }

private:
    /// A square of the atlas and what it shows.
    struct Held {
        int layer;
        vec4 square;
        uint64_t key;
    };
    struct Data;
    static fg::TextureHandle addNoMaps(fg::FrameGraph& graph, const char* reason);
    fg::TextureHandle addMaps(fg::FrameGraph& graph, const GpuScene& scene, const ShadowPlan& plan,
                              const ViewResources& view);
    void draw(const Data& data, fg::PassContext& context);
    void drawMap(const Data& data, size_t index, fg::PassContext& context) const;

    uint64_t castersKey(const GpuScene& scene);

    std::vector<Held> held_;
    Version casterVersion_ = 0; // that castersKey_ was made for
    uint64_t castersKey_ = 0;
    uint64_t mapsDrawn_ = 0;
};

} // namespace tyndall
