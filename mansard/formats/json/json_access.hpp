// JSON of others, looked into without trust: what is not there is null.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mansard::formats {

using Json = nlohmann::ordered_json;

inline auto nothing() -> const Json& {
  static const Json null;
  return null;
}
/// A member, or null.
inline auto member(const Json& object, const char* key) -> const Json& {
  if (!object.is_object()) return nothing();
  const auto at = object.find(key);
  return at == object.end() ? nothing() : *at;
}
/// The item of an array, or null: semantics may be shorter than what they are of.
inline auto item(const Json& array, std::size_t i) -> const Json& {
  return array.is_array() && i < array.size() ? array[i] : nothing();
}
inline auto text_of(const Json& value) -> std::string {
  return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace mansard::formats
