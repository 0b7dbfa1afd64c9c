// The area of a terrain and the outlines of the buildings' ground as one triangulation in plan.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mansard/terrain/detail/triangulation.hpp"
#include "mansard/terrain/terrain.hpp"

namespace mansard::terrain::detail {

struct Plan {
  Triangulation net;
  std::vector<std::int64_t> heights;  ///< of each vertex, quanta; of one on several outlines, that of some of them
  std::vector<bool> on_outline;       ///< of each vertex
  /// Of each edge of an outline, with the ground on its left, its height.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> outline;
  std::vector<bool> inside;    ///< of each triangle, whether it is ground of a building
  std::vector<bool> left_out;  ///< of each ground, whether it overlaps others
  double filled = 0;           ///< share of the heights around the grounds that were not known
  std::vector<base::Diagnostic> warnings;
};

/// Fails with "terrain-extent".
[[nodiscard]] auto plan_of(const model::HeightGrid& grid, std::span<const Ground> grounds) -> base::Result<Plan>;

/// Of a node of the grid; and of the heights at any place of its area.
[[nodiscard]] auto site_of(const model::HeightGrid& grid, std::size_t column, std::size_t row) -> Site;
[[nodiscard]] auto height_at(const model::HeightGrid& grid, Site site) -> std::int64_t;

}  // namespace mansard::terrain::detail
