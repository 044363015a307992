#include "core/json_writer.h"

#include <charconv>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace tyndall {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd"; // U+FFFD

/// Bytes of the well-formed UTF-8 sequence (RFC 3629) at the start of `text`; 0 where there is none.
size_t sequenceLength(std::string_view text) {
    const auto at = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    const auto continues = [&](size_t i) { return (at(i) & 0xc0) == 0x80; };
    const uint8_t lead = at(0);
    if (lead < 0x80) return 1;
    if (lead >= 0xc2 && lead <= 0xdf) return continues(1) ? 2 : 0;
    if (lead >= 0xe0 && lead <= 0xef) {
        const bool overlong = lead == 0xe0 && at(1) < 0xa0,
                   surrogate = lead == 0xed && at(1) > 0x9f;
        return continues(1) && continues(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (lead >= 0xf0 && lead <= 0xf4) {
        const bool overlong = lead == 0xf0 && at(1) < 0x90, beyond = lead == 0xf4 && at(1) > 0x8f;
        return continues(1) && continues(2) && continues(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
}

void appendEscaped(std::string& out, char c) {
    constexpr char kHex[] = "0123456789abcdef";
    switch (c) {
    case '"': out += "\\\""; return;
    case '\\': out += "\\\\"; return;
    case '\n': out += "\\n"; return;
    case '\t': out += "\\t"; return;
    case '\r': out += "\\r"; return;
    default: break;
    }
    if (uint8_t(c) < 0x20) {
        out += "\\u00";
        out += kHex[uint8_t(c) >> 4];
        out += kHex[uint8_t(c) & 15];
    } else {
        out += c;
    }
}

} // namespace

std::string jsonString(std::string_view text) {
    std::string out = "\"";
    while (!text.empty()) {
        const size_t length = sequenceLength(text);
        if (length == 1)
            appendEscaped(out, text.front());
        else
            out += length == 0 ? kReplacement : text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out + '"';
}

std::string jsonNumber(double value) {
    if (!std::isfinite(value)) return "null";
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    CHECK(error == std::errc(), "32 characters hold any double in its shortest form");
    return {buffer, end};
}

void JsonWriter::separate() {
    if (afterKey_) {
        afterKey_ = false;
        return;
    }
    if (levels_.empty()) {
        CHECK(text_.empty(), "a JSON text is one value");
        return;
    }
    Level& level = levels_.back();
    const bool first = level.count++ == 0;
    if (level.compact)
        text_ += first ? "" : ", ";
    else
        (text_ += first ? "\n" : ",\n").append(2 * levels_.size(), ' ');
}

JsonWriter& JsonWriter::key(std::string_view name) {
    CHECK(!levels_.empty() && levels_.back().closing == '}' && !afterKey_,
          "a key belongs into an object: " + std::string(name));
    separate();
    text_ += jsonString(name) + ": ";
    afterKey_ = true;
    return *this;
}

JsonWriter& JsonWriter::raw(std::string_view text) {
    CHECK(levels_.empty() || levels_.back().closing == ']' || afterKey_,
          "a value in an object needs a key: " + std::string(text));
    separate();
    text_ += text;
    return *this;
}

JsonWriter& JsonWriter::compact() {
    nextCompact_ = true;
    return *this;
}

JsonWriter& JsonWriter::open(char bracket) {
    raw(std::string_view(&bracket, 1));
    const bool inCompact = !levels_.empty() && levels_.back().compact;
    levels_.push_back({bracket == '{' ? '}' : ']', nextCompact_ || inCompact, 0});
    nextCompact_ = false;
    return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
    CHECK(!levels_.empty() && levels_.back().closing == bracket && !afterKey_,
          "brackets close in the order in which they opened");
    const Level level = levels_.back();
    levels_.pop_back();
    if (!level.compact && level.count > 0) text_.append("\n").append(2 * levels_.size(), ' ');
    text_ += bracket;
    return *this;
}

std::string JsonWriter::take() {
    CHECK(levels_.empty() && !afterKey_ && !text_.empty(), "a JSON text is one whole value");
    return std::exchange(text_, {}) + "\n";
}

} // namespace tyndall
