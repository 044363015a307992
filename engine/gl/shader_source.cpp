#include "gl/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <regex>

namespace tyndall::gl {
namespace {

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// `# name rest` split up; an empty name for any other line.
struct Directive {
    std::string_view name, rest;
};
Directive parseDirective(std::string_view line) {
    line = trimmed(line);
    if (line.empty() || line.front() != '#') return {};
    line = trimmed(line.substr(1));
    const size_t end = line.find_first_of(" \t\"<(/");
    if (end == std::string_view::npos) return {line, {}};
    return {line.substr(0, end), trimmed(line.substr(end))};
}

std::string_view firstWord(std::string_view text) {
    return text.substr(0, text.find_first_of(" \t/"));
}

/// Does `line` end inside a /* comment that began inside it or before?
bool endsInComment(std::string_view line, bool inside) {
    for (size_t i = 0; i < line.size(); ++i) {
        const std::string_view two = line.substr(i, 2);
        if (inside) {
            if (two == "*/") {
                inside = false;
                ++i;
            }
        } else if (two == "//") {
            return false;
        } else if (two == "/*") {
            inside = true;
            ++i;
        }
    }
    return inside;
}

std::vector<std::string_view> splitLines(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const size_t end = text.find('\n');
        lines.push_back(text.substr(0, end));
        if (end == std::string_view::npos) break;
        text.remove_prefix(end + 1);
    }
    return lines;
}

/// What is known of an #if … #endif that is open.
enum class Branch : uint32_t {
    Certain = 0, // an include guard: its lines count, the first time
    Unknown = 1, // the driver decides
    Cpp = 2,     // for C++ only: left out
};

class Expander {
public:
    explicit Expander(const ReadShader& read) : read_(read) {}

    Result<void> addFile(const std::string& path, const std::string& from) {
        if (std::ranges::find(stack_, path) != stack_.end()) {
            std::string chain;
            for (auto it = std::ranges::find(stack_, path); it != stack_.end(); ++it)
                chain += *it + " -> ";
            return Error{fmt::format("{}: includes go round in a circle: {}{}", from, chain, path)};
        }
        const size_t number = numberOf(path);
        const std::optional<std::string> text = read_(path);
        if (!text)
            return Error{from.empty() ? fmt::format("shader '{}' does not exist", path)
                                      : fmt::format("{}: no shader file '{}'", from, path)};
        stack_.push_back(path);
        addLineDirective(number, 1);
        const std::vector<std::string_view> lines = splitLines(*text);
        std::vector<Branch> branches;
        bool inComment = false;
        for (size_t i = 0; i < lines.size(); ++i) {
            const Directive directive = inComment ? Directive{} : parseDirective(lines[i]);
            inComment = endsInComment(lines[i], inComment);
            if (Result<void> added = addLine(lines, i, directive, branches, number, path); !added)
                return added;
        }
        stack_.pop_back();
        return {};
    }

    std::string out_;
    std::vector<std::string> files_;

private:
    size_t numberOf(const std::string& path) {
        const auto found = std::ranges::find(files_, path);
        if (found != files_.end()) return size_t(found - files_.begin());
        files_.push_back(path);
        return files_.size() - 1;
    }

    /// The next line is line `line` of file `number`.
    void addLineDirective(size_t number, size_t line) {
        out_ += fmt::format("#line {}\n", number * kLinesPerFile + line);
    }

    static void follow(const Directive& directive, std::span<const std::string_view> following,
                       std::vector<Branch>& branches) {
        const std::string_view word = firstWord(directive.rest);
        if (directive.name == "ifdef") {
            branches.push_back(word == "__cplusplus" ? Branch::Cpp : Branch::Unknown);
        } else if (directive.name == "ifndef") {
            const Directive next =
                following.empty() ? Directive{} : parseDirective(following.front());
            const bool guard =
                word == "__cplusplus" || (next.name == "define" && firstWord(next.rest) == word);
            branches.push_back(guard ? Branch::Certain : Branch::Unknown);
        } else if (directive.name == "if") {
            branches.push_back(Branch::Unknown);
        } else if (branches.empty()) {
            return; // a stray #else or #endif: the driver complains about it
        } else if (directive.name == "else" || directive.name == "elif") {
            branches.back() = branches.back() == Branch::Cpp ? Branch::Certain : Branch::Unknown;
        } else if (directive.name == "endif") {
            branches.pop_back();
        }
    }

