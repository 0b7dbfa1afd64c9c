// Compares models with the scan: the paper's vertical error, and what it does not see.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
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
  double grid = 0.25;   ///< m between samples
  double margin = 0.0;  ///< m around the bounding box
  double inset = 0.75;  ///< m; how deep inside the footprints the scores `inside` begin; 0: they are not measured
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Signed vertical differences, model − mesh, on a grid; NaN where either has no surface.
struct ErrorMap {
  geometry::Point2 origin;  ///< centre of cell (0, 0)
  double grid = 0.25;       ///< m
  std::size_t columns = 0, rows = 0;
  std::vector<float> difference;  ///< m, row by row from the south
  [[nodiscard]] auto at(std::size_t column, std::size_t row) const -> float {
    return difference[row * columns + column];
  }
};

/// The error over the footprints, but for a strip along their boundary, where a scan's smoothed corners and the
/// survey's own error matter more than the roofs. Misses count as in footprint_mse.
struct InsideScores {
  std::size_t cells = 0;
  double mse = 0;              ///< m²
  double median_absolute = 0;  ///< m
};

struct Scores {
  std::size_t cells = 0;     ///< where both surfaces exist
  double mse = 0;            ///< m²; the paper's error: both surfaces hit, over the bounding box
  double footprint_mse = 0;  ///< m²; over the GIS footprints only; where the model misses, its height is the ground's
  std::size_t footprint_cells = 0;
  double footprint_median_absolute = 0;  ///< m; over the same cells, misses counted
  /// More than Options::inset from the boundary of the footprints' union: where footprints touch (are closer than 0.1
  /// m) there is no boundary, so that party walls do not count as one.
  InsideScores inside;
  InsideScores inside_each;    ///< more than that from the boundary of each footprint, party walls or not
  double median = 0;           ///< m, signed
  double median_absolute = 0;  ///< m
  double p95_absolute = 0;     ///< m
  double missed = 0;           ///< m² of GIS footprint without model
  double invented = 0;         ///< m² of model outside the GIS footprints
  bool union_unknown = false;  ///< the footprints' union could not be computed: `inside` is measured as `inside_each`
};

/// Model − mesh in metres of every cell that a median of Scores is of, row by row from the south.
struct Differences {
  std::vector<float> footprints, inside, inside_each;
  void add(const Differences& more);
};

struct Comparison {
  Scores scores;
  ErrorMap map;
  Differences differences;
  std::size_t lost = 0;  ///< solids that cannot be cut into triangles: they count as missed
};

/// The top surfaces of the model and of the mesh over a grid.
/// `footprints` restrict footprint_mse, missed and invented; `ground` is the z that a missing model counts as.
/// Guarantees: 1 a mesh against itself scores 0 · 2 a constant lift by h scores h² · 3 the grid is aligned to whole
/// multiples of its spacing, so equal areas get equal samples. Cost: O(area / grid² · log n).
[[nodiscard]] auto compare(std::span<const model::LabelledSolid> model, const rays::Scene& mesh,
                           std::span<const geometry::Polygon> footprints, double ground, const Options& options,
                           const base::Run& run = {}) -> Comparison;

/// The same for any surface: solids of other producers, and models of several of them.
[[nodiscard]] auto compare(const geometry::Mesh& model, const rays::Scene& mesh,
                           std::span<const geometry::Polygon> footprints, double ground, const Options& options,
                           const base::Run& run = {}) -> Comparison;

/// The scores over these footprints alone, where they are small: `mse` and what is of it over their cells rather than
/// over the bounding box, and nothing invented. Cost: O(area / grid² · log n).
[[nodiscard]] auto scores_over(const rays::Scene& model, const rays::Scene& mesh,
                               std::span<const geometry::Polygon> footprints, double ground, const Options& options)
    -> Scores;

/// `footprint_mse` of scores_over for a surface of solids, m²; none where the mesh has no surface over the footprints.
/// Solids that cannot be cut into triangles count as missed.
[[nodiscard]] auto footprint_error(std::span<const model::Solid* const> solids, const rays::Scene& mesh,
                                   std::span<const geometry::Polygon> footprints, double ground, const Options& options)
    -> std::optional<double>;

/// The footprints raised flat to one height: what any model has to be better than.
struct Prism {
  double height = 0;  ///< z, m: the median of the mesh's top surface over the cells of the footprints
  Scores scores;      ///< as scores_over; without cells where the mesh has no surface there
  Differences differences;
};
[[nodiscard]] auto prism_over(const rays::Scene& mesh, std::span<const geometry::Polygon> footprints,
                              const Options& options) -> Prism;
/// The same prism, of a height that is known, against another surface.
[[nodiscard]] auto prism_over(const rays::Scene& mesh, std::span<const geometry::Polygon> footprints, double height,
                              const Options& options) -> Prism;

/// Several maps of one spacing as one; where two have a value the later one counts. With more cells than `most`, as for
/// buildings spread over a county, the cells are a whole number of times larger, each the mean of those in it.
[[nodiscard]] auto merged(std::span<const ErrorMap> maps, std::size_t most = 16'000'000) -> ErrorMap;

/// Sets median, median_absolute and p95_absolute by the differences, model − mesh in metres; NaN ones do not count.
void set_quantiles(std::span<const float> differences, Scores& scores);
/// Sets the medians over and inside the footprints.
void set_quantiles(const Differences& differences, Scores& scores);

/// Scores of several places as those of all of them. Medians and percentiles cannot be added up: they are weighted
/// means, good enough for a headline; set_quantiles has the exact ones.
[[nodiscard]] auto combined(std::span<const Scores> scores) -> Scores;

/// Mean squared vertical error, m², of one solid over its own polygon: its roof, without what is nearer than
/// Options::inset to a wall of it or to the polygon's boundary (away_from_walls). Cells where the mesh has no surface
/// do not count; without any it is infinite.
[[nodiscard]] auto error_over(const model::Solid& solid, const geometry::Polygon& polygon, const rays::Scene& mesh,
                              const Options& options) -> double;

}  // namespace mansard::evaluate
