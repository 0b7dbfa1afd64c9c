// Attributes by their name.
#pragma once

#include <string_view>
#include <variant>

#include "mansard/model/attributes.hpp"

namespace mansard::model {

/// The value of that name, if it has that type; else null.
template <class T>
[[nodiscard]] auto find(const Attributes& attributes, std::string_view name) -> const T* {
  for (const auto& [key, value] : attributes)
    if (key == name) return std::get_if<T>(&value);
  return nullptr;
}

}  // namespace mansard::model
