// Primitives: attributes, morph targets and skin in the rest pose, lists from strips, missing normals and tangents.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "core/check.h"
#include "scene/gltf_model.h"
#include "scene/mesh_tools.h"

namespace tyndall {
namespace {

enum Mode {
    Points = 0,
    Lines = 1,
    LineLoop = 2,
    LineStrip = 3,
    Triangles = 4,
    TriangleStrip = 5,
    TriangleFan = 6
};

MeshTopology topologyOf(int mode) {
    return mode == Points     ? MeshTopology::Points
           : mode < Triangles ? MeshTopology::Lines
                              : MeshTopology::Triangles;
}

/// Lists from any mode, as glTF 2.0 section 3.7.2.1 defines them; a rest that makes no whole line or triangle is dropped.
std::vector<uint32_t> makeList(int mode, std::vector<uint32_t> in) {
    const size_t n = in.size();
    std::vector<uint32_t> out;
    switch (mode) {
    case Points: return in;
    case Lines: in.resize(n / 2 * 2); return in;
    case Triangles: in.resize(n / 3 * 3); return in;
    case LineStrip:
    case LineLoop:
        for (size_t i = 0; i + 1 < n; ++i) out.insert(out.end(), {in[i], in[i + 1]});
        if (mode == LineLoop && n > 1) out.insert(out.end(), {in[n - 1], in[0]});
        return out;
    case TriangleStrip:
        for (size_t i = 0; i + 2 < n; ++i)
            out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
        return out;
    default:
        for (size_t i = 0; i + 2 < n; ++i) out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
        return out;
    }
}

/// Renumbers indices to the vertices that are used, in order of first use; returns those.
std::vector<uint32_t> compact(std::vector<uint32_t>& indices, size_t vertexCount) {
    std::vector<uint32_t> from;
    if (indices.size() <
        vertexCount /
            8) { // few of many: a table over all vertices would cost more than the primitive
        std::unordered_map<uint32_t, uint32_t> to;
        for (uint32_t& index : indices) {
            const auto [place, fresh] = to.emplace(index, uint32_t(from.size()));
            if (fresh) from.push_back(index);
            index = place->second;
        }
        return from;
    }
    constexpr uint32_t kUnused = 0xffffffffu;
    std::vector<uint32_t> to(vertexCount, kUnused);
    for (uint32_t& index : indices) {
        if (to[index] == kUnused) {
            to[index] = uint32_t(from.size());
            from.push_back(index);
        }
        index = to[index];
    }
    return from;
}

template <typename V>
std::vector<V> gather(const SharedFloats& data, const std::vector<uint32_t>& from, float fill) {
    std::vector<V> values;
    if (!data) return values;
    values.reserve(from.size());
    for (const uint32_t index : from) {
        V value(fill);
        for (int c = 0; c < std::min<int>(data->components, V::length()); ++c)
            value[c] = data->at(index)[c];
        values.push_back(value);
    }
    return values;
}

void normalizeAll(std::vector<vec3>& normals) {
    for (vec3& normal : normals) {
        const float length = glm::length(normal);
        normal = length > 1e-20f && std::isfinite(length) ? normal / length : vec3(0, 0, 1);
    }
}

void normalizeTangents(Mesh& mesh) {
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        vec4& tangent = mesh.tangents[i];
        const float length = glm::length(vec3(tangent)), sign = tangent.w < 0 ? -1.0f : 1.0f;
        const vec3 axis = std::abs(mesh.normals[i].x) < 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0);
        tangent = vec4(length > 1e-20f && std::isfinite(length)
                           ? vec3(tangent) / length
                           : glm::normalize(glm::cross(mesh.normals[i], axis)),
                       sign);
    }
}

/// The n of "PREFIXn"; -1 where `name` is not of that form.
int setOf(std::string_view name, std::string_view prefix) {
    int set = -1;
    if (!name.starts_with(prefix)) return -1;
    const char* const end = name.data() + name.size();
    const auto [rest, wrong] = std::from_chars(name.data() + prefix.size(), end, set);
    return wrong == std::errc() && rest == end ? set : -1;
}

/// What the accessor of an attribute may be.
std::string_view typesOf(std::string_view name) {
    if (name == "POSITION" || name == "NORMAL") return "VEC3";
    if (name == "COLOR_0") return "VEC3 VEC4";
    return name.starts_with("TEXCOORD_") ? "VEC2" : "VEC4";
}

struct Influences {
    std::vector<vec4> joints, weights;
};

