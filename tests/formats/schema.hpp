// As much of JSON Schema (draft 2020-12) as docs/plan.schema.json uses.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace schema {

using Json = nlohmann::ordered_json;

inline auto has_type(const Json& value, const std::string& type) -> bool {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  throw std::runtime_error("unknown type " + type);
}

/// The first place where the value breaks the schema, with the reason; empty when it is valid.
inline auto first_fault(const Json& root, const Json& value, const Json& rule, const std::string& place)
    -> std::string {
  const auto fault = [&](const std::string& reason) { return (place.empty() ? "root" : place) + ": " + reason; };
  const auto below = [&](const std::string& name) { return place.empty() ? name : place + "/" + name; };
  for (const auto& [word, meaning] : rule.items()) {
    if (word == "$ref") {
      const auto target = meaning.get<std::string>();
      if (auto f = first_fault(root, value, root.at(Json::json_pointer(target.substr(1))), place); !f.empty()) return f;
    } else if (word == "type") {
      bool any = false;
      for (const auto& type : meaning.is_array() ? meaning : Json::array({meaning})) any = any || has_type(value, type);
      if (!any) return fault("not of type " + meaning.dump());
    } else if (word == "const") {
      if (value != meaning) return fault("not " + meaning.dump());
    } else if (word == "required") {
      for (const auto& name : meaning)
        if (!value.contains(name.get<std::string>())) return fault(name.get<std::string>() + " is missing");
    } else if (word == "properties") {
      for (const auto& [name, inner] : meaning.items())
        if (value.contains(name))
          if (auto f = first_fault(root, value[name], inner, below(name)); !f.empty()) return f;
    } else if (word == "additionalProperties") {
      for (const auto& [name, inner] : value.items()) {
        if (rule.contains("properties") && rule["properties"].contains(name)) continue;
        if (meaning == false) return fault(name + " is unknown");
        if (meaning.is_object())
          if (auto f = first_fault(root, inner, meaning, below(name)); !f.empty()) return f;
      }
    } else if (word == "items" || word == "prefixItems") {
      if (meaning == false) continue;
      for (std::size_t i = 0; i < value.size(); ++i)
        if (auto f = first_fault(root, value[i], meaning, below(std::to_string(i))); !f.empty()) return f;
    } else if (word == "minItems") {
      if (value.size() < meaning.get<std::size_t>()) return fault("too short");
    } else if (word == "maxItems") {
      if (value.size() > meaning.get<std::size_t>()) return fault("too long");
    } else if (word == "minimum") {
      if (value < meaning) return fault("too small");
    } else if (word == "maximum") {
      if (value > meaning) return fault("too large");
    } else if (word == "exclusiveMinimum") {
      if (value <= meaning) return fault("too small");
    } else if (word != "$schema" && word != "$id" && word != "title" && word != "description" && word != "$defs") {
      throw std::runtime_error("this validator does not know \"" + word + "\"");
    }
  }
  return {};
}

inline auto first_fault(const Json& rule, const Json& value) -> std::string {
  return first_fault(rule, value, rule, "");
}

}  // namespace schema
