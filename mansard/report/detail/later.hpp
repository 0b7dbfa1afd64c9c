// What became of a wall between two parts after the program had chosen it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mansard/model/city.hpp"

namespace mansard::report::detail {

/// Metres of a wall; they add up to its length.
struct Later {
  double kept = 0;     ///< within 5 cm
  double moved = 0;    ///< up to 1 m to one side
  double dropped = 0;  ///< no wall between two parts is there
  double by = 0;       ///< m; mean distance of what was moved
};

/// The outlines of the parts of all models, for looking up what is near a wall.
class FinalWalls {
 public:
  explicit FinalWalls(std::span<const model::Building> buildings);

  /// Compared every quarter of a metre, straight across the lines. Cost: O(length · edges near by).
  [[nodiscard]] auto later(std::span<const geometry::Segment2> wall) const -> Later;

 private:
  struct Edge {
    geometry::Segment2 segment;
    std::size_t part = 0;
  };
  using Cell = std::pair<std::int64_t, std::int64_t>;

  /// m to the nearest wall between two parts, or, very near, to an outer wall; negative where there is none.
  [[nodiscard]] auto nearest(geometry::Point2 at, geometry::Point2 across) const -> double;

  std::vector<Edge> edges_;
  std::map<Cell, std::vector<std::size_t>> near_;
};

}  // namespace mansard::report::detail
