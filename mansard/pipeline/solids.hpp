// The solids that are written of a city's buildings.
#pragma once

#include <span>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/city.hpp"

namespace mansard::pipeline {

/// What came of a building's solids otherwise than as one valid solid of all its parts: codes of solid::unite.
struct SolidsOf {
  std::size_t building = 0;
  std::vector<base::Diagnostic> warnings;
  std::vector<std::size_t> simplified;  ///< parts whose model is a prism now
};

/// Gives every building the union of its parts (solid::unite_all), over one plan of each group of buildings that touch.
[[nodiscard]] auto unite_parts(std::span<model::Building> buildings) -> std::vector<SolidsOf>;

}  // namespace mansard::pipeline
