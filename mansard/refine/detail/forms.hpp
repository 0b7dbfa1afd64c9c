// The roofs that a plan may carry: flat, of one pitch, gabled either way, hipped, each also with a steep foot.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/model/plan.hpp"
#include "mansard/refine/detail/site.hpp"

namespace mansard::refine::detail {

/// A common form of roof over a plan, and how far it is from the samples as far as that shows without extruding it:
/// every sample is under the plane of the side that carries roof and is nearest to it.
struct Form {
  model::Plan plan;
  double misfit = 0;  ///< m²·m²
};

/// The plan with the common forms of roof, each with gutter height and pitch as the site's samples suggest, and as many
/// flat ones as there are levels to end at: the most promising first. Profiles of the plan keep their numbers.
[[nodiscard]] auto forms_of(const model::Plan& plan, const Site& site, const Options& options) -> std::vector<Form>;

/// One roof for all sides that carry it, as the site's samples suggest; it rises, be the scan level. `steep_foot`: with
/// a steep part below a flatter one, of usual size where the scan shows none. None where no sample is near to such a
/// side.
[[nodiscard]] auto roof_over(const model::Plan& plan, const Site& site, const std::vector<bool>& carries,
                             bool steep_foot, const Options& options) -> std::optional<model::Profile>;

/// Per profile of the plan what its sides may carry where the scan shows a level strip along them (`Options::setback`)
/// and something higher behind it: wall, terrace, wall, and what goes on above. Cost: O(cells · edges).
[[nodiscard]] auto setbacks_of(const model::Plan& plan, const Site& site, const Options& options)
    -> std::vector<std::vector<model::Profile>>;

/// A wall of that height, metres; of the minimum height at least.
[[nodiscard]] auto wall(double height, const Options::Forms& options) -> model::Profile;
/// A wall up to the gutter, then a roof.
[[nodiscard]] auto pitched(double gutter, double slope) -> model::Profile;

/// The edges of one profile.
struct Side {
  geometry::Point2 inward;  ///< unit; of its edges together, longer ones counting more
  double length = 0;        ///< m
};
/// Per profile of the plan.
[[nodiscard]] auto sides_of(const model::Plan& plan) -> std::vector<Side>;

/// One edge of a plan.
struct Eaves {
  geometry::Point2 start, along;  ///< along: unit
  double length = 0;              ///< m
  std::uint32_t profile = 0;
};
/// The edges whose profiles carry roof, of all that have a length.
[[nodiscard]] auto eaves_of(const model::Plan& plan, const std::vector<bool>& carries) -> std::vector<Eaves>;

struct Nearest {
  std::uint32_t profile = 0;
  double inward = 0;  ///< m
};
/// The nearest of those in whose strip, widened by 45° to both sides, the place lies.
[[nodiscard]] auto nearest_eaves(const std::vector<Eaves>& eaves, geometry::Point2 at) -> std::optional<Nearest>;

/// Whether a profile is nothing but a wall.
[[nodiscard]] inline auto is_wall(const model::Profile& profile) -> bool { return profile.back().inward == 0; }

}  // namespace mansard::refine::detail
