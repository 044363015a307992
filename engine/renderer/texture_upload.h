#pragma once
// Images as material textures: mip chains in sRGB or linear interpretation, with the samplers that glTF asks for.

#include <array>
#include <map>
#include <tuple>

#include "core/result.h"
#include "framegraph/gl/executor.h"
#include "gl/sampler.h"
#include "scene/scene.h"

namespace tyndall {

enum class ColorSpace : int32_t { Linear = 0, Srgb = 1 };

gl::SamplerSpec samplerSpec(const Sampler& sampler, float anisotropy);

/// For each mip level of `image` the alpha above which as large a part of it lies as lies above `cutoff` in level 0: with it
/// alpha-tested foliage keeps its area at every distance. Levels past the last repeat it.
std::array<float, 16> alphaCutoffs(const ImageData& image, float cutoff);

class TextureUpload {
public:
    explicit TextureUpload(fg::Executor& executor);
    ~TextureUpload();
    TextureUpload(const TextureUpload&) = delete;
    TextureUpload& operator=(const TextureUpload&) = delete;

    /// 1 to 16. Takes effect after forget().
    void setAnisotropy(float anisotropy) { anisotropy_ = anisotropy; }
    [[nodiscard]] float anisotropy() const { return anisotropy_; }
    /// Texture `index` of the scene; white for kNone and for textures without a decoded image.
    /// What is larger than the driver takes is scaled down, with a warning. Error: no room on the GPU.
    Result<fg::StaticTexture> obtain(const Scene& scene, int index, ColorSpace space);
    /// Releases everything: the scene's images changed.
    void forget();
    [[nodiscard]] fg::StaticTexture white() const { return white_; }

private:
    using SamplerKey = std::tuple<int, int, int, int, int>;
    using Key = std::tuple<int, ColorSpace, SamplerKey>; // image
    Result<fg::StaticTexture> uploadImage(const ImageData& image, ColorSpace space,
                                          const gl::SamplerSpec& sampler);

    fg::Executor& executor_;
    float anisotropy_ = 1;
    fg::StaticTexture white_;
    std::map<Key, fg::StaticTexture> textures_;
};

} // namespace tyndall
