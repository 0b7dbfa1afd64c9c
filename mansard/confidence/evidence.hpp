// What a scan says for and against the model of one building, measured after it is made.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/accuracy.hpp"
#include "mansard/model/solid.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::confidence {

/// The measures. Shares are 0 to 1; "off" is farther from the model than the smallest detail and three times the noise.
/// Cells "beside walls", nearer than where the scan shows an edge, are in none but `unseen`, `bare` and `walls`.
enum class Measure : std::uint8_t {
  area,         ///< m² of the footprint
  height,       ///< m; median of the model's heights above the ground
  unseen,       ///< share of the footprint that the scan does not cover, or covers with crowns of trees
  crowns,       ///< share of the footprint below such crowns
  bare,         ///< share of the footprint without a model where the scan does not show the ground
  razed,        ///< share of the footprint without a model where it does
  rms,          ///< m; root mean square of scan − model
  bias,         ///< m; median of the same
  above,        ///< share of cells in which the scan is off above the model
  below,        ///< share of cells in which it is off below the model
  patch_above,  ///< m²; the largest area of connected such cells above
  patch_below,  ///< m²; and below
  stacked,      ///< m; mean of the differences above, over all cells
  sunk,         ///< m; mean of the differences below, over all cells
  top,          ///< m; the 99th percentile of scan − model
  rough,        ///< share of cells in which scan − model is 0.25 m and four times the noise off the median around
  ring_high,    ///< share of a ring outside the free edges in which the scan is above half of the height
  ring_side,    ///< the largest such share of an eighth of that ring, by direction
  gap,  ///< area on no footprint, within 2 m, that is above half of the height in the scan, over that of the footprint
  seamless,  ///< share of an eighth of that ring in which the scan goes on as it does inside of the outline, nearer to
             ///< this footprint than to others: the maximum minus the minimum, since roofs overhang on all sides
  rim_low,   ///< share of a rim inside the free edges in which the scan is below half of the model's height there
  rim_side,  ///< the largest such share of an eighth of that rim
  free,      ///< length of the free edges, as a share of the outline's
  walls,     ///< share of the cells that are beside walls
  steps,     ///< m; squared height × length of the model's own walls within the footprint, over its area
  misplaced,  ///< m²; mean square of scan − model over the footprint, of cells where the scan shows the other side of a
              ///< wall
  relief,        ///< m; standard deviation of the scan's heights over the footprint
  low,           ///< share of cells in which the scan is less than 1.5 m above the ground, and there is a model
  ground_off,    ///< m; the model's ground above the median of the scan outside the ring, where that is lower than half
  samples,       ///< points, or independent areas of the scan's noise, over the footprint
  planes,        ///< roof faces of the model of 1 m² or more
  small_planes,  ///< share of the roof's area in faces of less than 4 m²
  steep,         ///< share of the roof's area that is steeper than 60°
  spread,        ///< m; from the 5th to the 95th percentile of the model's heights
  noise,         ///< m; of the scan over the block
  spacing,       ///< m; of the same
  blur,          ///< m; of the same, of edges
  edge_noise,    ///< m; of the same
  offset,        ///< m; of the footprints of the block against the scan
  height_off,    ///< m; the model's height less that which the footprint's own attribute says; 0 without one
  doubtful,      ///< 1 where the ground is assumed or the lowest that is seen
  fallback       ///< share of the parts that are simpler than their profiles
};
inline constexpr std::size_t measures = 42;
/// As in the enumeration.
[[nodiscard]] auto name_of(Measure measure) -> std::string_view;

struct Evidence {
  std::array<double, measures> of{};
  [[nodiscard]] auto operator[](Measure measure) -> double& { return of[static_cast<std::size_t>(measure)]; }
  [[nodiscard]] auto operator[](Measure measure) const -> double { return of[static_cast<std::size_t>(measure)]; }
};

/// A building and what is around it, in one frame.
struct Site {
  std::span<const geometry::Polygon> footprint;
  std::span<const geometry::Polygon> others;  ///< footprints near it, of its block and of others
  std::span<const model::LabelledSolid* const> solids;
  const rays::Scene& scan;  ///< as it was scanned
  const rays::Scene& seen;  ///< without crowns; the same where there are none
  double ground = 0;        ///< z, m
  const model::Accuracy& accuracy;
};
/// Measures of form and scan; those that only the run knows (height_off, doubtful, fallback) stay 0.
/// Guarantee: a function of the site alone. Cost: some thousands of cells whatever the size.
[[nodiscard]] auto evidence_of(const Site& site) -> Evidence;

}  // namespace mansard::confidence
