// Finds the crowns of trees over and beside roofs, so that no later stage takes them for parts of buildings.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::vegetation {

struct Options {
  bool mask = true;         ///< whether crowns are found at all
  double grid = 0.25;       ///< m between samples of the top surface
  double reach = 4.0;       ///< m; crowns are looked for up to this distance outside the outline
  double window = 2.75;     ///< m; side of the squares in which the surface is compared with a plane
  double roughness = 0.08;  ///< m, root mean square off the best plane: more is not a plane roof
  /// Maximum agreement of the slopes in a square, on two directions at right angles, of a crown. Measured on simulated
  /// crowns of odd seeds: docs/decisions/0062.
  double local_squareness = 0.7;
  double width = 1.25;      ///< m; what is rough over less than that is an edge, a parapet or a chimney
  double step = 1.0;        ///< m; heights of neighbouring samples that differ by more belong to different objects
  double min_area = 3.0;    ///< m², of the rough surface
  double max_area = 200.0;  ///< m²
  double min_inside = 0.5;  ///< m² of it over the outline; other trees do not matter
  /// Maximum agreement of all slopes of a crown on two directions at right angles. Roof structures have 0.44 and more:
  /// docs/decisions/0062.
  double squareness = 0.45;
  double overhang = 0.06;  ///< share of samples with the underside of the surface visible below them
  /// Minimum share of a crown outside the footprints for it to be that of a tree beside the building. Chosen by hand;
  /// not measured.
  double beyond = 0.25;
  double rise_beside = 2.0;      ///< m from the lowest to the highest sample of such a crown
  double rise_within = 3.0;      ///< m; the same of crowns within the outline, where roof structures overhang too
  double even = 0.05;            ///< m, root mean square: planes are grown from places so even over half a window
  double plane_distance = 0.12;  ///< m; what is so near to a plane is on it
  double plane_area = 8.0;       ///< m²; a plane of so much is a roof: the top of a crown is smaller
  double near_underside =
      2.0;              ///< m; over the outline, a crown is no farther than that from where it hangs over something
  double margin = 0.5;  ///< m; also removed around a crown, where the scan melts it into the roof
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// One crown, and by what it was recognised.
struct Crown {
  geometry::Point2 centre;  ///< metres
  double area = 0;          ///< m², seen from above
  double inside = 0;        ///< m² of it over the outline
  double top = 0;           ///< z, metres
  double rise = 0;          ///< m, of that above its lowest sample
  double roughness = 0;     ///< m, mean over its samples
  double squareness = 0;    ///< 0 … 1
  double overhang = 0;      ///< 0 … 1
};

struct Found {
  std::vector<Crown> crowns;             ///< from south to north, then from west to east
  std::vector<std::uint32_t> triangles;  ///< of the mesh, ascending: those of crowns
  std::vector<std::uint32_t> below;      ///< the same, and all that is above or below a crown
};

/// Regions of the top surface that are rough at the scale of a metre or two, slope to all sides and hang over what is
/// below them. Guarantees: 1 a mesh of planes wider than `window` has no crowns ·
/// 2 the same bytes at any thread count · 3 no triangle farther than reach + margin from the outline is named.
/// `footprints`: the buildings that make the outline. A region that covers most of one of them is that building, unless
/// half of it is beyond; then what has no visible underside is still roof. Cost: O(area / grid² + triangles).
[[nodiscard]] auto find(const geometry::Mesh& mesh, std::span<const geometry::Polygon> outline,
                        std::span<const std::vector<geometry::Polygon>> footprints, const Options& options,
                        const base::Run& run = {}) -> Found;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::vegetation
