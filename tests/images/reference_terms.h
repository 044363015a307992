#pragma once
// A scene and its reference picture from tests/images/references, term by term.

#include <string>

#include "core/image.h"
#include "scene/scene_file.h"
#include "support/content.h"
#include "transport/terms.h"

namespace tyndall::test {

class ReferenceTerms {
public:
    static constexpr int kWidth = 96, kHeight = 54;
    /// `file`: from the source's folder. Throws where the scene or the picture is missing.
    explicit ReferenceTerms(const std::string& file);

    [[nodiscard]] const Scene& scene() const { return loaded_.scene; }
    /// Of the layers of these terms.
    [[nodiscard]] Image sum(TermSet terms) const;

private:
    LoadedScene loaded_;
    ExrFile picture_;
};

} // namespace tyndall::test
