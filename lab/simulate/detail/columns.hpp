// How much of each cell of a grid is solid, by vertical lines.
#pragma once

#include <cstdint>
#include <vector>

#include "lab/simulate/detail/world.hpp"

namespace mansard::simulate::detail {

/// Nodes at origin + step × (i, j, k). Node (i, j, k) stands for the cube of that side around it.
struct Lattice {
  geometry::Point3 origin;
  double step = 0;
  [[nodiscard]] auto at(std::int64_t i, std::int64_t j, std::int64_t k) const -> geometry::Point3 {
    return origin + step * geometry::Point3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
  }
};

/// A box of nodes: i0 … i0 + ni − 1 and so on; what is below is solid, what is above is air.
struct Cells {
  std::int64_t i0 = 0, j0 = 0, k0 = 0, ni = 0, nj = 0, nk = 0;
  std::vector<float> share;  ///< solid share; k fastest, then i, then j
  [[nodiscard]] auto index(std::int64_t i, std::int64_t j, std::int64_t k) const -> std::size_t {
    return static_cast<std::size_t>(((j - j0) * ni + (i - i0)) * nk + (k - k0));
  }
  [[nodiscard]] auto at(std::int64_t i, std::int64_t j, std::int64_t k) const -> float { return share[index(i, j, k)]; }
};

/// The union of buildings, ground and objects over i0 … i0 + ni − 1 × j0 … j0 + nj − 1, with `spare` nodes above and
/// below all surfaces. `triangles` and `objects` must name all those that may lie over these nodes.
/// Sixteen lines a node, at sixteen different x and y each; along a line the share is exact.
[[nodiscard]] auto solid_share(const World& world, const Lattice& lattice, std::int64_t i0, std::int64_t j0,
                               std::int64_t ni, std::int64_t nj, std::int64_t spare,
                               const std::vector<std::uint32_t>& triangles, const std::vector<std::uint32_t>& objects)
    -> Cells;

/// Smoothed by a Gaussian of that standard deviation, in steps.
void blur(Cells& cells, double deviation);
/// How many nodes away that looks.
[[nodiscard]] auto blur_reach(double deviation) -> std::int64_t;

}  // namespace mansard::simulate::detail
