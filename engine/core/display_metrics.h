#pragma once
// How different two pictures look. Both are RGB as a display gets them: sRGB-encoded, in [0,1], of one size (a CHECK).

#include "core/image.h"

namespace tyndall {

/// Peak signal-to-noise ratio in dB: -10·log10(mean((v-r)²)), over pixels and channels of the encoded values, whose peak is 1.
/// Infinite where the two are equal.
double psnr(const Image& display, const Image& reference);

inline constexpr int kSsimWindow = 11; // pixels a side: what ssim() needs at least

/// Mean structural similarity, 1 where the two are equal. Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from
/// error visibility to structural similarity", IEEE TIP 13(4), 2004, equation 13 with its constants: 11×11 Gaussian windows
/// with a standard deviation of 1.5 pixels, K1 = 0.01, K2 = 0.03, population covariances, windows inside the picture alone.
/// On luma: 0.2126·R' + 0.7152·G' + 0.0722·B' of the encoded values, whose range is 1.
double ssim(const Image& display, const Image& reference);

inline constexpr double kFlipPixelsPerDegree =
    67; // a 0.7 m wide display of 3840 pixels seen from 0.7 m

/// The FLIP error of each pixel, one channel in [0,1]: how much a viewer sees who flips between the two. Andersson, Nilsson,
/// Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: a difference evaluator for alternating images", Proceedings of the
/// ACM on Computer Graphics and Interactive Techniques 3(2), 2020 (LDR-FLIP). Beyond the borders the outermost pixels go on.
Image flipMap(const Image& display, const Image& reference,
              double pixelsPerDegree = kFlipPixelsPerDegree);
/// Its mean over the pixels, the number that is quoted as FLIP.
double flip(const Image& display, const Image& reference,
            double pixelsPerDegree = kFlipPixelsPerDegree);

} // namespace tyndall
