// The smallest useful plugin: one setting, one shader, one pass that multiplies the picture by a colour.
// `cmake/new-plugin.sh NAME` copies this folder under a new name.

#include <cstddef>

#include "plugin/plugin_api.h"

namespace tyndall::example_tint {
namespace {

struct Settings {
    bool enabled;
    float red, green, blue;
};

const SettingDesc kSettings[] = {
    TYNDALL_BOOL(Settings, enabled, "tint.enabled", "Tint", false,
                 "Multiplies the picture by a colour."),
    TYNDALL_FLOAT(Settings, red, "tint.red", "Red", "", 0, 4, 1,
                  "Factor of the red channel. Above 1 brightens it."),
    TYNDALL_FLOAT(Settings, green, "tint.green", "Green", "", 0, 4, 1,
                  "Factor of the green channel. Above 1 brightens it."),
    TYNDALL_FLOAT(Settings, blue, "tint.blue", "Blue", "", 0, 4, 1,
                  "Factor of the blue channel. Above 1 brightens it."),
};

constexpr const char* kShader = R"(
layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D image;
layout(rgba32f) uniform writeonly image2D tinted;
layout(std140) uniform Params { vec4 tint; };
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(tinted)))) return;
    imageStore(tinted, pixel, texelFetch(image, pixel, 0) * tint);
}
)";

class Tint final : public plugin::Plugin {
public:
    const plugin::PluginInfo& info() const override {
        static constexpr plugin::PluginInfo kInfo{"example_tint", "0.1.0",
                                                  "Multiplies the picture by a colour."};
        return kInfo;
    }
    plugin::SettingsTable settings() override {
        return {kSettings, uint32_t(std::size(kSettings)), &settings_, nullptr, 0};
    }
    bool setup(plugin::Host& host, char*, uint32_t) override {
        host.addShader("example_tint/tint.comp", kShader);
        return true;
    }
    fg::TextureHandle addPostPasses(fg::FrameGraph& graph, const plugin::FrameInputs&,
                                    fg::TextureHandle color) override {
        struct Data {
            fg::TextureHandle image, tinted;
            vec4 tint;
        };
        const Data& pass = graph.addPass<Data>(
            "example_tint.tint",
            [&](fg::Builder& builder, Data& data) {
                if (!settings_.enabled) return builder.skip("setting tint.enabled is off");
                data.image = builder.read(color);
                data.tinted = builder.create("example_tint.image", graph.desc(color));
                data.tint = vec4(settings_.red, settings_.green, settings_.blue, 1);
            },
            [](const Data& data, fg::PassContext& context) {
                context.compute("example_tint/tint.comp")
                    .bind("image", data.image)
                    .bind("tinted", data.tinted)
                    .params(data.tint)
                    .dispatchOver(data.tinted);
            });
        return settings_.enabled ? pass.tinted : color;
    }
    void destroy() override { delete this; }

private:
    Settings settings_{};
};

} // namespace
} // namespace tyndall::example_tint

TYNDALL_PLUGIN(example_tint,
               []() -> tyndall::plugin::Plugin* { return new tyndall::example_tint::Tint; })
