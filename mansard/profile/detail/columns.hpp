// The slices of one run as columns of heights, and which of them show a roof that rises from this run.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mansard/profile/detail/climb.hpp"
#include "mansard/profile/detail/runs.hpp"
#include "mansard/profile/options.hpp"

namespace mansard::profile::detail {

/// The top surface along one slice: column b is at (b + ½) · column_width inward. Heights in metres above the base; NaN
/// in holes.
struct SliceColumns {
  double along = 0;                 ///< m from the start of the run
  std::vector<double> heights;      ///< as far as the slice belongs to the polygon
  std::optional<double> wall;       ///< m inward of the edge
  std::size_t first = 0, last = 0;  ///< the columns [first, last) rise away from the edge; none when equal
};

/// The topmost surface under the climb's highest point: what hangs above (trees, debris) is left out.
[[nodiscard]] auto columns_of(std::span<const Piece> pieces, const Sample& sample, double base,
                              std::optional<double> wall, const Options& options = {}) -> SliceColumns;

/// Sets `first` and `last` of every slice: columns belong to the run while the surface around them rises inward and
/// hardly along the run. That is what tells the eaves' own roof from a gable, a hip or the neighbour's roof.
void find_rising(std::vector<SliceColumns>& slices, const Options& options = {});

/// The columns' median over the slices in which they rise.
struct Pooled {
  double inward = 0, height = 0;  ///< m
  double weight = 0;              ///< number of slices
};
[[nodiscard]] auto pool(std::span<const SliceColumns> slices, const Options& options = {}) -> std::vector<Pooled>;

/// Median height of the columns nearest to the edge, metres above the base: the wall top of a run without own roof.
[[nodiscard]] auto edge_height(std::span<const SliceColumns> slices, const Options& options = {})
    -> std::optional<double>;

/// A lower, level part along the run before the building's wall: a porch, an annex, a step back.
struct Setback {
  double depth = 0;   ///< m inward to the wall, an integer number of columns
  double height = 0;  ///< m above the base, of the lower part
};
/// Where most slices show one: at least setback_depth columns deep, setback_height high and setback_step under what
/// stands behind.
[[nodiscard]] auto find_setback(std::span<const SliceColumns> slices, const Options& options = {})
    -> std::optional<Setback>;

/// The slices as seen from the wall behind the setback.
[[nodiscard]] auto behind(std::span<const SliceColumns> slices, const Setback& setback, const Options& options = {})
    -> std::vector<SliceColumns>;

}  // namespace mansard::profile::detail
