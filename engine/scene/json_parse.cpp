#include "scene/json_parse.h"

#include <algorithm>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tyndall {
namespace {

struct Place {
    size_t line = 1, column = 1;
};

Place placeOf(std::string_view text, size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    Place place;
    place.line += size_t(std::count(before.begin(), before.end(), '\n'));
    place.column +=
        before.size() - (before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1);
    return place;
}

/// The byte at which brackets nest too deeply, or npos. Strings are skipped; the parser judges everything else.
size_t tooDeepAt(std::string_view text) {
    int depth = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') {
            for (++i; i < text.size() && text[i] != '"'; ++i)
                if (text[i] == '\\') ++i;
        } else if (c == '[' || c == '{') {
            if (++depth > kMaxJsonDepth) return i;
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return std::string_view::npos;
}

/// Finds a key that an object has twice, which the parser would let pass. A pass of its own: the parser's callback would
/// do it in one, but takes quadratic time on long arrays of objects.
class DuplicateFinder : public nlohmann::json_sax<Json> {
public:
    bool start_object(std::size_t) override {
        open_.emplace_back();
        return true;
    }
    bool end_object() override {
        open_.pop_back();
        return true;
    }
    bool key(std::string& name) override {
        if (open_.back().insert(name).second) return true;
        duplicate = name;
        return false; // ends the pass
    }
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const std::string&) override { return true; }
    bool string(std::string&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;
    }

    std::string duplicate;

private:
    std::vector<std::unordered_set<std::string>> open_;
};

/// The library's message without its own prefix and its guess at the place.
std::string reason(const char* what) {
    std::string text = what;
    const size_t syntax = text.find("syntax error");
    if (syntax != std::string::npos)
        text = text.substr(syntax);
    else if (const size_t bracket = text.find("] "); bracket != std::string::npos)
        text = text.substr(bracket + 2);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
    return text.substr(0, 300);
}

} // namespace

Result<Json> parseJson(std::string_view text) {
    if (const size_t deep = tooDeepAt(text); deep != std::string_view::npos) {
        const Place place = placeOf(text, deep);
        return Error{fmt::format("line {}, column {}: JSON nests deeper than {} levels", place.line,
                                 place.column, kMaxJsonDepth)};
    }
    try {
        Json json = Json::parse(text.begin(), text.end());
        DuplicateFinder finder;
        Json::sax_parse(text.begin(), text.end(), &finder);
        if (!finder.duplicate.empty())
            return Error{fmt::format("key '{}' stands twice in one JSON object",
                                     finder.duplicate.substr(0, 60))};
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        const Place place = placeOf(text, error.byte == 0 ? 0 : error.byte - 1);
        return Error{fmt::format("line {}, column {}: not valid JSON: {}", place.line, place.column,
                                 reason(error.what()))};
    } catch (const nlohmann::json::exception& error) {
        return Error{fmt::format("not valid JSON: {}", reason(error.what()))};
    }
}

} // namespace tyndall
