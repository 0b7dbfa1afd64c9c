// Roofs of one kind, as an editor asks for them: the best of that kind for the scan; and the roof as it is, where the
// scan has it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mansard/refine/refine.hpp"

namespace mansard::refine {

enum class Kind : std::uint8_t {
  flat,
  shed,      ///< slopes on sides that face one way
  gable,     ///< slopes on sides that face two opposite ways
  hip,       ///< slopes on all sides
  half_hip,  ///< as a gable, the tops of whose ends slope
  gablet,    ///< as a hip, the tops of whose ends are upright
  pyramid,   ///< slopes on all sides that meet in one point
  gambrel,   ///< as a gable, each slope with a steep foot
  mansard,   ///< as a hip, each slope with a steep foot
};
inline constexpr std::array kinds{Kind::flat,   Kind::shed,    Kind::gable,   Kind::hip,    Kind::half_hip,
                                  Kind::gablet, Kind::pyramid, Kind::gambrel, Kind::mansard};
[[nodiscard]] auto to_string(Kind kind) -> std::string_view;

/// The outline of `plan` with the cheapest roof of the kind: its direction, and the gutter, pitch and knot of the sides
/// that face one way, by what the scan shows over it. `shared`: per edge of the outer ring whether a neighbour is
/// there; such edges have walls, unless the scan shows that the roof rises from them. Courtyards have walls. Fails with
/// "refine-kind" where the outline takes no roof of the kind that can be raised in full, and with "refine-unseen" where
/// the scan shows nothing.
/// Cost: some dozens of roofs; milliseconds for a house.
[[nodiscard]] auto roof_of(Kind kind, const model::Plan& plan, const std::vector<bool>& shared, const rays::Scene& mesh,
                           const Options& options, const extrude::Options& raising, const base::Run& run = {})
    -> base::Result<model::Plan>;

/// The same roof with the gutters, pitches and knots of its profiles and its cap where the scan has them; as it is
/// where that is no better. Fails as roof_of.
[[nodiscard]] auto fitted(const model::Plan& plan, const rays::Scene& mesh, const Options& options,
                          const extrude::Options& raising, const base::Run& run = {}) -> base::Result<model::Plan>;

}  // namespace mansard::refine
