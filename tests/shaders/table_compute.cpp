#include "shaders/table_compute.h"

#include <stdexcept>

#include "gl/api.h"

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

} // namespace

void bindStorage(const gl::Program& program, const char* name, const gl::Buffer& buffer) {
    const gl::ProgramResource* block = program.find(name);
    if (block && buffer)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(block->binding), buffer.id());
}

std::vector<vec4> runTable(gl::ShaderLibrary& library, const std::vector<std::string>& includes,
                           std::string_view body, std::span<const vec4> inputs, size_t outputs,
                           uint32_t count, const std::function<void(const gl::Program&)>& bind) {
    const std::string source = sourceOf(includes, body),
                      path = "test/" + std::to_string(std::hash<std::string>{}(source)) + ".comp";
    library.addSource(path, source);
    Result<const gl::Program*> found = library.compute(path);
    if (!found) throw std::runtime_error(found.message());
    const gl::Program& program = **found;
    const vec4 none(0);
    const gl::Buffer input("inputs", inputs.empty() ? std::as_bytes(std::span(&none, 1))
                                                    : std::as_bytes(inputs));
    gl::Buffer output("outputs", outputs * sizeof(vec4));
    output.clear();
    glUseProgram(program.id());
    bind(program);
    bindStorage(program, "Inputs", input);
    bindStorage(program, "Outputs", output);
    program.set("invocationCount", count);
    glDispatchCompute((count + 31) / 32, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glUseProgram(0);
    return output.readAll<vec4>();
}

std::vector<vec4> runOnGpu(const std::vector<std::string>& includes, std::string_view body,
                           std::span<const vec4> inputs, size_t outputs, uint32_t count,
                           const std::vector<BlockBytes>& blocks) {
    gl::ShaderLibrary library;
    std::vector<gl::Buffer> uniforms;
    return runTable(library, includes, body, inputs, outputs, count,
                    [&](const gl::Program& program) {
                        for (const BlockBytes& block : blocks) {
                            uniforms.emplace_back(block.name, block.bytes);
                            if (const gl::ProgramResource* resource = program.find(block.name))
                                glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(resource->binding),
                                                 uniforms.back().id());
                        }
                    });
}

} // namespace tyndall::test
