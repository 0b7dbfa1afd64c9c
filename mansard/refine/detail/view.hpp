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

/// At the centres of the cells, and at the samples where those are points. Cost: O(faces · rows they span + cells).
[[nodiscard]] auto view_of(const model::Solid& solid, const Site& site) -> View;

}  // namespace mansard::refine::detail
