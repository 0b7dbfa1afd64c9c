// What the cells of footprints add up to.
#pragma once

#include <span>
#include <vector>

#include "mansard/evaluate/detail/strip.hpp"
#include "mansard/evaluate/evaluate.hpp"

namespace mansard::evaluate::detail {

/// How far inside a cell is: past the strip along the boundary of the union, past that of each footprint.
struct Depth {
  bool inside = false, inside_each = false;
};

/// Footprints, prepared for queries row by row.
struct Plan {
  Cover cover;
  Strip of_each, of_union;
  bool measured = false;       ///< whether there is an inset
  bool union_unknown = false;  ///< the union could not be computed: `of_union` is `of_each`, which is inside less often

  Plan(std::span<const geometry::Polygon> footprints, double inset);
  /// Per column of row `j`; means something where the cover has the cell.
  [[nodiscard]] auto depths(const Grid& grid, std::int64_t j) const -> std::vector<Depth>;
};

/// What a row, or all rows, add up to.
struct Sums {
  std::size_t cells = 0, missed = 0, invented = 0;
  double squares = 0, footprint_squares = 0;
  Differences differences;

  /// A cell in the footprints: what the model, or the ground in its place, is higher than the mesh.
  void add_inside(double difference, Depth depth);
  /// A cell of the model: what it is higher than the mesh.
  void add_built(double difference);
  void add(const Sums& more);
  /// As scores, but for the quantiles.
  [[nodiscard]] auto scores(double grid) const -> Scores;
};

}  // namespace mansard::evaluate::detail
