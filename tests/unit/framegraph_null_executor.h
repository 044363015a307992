#pragma once
// Runs a frame graph without a GPU: passes execute against a context that writes down what they call.

#include <string>
#include <vector>

#include "core/check.h"
#include "framegraph/binding_check.h"
#include "framegraph/compile.h"

namespace tyndall::fg {

class NullContext final : public PassContext {
public:
    explicit NullContext(const FrameGraphImpl& graph, std::vector<std::string>& calls)
        : graph_(graph), calls_(calls) {}
    uint32_t pass = 0;

    void beginCompute(const char* shader, const Define*, uint32_t) override {
        note(std::string("compute ") + shader);
    }
    void beginRaster(const RasterShaders& shaders, const Define*, uint32_t) override {
        std::string call = "raster";
        for (const char* file :
             {shaders.vertex, shaders.tessControl, shaders.tessEvaluation, shaders.fragment})
            if (file) call += std::string(" ") + file;
        note(call);
    }
    void bindTexture(const char* name, TextureHandle, int32_t, int32_t) override {
        note(std::string("bind ") + name);
    }
    void bindBuffer(const char* name, BufferHandle) override { note(std::string("bind ") + name); }
    void bindStaticTexture(const char* name, StaticTexture) override {
        note(std::string("bind ") + name);
    }
    void bindStaticBuffer(const char* name, StaticBuffer) override {
        note(std::string("bind ") + name);
    }
    void uniformBlock(const char* block, const void*, size_t bytes) override {
        note(std::string("block ") + block + " " + std::to_string(bytes));
    }
    void uniformInt(const char* name, int32_t) override { note(std::string("int ") + name); }
    void uniformFloat(const char* name, float) override { note(std::string("float ") + name); }
    void dispatch(uint32_t x, uint32_t y, uint32_t z) override {
        note("dispatch " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z));
    }
    void dispatchThreads(uint32_t x, uint32_t y, uint32_t z) override {
        note("threads " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z));
    }
    void dispatchIndirect(BufferHandle, uint64_t) override { note("indirect"); }
    void targets(const Target*, uint32_t, const Target*) override { note("targets"); }
    void viewport(int32_t, int32_t, int32_t, int32_t) override { note("viewport"); }
    void rasterState(const RasterState&) override { note("state"); }
    void capture(BufferHandle, BufferHandle count, uint64_t countOffset, uint64_t) override {
        note(count ? "capture, count at " + std::to_string(countOffset) : "capture");
    }
    void draw(uint32_t, uint32_t, uint32_t) override { note("draw"); }
    void drawIndirect(BufferHandle, uint64_t byteOffset) override {
        note("draw indirect at " + std::to_string(byteOffset));
    }
    void drawGeometry(StaticGeometry, uint32_t, uint32_t, uint32_t, uint32_t) override {
        note("geometry");
    }
    void clearTexture(TextureHandle, const float*) override { note("clear"); }
    void clearBuffer(BufferHandle, uint32_t) override { note("clear"); }
    void copyTexture(TextureHandle, TextureHandle) override { note("copy"); }
    void upload(BufferHandle, uint64_t, const void*, size_t) override { note("upload"); }
    void barrier(Access) override { note("barrier"); }
    [[nodiscard]] TextureDesc desc(TextureHandle handle) const override {
        return graph_.desc(handle);
    }
    [[nodiscard]] BufferDesc desc(BufferHandle handle) const override {
        return graph_.desc(handle);
    }
    [[nodiscard]] bool isAbsent(TextureHandle handle) const override {
        return graph_.isAbsent(handle);
    }
    [[nodiscard]] bool isAbsent(BufferHandle handle) const override {
        return graph_.isAbsent(handle);
    }

private:
    void note(const std::string& call) {
        calls_.push_back(std::string(graph_.passes()[pass].name) + ": " + call);
    }
    const FrameGraphImpl& graph_;
    std::vector<std::string>& calls_;
};

/// What the executor does, without storage.
class NullExecutor {
public:
    FrameGraphImpl& beginFrame() {
        graph.beginFrame();
        return graph;
    }
    const CompiledGraph& compile(const CompileOptions& options = {}) {
        compiler.compile(graph, persistent, compiled, options);
        return compiled;
    }
    const CompiledGraph& execute() {
        compile();
        calls.clear();
        if (!compiled.errors.empty()) return compiled;
        NullContext context(graph, calls);
        for (uint32_t i = 0; i < compiled.passes.size(); ++i) {
            if (compiled.passes[i].status != PassStatus::Ran) continue;
            context.pass = i;
            compiled.passes[i].execute(compiled.passes[i].data, context);
        }
        persistent.commit(compiled);
        return compiled;
    }

    PersistentTable persistent;
    FrameGraphImpl graph{persistent};
    Compiler compiler;
    CompiledGraph compiled;
    std::vector<std::string> calls;
};

/// The pass of this name; there must be one.
inline const CompiledPass& passNamed(const CompiledGraph& graph, std::string_view name) {
    for (const CompiledPass& pass : graph.passes)
        if (pass.name == name) return pass;
    failCheck("passNamed", name, __FILE__, __LINE__);
}
inline const CompiledResource& resourceNamed(const CompiledGraph& graph, std::string_view name) {
    for (const CompiledResource& resource : graph.resources)
        if (resource.name == name) return resource;
    failCheck("resourceNamed", name, __FILE__, __LINE__);
}
inline PassStatus statusOf(const CompiledGraph& graph, std::string_view name) {
    return passNamed(graph, name).status;
}

} // namespace tyndall::fg
