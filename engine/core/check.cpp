#include "core/check.h"

namespace tyndall {

void failCheck(const char* expression, std::string_view message, const char* file, int line) {
    std::string text =
        std::string(file) + ":" + std::to_string(line) + ": '" + expression + "' does not hold";
    if (!message.empty()) text += ": " + std::string(message);
    throw CheckFailure(text);
}

} // namespace tyndall
