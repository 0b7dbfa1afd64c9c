// Holds a model against known truth: its division into parts, its roofs, its classes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/evaluate/distances.hpp"
#include "mansard/evaluate/planes.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/surfaces.hpp"

namespace mansard::evaluate {

/// The ground area of a part or a building.
using Outline = std::vector<geometry::Polygon>;

/// Seen from above: the union of the ground faces, or of all faces but walls where there are none. Empty where the
/// faces have no area from above. Fails with "geometry-boolean".
[[nodiscard]] auto outline_of(std::span<const model::ModelPart> parts) -> base::Result<Outline>;

/// m² that two outlines have in common. Fails with "geometry-boolean".
[[nodiscard]] auto common_area(const Outline& a, const Outline& b) -> base::Result<double>;

/// Two divisions of the same ground. Parts may overlap, as a tower and its podium do.
struct Partition {
  std::size_t truth = 0, model = 0;  ///< parts with an outline
  std::size_t unchecked = 0;         ///< pairs whose intersection could not be computed; they are not matched
  std::size_t matched = 0;  ///< pairs whose intersection over union is at least one half, one to one, best first
  double iou = 0;           ///< mean of the matched
  std::size_t splits =
      0;  ///< true parts that hold more than half of each of several model parts, none matched elsewhere
  std::size_t merges =
      0;  ///< model parts that hold more than half of each of several true parts, none matched elsewhere
};
[[nodiscard]] auto compare_partition(std::span<const Outline> truth, std::span<const Outline> model) -> Partition;

/// Lengths in metres, each wall counted from both of its sides.
struct PartyWalls {
  double truth = 0, found = 0;  ///< of true outlines along another one; with a shared boundary of the model near by
  double model = 0, right = 0;  ///< of model outlines along another one; with a true one near by
};
inline constexpr double party_touch = 0.1;  ///< m; outlines so near to each other share a boundary
inline constexpr double party_near = 0.5;   ///< m; so near by is found
[[nodiscard]] auto compare_party_walls(std::span<const Outline> truth, std::span<const Outline> model) -> PartyWalls;

/// Roof planes of the truth of 2 m² or more, looked at from above on a grid; shares are of the places seen.
struct Roofs {
  std::size_t planes = 0, found = 0;  ///< found: at least half of its places within both limits
  /// Of those at least three places wide somewhere, both ways: narrower ones (parapets, gutters) melt away in a scan.
  std::size_t broad = 0, broad_found = 0;
  std::size_t places = 0, bare = 0;                     ///< bare: the model has nothing there
  double angle_mean = 0, angle_median = 0;              ///< rad, between the normals
  double offset_median = 0, offset_p95_absolute = 0;    ///< m, model − truth, vertical
  double right_angle = 0, right_height = 0, right = 0;  ///< shares within 3°, within 0.25 m, within both
};
[[nodiscard]] auto compare_roofs(const model::Model& truth, const model::Model& model, double grid) -> Roofs;

/// Classes of the model at open places (open_samples), against that of the nearest surface of the truth.
struct Confusion {
  /// m²: area[truth][model].
  std::array<std::array<double, model::surface_class_count>, model::surface_class_count> area{};
  double beyond = 0;  ///< m² of the model further than `confusion_reach` from any surface of the truth
  /// The share of the area with the right class, of all that is near the truth; 0 for none.
  [[nodiscard]] auto accuracy() const -> double;
};
inline constexpr double confusion_reach = 1.0;  ///< m
/// Of two surfaces of the truth about as near (a surface that looks the other way counts as up to 0.4 m farther), the
/// one that looks the same way is meant.
[[nodiscard]] auto compare_classes(const model::ModelSurface& truth, const model::ModelSurface& model,
                                   const SampleOptions& options, std::uint64_t seed, const base::Run& run = {})
    -> Confusion;

}  // namespace mansard::evaluate
