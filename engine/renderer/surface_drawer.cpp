#include "renderer/surface_drawer.h"

#include <algorithm>

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
    const MaterialTextures& textures = scene_.textures(item.material);
    plugin::SurfaceTriangles triangles{};
    triangles.vertices = buffers.vertices;
    triangles.indices = buffers.indices;
    triangles.baseColor = textures.baseColor;
    triangles.metallicRoughness = textures.metallicRoughness;
    triangles.strideFloats = buffers.layout.strideFloats;
    triangles.triangleCount = item.indexCount / 3;
    std::ranges::copy(buffers.layout.uvFloats, triangles.uvFloats);
    triangles.colorFloats = buffers.layout.colorFloats;
    triangles.object = item.object;
    triangles.mesh = uint32_t(item.mesh);
    triangles.renderFromLocal = scene_.objectData()[item.object].renderFromLocal;
    return triangles;
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
