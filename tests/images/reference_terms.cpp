#include "reference_terms.h"

#include <stdexcept>

#include "reference/picture_cache.h"

namespace tyndall::test {

ReferenceTerms::ReferenceTerms(const std::string& name) {
    const std::filesystem::path file = sourceDir() / name;
    Result<LoadedScene> loaded = loadScene(file);
    if (!loaded.ok()) throw std::runtime_error(loaded.message());
    loaded_ = std::move(*loaded);
    reference::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    const std::filesystem::path picture =
        sourceDir() / "tests/images/references" /
        reference::pictureName(loaded_.scene, file, loaded_.scene.activeCamera, settings);
    if (!std::filesystem::exists(picture))
        throw std::runtime_error(picture.string() + " is missing: `make references`");
    picture_ = readExr(picture).value();
}

Image ReferenceTerms::sum(TermSet terms) const {
    Image sum(kWidth, kHeight, 3);
    for (const ImageLayer& layer : picture_.layers) {
        const Result<TermSet> term = parseTerms(layer.name);
        if (layer.name.empty() || !term.ok() || (*term & terms) == 0) continue;
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += layer.image.pixels[i];
    }
    return sum;
}

} // namespace tyndall::test