/// Linear blend skinning of the rest pose (glTF 2.0 section 3.7.3.3), of all sets of four influences.
void skin(Mesh& mesh, const std::vector<Influences>& sets, const std::vector<dmat4>& matrices) {
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        dmat4 blend(0.0);
        double total = 0;
        for (const Influences& set : sets)
            for (int k = 0; k < 4; ++k) {
                const double weight = double(set.weights[i][k]);
                const float joint = set.joints[i][k];
                if (weight == 0 || !(joint >= 0 && joint < float(matrices.size()))) continue;
                blend += matrices[size_t(joint)] * weight;
                total += weight;
            }
        if (!(std::abs(total) > 1e-6)) continue; // a vertex that no joint moves stays
        blend = blend * (1 / total);
        mesh.positions[i] = vec3(blend * dvec4(dvec3(mesh.positions[i]), 1));
        const dmat3 linear(blend);
        // The cofactor matrix is the inverse transpose without the division, so that it exists for a flattened pose.
        const dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
        if (!mesh.normals.empty())
            mesh.normals[i] =
                vec3(glm::normalize(cofactor * dvec3(mesh.normals[i]) + dvec3(1e-300)));
        if (!mesh.tangents.empty())
            mesh.tangents[i] =
                vec4(vec3(linear * dvec3(vec3(mesh.tangents[i]))), mesh.tangents[i].w);
    }
}

} // namespace

SharedFloats* PrimitiveSource::place(std::string_view name) {
    if (name == "POSITION") return &positions;
    if (name == "NORMAL") return &normals;
    if (name == "TANGENT") return &tangents;
    if (name == "COLOR_0") return &colors;
    if (const int set = setOf(name, "TEXCOORD_"); set >= 0 && set < kMaxUvSets)
        return &uvs[size_t(set)];
    if (const int set = setOf(name, "JOINTS_"); set >= 0) return &influences[set].joints;
    if (const int set = setOf(name, "WEIGHTS_"); set >= 0) return &influences[set].weights;
    return nullptr;
}

Result<std::vector<int>> GltfModel::readMesh(size_t index, const Shape& shape) {
    const gltf::Mesh& mesh = file_.document().meshes[index];
    std::vector<int> meshes;
    for (size_t i = 0; i < mesh.primitives.size(); ++i) {
        const std::string pointer = fmt::format("/meshes/{}/primitives/{}", index, i);
        if (auto read = readPrimitive(mesh.primitives[i], pointer, mesh.name, shape, meshes); !read)
            return read.error();
    }
    return meshes;
}

Result<void> GltfModel::readPrimitive(const gltf::Primitive& primitive, const std::string& pointer,
                                      const std::string& name, const Shape& shape,
                                      std::vector<int>& meshes) {
    if (!primitive.attributes.contains("POSITION")) {
        file_.note(pointer + " has no positions and is left out");
        return {};
    }
    auto source = readSource(primitive, pointer);
    if (!source) return source.error();
    if (auto morphed = addMorphTargets(primitive, pointer, shape.weights, *source); !morphed)
        return morphed;
    auto mesh = cutToIndices(primitive.mode, pointer, *source);
    if (!mesh) return mesh.error();
    if (mesh->positions.empty()) return {}; // nothing to draw
    mesh->name = name;
    mesh->material = primitive.material;
    if (shape.joints) {
        // The attributes were cut to the used vertices in the same order as here.
        std::vector<uint32_t> indices = makeList(primitive.mode, source->indices);
        const std::vector<uint32_t> from = compact(indices, source->vertexCount());
        std::vector<Influences> sets;
        for (const auto& [set, written] : source->influences)
            if (written.joints && written.weights)
                sets.push_back({gather<vec4>(written.joints, from, 0),
                                gather<vec4>(written.weights, from, 0)});
        skin(*mesh, sets, *shape.joints);
    }
    finishMesh(*mesh, pointer);
    meshes.push_back(int(scene_.meshes.size()));
    scene_.meshes.push_back(std::move(*mesh));
    return {};
}

Result<PrimitiveSource> GltfModel::readSource(const gltf::Primitive& primitive,
                                              const std::string& pointer) {
    PrimitiveSource source;
    if (primitive.draco)
        if (auto decoded = decodeDraco(file_, primitive, pointer, source); !decoded)
            return decoded.error();
    for (const auto& [name, accessor] : primitive.attributes) {
        SharedFloats* const place = source.place(name);
        if (!place || *place) continue;
        auto values = file_.floats(size_t(accessor), typesOf(name));
        if (!values) return values.error();
        *place = *values;
    }
    const size_t count = source.vertexCount();
    for (const auto& [name, accessor] : primitive.attributes)
        if (const SharedFloats* data = source.place(name);
            data && *data && (*data)->count() != count)
            return file_.at(pointer,
                            fmt::format("has {} positions, but {} elements of another attribute",
                                        count, (*data)->count()));
    if (primitive.indices != kNone && !source.indexed) {
        auto values = file_.indices(size_t(primitive.indices));
        if (!values) return values.error();
        source.indices = std::move(*values);
        source.indexed = true;
    }
    if (!source.indexed) {
        if (auto fits = file_.charge(count, pointer); !fits) return fits.error();
        source.indices.resize(count);
        for (size_t i = 0; i < count; ++i) source.indices[i] = uint32_t(i);
    }
    for (const uint32_t index : source.indices)
        if (index >= count)
            return file_.at(pointer + "/indices",
                            fmt::format("holds {}, but there are {} vertices", index, count));
    return source;
}

