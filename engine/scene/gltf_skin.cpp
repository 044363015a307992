#include <fmt/format.h>

#include "scene/gltf_model.h"

namespace tyndall {

Result<std::vector<dmat4>> skinMatrices(GltfFile& file, size_t skin,
                                        const std::vector<dmat4>& rootFromNode) {
    const std::vector<int>& joints = file.document().skins[skin].joints;
    SharedFloats inverseBind;
    if (const int accessor = file.document().skins[skin].inverseBind; accessor != kNone) {
        auto values = file.floats(size_t(accessor), "MAT4");
        if (!values) return values.error();
        inverseBind = *values;
        if (inverseBind->count() < joints.size())
            return file.at(
                fmt::format("/skins/{}/inverseBindMatrices", skin),
                fmt::format("has {} matrices for {} joints", inverseBind->count(), joints.size()));
    }
    std::vector<dmat4> matrices;
    for (size_t i = 0; i < joints.size(); ++i) {
        dmat4 bind(1.0);
        if (inverseBind)
            for (int k = 0; k < 16; ++k) bind[k / 4][k % 4] = double(inverseBind->at(i)[k]);
        matrices.push_back(rootFromNode[size_t(joints[i])] * bind);
    }
    return matrices;
}

} // namespace tyndall
