// Buildings as lots with the kind of their roof, before anything is extruded.
#pragma once

#include <string>
#include <vector>

#include "lab/simulate/simulate.hpp"
#include "mansard/model/plan.hpp"

namespace mansard::simulate::detail {

inline constexpr double degree = 0.017453292519943295;

enum class Roof : std::uint8_t { flat, pitched, mansard, mono };

/// A piece of a building with one roof.
struct Lot {
  std::string role = "house";  ///< house, annex, extension, bay window, dormer, …: docs/simulate.md
  geometry::Polygon polygon;
  Roof roof = Roof::flat;
  double base = 0;     ///< m above the building's ground
  double eaves = 6;    ///< m above the building's ground
  double pitch = 0.7;  ///< rad; of the upper part of a mansard roof
  /// Per edge of the outer ring: whether it stands upright up to the roof, as gables do. Edges of holes never lean on a
  /// mono roof.
  std::vector<bool> upright;
  bool parapet = false;  ///< around a flat roof, as a part of its own on top
  bool gutter = false;   ///< the roof begins behind a gutter
  double overhang = 0;   ///< m; of the eaves
};

/// A building: one GIS feature.
struct House {
  std::string id;
  std::string roof;   ///< in a word, for the truth's attributes
  double ground = 0;  ///< z, metres
  int storeys = 1;
  std::vector<Lot> lots;
};

/// How high above the eaves a roof may end, metres.
inline constexpr double most_rise = 6.5;

/// A lot as plan + profiles on that ground. Fails as extrude::crest does.
[[nodiscard]] auto plan_of(const Lot& lot, double ground) -> base::Result<model::Plan>;

/// The lot and, where it is wide enough, its parapet. Fails with "geometry-boolean".
[[nodiscard]] auto with_parapet(const Lot& lot) -> base::Result<std::vector<Lot>>;

/// The buildings of a block in its own frame: the street along x, the ground at 0.
[[nodiscard]] auto houses_of(Kind kind, const BlockOptions& options, base::Random& random) -> std::vector<House>;

}  // namespace mansard::simulate::detail
