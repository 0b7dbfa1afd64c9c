// Where the top surface jumps: the heights of a block on a grid turned to its footprints.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mansard/block/block.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/sweep/sweep.hpp"

namespace mansard::sweep::detail {

/// A direction many footprint edges run in, or perpendicular to, and the members that have such edges.
struct Grain {
  geometry::Point2 direction;        ///< unit
  std::vector<std::size_t> members;  ///< indices into Block::members, ascending
};

/// The block's directions, the one with the most metres of edge first.
[[nodiscard]] auto grains_of(const block::Block& block, const Options& options) -> std::vector<Grain>;

/// A place where the surface jumps across a line that runs along the grid's rows or columns.
struct Jump {
  double across = 0;         ///< m along the axis perpendicular to the line
  std::size_t row = 0;       ///< number of the cell along the line
  double height = 0;         ///< m, up in the direction of `across`, off the slopes beside it and perpendicular to them
  double low = 0, high = 0;  ///< z of the two sides beside it, m
};

/// Heights at the centres of square cells; NaN outside the footprints and where nothing as high as a building stands.
class HeightGrid {
 public:
  HeightGrid(const block::Block& block, const Grain& grain, const rays::Scene& mesh, const Options& options);

  /// The same seen with the axes exchanged: `across` and `along` below are then the other ones.
  void transpose() { transposed_ = !transposed_; }
  [[nodiscard]] auto across() const -> std::size_t { return transposed_ ? ny_ : nx_; }
  [[nodiscard]] auto along() const -> std::size_t { return transposed_ ? nx_ : ny_; }
  [[nodiscard]] auto z(std::size_t u, std::size_t t) const -> double {
    return transposed_ ? z_[u * nx_ + t] : z_[t * nx_ + u];
  }
  /// The place of coordinates along the two axes, m.
  [[nodiscard]] auto point(double u, double t) const -> geometry::Point2 {
    return transposed_ ? origin_ + t * x_ + u * y_ : origin_ + u * x_ + t * y_;
  }

  /// All jumps across lines of one direction, by row, then across.
  [[nodiscard]] auto jumps() const -> std::vector<Jump>;

  /// The mean of the surface across a line, over some of its rows: how high the jump is (as in Jump), and how far
  /// beside the line the middle of its flank lies. The line is at `across` in row `pivot`, and turned by `tangent`.
  struct Flank {
    double height = 0, beside = 0;  ///< m
  };
  struct Line {
    double across = 0, tangent = 0, pivot = 0;
    double cell = 0;  ///< m
    [[nodiscard]] auto at(double row) const -> double { return across + tangent * (row - pivot) * cell; }
  };
  [[nodiscard]] auto flank_of(std::span<const Jump> jumps, const Line& line) const -> Flank;

 private:
  const Options& options_;
  geometry::Point2 origin_, x_, y_;
  std::size_t nx_ = 0, ny_ = 0;
  std::vector<double> z_;
  bool transposed_ = false;
};

}  // namespace mansard::sweep::detail
