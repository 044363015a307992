#pragma once
// The rules of glTF 2.0 that the importer relies on: types and ranges of every property it reads, and that every index
// points at something. Private to the folder.

#include "core/result.h"
#include "scene/json_parse.h"

namespace tyndall {

/// Error: JSON pointer and sentence, without the file's name. Objects that are not read (animations, extras, unknown
/// extensions) are not judged. Numbers that a rounding error put outside of their limits are set to them, with a note.
Result<void> checkGltfRules(Json& gltf, std::vector<std::string>& notes);

/// Erases what is not read, after the rules have been passed: extras, unknown extensions, animations' members. What is left is small in
/// memory for each byte of the file, and no deeper than the rules are.
void keepWhatRulesJudge(Json& gltf);

/// Error where `extensionsRequired` names one that is not understood; in `notes` a sentence for each that is only used.
Result<void> checkGltfExtensions(const Json& gltf, std::vector<std::string>& notes);

} // namespace tyndall
