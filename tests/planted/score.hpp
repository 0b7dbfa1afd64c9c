// How near a segmentation comes to what was planted.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mansard/segment/segment.hpp"
#include "planted.hpp"

namespace mansard::planted {

/// What was planted, or found: polygons that belong to features.
struct Piece {
  geometry::Polygon polygon;
  std::optional<std::size_t> feature;
};
struct Plan {
  std::vector<Piece> pieces;
  std::vector<geometry::Segment2> walls;  ///< between two pieces; of a truth only
};
[[nodiscard]] auto plan_of(const Block& planted) -> Plan;
[[nodiscard]] auto plan_of(const std::vector<segment::Part>& parts) -> Plan;

/// Shares are 0 … 1; of nothing they are 1.
struct Matching {
  double recall = 1;     ///< share of the planted area that has a match: something found with IoU > 0.5, one at most
  double precision = 1;  ///< share of the found area that is such a match
};
struct Score {
  Matching parts;          ///< piece by piece
  Matching features;       ///< all pieces of a feature taken as one
  std::size_t splits = 0;  ///< planted pieces of which two or more found ones take a tenth each and lie mostly inside
  std::size_t merges = 0;  ///< found pieces that hold most of each of two or more planted ones
  double wall_length = 0;  ///< m of planted walls
  double wall_recall = 1;  ///< share of it within 0.5 m of a boundary between two found pieces that runs the same way
  double false_splits =
      0;                   ///< m of such boundaries farther than 0.5 m from any planted wall, per metre of planted wall
  double pair_recall = 1;  ///< of the pairs of places in one planted piece, those in one found piece
  double pair_precision = 1;  ///< the reverse
  double rand = 1;            ///< share of all pairs of planted places judged alike: together, or apart
};

/// Places that no found piece covers count as one found piece in the pair scores. With walls of no length, false splits
/// are in metres.
[[nodiscard]] auto score(const Plan& truth, const Plan& found) -> Score;

}  // namespace mansard::planted
