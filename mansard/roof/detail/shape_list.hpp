// The shapes of roofs, defined once: their names in files and on the command line, and how each is made.
#pragma once

#include <span>
#include <string_view>

#include "mansard/model/plan.hpp"
#include "mansard/roof/roof.hpp"

namespace mansard::roof::detail {

/// How a shape is made: by a function of its own in roof.cpp, or by sides that all move inward alike but for the ends
/// of the ridge, which move too, stand upright, or are upright in their lower part.
enum class Ends : std::uint8_t { own, move, upright, half_upright };

/// A roof that begins on a wall and reaches `rise` after `run`, metres.
struct Pitch {
  double wall = 0, run = 0, rise = 0;
};

struct ShapeInfo {
  Shape shape;
  std::string_view name;                      ///< as OpenStreetMap writes it
  std::span<const std::string_view> same;     ///< what else the shape is called, in lower case with '_'
  std::span<const std::string_view> similar;  ///< values of roof:shape to which this shape is the nearest
  Ends ends;
  Shape without_ends;                                              ///< made where no side of the outline can be an end
  auto(*profile)(const Pitch&, const Options&) -> model::Profile;  ///< of a side that moves; null for `own`
};

/// In the order of Shape.
[[nodiscard]] auto shapes() -> std::span<const ShapeInfo>;
[[nodiscard]] auto info_of(Shape shape) -> const ShapeInfo&;

/// Wall, then what comes above it; without a wall of no height.
[[nodiscard]] auto on_wall(double wall, std::initializer_list<model::ProfilePoint> above) -> model::Profile;

}  // namespace mansard::roof::detail
