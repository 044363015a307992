#include "renderer/blend_list.h"

#include <algorithm>

#include "core/check.h"
#include "gl/buffer.h"
#include "renderer/view.h"

namespace tyndall {
namespace {

uint32_t verticesPerPrimitive(fg::Topology topology) {
    switch (topology) {
    case fg::Topology::Lines: return 2;
    case fg::Topology::Points: return 1;
    case fg::Topology::Triangles: break;
    }
    return 3;
}

gpu::BlendVertex packVertex(const Mesh& mesh, size_t i) {
    const auto uv = [&](int set) {
        return mesh.uvs[size_t(set)].empty() ? vec2(0) : mesh.uvs[size_t(set)][i];
    };
    gpu::BlendVertex vertex{};
    vertex.position = vec4(mesh.positions[i], 1);
    vertex.normal = mesh.normals.empty() ? vec4(0) : vec4(mesh.normals[i], 0);
    vertex.tangent = mesh.tangents.empty() ? vec4(0) : mesh.tangents[i];
    vertex.uvSets01 = vec4(uv(0), uv(1));
    vertex.uvSets23 = vec4(uv(2), uv(3));
    vertex.color = mesh.colors.empty() ? vec4(1) : mesh.colors[i];
    return vertex;
}

} // namespace

void sortBackToFront(std::vector<BlendPrimitive>& primitives) {
    std::sort(primitives.begin(), primitives.end(),
              [](const BlendPrimitive& a, const BlendPrimitive& b) {
                  if (a.depth != b.depth) return a.depth > b.depth;
                  return a.item != b.item ? a.item < b.item : a.first < b.first;
              });
}

BlendList::~BlendList() {
    if (vertices_.id) executor_.release(vertices_);
    if (order_.id) executor_.release(order_);
}

const GpuScene& BlendList::scene() const {
    CHECK(scene_ != nullptr, "BlendList::update was never called");
    return *scene_;
}

Result<void> BlendList::update(const GpuScene& scene, const ViewResources& view) {
    const bool sceneChanged = scene_ != &scene || seen_ != scene.version();
    const bool viewChanged =
        seenPosition_ != view.data.cameraPosition || seenForward_ != view.data.cameraForward ||
        seenView_ != view.data.viewFromRender || seenSize_ != ivec2(view.width, view.height);
    if (!sceneChanged && !viewChanged) return {};
    scene_ = &scene;
    any_ = !scene.items(AlphaMode::Blend).empty();
    runs_.clear();
    seen_ = 0; // until it has succeeded
    if (any_) {
        if (sceneChanged)
            if (Result<void> done = updateVertices(scene); !done) return done;
        if (Result<void> done = updateOrder(scene, view); !done) return done;
    }
    seen_ = scene.version();
    seenPosition_ = view.data.cameraPosition;
    seenForward_ = view.data.cameraForward;
    seenView_ = view.data.viewFromRender;
    seenSize_ = ivec2(view.width, view.height);
    return {};
}

Result<void> BlendList::updateVertices(const GpuScene& scene) {
    const std::vector<Mesh>& meshes = scene.scene().meshes;
    firstVertex_.assign(meshes.size(), ~0u);
    std::vector<gpu::BlendVertex> vertices;
    for (const DrawItem& item : scene.items(AlphaMode::Blend)) {
        uint32_t& first = firstVertex_[size_t(item.mesh)];
        if (first != ~0u) continue;
        first = uint32_t(vertices.size());
        const Mesh& mesh = meshes[size_t(item.mesh)];
        for (size_t i = 0; i < mesh.positions.size(); ++i) vertices.push_back(packVertex(mesh, i));
    }
    if (vertices_.id) executor_.release(vertices_);
    vertices_ = {};
    Result<gl::Buffer> buffer =
        gl::Buffer::create("BlendVertices", vertices.size() * sizeof(gpu::BlendVertex),
                           gl::BufferAccess::GpuOnly, vertices.data());
    if (!buffer) return buffer.error();
    vertices_ = executor_.registerBuffer("BlendVertices", std::move(*buffer));
    return {};
}

void BlendList::collect(const GpuScene& scene, const ViewResources& view) {
    primitives_.clear();
    const std::span<const DrawItem> items = scene.items(AlphaMode::Blend);
    // A pixel more on each side than the view has: the list serves all frames of an average, each with its own jitter.
    ViewResources wider = view;
    wider.data.clipFromRender = glm::transpose(wider.data.clipFromRender);
    for (int axis = 0; axis < 2; ++axis)
        wider.data.clipFromRender[axis] /= 1.0f + 4.0f / view.data.size[axis];
    wider.data.clipFromRender = glm::transpose(wider.data.clipFromRender);
    const std::array<vec4, 5> planes = frustumPlanes(wider.data);
    const dvec3 forward(vec3(view.data.cameraForward)), eye(vec3(view.data.cameraPosition));
    for (uint32_t i = 0; i < items.size(); ++i) {
        if (!mayBeInside(items[i].bounds, planes)) continue;
        const Mesh& mesh = scene.scene().meshes[size_t(items[i].mesh)];
        const dmat4 renderFromLocal(scene.objectData()[items[i].object].renderFromLocal);
        // Depth along the axis is an affine function of the local position.
        const dvec3 gradient(glm::dot(forward, dvec3(renderFromLocal[0])),
                             glm::dot(forward, dvec3(renderFromLocal[1])),
                             glm::dot(forward, dvec3(renderFromLocal[2])));
        const double offset = glm::dot(forward, dvec3(renderFromLocal[3]) - eye);
        const uint32_t count = verticesPerPrimitive(items[i].topology);
        for (uint32_t first = 0; first + count <= mesh.indices.size(); first += count) {
            dvec3 sum(0);
            for (uint32_t k = 0; k < count; ++k)
                sum += dvec3(mesh.positions[mesh.indices[first + k]]);
            primitives_.push_back({float(glm::dot(gradient, sum) / count + offset), i, first});
        }
    }
}

void BlendList::makeEntries(const GpuScene& scene) {
    entries_.clear();
    const std::span<const DrawItem> items = scene.items(AlphaMode::Blend);
    for (const BlendPrimitive& primitive : primitives_) {
        const DrawItem& item = items[primitive.item];
        if (runs_.empty() || runs_.back().material != item.material ||
            runs_.back().topology != item.topology)
            runs_.push_back({item.material, item.topology, uint32_t(entries_.size()), 0});
        const Mesh& mesh = scene.scene().meshes[size_t(item.mesh)];
        const uint32_t count = verticesPerPrimitive(item.topology);
        for (uint32_t k = 0; k < count; ++k)
            entries_.emplace_back(
                firstVertex_[size_t(item.mesh)] + mesh.indices[primitive.first + k], item.object);
        runs_.back().entryCount += count;
    }
}

Result<void> BlendList::updateOrder(const GpuScene& scene, const ViewResources& view) {
    collect(scene, view);
    sortBackToFront(primitives_);
    makeEntries(scene);
    const uint64_t bytes = entries_.size() * sizeof(uvec2);
    if (bytes == 0) return {};
    if (bytes > orderBytes_) {
        if (order_.id) executor_.release(order_);
        order_ = {};
        orderBytes_ = 0;
        Result<gl::Buffer> buffer =
            gl::Buffer::create("BlendOrder", bytes, gl::BufferAccess::CpuUpdates);
        if (!buffer) return buffer.error();
        order_ = executor_.registerBuffer("BlendOrder", std::move(*buffer));
        orderBytes_ = bytes;
    }
    executor_.buffer(order_).write(0, entries_.data(), bytes);
    return {};
}

} // namespace tyndall
