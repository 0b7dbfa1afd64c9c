// A solid seen from above on the grid of its site.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/extrude/extrude.hpp"
#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

/// Error bound, of the z of a wall's normal: a sketch's normals are made from directions and slopes; a wall's z is 0,
/// and that of the steepest roof a kernel takes, one quantum of run over a rise of 15 m, is 1e-6.
constexpr double wall_normal = 1e-6;

struct View {
  std::vector<double> z;            ///< m above the base, per cell of the grid; NaN where the solid is not
  std::vector<std::uint32_t> face;  ///< the face seen; undefined where z is NaN
  /// The same per sample of the site, where those are points; else empty.
  std::vector<double> z_at;
  std::vector<std::uint32_t> face_at;

  /// Of a sample of the site.
  [[nodiscard]] auto z_of(const Site& site, std::size_t sample) const -> double {
    return z_at.empty() ? z[site.cells[sample]] : z_at[sample];
  }
  [[nodiscard]] auto face_of(const Site& site, std::size_t sample) const -> std::uint32_t {
    return z_at.empty() ? face[site.cells[sample]] : face_at[sample];
  }
};

/// At the centres of the cells alone. Cost: O(faces · rows they span + cells).
[[nodiscard]] auto cells_of(const model::Solid& solid, const Site& site) -> View;

/// What is seen at samples that are points, added to a view of the cells. Beside the edge of a face a point may be over
/// another face than the centre of its cell: one that is seen at a cell around it. Where it is over none of these, it
/// is taken to be over that of its own cell.
class SampleViews {
 public:
  SampleViews(const model::Solid& solid, const Site& site, View& view);
  /// Of the samples [first, last).
  void see(std::size_t first, std::size_t last);

 private:
  static constexpr std::uint32_t none = UINT32_MAX;

  /// Whether the face of a cell is that of all eight around it.
  [[nodiscard]] auto is_seen_around(std::uint32_t cell, std::uint32_t column, std::uint32_t row) const -> bool;
  [[nodiscard]] auto face_beside(std::uint32_t cell, std::size_t column, std::size_t row, geometry::Point2 place)
      -> std::uint32_t;

  const model::Solid& solid_;
  const Site& site_;
  View& view_;
  std::vector<std::uint32_t> seen_;    // per cell
  std::vector<std::uint32_t> others_;  // working memory
};

/// At the centres of the cells, and at the samples where those are points.
[[nodiscard]] auto view_of(const model::Solid& solid, const Site& site) -> View;

}  // namespace mansard::refine::detail
