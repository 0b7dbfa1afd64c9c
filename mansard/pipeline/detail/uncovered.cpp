#include "mansard/pipeline/detail/uncovered.hpp"

#include <algorithm>
#include <iterator>
#include <string>

namespace mansard::pipeline::detail {
namespace {

using geometry::Polygon;

auto is_sliver(const Polygon& polygon) -> bool {
  constexpr double least_area = 1.0;  // m²; less is a sliver along a neighbour
  constexpr double least_width = 0.5;
  return geometry::area(polygon) < least_area ||
         geometry::area(polygon) < least_width * geometry::perimeter(polygon.outer) / 2;
}

auto unchecked(const std::string& what) -> base::Diagnostic {
  return base::warning("pipeline-cover-unchecked",
                       what + "; the footprint is kept, and its model may overlap a neighbour's");
}

}  // namespace

auto uncovered(std::span<const Polygon> footprint, std::span<const Polygon> outlines) -> Uncovered {
  Uncovered out;
  for (const auto& whole : footprint) {
    std::vector<Polygon> left{whole};
    for (const auto& outline : outlines) {
      const auto box = geometry::bounds(outline.outer);
      std::vector<Polygon> rest;
      for (auto& polygon : left) {
        if (!box.overlaps(geometry::bounds(polygon.outer))) {
          rest.push_back(std::move(polygon));
        } else if (auto pieces = geometry::subtract(polygon, outline)) {
          rest.insert(rest.end(), pieces->begin(), pieces->end());
        } else {
          out.warnings.push_back(
              unchecked("a neighbour's outline could not be subtracted (" + pieces.error().message + ")"));
          rest.push_back(std::move(polygon));
        }
      }
      left = std::move(rest);
    }
    for (auto& polygon : left) {
      if (is_sliver(polygon)) continue;
      constexpr double apart = 0.01;  // m; a subtraction may leave rings that touch in a point
      if (const auto pieces = geometry::simple_pieces(polygon, apart)) {
        std::ranges::remove_copy_if(*pieces, std::back_inserter(out.polygons), is_sliver);
      } else {
        out.warnings.push_back(
            unchecked("the ground beside its neighbours has no simple outline (" + pieces.error().message + ")"));
        out.polygons.push_back(whole);
      }
    }
  }
  return out;
}

}  // namespace mansard::pipeline::detail
