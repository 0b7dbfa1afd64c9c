// What a file is, in 64 hexadecimal digits.
#pragma once

#include <string>
#include <string_view>

namespace mansard::ingest::detail {

/// SHA-256, lower case.
[[nodiscard]] auto sha256(std::string_view bytes) -> std::string;

}  // namespace mansard::ingest::detail
