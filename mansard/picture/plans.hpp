// Plans side by side, several pairs on one sheet.
#pragma once

#include <string>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/picture/picture.hpp"

namespace mansard::picture {

/// Seen from above, x to the right and y upward, with an outline.
struct PlanArea {
  std::vector<geometry::Polygon> polygons;  ///< m
  Colour colour = ground_grey;
  /// Lines of text to write on it: the first of these that fits into what is visible of the area. Where none does, the
  /// first that fits beside all areas not far away, with a line to this one; otherwise nothing is written.
  std::vector<std::vector<std::string>> labels;
};

struct PlanPanel {
  std::string title;
  std::vector<PlanArea> areas;  ///< later ones cover earlier ones
  std::string note;             ///< in the middle, where there are no areas
};

/// Panels with one frame and one scale, which fits all of their areas, and a bar that shows it.
struct PlanGroup {
  std::string title, subtitle;
  std::vector<PlanPanel> panels;
};

struct PlanKey {
  Colour colour;
  std::string meaning;
};

struct PlanSheet {
  std::string title, subtitle;
  std::vector<PlanKey> keys;
  std::vector<PlanGroup> groups;  ///< by row
  std::size_t columns = 2;        ///< groups in a row, at most
};

/// Panels of 440 × 360 pixels on white. Text that is wider than its place is cut and ends in "...". Same input, same
/// bytes. Cost: grows with the pixels, and per panel with its areas.
[[nodiscard]] auto plan_sheet(const PlanSheet& sheet) -> Image;

}  // namespace mansard::picture
