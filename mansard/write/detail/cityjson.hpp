// A city as CityJSON 2.0 (https://www.cityjson.org/specs/2.0.1/).
#pragma once

#include "mansard/write/detail/parts.hpp"

namespace mansard::write::detail {

/// Keys and models must have passed keys_of() and check_models().
[[nodiscard]] auto cityjson_text(const City& city, const Keys& keys) -> std::string;

}  // namespace mansard::write::detail
