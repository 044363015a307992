#pragma once
// A compiled frame for people and scripts: `tyndall graph --format text|dot|json`.

#include <string>
#include <string_view>

#include "core/result.h"
#include "framegraph/compiled_graph.h"

namespace tyndall::fg {

enum class DumpFormat : uint32_t { Text = 0, Dot = 1, Json = 2 };
/// "text", "dot" or "json". Errors: any other name.
Result<DumpFormat> parseDumpFormat(std::string_view name);

/// Passes in order with status, reason, barriers, reads and writes; resources with description, bytes, lifetime and storage.
std::string dump(const CompiledGraph& graph, DumpFormat format);

/// "texture-fetch image" for a set of GL barrier bits; empty for none.
std::string barrierNames(uint32_t bits);

} // namespace tyndall::fg
