// Where wings meet: along the lines of edges that go on inside beyond a reflex corner.
#pragma once

#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail {

/// An edge that goes on inside, at one end or at both.
struct WingLine {
  geometry::Point2 on, along;                             ///< the edge's start, and its direction
  std::vector<geometry::Segment2> lines;                  ///< what is new: one or two
  [[nodiscard]] auto middle() const -> geometry::Point2;  ///< of the longest
  [[nodiscard]] auto length() const -> double;            ///< m; of the longest

 private:
  [[nodiscard]] auto longest() const -> const geometry::Segment2&;
};

/// In the order of the edges. Cost: the square of the corners.
[[nodiscard]] auto wing_lines_of(const geometry::Polygon& part, const Options& options) -> std::vector<WingLine>;

/// The pieces that a line cuts off: one side of it, and both once more with a wedge of half the line's length beyond
/// it, which is where the roof of a wing runs into the slope of another as high. A bent plan has a roof that profiles
/// around it cannot raise where one wing runs through and ends in a gable; its wings have. Each costs operations on
/// polygons.
[[nodiscard]] auto wings_along(const geometry::Polygon& part, const WingLine& line, const Options& options)
    -> std::vector<geometry::Polygon>;

}  // namespace mansard::refine::detail
