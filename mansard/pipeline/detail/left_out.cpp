#include "mansard/pipeline/detail/left_out.hpp"

#include <algorithm>

#include "mansard/base/statistics.hpp"
#include "mansard/base/text.hpp"
#include "mansard/pipeline/detail/uncovered.hpp"
#include "mansard/report/attributes.hpp"

namespace mansard::pipeline::detail {
namespace {

/// A piece of a footprint without a model.
struct Piece {
  double area = 0, height = 0;  ///< m², m above the ground
};

auto in_words(const std::vector<Piece>& pieces, double area) -> std::string {
  std::string words = base::to_text(area, 1) + " m² of the footprint have no model:";
  for (const auto& piece : pieces)
    words += (&piece == pieces.data() ? " " : ", ") + base::to_text(piece.area, 1) + " m² " +
             base::to_text(piece.height, 1) + " m high";
  return words;
}

}  // namespace

void add_left_out(const block::Block& block, const segment::Segmentation& segmentation, const rays::Scene& mesh,
                  const Options& options, const std::vector<PartResult>& parts, BlockResult& out) {
  constexpr double least = 1;  // m²; less is within the error of a survey
  std::vector<geometry::Polygon> outlines;
  for (const auto& part : parts) outlines.push_back(model::polygon_of(part.plan));
  for (const auto& member : block.members) {
    if (std::ranges::none_of(parts, [&](const auto& part) { return part.feature == member.feature; })) continue;
    const auto left = uncovered(member.polygons, outlines);
    for (const auto& warning : left.warnings) out.unchecked.emplace_back(member.feature, warning);
    std::vector<Piece> pieces;
    double area = 0;
    for (const auto& polygon : left.polygons) {
      const auto heights = report::heights_over(mesh, polygon, options.roof_grid);
      if (heights.empty()) continue;
      const double height = base::percentile_of_sorted(heights, 0.5) - member.ground;
      if (height < options.segment.min_height) continue;
      pieces.push_back({geometry::area(polygon), height});
      area += pieces.back().area;
    }
    if (!(area > least)) continue;
    auto words = in_words(pieces, area);
    for (const auto& one : segmentation.left_out)
      if (one.feature == member.feature && one.area > least)
        words += "; " + base::to_text(one.area, 1) + " m² " + base::to_text(one.height, 1) + " m high are " + one.why;
    out.left_out.push_back({member.feature, area, words});
  }
}

}  // namespace mansard::pipeline::detail
