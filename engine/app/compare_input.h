#pragma once
// The two sides of a comparison, read from files.

#include <filesystem>
#include <optional>
#include <string>

#include "core/image.h"
#include "core/image_metrics.h"
#include "transport/terms.h"

namespace tyndall {

/// What of a file is compared: its picture, or the sum of some terms, or one layer.
struct ComparedPart {
    TermSet terms = 0; // none: not a sum of terms
    std::string layer; // "": the picture

    /// False for layers such as `depth` or `normal`, which may be negative and have no look.
    [[nodiscard]] bool isLight() const;
    /// "the picture", "LE + LSE", "layer 'depth'".
    [[nodiscard]] std::string text() const;
};

struct ComparedImage {
    std::string file;
    Image image;                   // grey or RGB; alpha is left out
    bool displayReferred = false;  // a PNG: sRGB-encoded values in [0,1]
    std::optional<Image> variance; // of each value of the image
    std::string whyNoVariance;
    ImageMetadata metadata;
    ValueCounts counts;
    std::string
        firstInvalid; // where the first value is that light cannot have; "" where there is none
};

/// Reads an .exr, .hdr or .png. Errors: an unreadable file or one of another kind; a part that is not in it (the sentence
/// tells what is).
Result<ComparedImage> readCompared(const std::filesystem::path& path, const ComparedPart& part);

/// Averages of squares of pixels, so that the image becomes as large as `reference`. Errors: it is not so many times as large in both directions; a PNG,
/// whose values cannot be averaged.
Result<void> reduceTo(const ComparedImage& reference, ComparedImage& image);

} // namespace tyndall
