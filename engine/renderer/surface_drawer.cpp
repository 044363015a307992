#include "renderer/surface_drawer.h"

#include "renderer/gbuffer_pass.h"
#include "renderer/view.h"

namespace tyndall {

void GpuSurfaceDrawer::update() {
    sets_.clear();
    for (const DrawItem& item : scene_.items())
        if (item.topology == fg::Topology::Triangles && item.alphaMode != AlphaMode::Blend)
            sets_.push_back(&item);
}

plugin::SurfaceTriangles GpuSurfaceDrawer::triangles(uint32_t set) const {
    const DrawItem& item = *sets_.at(set);
    const MeshUpload::Buffers buffers = scene_.buffers(item);
    return {buffers.vertices,     buffers.indices,     scene_.textures(item.material).baseColor,
            buffers.strideFloats, item.indexCount / 3, item.object};
}

GBuffer GpuSurfaceDrawer::addGBuffer(fg::FrameGraph& graph, const char* name,
                                     const plugin::SurfaceView& from, ViewResources& view) {
    Camera camera;
    camera.type = from.yfov > 0 ? CameraType::Perspective : CameraType::Orthographic;
    camera.yfov = double(from.yfov);
    camera.ymag = double(from.halfHeight);
    camera.znear = double(from.nearest);
    // A parallel view's depth reaches four scene radii (makeView).
    view = makeView({&camera, dmat4(from.renderFromView), dvec3(0), double(from.depthRange) / 4,
                     from.side, from.side, 0, 0, false});
    return addGBufferPass(graph, scene_, view, settings_, name, true);
}

} // namespace tyndall
