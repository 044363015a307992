#pragma once
// The steps from a checked glTF file to scene data. Private to the folder.

#include <map>
#include <string>
#include <vector>

#include "scene/gltf_file.h"
#include "scene/scene.h"

namespace tyndall {

/// A primitive before it is cut to what its indices use: parallel arrays over the file's vertices.
struct PrimitiveSource {
    SharedFloats positions, normals, tangents, colors;
    std::array<SharedFloats, kMaxUvSets> uvs;
    struct Influences {
        SharedFloats joints, weights; // four a vertex
    };
    std::map<int, Influences> influences; // JOINTS_n and WEIGHTS_n by n
    std::vector<uint32_t>
        indices; // as in the file, before lists are made; empty: all vertices in order
    bool indexed = false;
    /// Where the attribute `name` is kept; null where nothing here uses it.
    SharedFloats* place(std::string_view name);
    [[nodiscard]] size_t vertexCount() const { return positions ? positions->count() : 0; }
};

/// Fills everything that a KHR_draco_mesh_compression bit stream holds; attributes that it does not hold stay null.
Result<void> decodeDraco(GltfFile& file, const gltf::Primitive& primitive,
                         const std::string& pointer, PrimitiveSource& source);

/// Joint matrices (root from mesh) of a skin in its rest pose.
Result<std::vector<dmat4>> skinMatrices(GltfFile& file, size_t skin,
                                        const std::vector<dmat4>& rootFromNode);

class GltfModel {
public:
    GltfModel(GltfFile& file, Scene& scene) : file_(file), scene_(scene) {}
    Result<void> build();

private:
    // Materials (gltf_materials.cpp).
    Result<void> readMaterials();
    Result<void> readTextureRef(TextureRef& reference, const std::string& pointer);
    Result<int> readTexture(size_t texture);
    Result<int> readImage(size_t image);

    // Meshes (gltf_meshes.cpp). One mesh a primitive; `weights` and `skin` bake morph targets and the rest pose in.
    struct Shape {
        std::vector<double> weights;
        const std::vector<dmat4>* joints = nullptr;
    };
    Result<std::vector<int>> readMesh(size_t mesh, const Shape& shape);
    Result<void> readPrimitive(const gltf::Primitive& primitive, const std::string& pointer,
                               const std::string& name, const Shape& shape,
                               std::vector<int>& meshes);
    Result<PrimitiveSource> readSource(const gltf::Primitive& primitive,
                                       const std::string& pointer);
    Result<void> addMorphTargets(const gltf::Primitive& primitive, const std::string& pointer,
                                 const std::vector<double>& weights, PrimitiveSource& source);
    Result<Mesh> cutToIndices(int mode, const std::string& pointer, const PrimitiveSource& source);
    void finishMesh(Mesh& mesh, const std::string& pointer);

    // Nodes (gltf_nodes.cpp).
    Result<void> readNodes();
    std::vector<int> roots() const;
    Result<void> orderNodes(const std::vector<int>& roots);
    Result<Node> readNode(size_t index);
    Result<std::vector<dmat4>> readInstances(const gltf::Attributes& attributes,
                                             const std::string& pointer);
    Result<void> attachMeshes();
    Result<int> readCamera(size_t camera);
    int readLight(size_t light);
    void noteStaticPose();

    GltfFile& file_;
    Scene& scene_;
    std::map<size_t, int> textures_, images_, cameras_, lights_; // by index in the file
    std::map<size_t, std::vector<int>> meshes_; // those without a skin or weights of a node's own
    struct Placed {
        size_t node;
        int parent; // in the scene
    };
    std::vector<Placed> order_; // parents first; place in scene_.nodes = place here
    uint64_t pixels_ = 0;
};

} // namespace tyndall
