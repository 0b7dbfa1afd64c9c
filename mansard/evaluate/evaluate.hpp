// Compares models with the scan: the paper's vertical error, and what it does not see.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/label/label.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::evaluate {

struct Options {
  double grid = 0.25;  ///< m between samples
  double margin = 0.0; ///< m around the bounding box
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Signed vertical differences, model − mesh, on a grid; NaN where either has no surface.
struct ErrorMap {
  geometry::Point2 origin;  ///< centre of cell (0, 0)
  double grid = 0.25;       ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<float> difference;  ///< m, row by row from the south
  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> float { return difference[row * columns + column]; }
};

struct Scores {
  std::size_t cells = 0;      ///< where both surfaces exist
  double mse = 0;             ///< m²; the paper's error: both surfaces hit, over the bounding box
  double footprint_mse = 0;   ///< m²; over the GIS footprints only; where the model misses, its height is the ground's
  std::size_t footprint_cells = 0;
  double median = 0;          ///< m, signed
  double median_absolute = 0; ///< m
  double p95_absolute = 0;    ///< m
  double missed = 0;          ///< m² of GIS footprint without model
  double invented = 0;        ///< m² of model outside the GIS footprints
};

struct Comparison {
  Scores scores;
  ErrorMap map;
};

/// The top surfaces of the model and of the mesh over a grid.
/// `footprints` restrict footprint_mse, missed and invented; `ground` is the z that a missing model counts as.
/// Guarantees: 1 a mesh against itself scores 0 · 2 a constant lift by h scores h² · 3 the grid is aligned to whole
/// multiples of its spacing, so equal areas get equal samples. Cost: O(area / grid² · log n).
[[nodiscard]] auto compare(std::span<const label::LabelledSolid> model, const rays::Scene& mesh,
                           std::span<const geometry::Polygon> footprints, double ground, const Options& options,
                           const base::Run& run = {}) -> Comparison;

/// The same of any surface; what is not a solid of ours, and the models of several makers.
[[nodiscard]] auto compare(const geometry::Mesh& model, const rays::Scene& mesh,
                           std::span<const geometry::Polygon> footprints, double ground, const Options& options,
                           const base::Run& run = {}) -> Comparison;

/// The scores over these footprints alone, where they are small: `mse` and what is of it over their cells rather than
/// over the bounding box, and nothing invented. Cost: O(area / grid² · log n).
[[nodiscard]] auto scores_over(const rays::Scene& model, const rays::Scene& mesh,
                               std::span<const geometry::Polygon> footprints, double ground, double grid) -> Scores;

/// Several maps of one spacing as one; where two have a value the later one counts. With more cells than `most`, as for
/// buildings spread over a county, the cells are a whole number of times larger, each the mean of those in it.
[[nodiscard]] auto merged(std::span<const ErrorMap> maps, std::size_t most = 16'000'000) -> ErrorMap;

/// Sets median, median_absolute and p95_absolute by the differences, model − mesh in metres; NaN ones do not count.
void set_quantiles(std::span<const float> differences, Scores& scores);

/// Mean squared vertical error, m², of one solid over its own polygon, for choosing between candidates; cells where the
/// mesh has no surface do not count. `grid` in metres.
[[nodiscard]] auto error_over(const extrude::Solid& solid, const geometry::Polygon& polygon, const rays::Scene& mesh,
                              double grid) -> double;

}  // namespace mansard::evaluate
