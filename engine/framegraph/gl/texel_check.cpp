#include "framegraph/gl/texel_check.h"

#include "core/check.h"

namespace tyndall::fg {

void TexelCheck::begin(size_t passCount) {
    passCount_ = passCount;
    const uint64_t bytes = std::max<size_t>(passCount, 1) * sizeof(Counts);
    if (!counts_ || counts_.bytes() < bytes) counts_ = gl::Buffer("texel counts", bytes);
    counts_.clear(0);
}

Result<void> TexelCheck::add(ProgramCache& programs, const gl::Texture& texture, bool countNegative,
                             size_t pass) {
    const gl::TextureSpec& spec = texture.spec();
    const int kind = spec.target == GL_TEXTURE_3D ? 2 : spec.target == GL_TEXTURE_2D_ARRAY ? 1 : 0;
    const Define defines[] = {{"KIND", kind}};
    const char* const files[] = {"common/count_invalid.comp"};
    Result<const gl::Program*> found = programs.find("texel check", files, defines);
    if (!found.ok()) return found.error();
    const gl::Program& program = **found;
    const gl::ProgramResource* image = program.find("image");
    const gl::ProgramResource* counts = program.find("Counts");
    CHECK(image != nullptr && counts != nullptr,
          "common/count_invalid.comp lacks 'image' or 'Counts'");
    // What the pass wrote by shaders must be seen, and the counters be cleared.
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glUseProgram(program.id());
    glBindTextureUnit(GLuint(image->binding), texture.id());
    glBindSampler(GLuint(image->binding), 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(counts->binding), counts_.id());
    program.set("countNegative", countNegative ? 1 : 0);
    program.set("passIndex", int32_t(pass));
    for (int mip = 0; mip < spec.mips; ++mip) {
        const gl::TextureRegion size = texture.mipRegion(mip);
        program.set("level", mip);
        glDispatchCompute(GLuint(size.width + 7) / 8, GLuint(size.height + 7) / 8,
                          GLuint(size.depth));
    }
    return {};
}

const std::vector<TexelCheck::Counts>& TexelCheck::read() {
    values_.assign(passCount_, {});
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (passCount_ > 0) counts_.read(0, values_.data(), passCount_ * sizeof(Counts));
    return values_;
}

} // namespace tyndall::fg
