#pragma once
// Reading JSON that somebody else wrote: exceptions of the library become sentences, depth and size have limits.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "core/result.h"

namespace tyndall {

/// Keeps the order of keys: settings apply in the order they are written in.
using Json = nlohmann::ordered_json;

inline constexpr int kMaxJsonDepth = 64;

/// Errors (without the file's name): where the syntax breaks, nesting deeper than kMaxJsonDepth, bad UTF-8, a number
/// too large for a double, a key that an object has twice.
Result<Json> parseJson(std::string_view text);

} // namespace tyndall
