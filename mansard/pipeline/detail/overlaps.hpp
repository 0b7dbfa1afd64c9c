// Solids that overlap: no fault of any of them, and yet nothing that a city can be.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// What there is to say of solids that overlap, in space that grows with the number of solids and not with that of
/// their pairs.
struct Overlaps {
  struct Of {
    std::size_t building = 0;
    base::Diagnostic what;
  };
  std::vector<Of> of_each;               ///< the largest overlaps of each solid, and how many more it has
  std::vector<base::Diagnostic> in_all;  ///< the number of pairs and the largest, and what could not be computed
  std::vector<report::Overlap> pairs;    ///< all that were computed
};

/// Every two of the written solids whose ground floors share any area at all, and whose heights do: walls of neighbours
/// coincide exactly in whole units of the files, or have a gap between them. "pipeline-overlap", or
/// "pipeline-overlap-unchecked" where the ground cannot be intersected. In the order of the buildings. Overhanging
/// eaves are not looked at, nor are solids of one building whose bases are at different heights. Two solids that both
/// overlap many others may not be compared; the numbers are lower bounds then. Cost: O(n log n) for n solids. Nothing
/// once the run is cancelled.
[[nodiscard]] auto overlaps(const std::vector<model::Building>& buildings, const base::Run& run = {}) -> Overlaps;

/// A solid as it stands on the ground: what there is to know of it here.
struct Standing {
  std::size_t building = 0;
  std::string name;  ///< of its first part
  std::vector<geometry::Polygon> ground;
  geometry::Box2 box;
  double low = std::numeric_limits<double>::infinity(), high = -low;
};
[[nodiscard]] auto standing(std::size_t number, const model::Building& building) -> std::vector<Standing>;
/// What of a solid must be known while all are compared.
struct Extent {
  std::uint32_t building = 0, solid = 0;  ///< the number of the building, and that of the solid in it
  geometry::Box2 box;
  double low = 0, high = 0;
};
[[nodiscard]] auto extents(const std::vector<Standing>& solids) -> std::vector<Extent>;
/// All solids of a building. From any thread.
using LoadStanding = std::function<base::Result<std::vector<Standing>>(std::uint32_t building)>;
/// The same of solids in the order of their buildings, of which only those that may overlap are loaded.
[[nodiscard]] auto overlaps(const std::vector<Extent>& solids, const LoadStanding& load, const base::Run& run = {})
    -> Overlaps;

/// Says it among the reasons of the buildings, and among the warnings. `buildings[i]` is the report on
/// `city.buildings[i]`.
void report_overlaps(report::Reconstruction& reconstruction, const base::Run& run = {});

}  // namespace mansard::pipeline::detail
