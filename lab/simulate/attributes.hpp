// What the attributes that this module gives to models mean.
#pragma once

#include <vector>

#include "mansard/formats/attributes.hpp"

namespace mansard::simulate {

[[nodiscard]] auto attributes() -> std::vector<formats::Attribute>;

}  // namespace mansard::simulate
