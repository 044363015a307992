#pragma once
// The images of one frame, one a term of light transport (or one a union that a technique computes jointly).

#include <array>

#include "framegraph/handle.h"
#include "transport/plan.h"
#include "transport/terms.h"

namespace tyndall {

/// Three direct ones, and from each technique one a receiver: however the terms are dealt out, each on surfaces has one owner, and each in media
/// one for each of four kinds of media at most.
inline constexpr size_t kMaxTermImages = 3 + 4 + 4 * 4;

struct TermImageHandle {
    TermSet terms = 0;
    fg::TextureHandle image;   // RGBA32F, nits reaching the eye
    int owner = kDirectPasses; // or an index into the techniques, as in FramePlan
};

/// In the order in which they are summed. The first three are LE, LSE and LVE when they are rendered.
struct TermImages {
    std::array<TermImageHandle, kMaxTermImages> images{};
    uint32_t count = 0;
    void add(TermSet terms, fg::TextureHandle image, int owner = kDirectPasses);
    [[nodiscard]] fg::TextureHandle find(Term term) const;
    void replace(Term term, fg::TextureHandle image);
};

} // namespace tyndall
