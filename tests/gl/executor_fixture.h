#pragma once
// An executor with a few small shaders, on every back end.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "framegraph/gl/executor.h"
#include "gl/buffer.h"
#include "gl/gl_fixture.h"
#include "gl/sampler.h"
#include "gl/shader_library.h"
#include "gl/texture.h"

namespace tyndall::fg {

struct Data {
    TextureHandle in, out;
    BufferHandle bufferIn, bufferOut;
    float value;
    int width; // texels to write; 0: all
};

class ExecutorTest : public test::GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped()) return;
        library_.emplace(libraryOptions());
        // out = value
        library_->addSource(
            "test/fill.comp",
            "layout(local_size_x = 8, local_size_y = 8) in;\n"
            "layout(rgba32f) uniform writeonly image2D target;\nuniform float value;\n"
            "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(value)); }\n");
        // out = in + value, at its own place
        library_->addSource(
            "test/add.comp",
            "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D source;\n"
            "layout(rgba32f) uniform writeonly image2D target;\nuniform float value;\n"
            "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
            "  ivec2 q = min(p, textureSize(source, 0) - 1);\n"
            "  imageStore(target, p, texelFetch(source, q, 0) + vec4(value)); }\n");
        // out = x + 100 y of the texel
        library_->addSource("test/place.comp",
                            "layout(local_size_x = 8, local_size_y = 8) in;\n"
                            "layout(rgba32f) uniform writeonly image2D target;\n"
                            "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                            "  imageStore(target, p, vec4(p.x + 100 * p.y, 0, 0, 1)); }\n");
        executor_.emplace(*library_);
    }
    void TearDown() override {
        executor_.reset();
        library_.reset();
        GlTest::TearDown();
    }

    virtual gl::ShaderLibraryOptions libraryOptions() { return {}; }
    Executor& executor() { return *executor_; }
    gl::ShaderLibrary& library() { return *library_; }
    FrameGraph& begin() { return *(graph_ = &executor_->beginFrame()); }
    FrameGraph& graph() { return *graph_; }
    void run() {
        const Result<void> done = executor_->execute();
        ASSERT_TRUE(done.ok()) << done.message();
    }

    static TextureDesc color(int width = 16, int height = 8) {
        return texture2D(Format::RGBA32F, width, height);
    }

    TextureHandle fill(const char* name, float value, const TextureDesc& desc = color(),
                       int width = 0) {
        return graph_
            ->addPass<Data>(
                name,
                [&](Builder& b, Data& d) {
                    d.out = b.create(name, desc);
                    d.value = value;
                    d.width = width;
                },
                [](const Data& d, PassContext& c) {
                    const TextureDesc size = c.desc(d.out);
                    c.compute("test/fill.comp")
                        .bind("target", d.out)
                        .set("value", d.value)
                        .dispatchOver(uint32_t(d.width ? d.width : size.width),
                                      uint32_t(size.height));
                })
            .out;
    }
    TextureHandle add(const char* name, TextureHandle in, float value,
                      uint64_t* cacheKey = nullptr) {
        return graph_
            ->addPass<Data>(
                name,
                [&](Builder& b, Data& d) {
                    d.in = b.read(in);
                    d.out = b.create(name, graph_->isAbsent(in) ? color() : graph_->desc(in));
                    d.value = value;
                    if (cacheKey) b.cacheBy(*cacheKey);
                },
                [](const Data& d, PassContext& c) {
                    c.compute("test/add.comp")
                        .bind("source", d.in)
                        .bind("target", d.out)
                        .set("value", d.value)
                        .dispatchOver(d.out);
                })
            .out;
    }
    /// The value of all texels' red; NaN where they differ.
    float everywhere(TextureHandle handle) {
        const Image image = executor_->readImage(handle);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                if (image.at(x, y)[0] != image.at(0, 0)[0])
                    return std::numeric_limits<float>::quiet_NaN();
        return image.at(0, 0)[0];
    }
    /// What a buffer holds.
    template <typename T> std::vector<T> valuesOf(BufferHandle handle) {
        const std::vector<std::byte> bytes = executor_->readBuffer(handle);
        std::vector<T> values(bytes.size() / sizeof(T));
        if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
        return values;
    }
    /// The message of the check that fails in execute().
    std::string failure() {
        try {
            (void)executor_->execute();
        } catch (const CheckFailure& caught) {
            return caught.what();
        }
        return "nothing failed";
    }
    const PassReport& reportOf(std::string_view name) {
        for (const PassReport& pass : executor_->report().passes)
            if (pass.name == name) return pass;
        failCheck("reportOf", name, __FILE__, __LINE__);
    }

private:
    std::optional<gl::ShaderLibrary> library_;
    std::optional<Executor> executor_;
    FrameGraph* graph_ = nullptr;
};

} // namespace tyndall::fg
