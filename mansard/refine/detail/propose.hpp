// Where a part may be cut in two so that simple roofs fit better: structures of another height that stand in it or bite
// into it, and straight lines between two roofs. Pure geometry: what a cut is worth in full only raising can tell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/detail/heights.hpp"
#include "mansard/refine/detail/propose_raster.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail {

/// A piece of a part that may become a part of its own.
struct Proposal {
  geometry::Polygon polygon;  ///< metres; in the part, simple; holes only where the part has holes
  double gain = 0;            ///< m²·m²: squared residual, by area, that simple surfaces in the pieces would explain
  std::string what;           ///< for the reader: "stands 2.4 m above the roof around it"
  bool whole_side = false;    ///< one straight line across the part; the piece is one side of it
  bool rim = false;           ///< the rest is a strip around the piece
};

/// A piece of a part with its free sides where the scan has them (place.hpp), and with
/// the part's own corners. None where polygon operations cannot tell the two apart, or too little is left.
[[nodiscard]] auto at_steps(const geometry::Polygon& part, const geometry::Polygon& piece, const Heights& measured,
                            const OnPlanes& samples, const Options& options) -> std::optional<geometry::Polygon>;

/// The cuts worth trying, best first.
///   1. Every polygon lies in the part, is simple, and leaves at least `least_area` on either side.
///   2. No two are nearly the same cut.
///   3. The same input gives the same list, to the byte.
/// Cost: O(n log n) in the cells.
/// Measured and model share one grid; cells that are NaN in either count for nothing. `least_gain`, m²·m²: squared
/// residual, summed over area, that a cut must explain.
/// `samples`: of the scan, with the planes that they are on.
[[nodiscard]] auto propose(const geometry::Polygon& part, const Heights& measured, const Heights& model,
                           double least_gain, const Options& options, const OnPlanes& samples = {})
    -> std::vector<Proposal>;

/// Proposal::gain of cuts that are known. The options must outlive it.
class Gains {
 public:
  Gains(const geometry::Polygon& part, const Heights& measured, const Heights& model, const Options& options);
  /// `along`, unit: of a ridge that the piece may have, or across that.
  [[nodiscard]] auto of(const geometry::Polygon& piece, geometry::Point2 along) const -> double;

 private:
  carve::Raster raster_;
  const Options& options_;
};

}  // namespace mansard::refine::detail
