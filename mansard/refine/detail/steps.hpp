// Steps that a scan shows as steep slopes.
#pragma once

#include <cstdint>
#include <vector>

#include "mansard/refine/detail/judge.hpp"

namespace mansard::refine::detail {

/// The plan with another profile on one edge, or on all chords of the curve that it is part of; a profile that other
/// edges carry too stays theirs.
[[nodiscard]] auto carrying(const model::Plan& plan, std::uint32_t ring, std::uint32_t edge, model::Profile profile)
    -> model::Plan;

/// Faces of more than 45° that are no walls: each may be a step that a scan smoothed, or that is between two samples.
[[nodiscard]] auto steep_faces(const Judged& judged) -> std::vector<std::uint32_t>;

/// Roofs with a step instead of a steep face: level to where level and line suit the samples over it best, then a wall.
/// None where the face leaves less than a number costs, or where the step would be nearer to the edge than the scan can
/// tell.
[[nodiscard]] auto with_step(const Judged& judged, std::uint32_t face, const Judge& judge) -> std::vector<model::Plan>;

/// The roof with steps instead of steep faces wherever it then costs no more than `most`.
[[nodiscard]] auto stepped(Judged judged, const Judge& judge, double most) -> Judged;

}  // namespace mansard::refine::detail
