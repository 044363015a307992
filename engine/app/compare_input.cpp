#include "app/compare_input.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace tyndall {
namespace fs = std::filesystem;
namespace {

/// The picture's layer has no name, or this one.
bool isPicture(std::string_view layer) { return layer.empty() || layer == "beauty"; }

std::string layerNames(const ExrFile& file) {
    std::string names;
    for (const ImageLayer& layer : file.layers)
        names += (names.empty() ? "" : ", ") + (layer.name.empty() ? "the picture" : layer.name);
    return names;
}

const ImageLayer* findLayer(const ExrFile& file, std::string_view name) {
    for (const ImageLayer& layer : file.layers)
        if (isPicture(name) ? isPicture(layer.name) : layer.name == name) return &layer;
    return nullptr;
}

Result<const ImageLayer*> requireLayer(const fs::path& path, const ExrFile& file,
                                       std::string_view name) {
    if (const ImageLayer* layer = findLayer(file, name)) return layer;
    if (isPicture(name))
        return Error{fmt::format(
            "'{}' has no picture (channels R, G, B or Y, or a layer 'beauty'): there are {}",
            path.string(), layerNames(file))};
    return Error{
        fmt::format("'{}' has no layer '{}': there are {}", path.string(), name, layerNames(file))};
}

/// Grey or RGB: a fourth channel is coverage, not light.
Image withoutAlpha(const Image& image) {
    if (image.channels <= 3) return image;
    Image rgb(image.width, image.height, 3);
    for (size_t i = 0; i < size_t(image.width) * size_t(image.height); ++i)
        std::copy_n(image.pixels.data() + i * size_t(image.channels), 3, rgb.pixels.data() + i * 3);
    return rgb;
}

/// Counts the values of one layer, and keeps the place of the first that light cannot have.
void countLayer(ComparedImage& to, const ImageLayer& layer, const Image& image, bool isLight) {
    const ValueCounts counts = countValues(image);
    to.counts.nonFinite += counts.nonFinite;
    if (isLight) to.counts.negative += counts.negative;
    if (!to.firstInvalid.empty()) return;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const float value = image.pixels[i];
        if (std::isfinite(value) && !(isLight && value < 0)) continue;
        const size_t pixel = i / size_t(image.channels), channel = i % size_t(image.channels);
        to.firstInvalid =
            fmt::format("{} at pixel ({}, {}), channel {}{}", value, pixel % size_t(image.width),
                        pixel / size_t(image.width), image.channels == 1 ? 'Y' : "RGB"[channel],
                        isPicture(layer.name) ? "" : " of layer '" + layer.name + "'");
        return;
    }
}

/// The terms that a layer is the sum of: "LVVE", or "LVVE+LXVVE" where they are rendered as one. None: not of terms.
TermSet termsOfLayer(std::string_view name) {
    TermSet set = 0;
    for (size_t at = 0; at <= name.size();) {
        const size_t end = std::min(name.find('+', at), name.size());
        const Result<TermSet> term = parseTerms(name.substr(at, end - at));
        if (!term.ok() || termNames(*term) != name.substr(at, end - at)) return 0;
        set |= *term;
        at = end + 1;
    }
    return set;
}

/// "'LVVE', 'LXVVE'".
std::string quoted(TermSet set) {
    std::string text;
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (set & bit(Term(i)))
            text += fmt::format("{}'{}'", text.empty() ? "" : ", ", termName(Term(i)));
    return text;
}

/// The layers whose sum the wanted terms are.
Result<std::vector<const ImageLayer*>> layersOfTerms(const fs::path& path, const ExrFile& file,
                                                     TermSet wanted) {
    std::vector<const ImageLayer*> layers;
    TermSet covered = 0;
    for (const ImageLayer& layer : file.layers) {
        const TermSet set = termsOfLayer(layer.name);
        if (!(set & wanted) || (set & covered)) continue;
        if (set & ~wanted)
            return Error{
                fmt::format("--terms: '{}' has {} only in its layer '{}': compare {} together",
                            path.string(), termNames(set & wanted), layer.name, termNames(set))};
        covered |= set;
        layers.push_back(&layer);
    }
    if (const TermSet missing = wanted & ~covered)
        return Error{fmt::format("--terms: '{}' has no layer {}: there are {}", path.string(),
                                 quoted(missing), layerNames(file))};
    return layers;
}

Result<void> addTerms(ComparedImage& to, const fs::path& path, const ExrFile& file, TermSet terms) {
    const Result<std::vector<const ImageLayer*>> layers = layersOfTerms(path, file, terms);
    if (!layers.ok()) return layers.error();
    std::vector<double> sums;
    for (const ImageLayer* layer : *layers) {
        const Image image = withoutAlpha(layer->image);
        countLayer(to, *layer, image, true);
        if (sums.empty()) {
            to.image = Image(image.width, image.height, image.channels);
            sums.resize(image.pixels.size());
        }
        if (sums.size() != image.pixels.size())
            return Error{
                fmt::format("--terms: layer '{}' of '{}' has {} channels, those before it {}",
                            layer->name, path.string(), image.channels, to.image.channels)};
        for (size_t p = 0; p < sums.size(); ++p) sums[p] += double(image.pixels[p]);
    }
    for (size_t p = 0; p < sums.size(); ++p) to.image.pixels[p] = float(sums[p]);
    return {};
}

