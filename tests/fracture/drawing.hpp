// Small plans drawn in text: a letter is a point, a column is a metre east, a line a metre north of the one below it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/fracture/fracture.hpp"

namespace mansard::fracture {

inline auto points_in(std::string_view drawing) -> std::map<char, geometry::Point2> {
  std::map<char, geometry::Point2> points;
  double x = 0, y = 0;
  for (const char c : drawing) {
    if (c == '\n') {
      x = 0, --y;
      continue;
    }
    if (c >= 'a' && c <= 'z') points[c] = {x, y};
    ++x;
  }
  for (auto& [name, p] : points) p.y -= y;  // the last line is y = 0
  return points;
}

/// The pairs of letters in `pairs` ("ab cd") as cuts numbered from 0.
inline auto cuts_in(std::string_view drawing, std::string_view pairs) -> std::vector<Cut> {
  const auto points = points_in(drawing);
  std::vector<Cut> cuts;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 3)
    cuts.push_back({{points.at(pairs[i]), points.at(pairs[i + 1])}, static_cast<std::uint32_t>(cuts.size())});
  return cuts;
}

/// From (0, 0) to (east, north).
inline auto box(double east, double north) -> geometry::Box2 {
  geometry::Box2 result;
  result.add({0, 0});
  result.add({east, north});
  return result;
}

}  // namespace mansard::fracture
