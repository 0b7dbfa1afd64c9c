// A city as Wavefront OBJ and MTL.
#pragma once

#include "mansard/write/detail/parts.hpp"

namespace mansard::write::detail {

[[nodiscard]] auto obj_text(const City& city, const Keys& keys, const std::string& mtl_name)
    -> base::Result<std::string>;
[[nodiscard]] auto mtl_text() -> std::string;

}  // namespace mansard::write::detail
