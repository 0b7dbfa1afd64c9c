// Text in columns. Widths count letters, not bytes: units and names are UTF-8.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mansard::cli {

/// How many columns of a terminal the text takes, one for each code point.
[[nodiscard]] auto columns_of(std::string_view text) -> std::size_t;

/// The text with blanks behind it up to that many columns; a longer one as it is.
[[nodiscard]] auto padded(std::string text, std::size_t columns) -> std::string;

/// Lines of at most so many columns, broken between words; a word that is longer is broken within. Never empty.
[[nodiscard]] auto wrapped(std::string_view text, std::size_t columns) -> std::vector<std::string>;

/// A term in a column of its own, and beside it what is said of it, within `width`; a term that is too long for its
/// column has a line of its own. Every line ends with a line break.
[[nodiscard]] auto term_and_text(const std::string& term, std::string_view text, std::size_t margin, std::size_t width)
    -> std::string;

/// "a, b and c".
[[nodiscard]] auto listed(const std::vector<std::string>& words, std::string_view last = "and") -> std::string;

}  // namespace mansard::cli
