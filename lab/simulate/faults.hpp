// Faults of surveys, planted building by building, each written down: what a scan or a footprint can have wrong while
// all others are right. What a program says of them can then be compared with what it should have known.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mansard/model/scene.hpp"

namespace mansard::simulate {

struct Truth;
struct Scan;
struct AirbornePoints;

/// `amount` of a Fault is in brackets.
enum class FaultKind : std::uint8_t {
  unseen,      ///< the scan has nothing on one side of a line (share of the outline's width)
  sparse,      ///< few points are left over the building (points a square metre); of clouds
  classes,     ///< the building's points have class 67 on one side of a line (share of the width); of clouds
  crown,       ///< a crown on the roof, labelled as building (share of the outline's area)
  scaffold,    ///< a scaffold with a sheet around all walls, as high as the roof (m wide)
  crane,       ///< the boom of a crane above the roof, labelled as building (m above it)
  pits,        ///< glass or water: patches of heights that are metres too low (share of the outline's area)
  demolished,  ///< the scan shows the ground (0)
  lower,       ///< the scan is older than a storey (m that it shows less)
  deck,        ///< a deck, bridge or terrace beside a wall, at two thirds of the height (m wide)
  moved,       ///< the footprint is beside the building (m)
  turned,      ///< the footprint is turned about its middle (rad)
  larger,      ///< the footprint is larger than the building, in one direction (factor)
  smaller      ///< the footprint is a part of the building (factor)
};
inline constexpr std::size_t fault_kinds = 14;
/// By the names of the enumeration.
[[nodiscard]] auto to_string(FaultKind kind) -> std::string_view;

struct Fault {
  std::uint32_t building = 0;  ///< index into City::buildings
  FaultKind kind = FaultKind::unseen;
  double amount = 0;
  double direction = 0;  ///< rad; of a displacement, or from what is kept to what is lost
};

/// `share` of the buildings have a fault each, of a kind that is drawn; without `points`, none of those that only
/// clouds have, and without `heights` of the footprints none that nothing else can show (lower). Buildings of less than
/// 20 m² have none: what is seen of them is decided by a cell or two. Guarantee: the same truth, share and seed give
/// the same faults.
[[nodiscard]] auto faults_of(const Truth& truth, double share, bool points, bool heights, std::uint64_t seed)
    -> std::vector<Fault>;

/// Those of the scanned surface. The spacing of new triangles is the scan's.
void plant(const std::vector<Fault>& faults, const Truth& truth, std::uint64_t seed, Scan& scan);
/// Those that clouds alone have.
void plant(const std::vector<Fault>& faults, const Truth& truth, std::uint64_t seed, AirbornePoints& points);
/// Those of the survey. A feature of several buildings has the fault of the first that has one.
void plant(const std::vector<Fault>& faults, const Truth& truth, std::vector<model::Footprint>& footprints);

}  // namespace mansard::simulate
