#include "passes/lights_fixture.h"

#include <cstring>

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall::test {
namespace {

constexpr const char* kProbeShader = R"(
#include "common/random.glsl"
#include "lighting/clusters.glsl"
#include "lighting/light.glsl"
#include "lighting/shadow.glsl"
layout(local_size_x = 64) in;
layout(std430) readonly buffer Probes { vec4 probes[]; };
layout(std430) writeonly buffer Results { vec4 results[]; };
uniform int probeCount;
uniform int rectSamples;
uniform int everyLight;

vec2 lookAtLight(uint light, vec3 position, vec3 normal, vec2 noise) {
    float visibility = shadowVisibility(light, position, normal, noise);
    int side = lights[light].type == kLightRect ? rectSamples : 1;
    float sum = 0.0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            LightSample incoming = sampleLight(light, position, (vec2(x, y) + 0.5) / float(side));
            float cosine = dot(normal, normal) > 0.0 ? max(0.0, dot(normal, incoming.direction)) : 1.0;
            sum += incoming.illuminance.r * cosine;
        }
    sum /= float(side * side);
    return vec2(sum * visibility, sum);
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    if (id >= uint(probeCount)) return;
    vec3 position = probes[2u * id].xyz;
    vec3 normal = probes[2u * id + 1u].xyz;
    vec2 noise = pixelNoise2(uvec2(id & 63u, id >> 6), 3u);
    vec2 all = vec2(0.0);
    for (uint i = 0u; everyLight != 0 && i < clusterLightCount(kEveryLight); ++i) all += lookAtLight(i, position, normal, noise);
    float listed = 0.0;
    uint cluster = clusterOfPosition(position);
    for (uint i = 0u; i < clusterLightCount(cluster); ++i) listed += lookAtLight(clusterLight(cluster, i), position, normal, noise).x;
    results[id] = vec4(all, listed, clusterLightCount(kEveryLight) > 0u ? shadowVisibility(0u, position, normal, noise) : 1.0);
}
)";

struct ProbePass {
    fg::BufferHandle probes, results;
    LightResources lights;
    ViewResources view;
    const vec4* data;
    uint32_t count;
    int rectSamples, everyLight;
};

} // namespace

