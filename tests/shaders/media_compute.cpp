#include "shaders/media_compute.h"

#include <cstring>

#include "gl/api.h"
#include "media/blackbody.h"
#include "shaders/table_compute.h"
#include "shared/view.h"

namespace tyndall::test {
namespace {

void bindTexture(const gl::Program& program, const char* name, const gl::Texture& texture) {
    const gl::ProgramResource* sampler = program.find(name);
    if (!sampler || !texture) return;
    glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(texture.id(), wrap, GL_CLAMP_TO_EDGE);
    glBindTextureUnit(GLuint(sampler->binding), texture.id());
}

template <typename T> gl::Buffer bufferOf(const char* name, const std::vector<T>& values) {
    if (values.empty()) {
        gl::Buffer zeros(name, 1024);
        zeros.clear();
        return zeros;
    }
    return gl::Buffer(name, std::as_bytes(std::span(values)));
}

} // namespace

Scene sceneOf(std::span<const Medium> media, std::span<const dmat4> worldFromNode) {
    Scene scene;
    for (size_t i = 0; i < media.size(); ++i) {
        scene.media.push_back(media[i]);
        Node node;
        node.matrix = worldFromNode[i];
        node.medium = int(i);
        scene.nodes.push_back(node);
    }
    return scene;
}

MediaCompute::MediaCompute(const Scene& scene, const MediaOptions& options) {
    std::vector<std::string> notes;
    placed_ = placeMedia(scene, options.renderOrigin, notes);
    gpu::MediaHeader header{};
    header.phaseGroupCount = assignPhaseGroups(placed_, header, notes);
    header.mediumCount = uint32_t(placed_.size());
    for (const PlacedMedium& medium : placed_)
        header.gridCount += medium.data.kind == gpu::kMediumGrid ? 1u : 0u;
    header.flags = options.flags;
    header.stepVoxels = options.stepVoxels;
    header.analyticSteps = options.steps;
    header.minTransmittance = options.minTransmittance;
    header.environmentFirst = options.environmentFirst;
    header.environmentLights = options.environmentLights;
    header.environmentStride = options.environmentStride;
    uploadGrids();
    std::vector<std::byte> table(sizeof header + placed_.size() * sizeof(gpu::MediumData) + 16);
    std::memcpy(table.data(), &header, sizeof header);
    for (size_t i = 0; i < placed_.size(); ++i)
        std::memcpy(table.data() + sizeof header + i * sizeof(gpu::MediumData), &placed_[i].data,
                    sizeof(gpu::MediumData));
    media_ = bufferOf("media", table);
    const BlackbodyTable blackbody = makeBlackbodyTable();
    std::vector<vec4> block{
        vec4(float(BlackbodyTable::kCoolest), float(BlackbodyTable::kHottest),
             float(1.0 / (1.0 / BlackbodyTable::kCoolest - 1.0 / BlackbodyTable::kHottest)),
             float(blackbody.entries.size() - 1))};
    block.insert(block.end(), blackbody.entries.begin(), blackbody.entries.end());
    blackbody_ = bufferOf("blackbody", block);
    views_ = bufferOf("views", options.views);
    lights_ = bufferOf("lights", options.lights);
    gpu::ViewData view{};
    view.flags = options.viewFlags;
    view.frameIndex = options.frameIndex;
    view.seed = options.seed;
    view_ = bufferOf("view", std::vector<gpu::ViewData>{view});
    volume_ = gl::Texture("volume", {GL_TEXTURE_3D, GL_RGBA16F, 1, 1, 1, 1});
    volume_.clear(0);
}

/// All bricks one after another along x, then y.
void MediaCompute::uploadGrids() {
    std::vector<gpu::BrickData> table;
    std::vector<const float*> slots;
    const auto add = [&](const BrickGrid& grid) {
        const size_t first = slots.size(), firstBrick = table.size();
        for (uint32_t i = 0; i < grid.slotCount(); ++i)
            slots.push_back(grid.samples.data() + size_t(i) * kBrickSampleCount);
        for (const Brick& brick : grid.bricks) {
            const size_t slot = first + brick.slot;
            table.push_back({brick.minimum, brick.maximum,
                             brick.slot == Brick::kNoSlot ? gpu::kNoSlot
                                                          : uint32_t(slot % 100 | slot / 100 << 10),
                             0});
        }
        return int(firstBrick);
    };
    for (PlacedMedium& medium : placed_) {
        if (medium.data.kind != gpu::kMediumGrid) continue;
        medium.data.gridBricks.w = add(*medium.medium->density);
        if (medium.data.emission.w > 0)
            medium.data.temperatureBricks.w = add(*medium.medium->temperature);
    }
    const int columns = int(std::min<size_t>(std::max<size_t>(slots.size(), 1), 100)),
              rows = int(slots.size() / 100) + 1;
    atlas_ = gl::Texture("atlas", {GL_TEXTURE_3D, GL_R32F, 9 * columns, 9 * rows, 9, 1});
    for (size_t i = 0; i < slots.size(); ++i)
        atlas_.write({0, int(9 * (i % 100)), int(9 * (i / 100)), 0, 9, 9, 9}, slots[i],
                     kBrickSampleCount * sizeof(float));
    bricks_ = bufferOf("bricks", table);
}

void MediaCompute::bind(const gl::Program& program) {
    bindStorage(program, "Media", media_);
    bindStorage(program, "Bricks", bricks_);
    bindStorage(program, "Blackbody", blackbody_);
    bindStorage(program, "OpticalDepthViews", views_);
    bindStorage(program, "Lights", lights_);
    bindTexture(program, "mediumAtlas", atlas_);
    bindTexture(program, "lightOpticalDepth", volume_);
    if (const gl::ProgramResource* block = program.find("View"))
        glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(block->binding), view_.id());
}

std::vector<vec4> MediaCompute::run(gl::ShaderLibrary& library,
                                    const std::vector<std::string>& includes, std::string_view body,
                                    std::span<const vec4> inputs, uint32_t count) {
    // Shadow maps that no light asks for still have to be bound.
    gl::Buffer noShadows("shadows", 1024);
    noShadows.clear();
    return runTable(library, includes, body, inputs, count, count, [&](const gl::Program& program) {
        bind(program);
        bindStorage(program, "ShadowViews", noShadows);
    });
}

} // namespace tyndall::test