    Result<void> addLine(std::span<const std::string_view> lines, size_t i,
                         const Directive& directive, std::vector<Branch>& branches, size_t number,
                         const std::string& path) {
        const bool wasCpp = std::ranges::find(branches, Branch::Cpp) != branches.end();
        follow(directive, lines.subspan(i + 1), branches);
        const bool isCpp = std::ranges::find(branches, Branch::Cpp) != branches.end();
        const bool isDirectiveOfBranch = wasCpp != isCpp;
        if (isCpp && !isDirectiveOfBranch) {
            out_ += '\n';
            return {};
        }
        if (directive.name != "include") {
            out_ += lines[i];
            out_ += '\n';
            return {};
        }
        const std::string place = fmt::format("{}:{}", path, i + 1);
        const size_t close =
            directive.rest.size() < 2 ? std::string_view::npos : directive.rest.find('"', 1);
        if (directive.rest.empty() || directive.rest.front() != '"' ||
            close == std::string_view::npos)
            return Error{fmt::format(
                "{}: '{}' is no include: write #include \"folder/file.glsl\", relative to shaders/",
                place, trimmed(lines[i]))};
        const bool certain = std::ranges::find(branches, Branch::Unknown) == branches.end() &&
                             uncertainIncludes_ == 0;
        if (Result<void> added =
                include(std::string(directive.rest.substr(1, close - 1)), place, certain);
            !added)
            return added;
        addLineDirective(number, i + 2);
        return {};
    }

    /// Once is enough, but only the driver knows whether an earlier copy in some #if was taken: it gets a guard to
    /// decide by.
    Result<void> include(const std::string& path, const std::string& from, bool certain) {
        const bool onStack = std::ranges::find(stack_, path) != stack_.end();
        if (!onStack && std::ranges::find(taken_, path) != taken_.end()) return {};
        const size_t number = numberOf(path);
        out_ += fmt::format("#ifndef TYNDALL_INCLUDED_{0}\n#define TYNDALL_INCLUDED_{0}\n", number);
        if (certain) taken_.push_back(path);
        if (!certain) ++uncertainIncludes_;
        Result<void> added = addFile(path, from);
        if (!certain) --uncertainIncludes_;
        out_ += "#endif\n";
        return added;
    }

    const ReadShader& read_;
    std::vector<std::string> stack_; // files being expanded, outermost first
    std::vector<std::string> taken_; // files that are in the text for sure
    int uncertainIncludes_ = 0;      // open includes that stand in an #if
};

} // namespace

Result<ExpandedShader> expandShader(const std::string& path, std::span<const ShaderDefine> defines,
                                    const ReadShader& read) {
    Expander expander(read);
    expander.out_ = "#version 450 core\n";
    for (const ShaderDefine& define : defines)
        expander.out_ += fmt::format("#define {} {}\n", define.name, define.value);
    if (Result<void> added = expander.addFile(path, {}); !added) return added.error();
    return ExpandedShader{std::move(expander.out_), std::move(expander.files_)};
}

std::string mapShaderMessages(std::string_view driverLog, const ExpandedShader& shader) {
    // Mesa: "0:12(5): error: …"; NVIDIA: "0(12) : error C1008: …"; others: "ERROR: 0:12: …". The first number is the
    // source's.
    static const std::regex kMesa(R"(^\d+:(\d+)\((\d+)\):\s*(.*)$)");
    static const std::regex kNvidia(R"(^\d+\((\d+)\)\s*:\s*(.*)$)");
    static const std::regex kOthers(R"(^(ERROR|WARNING):\s*\d+:(\d+):\s*(.*)$)");
    const auto place = [&](const std::string& number) {
        size_t line = 0;
        std::from_chars(number.data(), number.data() + number.size(), line);
        const size_t file = line / kLinesPerFile;
        return file < shader.files.size()
                   ? fmt::format("{}:{}", shader.files[file], line % kLinesPerFile)
                   : "line " + number;
    };
    std::string mapped;
    for (std::string_view view : splitLines(driverLog)) {
        const std::string line(trimmed(view));
        if (line.empty() || line.front() == '\0') continue;
        if (!mapped.empty()) mapped += '\n';
        std::smatch match;
        if (std::regex_match(line, match, kMesa))
            mapped += fmt::format("{}:{}: {}", place(match[1]), match[2].str(), match[3].str());
        else if (std::regex_match(line, match, kNvidia))
            mapped += fmt::format("{}: {}", place(match[1]), match[2].str());
        else if (std::regex_match(line, match, kOthers))
            mapped += fmt::format("{}: {}: {}", place(match[2]), match[1].str(), match[3].str());
        else
            mapped += line;
    }
    return mapped;
}

} // namespace tyndall::gl
