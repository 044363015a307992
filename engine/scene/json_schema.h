#pragma once
// The part of JSON Schema (draft 2020-12) that docs/scene.schema.json uses, with sentences for people.
//
// Keywords: type, const, enum, properties, required, additionalProperties, items, minItems, maxItems, minLength, minimum,
// maximum, exclusiveMinimum, exclusiveMaximum, $ref ("#/…"), and anyOf, of which the first branch that
// accepts the value's JSON type is taken, so that an error speaks of what was meant.

#include "core/result.h"
#include "scene/json_parse.h"

namespace tyndall {

/// Error: "/nodes/2/light: unknown key 'intensty'; did you mean 'intensity'?", without the file's name.
Result<void> validateJson(const Json& value, const Json& schema);

/// Numbers that miss a limit by no more than the keyword `tolerance` of their schema are set to the limit.
struct Rounded {
    size_t count = 0;
    std::string first; // "/materials/0/pbrMetallicRoughness/metallicFactor is 1.0000001"
};
Rounded roundIntoLimits(Json& value, const Json& schema);

/// Of a valid value, what the schema speaks of: other members of objects are erased, elements of arrays without `items` emptied, integers
/// written as integers (4.0 → 4) and other numbers as floating-point ones. Knows no anyOf.
void keepJudged(Json& value, const Json& schema);

/// docs/scene.schema.json, which is built into the program.
const Json& sceneFileSchema();

} // namespace tyndall
