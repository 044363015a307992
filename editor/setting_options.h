#pragma once
// Settings as options of the command line: the shortest way to say them.

#include <map>
#include <string>
#include <vector>

#include "core/settings.h"

namespace tyndall::editor {

/// Options that lead from `ofScene` (all settings by key, as the scene file has them) to what the registry holds now:
/// `--quality NAME` where a preset comes nearer, and one option for each setting that then still differs, `--gi NAME` for
/// `techniqueKey`. Settings whose keys begin with "inspect." are left out. Words for a shell.
std::vector<std::string> settingOptions(const SettingsRegistry& settings,
                                        const std::map<std::string, std::string>& ofScene,
                                        const std::string& techniqueKey);

/// The text as one word of a shell's command line.
std::string shellWord(const std::string& text);

} // namespace tyndall::editor
