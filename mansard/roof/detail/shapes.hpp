// What the edges of an outline do under each shape of roof, at unit slope.
#pragma once

#include <optional>
#include <vector>

#include "mansard/roof/detail/crest.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof::detail {

/// A roof in which every edge that moves does so alike, or with its lag: all shapes but skillion and pyramidal.
struct Design {
  Shape shape = Shape::hipped;  ///< what is made, which need not be what was asked for
  std::vector<Sweep> sweeps;    ///< per side
  std::vector<bool> half_move;  ///< per side: it moves up to Options::half_hip of the height, and stands upright above
  std::vector<bool> half_way;   ///< per side: its eaves are half-way up, and its slope is half as steep
  bool as_asked = true;
  std::vector<base::Diagnostic> warnings;
};
[[nodiscard]] auto design_of(const geometry::Polygon& polygon, const std::vector<Side>& sides, const Form& form,
                             const Options& options) -> Design;

/// The way the ridge of a roof over the smallest box around an outline goes: along its longer side, or as orientation
/// and direction say. With `to_end`, the direction is that of an end of the ridge.
[[nodiscard]] auto ridge_axis(const Extent& extent, const Form& form, bool to_end = false) -> geometry::Point2;

/// A direction of the compass, radians from north clockwise, as a unit vector.
[[nodiscard]] auto pointing(double bearing) -> geometry::Point2;

/// A plane over the whole outline, swept by the edges that lie level in it.
struct Slope {
  geometry::Polygon polygon;  ///< the outline, low corners cut off
  geometry::Point2 uphill;    ///< unit
  double low = 0, run = 0;    ///< m; uphill · p is from low to low + run
  std::size_t cut = 0;        ///< how many corners
};
[[nodiscard]] auto slope_of(const geometry::Polygon& polygon, const Form& form, const Options& options) -> Slope;
/// The same for a slope that is known.
[[nodiscard]] auto slope_along(const geometry::Polygon& polygon, geometry::Point2 uphill, const Options& options)
    -> Slope;
/// Per side of the slope's polygon: whether it is level in the plane, the plane rising from it.
[[nodiscard]] auto level_sides(const std::vector<Side>& sides, geometry::Point2 uphill, const Options& options)
    -> std::vector<bool>;

/// The apex of a pyramid: the centroid if it sees all sides from far enough, else the place that sees them best.
[[nodiscard]] auto apex_of(const geometry::Polygon& polygon, const std::vector<Side>& sides, const Options& options)
    -> std::optional<geometry::Point2>;

}  // namespace mansard::roof::detail
