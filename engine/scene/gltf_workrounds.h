#pragma once
// What tinygltf 2.7 refuses or would not keep, though it is sound: taken out of the JSON before, put back into the document after.
// Private to the folder.

#include "scene/gltf_document.h"

namespace tyndall::gltf {

struct Withheld {
    std::vector<Buffer> buffers;
    std::vector<Image> images;
    std::vector<uint64_t> strides;         // by buffer view
    std::vector<std::vector<int>> indices; // by mesh and primitive
};

/// `gltf` has passed the rules. What it loses is returned; the rest is put into a form that tinygltf takes.
Withheld withhold(Json& gltf);

} // namespace tyndall::gltf
