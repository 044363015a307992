#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf_model.h"

namespace tyndall {

Result<std::vector<dmat4>> skinMatrices(GltfFile& file, size_t skin,
                                        const std::vector<dmat4>& rootFromNode) {
    const Json& json = file.array("skins")[skin];
    const Json& joints = json.at("joints");
    SharedFloats inverseBind;
    if (const auto accessor = json.find("inverseBindMatrices"); accessor != json.end()) {
        auto values = file.floats(accessor->get<size_t>(), "MAT4");
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
        matrices.push_back(rootFromNode[joints[i].get<size_t>()] * bind);
    }
    return matrices;
}

} // namespace tyndall
