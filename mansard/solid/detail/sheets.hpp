// The faces of several solids over one integer plan, in which every point that lies on a wall is a corner of it.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mansard/model/file_grid.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::solid::detail {

using model::quanta_per_metre;  // points are on the grid of the files

using Place = std::array<std::int64_t, 2>;  ///< x and y from the origin of the sheets

/// A corner: a point of the plan, by its number, and a height.
struct Node {
  std::uint32_t at = 0;
  std::int64_t z = 0;
  friend auto operator<=>(const Node&, const Node&) = default;
};
using Path = std::vector<Node>;
using Step = std::pair<std::uint32_t, std::uint32_t>;  ///< from one point of the plan to another

enum class Facing : std::uint8_t { up, down, aside };

/// A face of one of the solids.
struct Sheet {
  Facing facing = Facing::up;
  std::uint32_t solid = 0, face = 0;
  std::vector<Path> paths;  ///< as the loops of a face
};

/// Whose corner is at a place, too, where it is not 0: another building's, or another solid's of the building.
inline constexpr std::uint8_t of_a_building = 1, of_a_solid = 2;

struct Sheets {
  Place origin{};
  std::int64_t level = 0;  ///< whole quanta, as `origin`: heights of a union count from here until it is finished
  std::int64_t near = model::least_apart;  ///< quanta; points nearer than this become one
  std::vector<Place> places;
  std::vector<Sheet> sheets;
  std::vector<std::int64_t> base;    ///< of each solid
  std::vector<std::uint8_t> pinned;  ///< by place: whose corner it is, too, and stays; see below
};

/// None where a solid has more than one level of ground, or soffits: it is no height field then.
[[nodiscard]] auto sheets_of(std::span<const model::LabelledSolid* const> parts, std::int64_t near = model::least_apart)
    -> std::optional<Sheets>;

/// What a solid has on one side of a step: the roof over it, from its start to its end.
struct Side {
  std::uint32_t sheet = 0;
  std::int64_t z0 = 0, z1 = 0;
};
/// By the step that has the side on its left.
using Sides = std::map<Step, Side>;

/// None where two roofs claim the same side of a step: the solids overlap.
[[nodiscard]] auto sides_of(const Sheets& sheets) -> std::optional<Sides>;

/// By solids of several owners: the first of the owners that each belongs to, when those are put together whose ground
/// comes nearer than Sheets::near in plan. An owner stays by itself where its ground overlaps that of others at more
/// than some dozen edges.
[[nodiscard]] auto touching(const Sheets& sheets, const std::vector<std::uint32_t>& owner_of_solid,
                            std::uint32_t owners) -> std::vector<std::uint32_t>;

/// Merges points that are nearer than Sheets::near in space, breaks walls where points come as near in plan, where they
/// cross, and where one roof passes through another along them. False where this does not come to an end.
[[nodiscard]] auto conform(Sheets& sheets) -> bool;

/// Where solids of one owner would meet in an vertical line only, cuts a corner off the solids on one side, 1.3 mm to 2
/// cm long: what is beside them takes it, so that it is joined across the corner, else there is a gap. Where the corner
/// is too sharp, or too near the next one, nothing is cut. After conform(). Whether anything was.
auto cut_corners(Sheets& sheets, const std::vector<std::uint32_t>& owner_of_solid) -> bool;

/// Whether conform() moved nothing: all that came to the faces are corners on their edges, and those of other solids
/// lie on them exactly.
[[nodiscard]] auto only_broken(const Sheets& before, const Sheets& after) -> bool;

}  // namespace mansard::solid::detail
