#pragma once
// Which programs C++ may ask for: the list in shaders/variants.txt. One program a line:
//
//   # a comment
//   media/march.comp EXACT=0,1 OCTAVES=0,1
//   gbuffer/gbuffer.vert gbuffer/gbuffer.frag MASK=0,1
//
// is four variants of one and two of the other. A program that exists only with certain combinations has several lines.
// A request names every define of its line, in any order, each with a value of the list.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gl/shader_source.h"

namespace tyndall::gl {

/// A program to be had: its files (one a stage) and defines.
struct ProgramRequest {
    std::vector<std::string> files;
    std::vector<ShaderDefine> defines;

    /// "media/march.comp EXACT=1 OCTAVES=0", defines sorted by name: the program's name and its key.
    [[nodiscard]] std::string describe() const;
};

/// One line of the list.
struct VariantLine {
    struct Define {
        std::string name;
        std::vector<int32_t> values;
    };
    std::vector<std::string> files;
    std::vector<Define> defines;
    int line = 0; // of the list, from 1
};

class VariantList {
public:
    VariantList() = default;
    /// Errors, with `name`, line and what would be right: a line without a shader, a shader whose ending is unknown, a
    /// define without values or with something that is no whole number, the same define twice.
    static Result<VariantList> parse(std::string_view text, std::string_view name);

    [[nodiscard]] std::span<const VariantLine> lines() const { return lines_; }
    [[nodiscard]] bool contains(const ProgramRequest& request) const;
    /// Calls `visit` for every variant of every line.
    void forEachVariant(const std::function<void(const ProgramRequest&)>& visit) const;

private:
    std::vector<VariantLine> lines_;
};

} // namespace tyndall::gl
