// UTF-8, and text for markup.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mansard::base {

/// The length of the well-formed UTF-8 sequence at the start of `s`, which is not empty; 0 when there is none (RFC
/// 3629, table in section 4).
[[nodiscard]] auto utf8_length(std::string_view s) -> std::size_t;

/// Bytes that are not UTF-8 as U+FFFD.
[[nodiscard]] auto as_utf8(std::string_view text) -> std::string;

/// What may be between tags, or in double quotation marks, of XML and HTML: &, <, > and " as entities; characters that
/// XML does not have as spaces, and bytes that are not UTF-8 as U+FFFD.
[[nodiscard]] auto markup_escaped(std::string_view text) -> std::string;

}  // namespace mansard::base
