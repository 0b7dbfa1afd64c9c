// A city as binary glTF 2.0.
#pragma once

#include "mansard/write/detail/parts.hpp"

namespace mansard::write::detail {

[[nodiscard]] auto glb_bytes(const City& city, const Keys& keys) -> base::Result<std::string>;

}  // namespace mansard::write::detail