void addVariance(ComparedImage& to, const fs::path& path, const ExrFile& file,
                 const ComparedPart& part) {
    const ImageLayer* variance = findLayer(file, "variance");
    // A reference of just these terms: their sum is its picture.
    const auto traced = file.metadata.find("tyndall.terms");
    const bool allOfIt =
        part.terms != 0 && traced != file.metadata.end() && traced->second == termNames(part.terms);
    if (!allOfIt && (part.terms != 0 || !isPicture(part.layer)))
        to.whyNoVariance =
            "the layer 'variance' is that of the whole picture, not of " + part.text();
    else if (!variance)
        to.whyNoVariance = fmt::format("'{}' has no layer 'variance'", path.string());
    else
        to.variance = withoutAlpha(variance->image);
}

Result<ComparedImage> readExrPart(const fs::path& path, const ComparedPart& part) {
    const Result<ExrFile> file = readExr(path);
    if (!file.ok()) return file.error();
    ComparedImage compared;
    compared.metadata = file->metadata;
    if (part.terms != 0) {
        if (const Result<void> added = addTerms(compared, path, *file, part.terms); !added.ok())
            return added.error();
    } else {
        const Result<const ImageLayer*> layer = requireLayer(path, *file, part.layer);
        if (!layer.ok()) return Error{(part.layer.empty() ? "" : "--layer: ") + layer.message()};
        compared.image = withoutAlpha((*layer)->image);
        countLayer(compared, **layer, compared.image, part.isLight());
    }
    addVariance(compared, path, *file, part);
    return compared;
}

Result<ComparedImage> readWithoutLayers(const fs::path& path, const ComparedPart& part, bool png) {
    if (part.terms != 0 || !part.layer.empty())
        return Error{fmt::format("{}: '{}' has no layers; give an .exr that has",
                                 part.terms != 0 ? "--terms" : "--layer", path.string())};
    Result<Image> image = png ? readPng(path) : readHdr(path);
    if (!image.ok()) return image.error();
    ComparedImage compared;
    compared.image = std::move(*image);
    compared.displayReferred = png;
    compared.whyNoVariance = fmt::format("'{}' has no layer 'variance'", path.string());
    return compared;
}

} // namespace

bool ComparedPart::isLight() const { return isPicture(layer) || termsOfLayer(layer) != 0; }

std::string ComparedPart::text() const {
    if (terms == 0) return isPicture(layer) ? "the picture" : "layer '" + layer + "'";
    std::string text;
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (terms & bit(Term(i)))
            text += (text.empty() ? "" : " + ") + std::string(termName(Term(i)));
    return text;
}

Result<ComparedImage> readCompared(const fs::path& path, const ComparedPart& part) {
    const std::string extension = lowerExtension(path);
    if (extension != ".exr" && extension != ".hdr" && extension != ".png")
        return Error{fmt::format("'{}' cannot be compared: its name must end in .exr, .hdr or .png",
                                 path.string())};
    Result<ComparedImage> compared = extension == ".exr"
                                         ? readExrPart(path, part)
                                         : readWithoutLayers(path, part, extension == ".png");
    if (compared.ok()) compared->file = path.string();
    return compared;
}

Result<void> reduceTo(const ComparedImage& reference, ComparedImage& image) {
    const Image &wide = image.image, &narrow = reference.image;
    const int factor = narrow.width > 0 ? wide.width / narrow.width : 0;
    if (factor < 1 || wide.width != factor * narrow.width || wide.height != factor * narrow.height)
        return Error{fmt::format(
            "--reduce: '{}' is {}x{} pixels, which is no multiple of the {}x{} of '{}'", image.file,
            wide.width, wide.height, narrow.width, narrow.height, reference.file)};
    if (image.displayReferred)
        return Error{fmt::format(
            "--reduce: '{}' is a PNG, whose values are not light that could be averaged",
            image.file)};
    Image averages(narrow.width, narrow.height, wide.channels);
    const double share = 1.0 / (double(factor) * double(factor));
    for (int y = 0; y < narrow.height; ++y)
        for (int x = 0; x < narrow.width; ++x)
            for (int c = 0; c < wide.channels; ++c) {
                double sum = 0;
                for (int k = 0; k < factor * factor; ++k)
                    sum += double(wide.at(x * factor + k % factor, y * factor + k / factor)[c]);
                averages.at(x, y)[c] = float(sum * share);
            }
    image.image = std::move(averages);
    image.variance.reset();
    image.whyNoVariance = "it was reduced";
    return {};
}

} // namespace tyndall
