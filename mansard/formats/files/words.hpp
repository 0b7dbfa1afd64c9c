// Lines, words and numbers of the text formats, free of any locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mansard::formats {

/// Without the byte order mark that editors put before text in UTF-8: it would make the first word another one.
[[nodiscard]] auto without_mark(std::string_view text) -> std::string_view;

/// Takes the next line off the front, without its end ("\n" or "\r\n").
[[nodiscard]] auto take_line(std::string_view& text) -> std::string_view;

/// Takes the next word off the front: what stands between blanks, tabs and line ends. Empty at the end.
[[nodiscard]] auto take_word(std::string_view& text) -> std::string_view;

/// A coordinate: unlike base::to_number it knows "nan", "inf" and the "1.#QNAN" of old compilers, since meshes do
/// contain them; what is too large for a double is infinite, what is too small is 0.
[[nodiscard]] auto to_coordinate(std::string_view word) -> std::optional<double>;

/// A whole number at the front of the word, up to a '/' (as in OBJ faces).
[[nodiscard]] auto to_corner(std::string_view word) -> std::optional<std::int64_t>;

}  // namespace mansard::formats
