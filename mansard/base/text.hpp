// Numbers as text and back, free of any locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mansard::base {

/// The shortest text that reads back as the same double ("0.1", "1e+30", "nan").
[[nodiscard]] auto to_text(double value) -> std::string;
/// Fixed notation with that many decimals; "-0.00" is written "0.00".
[[nodiscard]] auto to_text(double value, int decimals) -> std::string;

/// The whole of `text` as a finite number or an integer; nothing otherwise. A leading '+' is accepted.
[[nodiscard]] auto to_number(std::string_view text) -> std::optional<double>;
[[nodiscard]] auto to_integer(std::string_view text) -> std::optional<std::int64_t>;

/// ASCII letters in lower case; other bytes stay, so UTF-8 text stays valid. Independent of the locale.
[[nodiscard]] auto lower(std::string_view text) -> std::string;

/// Control characters as spaces. Names come from files: a line break in one must not make two lines of one, nor an
/// escape code reach a terminal.
[[nodiscard]] auto on_one_line(std::string text) -> std::string;

}  // namespace mansard::base
