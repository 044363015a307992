#include "scene/json_schema.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/settings.h"
#include "scene/scene_schema_text.h"

namespace tyndall {
namespace {

bool hasType(const Json& value, std::string_view type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "number") return value.is_number();
    if (type == "integer")
        return value.is_number() && value.get<double>() == std::floor(value.get<double>());
    CHECK(false, "schema type '" + std::string(type) + "' is not supported");
}

std::string listed(const Json& values) {
    std::string text;
    for (size_t i = 0; i < values.size(); ++i) {
        if (i > 0) text += i + 1 == values.size() ? " or " : ", ";
        text += values[i].is_string() ? values[i].get<std::string>() : values[i].dump();
    }
    return text;
}

std::string shown(const Json& value) {
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 37) + "..." : text;
}

class Validator {
public:
    explicit Validator(const Json& root) : root_(root) {}

    Result<void> check(const Json& value, const Json& schemaHere,
                       const std::string& pointer) const {
        const Json& schema = resolved(schemaHere);
        if (const auto branches = schema.find("anyOf"); branches != schema.end())
            return checkAnyOf(value, *branches, pointer);
        if (auto wrong = checkTypeAndValue(value, schema, pointer); !wrong) return wrong;
        if (value.is_number()) return checkNumber(value, schema, pointer);
        if (value.is_array()) return checkArray(value, schema, pointer);
        if (value.is_object()) return checkObject(value, schema, pointer);
        return {};
    }

    /// See roundIntoLimits.
    void round(Json& value, const Json& schemaHere, const std::string& pointer,
               Rounded& rounded) const {
        const Json& schema = resolved(schemaHere);
        if (value.is_number()) {
            const double tolerance = schema.value("tolerance", 0.0), number = value.get<double>();
            const double limited = std::clamp(number, schema.value("minimum", number),
                                              schema.value("maximum", number));
            if (limited == number || std::abs(limited - number) > tolerance) return;
            if (rounded.count++ == 0) rounded.first = pointer + " is " + value.dump();
            value = limited;
        } else if (const auto items = schema.find("items");
                   value.is_array() && items != schema.end()) {
            for (size_t i = 0; i < value.size(); ++i)
                round(value[i], *items, fmt::format("{}/{}", pointer, i), rounded);
        } else if (const auto properties = schema.find("properties");
                   value.is_object() && properties != schema.end()) {
            for (auto& [key, member] : value.items())
                if (const auto property = properties->find(key); property != properties->end())
                    round(member, *property, pointer + "/" + key, rounded);
        }
    }

    /// See keepJudged.
    void keep(Json& value, const Json& schemaHere) const {
        const Json& schema = resolved(schemaHere);
        if (value.is_number()) return writeNumber(value, schema);
        if (value.is_array()) {
            const auto items = schema.find("items");
            for (Json& item : value) {
                if (items == schema.end())
                    item = Json::object();
                else
                    keep(item, *items);
            }
        }
        if (!value.is_object()) return;
        const Json none = Json::object();
        const auto found = schema.find("properties"), others = schema.find("additionalProperties");
        const Json& properties = found == schema.end() ? none : *found;
        Json kept = Json::object();
        for (auto& [key, member] : value.items()) {
            const auto property = properties.find(key);
            if (property == properties.end() && others == schema.end()) continue;
            keep(member, property == properties.end() ? *others : *property);
            kept[key] = std::move(member);
        }
        value = std::move(kept);
    }

private:
    static void writeNumber(Json& value, const Json& schema) {
        if (schema.value("type", std::string()) == "number")
            value = value.get<double>();
        else if (value.get<double>() >= 0)
            value = value.get<uint64_t>();
    }

    static Error wrong(const std::string& pointer, const std::string& sentence) {
        return Error{(pointer.empty() ? std::string("the file") : pointer) + " " + sentence};
    }

    const Json& resolved(const Json& schema) const {
        const Json* here = &schema;
        for (auto reference = here->find("$ref"); reference != here->end();
             reference = here->find("$ref"))
            here = &root_.at(Json::json_pointer(reference->get<std::string>().substr(1)));
        return *here;
    }

    static bool typeFits(const Json& value, const Json& schema) {
        const auto type = schema.find("type");
        if (type == schema.end()) return true;
        if (type->is_string()) return hasType(value, type->get<std::string>());
        for (const Json& one : *type)
            if (hasType(value, one.get<std::string>())) return true;
        return false;
    }

    static std::string typeNames(const Json& schema) {
        const auto type = schema.find("type");
        if (type == schema.end()) return "value";
        return type->is_string() ? type->get<std::string>() : listed(*type);
    }

    Result<void> checkAnyOf(const Json& value, const Json& branches,
                            const std::string& pointer) const {
        std::string types;
        for (const Json& branch : branches) {
            if (typeFits(value, resolved(branch))) return check(value, branch, pointer);
            types += (types.empty() ? "" : " or ") + typeNames(resolved(branch));
        }
        return wrong(pointer, fmt::format("is {} but must be of type {}", shown(value), types));
    }

