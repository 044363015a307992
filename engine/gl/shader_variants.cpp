#include "gl/shader_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "gl/program.h"

namespace tyndall::gl {
namespace {

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> parts;
    size_t begin = 0;
    while (begin <= text.size()) {
        const size_t end = std::min(text.find_first_of(separators, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

Result<int32_t> parseWhole(std::string_view text) {
    int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && !text.empty()) return value;
    return Error{fmt::format("'{}' is no whole number", text)};
}

Result<VariantLine::Define> parseDefine(std::string_view word) {
    const size_t equals = word.find('=');
    VariantLine::Define define{std::string(word.substr(0, equals)), {}};
    if (define.name.empty()) return Error{fmt::format("'{}' has no name: write NAME=0,1", word)};
    for (std::string_view text : split(word.substr(equals + 1), ",")) {
        const Result<int32_t> value = parseWhole(text);
        if (!value) return Error{fmt::format("'{}': {}: write NAME=0,1", word, value.message())};
        define.values.push_back(*value);
    }
    return define;
}

Result<VariantLine> parseLine(std::string_view text, int number) {
    VariantLine line;
    line.line = number;
    for (std::string_view word : split(text, " \t\r")) {
        if (word.empty()) continue;
        if (word.find('=') == std::string_view::npos) {
            if (Result<GLenum> stage = stageOfFile(word); !stage) return stage.error();
            if (!line.defines.empty())
                return Error{
                    fmt::format("'{}' stands after the defines: shaders come first", word)};
            line.files.emplace_back(word);
            continue;
        }
        Result<VariantLine::Define> define = parseDefine(word);
        if (!define) return define.error();
        if (std::ranges::find(line.defines, define->name, &VariantLine::Define::name) !=
            line.defines.end())
            return Error{fmt::format(
                "'{}' is there twice: write its values once, separated by commas", define->name)};
        line.defines.push_back(std::move(*define));
    }
    if (line.files.empty() && !line.defines.empty())
        return Error{"there is no shader before the defines"};
    return line;
}

bool matches(const VariantLine& line, const ProgramRequest& request) {
    if (line.files != request.files || line.defines.size() != request.defines.size()) return false;
    return std::ranges::all_of(request.defines, [&](const ShaderDefine& define) {
        const auto found = std::ranges::find(line.defines, define.name, &VariantLine::Define::name);
        return found != line.defines.end() &&
               std::ranges::find(found->values, define.value) != found->values.end();
    });
}

} // namespace

std::string ProgramRequest::describe() const {
    std::vector<ShaderDefine> sorted = defines;
    std::ranges::sort(sorted, {}, &ShaderDefine::name);
    std::string text;
    for (const std::string& file : files) text += (text.empty() ? "" : " ") + file;
    for (const ShaderDefine& define : sorted)
        text += fmt::format(" {}={}", define.name, define.value);
    return text;
}

Result<VariantList> VariantList::parse(std::string_view text, std::string_view name) {
    VariantList list;
    int number = 0;
    for (std::string_view full : split(text, "\n")) {
        ++number;
        Result<VariantLine> line = parseLine(full.substr(0, full.find('#')), number);
        if (!line) return Error{fmt::format("{}:{}: {}", name, number, line.message())};
        if (!line->files.empty()) list.lines_.push_back(std::move(*line));
    }
    return list;
}

bool VariantList::contains(const ProgramRequest& request) const {
    return std::ranges::any_of(lines_,
                               [&](const VariantLine& line) { return matches(line, request); });
}

void VariantList::forEachVariant(const std::function<void(const ProgramRequest&)>& visit) const {
    for (const VariantLine& line : lines_) {
        std::vector<size_t> choice(line.defines.size(), 0); // counts up like an odometer
        while (true) {
            ProgramRequest request{line.files, {}};
            for (size_t i = 0; i < choice.size(); ++i)
                request.defines.push_back(
                    {line.defines[i].name, line.defines[i].values[choice[i]]});
            visit(request);
            size_t digit = 0;
            while (digit < choice.size() && ++choice[digit] == line.defines[digit].values.size())
                choice[digit++] = 0;
            if (digit == choice.size()) break;
        }
    }
}

} // namespace tyndall::gl
