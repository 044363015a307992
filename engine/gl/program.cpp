#include "gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gl/context.h"
#include "gl/program_reflection.h"

namespace tyndall::gl {
namespace {

uint64_t hashOf(std::string_view text) {
    uint64_t hash = 14695981039346656037ull; // FNV-1a
    for (char c : text) hash = (hash ^ uint64_t(static_cast<unsigned char>(c))) * 1099511628211ull;
    return hash;
}

bool isWordCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

void collectIdentifiers(std::string_view text, std::vector<uint64_t>& hashes) {
    for (size_t i = 0; i < text.size();) {
        if (!isWordCharacter(text[i])) {
            ++i;
            continue;
        }
        size_t end = i;
        while (end < text.size() && isWordCharacter(text[end])) ++end;
        hashes.push_back(hashOf(text.substr(i, end - i)));
        i = end;
    }
}

template <typename GetLength, typename GetText>
std::string driverLog(GLuint id, GetLength getLength, GetText getText) {
    GLint length = 0;
    getLength(id, GL_INFO_LOG_LENGTH, &length);
    std::string text(size_t(std::max(length, 1)), '\0');
    GLsizei written = 0;
    getText(id, GLsizei(text.size()), &written, text.data());
    text.resize(size_t(written));
    return text;
}

} // namespace

const char* resourceKindName(ResourceKind kind) {
    static constexpr const char* kNames[] = {"uniform block", "storage block", "sampler", "image",
                                             "uniform"};
    return kNames[size_t(kind)];
}

Result<GLenum> stageOfFile(std::string_view path) {
    static constexpr std::pair<std::string_view, GLenum> kEndings[] = {
        {".comp", GL_COMPUTE_SHADER},      {".vert", GL_VERTEX_SHADER},
        {".frag", GL_FRAGMENT_SHADER},     {".geom", GL_GEOMETRY_SHADER},
        {".tesc", GL_TESS_CONTROL_SHADER}, {".tese", GL_TESS_EVALUATION_SHADER}};
    for (const auto& [ending, stage] : kEndings)
        if (path.ends_with(ending)) return stage;
    return Error{fmt::format(
        "shader '{}' has no stage: its name must end in .comp, .vert, .frag, .geom, .tesc or .tese",
        path)};
}

PendingProgram::PendingProgram(std::string_view name, std::span<const StageSource> stages)
    : name_(name) {
    CHECK(!stages.empty(), fmt::format("program '{}' has no stage", name));
    for (const StageSource& stage : stages) {
        const GLuint shader = glCreateShader(stage.stage);
        const char* text = stage.shader.text.c_str();
        const auto length = GLint(stage.shader.text.size());
        glShaderSource(shader, 1, &text, &length);
        glCompileShader(shader);
        stages_.push_back({shader, stage.shader});
    }
    // Linking is asked for at once, without looking at the compilation first, so that the driver can do both on its
    // threads.
    object_ = Object(ObjectKind::Program, glCreateProgram());
    for (const Stage& stage : stages_) glAttachShader(object_.id(), stage.shader);
    glLinkProgram(object_.id());
}

PendingProgram& PendingProgram::operator=(PendingProgram&& other) noexcept {
    if (this == &other) return *this;
    deleteShaders();
    name_ = std::move(other.name_);
    stages_ = std::exchange(other.stages_, {});
    object_ = std::move(other.object_);
    return *this;
}

PendingProgram::~PendingProgram() { deleteShaders(); }

void PendingProgram::deleteShaders() {
    if (hasCurrentContext() && object_) {
        for (const Stage& stage : stages_) {
            glDetachShader(object_.id(), stage.shader);
            glDeleteShader(stage.shader);
        }
    }
    stages_.clear();
}

bool PendingProgram::ready() const {
    if (!object_ || !currentCapabilities().has("GL_KHR_parallel_shader_compile")) return true;
    GLint done = GL_FALSE;
    glGetProgramiv(object_.id(), GL_COMPLETION_STATUS_KHR, &done);
    return done == GL_TRUE;
}

Result<void> PendingProgram::checkStages() const {
    for (const Stage& stage : stages_) {
        GLint compiled = GL_FALSE;
        glGetShaderiv(stage.shader, GL_COMPILE_STATUS, &compiled);
        if (compiled) continue;
        const std::string log = driverLog(stage.shader, glGetShaderiv, glGetShaderInfoLog);
        return Error{fmt::format("shader '{}' does not compile:\n{}", name_,
                                 mapShaderMessages(log, stage.source))};
    }
    return {};
}

/// What `program` knows of its stages one by one.
void PendingProgram::describeStages(Program& program) const {
    for (const Stage& stage : stages_) {
        GLint type = 0;
        glGetShaderiv(stage.shader, GL_SHADER_TYPE, &type);
        collectIdentifiers(stage.source.text, program.identifiers_);
        const std::string remarks = mapShaderMessages(
            driverLog(stage.shader, glGetShaderiv, glGetShaderInfoLog), stage.source);
        if (!remarks.empty())
            program.warnings_ += (program.warnings_.empty() ? "" : "\n") + remarks;
        if (GLenum(type) == GL_FRAGMENT_SHADER) program.hasFragments_ = true;
        if (GLenum(type) == GL_TESS_EVALUATION_SHADER)
            program.tessellatesTo_ = tessellatedPrimitive(object_.id());
        if (GLenum(type) != GL_COMPUTE_SHADER) continue;
        GLint size[3] = {};
        glGetProgramiv(object_.id(), GL_COMPUTE_WORK_GROUP_SIZE, size);
        program.localSize_ = uvec3(size[0], size[1], size[2]);
    }
    std::ranges::sort(program.identifiers_);
    program.identifiers_.erase(std::ranges::unique(program.identifiers_).begin(),
                               program.identifiers_.end());
}

Result<Program> PendingProgram::finish() {
    CHECK(object_, "finish() of an empty PendingProgram");
    PendingProgram self = std::move(*this);
    if (Result<void> compiled = self.checkStages(); !compiled) return compiled.error();
    GLint linked = GL_FALSE;
    glGetProgramiv(self.object_.id(), GL_LINK_STATUS, &linked);
    if (!linked) {
        const std::string log = driverLog(self.object_.id(), glGetProgramiv, glGetProgramInfoLog);
        return Error{fmt::format("shader '{}' does not link:\n{}", self.name_,
                                 mapShaderMessages(log, self.stages_.front().source))};
    }
    Program program;
    program.name_ = self.name_;
    program.resources_ = reflectAndBind(self.object_.id());
    if (Result<void> limits = checkBindingLimits(self.name_, program.resources_); !limits)
        return limits.error();
    const Result<int> stride = captureStride(self.name_, self.object_.id());
    if (!stride) return stride.error();
    program.captureStride_ = *stride;
    self.describeStages(program);
    self.deleteShaders();
    program.object_ = std::move(self.object_);
    program.object_.label(program.name_);
    return program;
}

Result<Program> Program::build(std::string_view name, std::span<const StageSource> stages) {
    return PendingProgram(name, stages).finish();
}

const ProgramResource* Program::find(std::string_view name) const {
    for (const ProgramResource& resource : resources_)
        if (resource.name == name) return &resource;
    return nullptr;
}

bool Program::mentions(std::string_view identifier) const {
    return std::ranges::binary_search(identifiers_, hashOf(identifier));
}

void Program::set(std::string_view uniform, int32_t value) const {
    if (const ProgramResource* found = find(uniform))
        glProgramUniform1i(id(), found->location, value);
}
void Program::set(std::string_view uniform, uint32_t value) const {
    if (const ProgramResource* found = find(uniform))
        glProgramUniform1ui(id(), found->location, value);
}
void Program::set(std::string_view uniform, float value) const {
    if (const ProgramResource* found = find(uniform))
        glProgramUniform1f(id(), found->location, value);
}

} // namespace tyndall::gl
