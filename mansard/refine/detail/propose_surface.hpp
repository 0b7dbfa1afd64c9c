// How well simple surfaces fit a set of cells: sums that add and subtract, so that any cut is tried at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mansard/geometry/fit.hpp"
#include "mansard/refine/detail/propose_raster.hpp"

namespace mansard::refine::detail::carve {

/// The plane through samples, of which there is one at least; level where they are on one line in plan.
[[nodiscard]] auto plane_of(const geometry::PlaneSums& sums) -> geometry::FittedPlane;

/// Sums over cells; x and y from the raster's corner, metres.
struct Moments : geometry::PlaneSums {
  double zz = 0, r = 0, rr = 0;  ///< r: residuals of the model
  void add(double px, double py, double pz, double pr);
  auto operator+=(const Moments& o) -> Moments&;
  auto operator-=(const Moments& o) -> Moments&;
};

/// Σ squared error, m² × cells, of the best of: the model, the model lifted, a level, a plane.
[[nodiscard]] auto plain_error(const Moments& m) -> double;

/// Of the best roof with its ridge at `knot` across the direction, sums given left and right of it. Infinite where the
/// two slopes make a valley, which is two roofs, or one is too steep for a roof.
[[nodiscard]] auto ridge_error(const geometry::LineSums& left, const geometry::LineSums& right, double knot,
                               double max_slope) -> double;

/// Of the best of all ridges over a row of bins, given as running sums: bin i is sums[i + 1] − sums[i], knots between
/// bins at first_knot + i·step.
[[nodiscard]] auto best_ridge_error(std::span<const geometry::LineSums> sums, double first_knot, double step,
                                    const Options::Surfaces& options) -> double;

/// Errors of one set of cells, m² × cells: of the model as it is, and of the best simple surface (or the model).
struct Error {
  double count = 0, model = 0, best = 0;
};

/// What a cut explains, m² × cells. Where one surface for all would explain most of what the model leaves, only what
/// two explain beyond that one; else what the smaller side alone gains over the model, if that is more, since one
/// surface for all would bend towards whatever else stands in the part.
[[nodiscard]] auto gain_of(const Error& inside, const Error& outside, const Error& whole,
                           const Options::Surfaces& options) -> double;

/// Two sets of cells, each by its best simple surface, and both by one.
struct Errors {
  Error inside, outside, whole;
};
[[nodiscard]] auto errors_of(const Raster& raster, const std::vector<std::uint8_t>& mask, const Frame& ridges,
                             const Options::Surfaces& options) -> Errors;
[[nodiscard]] inline auto gain_of(const Errors& errors, const Options::Surfaces& options) -> double {
  return gain_of(errors.inside, errors.outside, errors.whole, options);
}

}  // namespace mansard::refine::detail::carve
