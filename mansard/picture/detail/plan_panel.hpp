// One plan of a sheet.
#pragma once

#include "mansard/picture/detail/canvas.hpp"
#include "mansard/picture/plans.hpp"

namespace mansard::picture::detail {

inline constexpr std::size_t panel_width = 440, panel_height = 360;  // px

/// What a panel shows.
struct PlanFrame {
  geometry::Point2 centre;
  double pixels_per_metre = 1;
};
/// All areas of the group; a frame of 10 m where there are none.
[[nodiscard]] auto frame_of(const PlanGroup& group) -> PlanFrame;

[[nodiscard]] auto draw_panel(const PlanPanel& panel, const PlanFrame& frame) -> Image;

}  // namespace mansard::picture::detail
