#pragma once
// An executor with the programs of tests/gl/shaders: points that are captured, counted and drawn.

#include "executor_fixture.h"

namespace tyndall::gl {
std::span<const EmbeddedShader> executorTestShaders();
}

namespace tyndall::fg {

class ExecutorPointsTest : public ExecutorTest {
protected:
    gl::ShaderLibraryOptions libraryOptions() override {
        return {.embedded = gl::executorTestShaders()};
    }
    /// A buffer of the frame with this content.
    template <typename T> BufferHandle uploaded(const char* name, const std::vector<T>& values) {
        struct Upload {
            BufferHandle out;
            const T* data;
            size_t bytes;
        };
        const size_t bytes = values.size() * sizeof(T);
        return graph()
            .addPass<Upload>(
                name,
                [&](Builder& b, Upload& d) {
                    d.out = b.create(name, BufferDesc{bytes}, Access::TransferWrite);
                    d.data = values.data();
                    d.bytes = bytes;
                },
                [](const Upload& d, PassContext& c) { c.upload(d.out, 0, d.data, d.bytes); })
            .out;
    }
    static RasterState points() {
        RasterState state;
        state.topology = Topology::Points;
        return state;
    }
};

} // namespace tyndall::fg
