// From the rings a file has to simple, oriented polygons, or the reason why not.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/vector/features.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::ingest::detail {

struct Repaired {
  std::vector<geometry::Polygon> polygons;  ///< empty exactly when there is a defect
  std::optional<base::Diagnostic> defect;   ///< without a subject
  std::vector<std::string> repairs;         ///< what was changed beyond repeated points, in words
};

/// Local frame; `origin` is added to the coordinates that messages name. Repeated points (closer than 1 mm) go
/// silently; spikes, small crossings and places where rings come within 1 mm of each other are repaired as long as the
/// area stays within 1 %; rings that touch are bridged by 5 cm.
[[nodiscard]] auto repair(const std::vector<formats::RawPolygon>& parts, const std::array<double, 2>& origin)
    -> Repaired;

}  // namespace mansard::ingest::detail
