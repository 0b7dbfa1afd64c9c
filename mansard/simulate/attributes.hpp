// What the attributes that this room gives to models mean.
#pragma once

#include <vector>

#include "mansard/write/attributes.hpp"

namespace mansard::simulate {

[[nodiscard]] auto attributes() -> std::vector<write::Attribute>;

}  // namespace mansard::simulate