    static Result<void> checkTypeAndValue(const Json& value, const Json& schema,
                                          const std::string& pointer) {
        if (!typeFits(value, schema))
            return wrong(pointer, fmt::format("is {} but must be of type {}", shown(value),
                                              typeNames(schema)));
        if (const auto only = schema.find("const"); only != schema.end() && value != *only)
            return wrong(pointer, fmt::format("is {} but must be {}", shown(value), only->dump()));
        if (const auto choice = schema.find("enum"); choice != schema.end()) {
            for (const Json& allowed : *choice)
                if (value == allowed) return {};
            return wrong(pointer,
                         fmt::format("is {} but must be {}", shown(value), listed(*choice)));
        }
        if (value.is_string() &&
            value.get_ref<const std::string&>().size() < schema.value("minLength", size_t(0)))
            return wrong(pointer, "must not be empty");
        return {};
    }

    static Result<void> checkNumber(const Json& value, const Json& schema,
                                    const std::string& pointer) {
        struct Rule {
            const char* keyword;
            const char* words;
            bool (*holds)(double, double);
        };
        static constexpr Rule kRules[] = {
            {"minimum", "at least", [](double v, double limit) { return v >= limit; }},
            {"maximum", "at most", [](double v, double limit) { return v <= limit; }},
            {"exclusiveMinimum", "greater than", [](double v, double limit) { return v > limit; }},
            {"exclusiveMaximum", "less than", [](double v, double limit) { return v < limit; }},
        };
        for (const Rule& rule : kRules) {
            const auto limit = schema.find(rule.keyword);
            if (limit != schema.end() && !rule.holds(value.get<double>(), limit->get<double>()))
                return wrong(pointer, fmt::format("is {} but must be {} {}", shown(value),
                                                  rule.words, limit->dump()));
        }
        return {};
    }

    Result<void> checkArray(const Json& value, const Json& schema,
                            const std::string& pointer) const {
        const size_t minimum = schema.value("minItems", size_t(0)),
                     maximum = schema.value("maxItems", SIZE_MAX);
        if (value.size() < minimum || value.size() > maximum) {
            const std::string wanted = minimum == maximum ? std::to_string(minimum)
                                       : maximum == SIZE_MAX
                                           ? fmt::format("at least {}", minimum)
                                           : fmt::format("{} to {}", minimum, maximum);
            return wrong(pointer,
                         fmt::format("has {} elements but must have {}", value.size(), wanted));
        }
        const auto items = schema.find("items");
        if (items == schema.end()) return {};
        for (size_t i = 0; i < value.size(); ++i)
            if (auto inside = check(value[i], *items, fmt::format("{}/{}", pointer, i)); !inside)
                return inside;
        return {};
    }

    Result<void> checkObject(const Json& value, const Json& schema,
                             const std::string& pointer) const {
        if (const auto required = schema.find("required"); required != schema.end())
            for (const Json& key : *required)
                if (!value.contains(key.get<std::string>()))
                    return wrong(pointer, fmt::format("lacks the key '{}', which is required",
                                                      key.get<std::string>()));
        const Json none = Json::object();
        const auto found = schema.find("properties");
        const Json& properties = found == schema.end() ? none : *found;
        const auto others = schema.find("additionalProperties");
        for (const auto& [key, member] : value.items()) {
            const std::string inside = pointer + "/" + key;
            if (const auto property = properties.find(key); property != properties.end()) {
                if (auto result = check(member, *property, inside); !result) return result;
            } else if (others != schema.end() && others->is_object()) {
                if (auto result = check(member, *others, inside); !result) return result;
            } else if (others != schema.end()) {
                return unknownKey(key, properties, pointer);
            }
        }
        return {};
    }

    static Error unknownKey(const std::string& key, const Json& properties,
                            const std::string& pointer) {
        std::vector<std::string_view> names;
        for (const auto& [name, unused] : properties.items()) names.push_back(name);
        const std::string nearest = nearestName(key, names);
        std::string all;
        for (const std::string_view name : names)
            all += (all.empty() ? "" : ", ") + std::string(name);
        return wrong(pointer, fmt::format("has the unknown key '{}'; {}", key.substr(0, 60),
                                          nearest.empty() ? "it takes " + all
                                                          : "did you mean '" + nearest + "'?"));
    }

    const Json& root_;
};

} // namespace

Result<void> validateJson(const Json& value, const Json& schema) {
    return Validator(schema).check(value, schema, "");
}

Rounded roundIntoLimits(Json& value, const Json& schema) {
    Rounded rounded;
    Validator(schema).round(value, schema, "", rounded);
    return rounded;
}

void keepJudged(Json& value, const Json& schema) { Validator(schema).keep(value, schema); }

const Json& sceneFileSchema() {
    static const Json schema = Json::parse(kSceneSchemaText);
    return schema;
}

} // namespace tyndall
