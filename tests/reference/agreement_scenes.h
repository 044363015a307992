#pragma once
// Ten scenes on which both path tracers must agree: between them they have all that the tracers know.

#include <vector>

#include "scene/scene.h"

namespace tyndall::validation {

struct AgreementScene {
    const char* name;
    Scene scene;
    int camera;
    uint32_t simpleSamples, volumeSamples;
};
inline constexpr int kAgreementScenes = 10;
AgreementScene agreementScene(int index);

} // namespace tyndall::validation
