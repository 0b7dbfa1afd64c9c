// Heights across the edges of footprints: where the roof ends, how sharply, and whether there is a wall below.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::accuracy::detail {

/// m inside of the wall at which the fall of the surface below its roof is read.
inline constexpr std::array<double, 8> depths{0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8};

struct Transect {
  std::size_t edge = 0;
  double outside = 0;                        ///< m; how far outside of the footprint's edge the roof ends
  std::array<double, depths.size()> fall{};  ///< m below the roof's plane, at `depths`
  double walls = 0;                          ///< share of the wall's height near which the scan has a surface
};
struct Edge {
  geometry::Point2 outward;  ///< unit
  double length = 0;         ///< m
};
struct Transects {
  std::vector<Edge> edges;
  std::vector<Transect> transects;
};
/// `scene` is of the mesh.
[[nodiscard]] auto across(std::span<const geometry::Polygon> outline, const geometry::Mesh& mesh,
                          const rays::Scene& scene) -> Transects;

/// m: the standard deviation of the smoothing that makes the median falls; none where there are too few transects.
[[nodiscard]] auto blur_from(const Transects& transects) -> std::optional<double>;

/// m: the standard deviation of where the roof ends along a straight edge; none where there are too few transects.
[[nodiscard]] auto roughness_of(const Transects& transects) -> std::optional<double>;

struct Offset {
  geometry::Point2 offset;
  double error = 0, spread = 0;  ///< m
  std::size_t edges = 0;
};
/// None where edges face too few ways.
[[nodiscard]] auto offset_from(const Transects& transects) -> std::optional<Offset>;

}  // namespace mansard::accuracy::detail
