#include "shaders/lighting_compute.h"

#include <stdexcept>

#include "gl/api.h"
#include "gl/buffer.h"

namespace tyndall::test {
namespace {

std::string sourceOf(const std::vector<std::string>& includes, std::string_view body) {
    std::string text;
    for (const std::string& include : includes) text += "#include \"" + include + "\"\n";
    text +=
        "layout(local_size_x = 32) in;\n"
        "layout(std430) readonly buffer Inputs { vec4 inputs[]; };\n"
        "layout(std430) writeonly buffer Outputs { vec4 outputs[]; };\n"
        "uniform uint invocationCount;\n"
        "void main() {\n    uint id = gl_GlobalInvocationID.x;\n    if (id >= invocationCount) return;\n";
    text += body;
    return text + "\n}\n";
}

void bindStorage(const gl::Program& program, const char* name, const gl::Buffer& buffer) {
    if (const gl::ProgramResource* block = program.find(name))
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(block->binding), buffer.id());
}

} // namespace

std::vector<vec4> runOnGpu(const std::vector<std::string>& includes, std::string_view body,
                           std::span<const vec4> inputs, size_t outputs, uint32_t count,
                           const std::vector<BlockBytes>& blocks) {
    gl::ShaderLibrary library;
    library.addSource("test/table.comp", sourceOf(includes, body));
    Result<const gl::Program*> found = library.compute("test/table.comp");
    if (!found) throw std::runtime_error(found.message());
    const gl::Program& program = **found;
    const vec4 none(0);
    const gl::Buffer input("inputs", inputs.empty() ? std::as_bytes(std::span(&none, 1))
                                                    : std::as_bytes(inputs));
    gl::Buffer output("outputs", outputs * sizeof(vec4));
    output.clear();
    std::vector<gl::Buffer> uniforms;
    glUseProgram(program.id());
    for (const BlockBytes& block : blocks) {
        uniforms.emplace_back(block.name, block.bytes);
        if (const gl::ProgramResource* resource = program.find(block.name))
            glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(resource->binding), uniforms.back().id());
    }
    bindStorage(program, "Inputs", input);
    bindStorage(program, "Outputs", output);
    program.set("invocationCount", count);
    glDispatchCompute((count + 31) / 32, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glUseProgram(0);
    return output.readAll<vec4>();
}

} // namespace tyndall::test
