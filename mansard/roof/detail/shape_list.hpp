// The shapes of roofs, defined once: their names in files and on the command line, and how each is made.
#pragma once

#include <span>
#include <string_view>

#include "mansard/model/plan.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof::detail {

/// How a shape is made: by a function of its own in roof.cpp, by sides that all lean to one apex, or by sides that all
/// move inward alike but for the ends of the ridge, which move too, stand upright, are upright in their lower part,
/// move in their lower part only, or of which one moves or is half upright and the others stand upright.
enum class Ends : std::uint8_t { own, apex, move, upright, half_upright, half_move, one_move, one_half_upright };

/// What the side opposite the one that the roof faces does: the same, its eaves are higher and its slope the same, or
/// its eaves are half-way up and its slope is half as steep.
enum class Opposite : std::uint8_t { same, higher, half_way };

/// A roof that begins on a wall and reaches `rise` after `run`, metres.
struct Pitch {
  double wall = 0, run = 0, rise = 0;
  double longest = 0;  ///< m; of the runs of all sides, which decides how many pitches a curve has
};

struct ShapeInfo {
  Shape shape;
  std::string_view name;                      ///< as OpenStreetMap writes it
  std::span<const std::string_view> same;     ///< what else the shape is called, in lower case with '_'
  std::span<const std::string_view> similar;  ///< values of roof:shape to which this shape is the nearest
  Ends ends;
  Shape without_ends;  ///< made where no side of the outline can be an end, or there is no apex
  auto(*profile)(const Pitch&, const Options&) -> model::Profile;  ///< of a side that moves; null for `own`
  Opposite opposite = Opposite::same;
  double rise_of_run = 0;  ///< rise over run where no tag says either; 0: the option pitch
};

/// In the order of Shape.
[[nodiscard]] auto shapes() -> std::span<const ShapeInfo>;
[[nodiscard]] auto info_of(Shape shape) -> const ShapeInfo&;

/// Whether a roof of that shape is made of planes side by side, each a plan of its own.
[[nodiscard]] inline auto is_of_several(Shape shape) -> bool {
  return shape == Shape::butterfly || shape == Shape::sawtooth;
}

/// Wall, then what comes above it; without a wall of no height.
[[nodiscard]] auto on_wall(double wall, std::initializer_list<model::ProfilePoint> above) -> model::Profile;

}  // namespace mansard::roof::detail