dmat4 lookingAlong(const dvec3& position, const dvec3& forward) {
    const dvec3 z = -glm::normalize(forward),
                pole = std::abs(z.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 x = glm::normalize(glm::cross(pole, z));
    return dmat4(dvec4(x, 0), dvec4(glm::cross(z, x), 0), dvec4(z, 0), dvec4(position, 1));
}

int SceneMaker::node(const dmat4& worldFromNode) {
    Node n;
    n.matrix = worldFromNode;
    scene.nodes.push_back(n);
    touch();
    return int(scene.nodes.size()) - 1;
}

int SceneMaker::primitive(PrimitiveShape shape, const dvec3& size, const dvec3& position,
                          const dquat& rotation, const Material& material) {
    Primitive what;
    what.shape = shape;
    what.size = size;
    const int index = mesh(makePrimitive(what), material);
    scene.nodes[size_t(index)].matrix =
        glm::translate(dmat4(1), position) * glm::mat4_cast(rotation);
    return index;
}

int SceneMaker::mesh(Mesh mesh, const Material& material) {
    mesh.material = int(scene.materials.size());
    mesh.version = nextVersion();
    scene.materials.push_back(material);
    scene.materials.back().version = nextVersion();
    scene.meshes.push_back(std::move(mesh));
    const int index = node(dmat4(1));
    scene.nodes[size_t(index)].meshes = {int(scene.meshes.size()) - 1};
    return index;
}

int SceneMaker::light(const Light& light, const dmat4& worldFromNode) {
    scene.lights.push_back(light);
    scene.lights.back().version = nextVersion();
    const int index = node(worldFromNode);
    scene.nodes[size_t(index)].light = int(scene.lights.size()) - 1;
    return index;
}

int SceneMaker::pointLight(float candela, const dvec3& position, float radius, float range) {
    Light lamp;
    lamp.type = LightType::Point;
    lamp.intensity = candela;
    lamp.radius = radius;
    lamp.range = range;
    return light(lamp, glm::translate(dmat4(1), position));
}

int SceneMaker::directionalLight(float lux, const dvec3& travel, float angularRadius) {
    Light sun;
    sun.type = LightType::Directional;
    sun.intensity = lux;
    sun.radius = angularRadius;
    return light(sun, lookingAlong(dvec3(0), travel));
}

void SceneMaker::moveNode(int index, const dvec3& by) {
    *scene.nodes[size_t(index)].matrix =
        glm::translate(dmat4(1), by) * *scene.nodes[size_t(index)].matrix;
    scene.versions.transforms = nextVersion();
}

void SceneMaker::touch() {
    SceneVersions& v = scene.versions;
    v.structure = v.transforms = v.meshes = v.materials = v.textures = v.lights = v.environment =
        nextVersion();
    scene.environment.version = nextVersion();
}

void LightsTest::SetUp() {
    GlTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    library_.emplace();
    library_->addSource("test/light_probe.comp", kProbeShader);
    executor_.emplace(*library_);
    gpuScene_.emplace(*executor_);
    lights_.emplace();
    settings_ = {};
    lights_->registerSettings(settings_);
    settings_.applyPreset(Quality::High);
    lights_->lightSettings().cutoff = 0; // every light everywhere
    lights_->shadowSettings().resolution = 512;
    lights_->shadowSettings().localResolution = 512;
    lights_->shadowSettings().environmentResolution = 256;
    lights_->shadowSettings().atlasSize = 2048;
}

void LightsTest::TearDown() {
    lights_.reset();
    gpuScene_.reset();
    executor_.reset();
    library_.reset();
    GlTest::TearDown();
}

void LightsTest::forgetEverything() {
    const LightSettings lightSettings = lights_->lightSettings();
    const ShadowSettings shadowSettings = lights_->shadowSettings();
    lights_.reset();
    gpuScene_.reset();
    executor_.reset();
    executor_.emplace(*library_);
    gpuScene_.emplace(*executor_);
    lights_.emplace();
    settings_ = {};
    lights_->registerSettings(settings_);
    settings_.applyPreset(Quality::High);
    lights_->lightSettings().cutoff = 0; // every light everywhere
    lights_->lightSettings() = lightSettings;
    lights_->shadowSettings() = shadowSettings;
}

std::string LightsTest::statusOf(std::string_view name) {
    for (const fg::PassReport& pass : executor_->report().passes)
        if (pass.name == name)
            return std::string(fg::statusName(pass.status)) +
                   (pass.status == fg::PassStatus::Skipped ? ": " + std::string(pass.reason) : "");
    return "not there";
}

void LightsTest::lookOnce(SceneMaker& maker, const std::vector<Probe>& probes,
                          const ProbeOptions& options, uint32_t frame, std::vector<dvec4>& sums) {
    Camera camera;
    camera.znear = 1e-3 * options.sceneRadius;
    camera.type = options.orthographic ? CameraType::Orthographic : CameraType::Perspective;
    camera.ymag = options.sceneRadius;
    ViewRequest request;
    request.camera = &camera;
    request.worldFromCamera =
        glm::translate(dmat4(1), options.eye) * glm::rotate(dmat4(1), options.yaw, dvec3(0, 1, 0));
    request.sceneRadius = options.sceneRadius;
    request.width = 64;
    request.height = 48;
    request.converge = options.converge;
    request.frameIndex = frame;
    const ViewResources view = makeView(request);

    const Result<void> uploaded = gpuScene_->update(maker.scene, dvec3(0));
    ASSERT_TRUE(uploaded.ok()) << uploaded.message();
    fg::FrameGraph& graph = executor_->beginFrame();
    std::vector<Bounds> casters;
    for (const DrawItem& item : gpuScene_->items()) casters.push_back(item.bounds);
    Bounds withLamps = maker.scene.worldBounds();
    for (const Node& node : maker.scene.nodes)
        if (node.light != kNone) withLamps.include(node.translation);
    lights_->update({&maker.scene, dvec3(0), casters, maker.scene.worldBounds(), withLamps, &view});
    const LightResources resources = lights_->addPasses(graph, *gpuScene_, view, true);
    std::vector<vec4> data;
    for (const Probe& probe : probes) {
        data.push_back(vec4(vec3(probe.position), 1));
        data.push_back(vec4(vec3(probe.normal), 0));
    }
    struct Upload {
        fg::BufferHandle probes;
        const vec4* data;
        size_t bytes;
    };
    const Upload& upload = graph.addPass<Upload>(
        "test.probes",
        [&](fg::Builder& builder, Upload& u) {
            u.data = data.data();
            u.bytes = data.size() * sizeof(vec4);
            u.probes =
                builder.create("test.probes", fg::BufferDesc{u.bytes}, fg::Access::TransferWrite);
        },
        [](const Upload& u, fg::PassContext& context) {
            context.upload(u.probes, 0, u.data, u.bytes);
        });
    const ProbePass& pass = graph.addPass<ProbePass>(
        "test.look",
        [&](fg::Builder& builder, ProbePass& p) {
            p.probes = builder.read(upload.probes);
            p.lights = readLights(builder, resources);
            p.results =
                builder.create("test.results", fg::BufferDesc{probes.size() * sizeof(vec4)});
            p.view = view;
            p.count = uint32_t(probes.size());
            p.rectSamples = options.rectSamples;
            p.everyLight = options.everyLight ? 1 : 0;
        },
        [](const ProbePass& p, fg::PassContext& context) {
            auto command = context.compute("test/light_probe.comp");
            bindLightLists(bindLights(bindView(command, p.view), p.lights), p.lights)
                .bind("Probes", p.probes)
                .bind("Results", p.results);
            command.set("probeCount", int(p.count))
                .set("rectSamples", p.rectSamples)
                .set("everyLight", p.everyLight)
                .dispatchOver(p.count);
        });
    graph.markOutput(pass.results);
    graph.markOutput(resources.clusters);
    const Result<void> done = executor_->execute();
    ASSERT_TRUE(done.ok()) << done.message();
    const std::vector<std::byte> bytes = executor_->readBuffer(pass.results);
    std::vector<vec4> results(probes.size());
    std::memcpy(results.data(), bytes.data(), results.size() * sizeof(vec4));
    for (size_t i = 0; i < results.size(); ++i) {
        for (int c = 0; c < 4; ++c)
            ASSERT_TRUE(std::isfinite(results[i][c]) && results[i][c] >= 0)
                << "probe " << i << ", value " << c << ": " << results[i][c];
        sums[i] += dvec4(results[i]);
    }
    const std::vector<std::byte> lists = executor_->readBuffer(resources.clusters);
    clusterWords_.resize(lists.size() / 4);
    std::memcpy(clusterWords_.data(), lists.data(), clusterWords_.size() * 4);
}

std::vector<Seen> LightsTest::look(SceneMaker& maker, const std::vector<Probe>& probes,
                                   const ProbeOptions& options) {
    std::vector<dvec4> sums(probes.size(), dvec4(0));
    for (uint32_t frame = 0; frame < options.frames; ++frame) {
        lookOnce(maker, probes, options, options.firstFrame + frame, sums);
        if (HasFatalFailure()) break;
    }
    std::vector<Seen> seen;
    for (const dvec4& sum : sums) {
        const dvec4 mean = sum / double(options.frames);
        seen.push_back({float(mean.x), float(mean.y), float(mean.z), float(mean.w)});
    }
    return seen;
}

} // namespace tyndall::test
