#include <gtest/gtest.h>

#include "gltf_mutation.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

TEST(SceneFileHostile, DamagedCopiesAreLoadedOrRefused) {
    const fs::path scratch = test::scratchDir("scene-damaged");
    for (const char* name : {"cornell.scene.json", "fog_hall.scene.json"}) {
        const std::string good = readFile(test::sourceDir() / "content" / name).value();
        for (uint64_t i = 0; i < 500; ++i) {
            SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(test::seed() + i));
            ASSERT_TRUE(
                writeFileAtomically(scratch / name, test::damaged(good, test::seed() + i)).ok());
            test::expectLoadedOrRefused(scratch / name);
        }
    }
}

} // namespace
} // namespace tyndall
