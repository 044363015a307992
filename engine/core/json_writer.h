#pragma once
// JSON as text, for what the programs write: reports, traces, dumps. Keys keep the order in which they come.

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {

/// `text` in quotes, with everything escaped that JSON asks for. Bytes that are not UTF-8 become U+FFFD.
std::string jsonString(std::string_view text);
/// The shortest text that reads back as the same number; `null` where it is not finite, as JSON has no such number.
std::string jsonNumber(double value);

/// Writes one value, indented by two spaces a level. Keys and values must alternate as in the text: misuse is a CHECK failure.
class JsonWriter {
public:
    JsonWriter& beginObject() { return open('{'); }
    JsonWriter& endObject() { return close('}'); }
    JsonWriter& beginArray() { return open('['); }
    JsonWriter& endArray() { return close(']'); }
    JsonWriter& key(std::string_view name);
    JsonWriter& value(std::string_view text) { return raw(jsonString(text)); }
    JsonWriter& value(const char* text) { return raw(jsonString(text)); }
    JsonWriter& value(bool yes) { return raw(yes ? "true" : "false"); }
    JsonWriter& value(double number) { return raw(jsonNumber(number)); }
    template <std::integral T> JsonWriter& value(T number) { return raw(std::to_string(number)); }
    JsonWriter& null() { return raw("null"); }
    template <typename T> JsonWriter& member(std::string_view name, const T& v) {
        return key(name).value(v);
    }
    /// The next object or array is written on one line.
    JsonWriter& compact();

    /// The finished text with a final newline. CHECKs that everything opened is closed.
    [[nodiscard]] std::string take();

private:
    JsonWriter& open(char bracket);
    JsonWriter& close(char bracket);
    JsonWriter& raw(std::string_view text);
    void separate();
    struct Level {
        char closing;
        bool compact;
        size_t count;
    };
    std::vector<Level> levels_;
    std::string text_;
    bool afterKey_ = false;
    bool nextCompact_ = false;
};

} // namespace tyndall
