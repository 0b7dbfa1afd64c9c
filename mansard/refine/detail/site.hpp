// What the mesh shows over one part, and how much each look counts.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/refine/detail/blur.hpp"
#include "mansard/refine/detail/evidence.hpp"
#include "mansard/refine/detail/heights.hpp"
#include "mansard/refine/refine.hpp"

namespace mansard::refine::detail {

struct Site {
  geometry::Polygon polygon;
  double base = 0;       ///< z, metres
  Heights measured;      ///< of the scan's surface; NaN where there is none, or outside the polygon
  double cell_area = 0;  ///< m²

  // The samples: what the scan measured. Of a surface, its height at the centres of the cells, in their order; of
  // points, each of them.
  std::vector<std::uint32_t> cells;  ///< the cell that each lies in
  std::vector<geometry::Point2> places;
  std::vector<double> z;       ///< m above the base
  std::vector<double> weight;  ///< 1; less along the outline
  std::vector<double> sorted;  ///< the heights
  double sample_area = 0;      ///< m²; that each stands for
  bool of_points = false;
  std::vector<std::uint32_t> plane_of;    ///< the plane that each is on, or none; of a surface once it was looked for
  std::span<const planes::Plane> planes;  ///< of all points; their heights are not above the base

  Kernel kernel;  ///< by which the scan smooths, on this grid
  /// Per cell of the grid: 0 outside the polygon, else the factor that makes a sum of `blurred` a mean of what is
  /// inside.
  std::vector<double> unblurred;
  /// Of a surface, the same as `z` and `weight` for sums over whole rows: per cell of the grid, 0 where there is none.
  std::vector<double> heights, weights;
  /// The same, m: what a roof is above the scan by more than that counts linearly. Infinite but in the margin of the
  /// outline that was looked at first: not along cuts.
  std::vector<double> limits;
  /// Per row of the grid the columns [first, last) from its first cell with a height to its last.
  std::vector<std::pair<std::size_t, std::size_t>> extents;
  /// Cells without a height, and how high a roof there may be at most: the crown of a tree hides it.
  std::vector<std::pair<std::uint32_t, double>> ceilings{};

  /// m²: of the ground over which the scan has a surface.
  [[nodiscard]] auto seen_area() const -> double;
};

/// Looks down on the polygon every `grid` metres, at the centres of cells aligned to whole multiples of it; coarser
/// over very large parts. Of a scan that consists of points, those over the polygon are the samples.
[[nodiscard]] auto look(const geometry::Polygon& polygon, double base, const rays::Scene& mesh, const Options& options,
                        const Evidence* points = nullptr) -> Site;
/// A piece of a site that was looked at already.
[[nodiscard]] auto crop(const Site& site, const geometry::Polygon& piece, const Options& options) -> Site;

/// Both pieces of ground as one, the polygon of both given: what was sampled over them, and what is between them.
[[nodiscard]] auto merged(const Site& a, const Site& b, const geometry::Polygon& both, const rays::Scene& mesh,
                          const Options& options, const Evidence* points = nullptr) -> Site;

/// Looks for the planes of the surfaces over some sites, all together.
void put_on_planes(std::span<Site> sites, const Options& options);

/// The same without what is seen at some places.
[[nodiscard]] auto without(const Site& site, const std::function<bool(geometry::Point2)>& taken, const Options& options)
    -> Site;

/// The same of which nothing is seen.
[[nodiscard]] auto without_cells(const Site& site, const Options& options) -> Site;
/// Adds the ceilings: `above` is what is seen with the crowns of trees.
void add_ceilings(Site& site, const rays::Scene& above);

/// Over how many cells of a part of some ground the roof of that ground is above the crown that hides it. `roof`:
/// heights by the cells of the grid of that ground, which has the spacing of the part's.
[[nodiscard]] auto too_high_over(const Site& part, const Heights& grid, const std::vector<double>& roof) -> std::size_t;

/// The middle of the band of height (`Options::Samples::level_band`) that contains the most samples: the level of a
/// flat roof, whatever is built on it.
[[nodiscard]] auto commonest(const std::vector<double>& sorted, const Options& options) -> double;

}  // namespace mansard::refine::detail
