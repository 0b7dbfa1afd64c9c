// Long texts in pieces that threads read side by side, and the plain numbers that nearly all of them hold.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "mansard/formats/mesh/raw_mesh.hpp"

namespace mansard::formats {

/// The text in pieces of about `size` bytes, each with whole lines. With `continued`, a line that ends in a backslash
/// and the next one stay together. The pieces depend on the text alone, never on the number of threads.
[[nodiscard]] auto chunks_of(std::string_view text, bool continued, std::size_t size = std::size_t{1} << 20)
    -> std::vector<std::string_view>;

/// What the pieces gave, as one mesh in their order; indices are taken as they are. The pieces are emptied on the way,
/// so that there is little more than one copy at any time.
[[nodiscard]] auto join(std::vector<RawMesh>& pieces) -> RawMesh;

/// A text whose first `count` lines with anything in them are read each for itself, side by side: `read` gets a line
/// with its number from 0 and adds to the mesh, or says that the line is not what it should be. Nothing where a line is
/// not, or where there are too few: a reader that goes through the text word by word then finds out why. With
/// `comment`, lines that start with that character have nothing in them; 0 for none.
[[nodiscard]] auto read_lines(std::string_view text, std::size_t count, char comment,
                              const std::function<bool(std::string_view, std::size_t, RawMesh&)>& read)
    -> std::optional<RawMesh>;

[[nodiscard]] inline auto is_blank(char c) -> bool { return c == ' ' || (c >= '\t' && c <= '\r'); }
[[nodiscard]] inline auto is_digit(char c) -> bool { return c >= '0' && c <= '9'; }

inline void skip_blanks(const char*& at, const char* end) {
  while (at != end && is_blank(*at)) ++at;
}

/// Takes the next word off the front where it is a number without an exponent and short enough for whole arithmetic,
/// which then is exactly what to_coordinate gives: both the digits and the power of ten are doubles, and one division
/// rounds once (W. D. Clinger, How to read floating point numbers accurately, 1990). False where to_coordinate must
/// look.
[[nodiscard]] inline auto take_plain_number(const char*& at, const char* end, double& value) -> bool {
  static constexpr std::array<double, 19> power{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8, 1e9,
                                                1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18};
  skip_blanks(at, end);
  const char* look = at;
  const bool negative = look != end && *look == '-';
  if (negative) ++look;
  const char* const first = look;
  std::uint64_t digits = 0;
  for (; look != end && is_digit(*look); ++look) digits = 10 * digits + static_cast<std::uint64_t>(*look - '0');
  const std::ptrdiff_t whole = look - first;
  std::ptrdiff_t decimals = 0;
  if (look != end && *look == '.') {
    const char* const point = ++look;
    for (; look != end && is_digit(*look); ++look) digits = 10 * digits + static_cast<std::uint64_t>(*look - '0');
    decimals = look - point;
  }
  if (whole == 0 || whole + decimals > 18 || digits > (std::uint64_t{1} << 53) || (look != end && !is_blank(*look)))
    return false;
  const double size = static_cast<double>(digits) / power[static_cast<std::size_t>(decimals)];
  value = negative ? -size : size;
  at = look;
  return true;
}

/// Takes the next word off the front where it starts with one to nine digits, up to a '/' or its end. False where
/// to_corner must look.
[[nodiscard]] inline auto take_plain_index(const char*& at, const char* end, std::uint32_t& value) -> bool {
  skip_blanks(at, end);
  const char* look = at;
  std::uint32_t digits = 0;
  for (; look != end && is_digit(*look); ++look) {
    if (look - at == 9) return false;
    digits = 10 * digits + static_cast<std::uint32_t>(*look - '0');
  }
  if (look == at || (look != end && *look != '/' && !is_blank(*look))) return false;
  while (look != end && !is_blank(*look)) ++look;
  value = digits;
  at = look;
  return true;
}

}  // namespace mansard::formats
