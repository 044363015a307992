#pragma once
// Linked programs that know their resources by name.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "core/result.h"
#include "gl/object.h"
#include "gl/shader_source.h"

namespace tyndall::gl {

enum class ResourceKind : uint32_t {
    UniformBlock = 0,
    StorageBlock = 1,
    Sampler = 2,
    Image = 3,
    Uniform = 4, // a plain variable outside blocks
};
const char* resourceKindName(ResourceKind kind);

/// A variable inside a block, as the driver laid it out.
struct BlockMember {
    std::string name; // as GL names it: "view.size", "lights[0].position"
    GLenum type = 0;
    int offset = 0;       // bytes
    int arraySize = 1;    // 0: unbounded
    int arrayStride = 0;  // bytes
    int matrixStride = 0; // bytes
    int topLevelStride =
        0; // bytes between elements of the block's outer array; storage blocks only
};

/// Something that a program reads or writes.
struct ProgramResource {
    ResourceKind kind = ResourceKind::Uniform;
    std::string name; // without "[0]"
    int binding =
        -1; // binding point (blocks), first texture unit, first image unit; assigned by link order, from 0 per kind
    int location = -1;                // samplers, images, uniforms
    GLenum type = 0;                  // GL_SAMPLER_2D, GL_FLOAT … ; 0 for blocks
    int count = 1;                    // elements of an array
    int64_t bytes = 0;                // of a block without its unbounded array
    std::vector<BlockMember> members; // of a block
};

/// The source of one stage.
struct StageSource {
    GLenum stage = GL_COMPUTE_SHADER;
    ExpandedShader shader;
};
/// From the ending: .comp .vert .frag .geom .tesc .tese. Errors: another ending.
Result<GLenum> stageOfFile(std::string_view path);

/// A linked program. Bindings of everything it uses are assigned already; nothing is found by a number in a shader.
/// Empty when moved from.
class Program {
public:
    Program() = default;
    /// Compiles and links. Errors: the driver's messages, with files and lines; transform feedback into another buffer
    /// than the one with the number 0.
    static Result<Program> build(std::string_view name, std::span<const StageSource> stages);

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] const std::string& name() const { return name_; }
    explicit operator bool() const { return bool(object_); }
    /// Invocations of a group; zero for raster programs.
    [[nodiscard]] uvec3 localSize() const { return localSize_; }
    [[nodiscard]] bool isCompute() const { return localSize_.x > 0; }
    /// False where the program ends before rasterisation, or leaves only depth.
    [[nodiscard]] bool hasFragments() const { return hasFragments_; }
    /// What its tessellation makes of patches: GL_POINTS, GL_LINES or GL_TRIANGLES; nothing where it has none.
    [[nodiscard]] std::optional<GLenum> tessellatesTo() const { return tessellatesTo_; }
    /// Bytes that transform feedback captures of a vertex, as the shader's xfb qualifiers say; 0: it captures nothing.
    [[nodiscard]] int captureStride() const { return captureStride_; }

    /// What the driver's compiler remarked, with files and lines; empty where it had nothing to say.
    [[nodiscard]] const std::string& warnings() const { return warnings_; }

    /// Everything active, in the driver's order.
    [[nodiscard]] std::span<const ProgramResource> resources() const { return resources_; }
    /// Null where the program has no such active resource.
    [[nodiscard]] const ProgramResource* find(std::string_view name) const;
    /// True when the source has this identifier anywhere: what is bound to a name that was optimised away is no
    /// mistake.
    [[nodiscard]] bool mentions(std::string_view identifier) const;

    /// Sets a plain uniform; does nothing where it is not active.
    void set(std::string_view uniform, int32_t value) const;
    void set(std::string_view uniform, uint32_t value) const;
    void set(std::string_view uniform, float value) const;

private:
    friend class PendingProgram;
    Object object_;
    std::string name_;
    std::string warnings_;
    uvec3 localSize_{0};
    bool hasFragments_ = false;
    std::optional<GLenum> tessellatesTo_;
    int captureStride_ = 0; // bytes
    std::vector<ProgramResource> resources_;
    std::vector<uint64_t> identifiers_; // hashes, sorted
};

/// A program that the driver is compiling, perhaps on threads of its own (GL_KHR_parallel_shader_compile). Empty when
/// moved from.
class PendingProgram {
public:
    PendingProgram() = default;
    PendingProgram(std::string_view name, std::span<const StageSource> stages);
    PendingProgram(PendingProgram&&) noexcept = default;
    PendingProgram& operator=(PendingProgram&&) noexcept;
    ~PendingProgram();

    /// True when finish() would not wait; always true without the extension. Never waits.
    [[nodiscard]] bool ready() const;
    /// Waits for the driver; the pending program is empty afterwards. Errors as Program::build.
    Result<Program> finish();

private:
    struct Stage {
        GLuint shader = 0;
        ExpandedShader source;
    };
    Result<void> checkStages() const;
    void describeStages(Program& program) const;
    void deleteShaders();
    std::string name_;
    std::vector<Stage> stages_;
    Object object_;
};

} // namespace tyndall::gl
