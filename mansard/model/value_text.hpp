// The value of an attribute as text.
#pragma once

#include <string>

#include "mansard/model/attributes.hpp"

namespace mansard::model {

/// "true" or "false", a number with the fewest digits that give it back, the text; empty where there is no value.
[[nodiscard]] auto text_of(const Value& value) -> std::string;

}  // namespace mansard::model
