// Drawings of geometry: plans from above, profiles over each other.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "lab/explore/explore.hpp"

namespace mansard::explore::detail {

/// The parts, neighbours in different colours, under the outlines of the GIS footprints, which frame the drawing.
[[nodiscard]] auto plan_drawing(const std::vector<geometry::Polygon>& parts,
                                const std::vector<geometry::Polygon>& footprints, double size, std::string_view label)
    -> std::string;

/// What a profile is: one vertical line; one pitch, above a wall or not; more.
enum class ProfileKind : std::uint8_t { vertical, one_pitch, more };
[[nodiscard]] auto kind_of(const model::Profile& profile) -> ProfileKind;

/// What a dataset's profiles are, by the length of the edges that rise along them.
struct ProfileShares {
  std::size_t profiles = 0, slices = 0, attempted = 0;
  double length = 0;                ///< m
  std::array<double, 3> of_kind{};  ///< m, by ProfileKind
  double unseen = 0;                ///< m without a raw slice: vertical by the prior
};
[[nodiscard]] auto shares_of(const std::vector<Rise>& rises) -> ProfileShares;

/// Height over inward distance, both in metres at one scale, all profiles over each other.
[[nodiscard]] auto profile_drawing(const std::vector<Rise>& rises, std::string_view label) -> std::string;

}  // namespace mansard::explore::detail
