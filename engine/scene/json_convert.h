#pragma once
// Small conversions from JSON that a schema has already judged. Private to the folder; include after nlohmann/json.hpp.

#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/math.h"
#include "core/settings.h"
#include "scene/json_parse.h"

namespace tyndall {

inline dvec3 toVector(const Json& json) {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

/// `otherwise` where the key is missing.
inline vec3 colorOr(const Json& json, std::string_view key, const vec3& otherwise) {
    const auto found = json.find(key);
    return found == json.end() ? otherwise : vec3(toVector(*found));
}

inline float floatOr(const Json& json, std::string_view key, float otherwise) {
    const auto found = json.find(key);
    return found == json.end() ? otherwise : found->get<float>();
}

/// The place of `name` in a table; CHECKs that it is there (the schema saw to it).
template <typename Names> int indexOf(const Names& names, std::string_view name) {
    int index = 0;
    for (const std::string_view one : names) {
        if (one == name) return index;
        ++index;
    }
    CHECK(false, "'" + std::string(name) + "' is in the schema but not in the table");
}

/// "is 'smok', which is no node's name; did you mean 'smoke'?"
template <typename Map> std::string unknownName(const std::string& name, const Map& known) {
    std::vector<std::string_view> names;
    for (const auto& [one, unused] : known) names.push_back(one);
    const std::string nearest = nearestName(name, names);
    return "is '" + name + "', which is not the name of a node of this file" +
           (nearest.empty() ? std::string() : "; did you mean '" + nearest + "'?");
}

} // namespace tyndall
