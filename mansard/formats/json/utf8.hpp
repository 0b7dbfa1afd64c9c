// What is UTF-8 and what is not.
#pragma once

#include <cstddef>
#include <string_view>

namespace mansard::formats::detail {

/// The length of the well-formed UTF-8 sequence at the start of `s`, which is not empty; 0 when there is none (RFC
/// 3629, table in section 4).
[[nodiscard]] auto utf8_length(std::string_view s) -> std::size_t;

}  // namespace mansard::formats::detail
