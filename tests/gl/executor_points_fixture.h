#pragma once
// An executor with the programs of tests/gl/shaders: points that are captured, counted and drawn.

#include <deque>
#include <span>
#include <vector>

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
            const std::byte* data;
            size_t bytes;
        };
        const auto bytes = std::as_bytes(std::span(values));
        const std::vector<std::byte>& kept = kept_.emplace_back(bytes.begin(), bytes.end());
        return graph()
            .addPass<Upload>(
                name,
                [&](Builder& b, Upload& d) {
                    d.out = b.create(name, BufferDesc{kept.size()}, Access::TransferWrite);
                    d.data = kept.data();
                    d.bytes = kept.size();
                },
                [](const Upload& d, PassContext& c) { c.upload(d.out, 0, d.data, d.bytes); })
            .out;
    }
    static RasterState points() {
        RasterState state;
        state.topology = Topology::Points;
        return state;
    }

private:
    std::deque<std::vector<std::byte>> kept_; // passes run after their content was given
};

} // namespace tyndall::fg