Result<void> GltfModel::addMorphTargets(const gltf::Primitive& primitive,
                                        const std::string& pointer,
                                        const std::vector<double>& weights,
                                        PrimitiveSource& source) {
    const std::vector<gltf::Attributes>& targets = primitive.targets;
    if (targets.empty()) return {};
    file_.note("morph targets are shown as their default weights have them");
    const std::pair<const char*, SharedFloats*> kinds[] = {{"POSITION", &source.positions},
                                                           {"NORMAL", &source.normals},
                                                           {"TANGENT", &source.tangents}};
    for (const auto& [name, data] : kinds) {
        if (!*data) continue;
        std::shared_ptr<FloatData> moved;
        for (size_t t = 0; t < std::min(targets.size(), weights.size()); ++t) {
            const auto accessor = targets[t].find(name);
            if (accessor == targets[t].end() || weights[t] == 0) continue;
            const auto offsets = file_.floats(size_t(accessor->second), "VEC3");
            if (!offsets) return offsets.error();
            if ((*offsets)->count() != (*data)->count())
                return file_.at(fmt::format("{}/targets/{}/{}", pointer, t, name),
                                fmt::format("has {} elements, but the primitive {} vertices",
                                            (*offsets)->count(), (*data)->count()));
            if (!moved) {
                if (auto fits = file_.charge((*data)->values.size(), pointer); !fits) return fits;
                moved = std::make_shared<FloatData>(**data);
            }
            for (size_t i = 0; i < moved->count(); ++i)
                for (size_t c = 0; c < 3; ++c)
                    moved->values[i * size_t(moved->components) + c] +=
                        float(weights[t]) * (*offsets)->at(i)[c];
        }
        if (moved) *data = moved;
    }
    return {};
}

Result<Mesh> GltfModel::cutToIndices(int mode, const std::string& pointer,
                                     const PrimitiveSource& source) {
    Mesh mesh;
    mesh.topology = topologyOf(mode);
    // A strip makes up to three indices out of one; what they keep of the attributes is at most as much.
    if (auto fits =
            file_.charge(source.indices.size() *
                             (mode == LineStrip || mode == LineLoop || mode > Triangles ? 3 : 1),
                         pointer);
        !fits)
        return fits.error();
    mesh.indices = makeList(mode, source.indices);
    if (mode == Triangles && source.indices.size() % 3 != 0)
        file_.note(pointer + " has indices that make no whole triangle; they are dropped");
    const std::vector<uint32_t> from = compact(mesh.indices, source.vertexCount());
    mesh.positions = gather<vec3>(source.positions, from, 0);
    mesh.normals = gather<vec3>(source.normals, from, 0);
    mesh.tangents = gather<vec4>(source.tangents, from, 0);
    mesh.colors = gather<vec4>(source.colors, from, 1);
    for (size_t set = 0; set < source.uvs.size(); ++set)
        mesh.uvs[set] = gather<vec2>(source.uvs[set], from, 0);
    return mesh;
}

void GltfModel::finishMesh(Mesh& mesh, const std::string& pointer) {
    for (vec3& position :
         mesh.positions) // morph targets and skins can leave the range that accessors keep to
        if (!(std::abs(position.x) <= 1e18f && std::abs(position.y) <= 1e18f &&
              std::abs(position.z) <= 1e18f)) {
            position = vec3(0);
            file_.note(pointer + " has positions beyond 1e18 metres; they are moved to the origin");
        }
    const Material& material = scene_.materialOf(mesh);
    for (const TextureRef* reference :
         {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
          &material.occlusionTexture, &material.emissiveTexture}) {
        auto& uvs = mesh.uvs[size_t(reference->uvSet)];
        if (reference->texture == kNone || !uvs.empty()) continue;
        file_.note(fmt::format("{} lacks TEXCOORD_{}, which its material uses; (0, 0) is taken",
                               pointer, reference->uvSet));
        uvs.assign(mesh.positions.size(), vec2(0));
    }
    for (vec4& color : mesh.colors) color = glm::clamp(color, vec4(0), vec4(1));
    if (mesh.topology == MeshTopology::Triangles) {
        if (mesh.normals.empty())
            makeFlatNormals(mesh);
        else
            normalizeAll(mesh.normals);
        const bool wanted = material.normalTexture.texture != kNone;
        if (!wanted)
            mesh.tangents.clear();
        else if (mesh.tangents.empty())
            makeTangents(mesh, material.normalTexture.uvSet);
        else
            normalizeTangents(mesh);
    } else {
        normalizeAll(mesh.normals);
        mesh.tangents.clear();
    }
    mesh.bounds = boundsOf(mesh.positions);
}

} // namespace tyndall
