// Solids that overlap: no fault of any of them, and yet nothing that a city can be.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// Two solids, of one building or of two.
struct Overlap {
  std::size_t building = 0, other = 0;
  base::Diagnostic first, second;  ///< what each says of the other
  std::optional<double> volume;    ///< m³, at most; none where it could not be computed
};

/// Every two of the written solids whose ground floors share any area at all, and whose heights do: walls of neighbours
/// coincide exactly in whole units of the files, or have a gap between them. "pipeline-overlap", or
/// "pipeline-overlap-unchecked" where the ground cannot be intersected. In the order of the buildings. Overhanging
/// eaves are not looked at. Cost: O(n log n) for n solids whose boxes overlap few others.
[[nodiscard]] auto overlaps(const std::vector<model::Building>& buildings) -> std::vector<Overlap>;

/// A solid as it stands on the ground: what there is to know of it here.
struct Standing {
  std::size_t building = 0;
  std::string name;  ///< of its first part
  std::vector<geometry::Polygon> ground;
  geometry::Box2 box;
  double low = std::numeric_limits<double>::infinity(), high = -low;
};
[[nodiscard]] auto standing(std::size_t number, const model::Building& building) -> std::vector<Standing>;
/// The same of solids in the order of their buildings.
[[nodiscard]] auto overlaps(std::vector<Standing> all) -> std::vector<Overlap>;

/// What is said of the whole: one warning with the number and the largest, and all that could not be computed.
[[nodiscard]] auto overlaps_in_all(const std::vector<Overlap>& overlaps) -> std::vector<base::Diagnostic>;

/// Says it among the reasons of both buildings, and among the warnings. `buildings[i]` is the report on
/// `city.buildings[i]`.
void report_overlaps(report::Reconstruction& reconstruction);

}  // namespace mansard::pipeline::detail
