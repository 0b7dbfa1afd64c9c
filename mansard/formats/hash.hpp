// What a file is, in 64 hexadecimal digits.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace mansard::formats {

/// SHA-256, lower case.
[[nodiscard]] auto sha256(std::string_view bytes) -> std::string;

/// The same, while other work on the bytes goes on in another thread where there is one. What `work` throws leaves
/// here.
[[nodiscard]] auto sha256_beside(std::string_view bytes, const std::function<void()>& work) -> std::string;

}  // namespace mansard::formats
