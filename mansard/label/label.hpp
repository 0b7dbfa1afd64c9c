// Says of every face what it is: wall, party wall, roof or ground.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/mesh.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::label {

struct Options {
  double wall_angle = 0.2;      ///< rad from vertical; a side leaning more is roof
  double party_distance = 0.1;  ///< m; walls this near a neighbour's opposite wall are party walls
  double party_share = 0.5;     ///< of a wall's area before which another one stands, from which it is a party wall
  double party_cosine = 0.966;  ///< cosine of 15°: walls that face each other within that are opposite
  /// m; width of the strips in which that share is measured; half of party_distance: no wall is resolved better
  static constexpr double party_strip = 0.05;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

/// Side faces within `wall_angle` of vertical and connectors are walls, the base is ground, soffits are soffits, all
/// else roof. A wall is a party wall where more than `party_share` of its area faces a wall of another solid of the
/// block, opposite and within `party_distance`. Guarantees: 1 one class per face · 2 the order of solids does not
/// matter.
[[nodiscard]] auto classify(std::vector<model::Solid> solids, const Options& options, const base::Run& run = {})
    -> std::vector<model::LabelledSolid>;

/// Areas per class, m².
struct Areas {
  double wall = 0, party_wall = 0, roof_flat = 0, roof_sloped = 0, ground = 0, soffit = 0;
};
[[nodiscard]] auto areas(const model::LabelledSolid& labelled) -> Areas;

}  // namespace mansard::label
