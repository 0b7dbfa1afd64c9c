#include "mansard/pipeline/detail/place.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/geometry/change.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// A nanometre: numbers of 4 000 km keep it.
constexpr double plan_unit = 0x1p-30;
auto rounded(double x) -> double { return model::rounded(x, plan_unit); }

/// From a block's own frame to the scene's.
struct Way {
  Point3 by;
  const std::vector<std::size_t>& features;

  explicit Way(const block::OwnFrame& frame)
      : by{static_cast<double>(frame.block.origin[0]), static_cast<double>(frame.block.origin[1]),
           static_cast<double>(frame.block.origin[2])},
        features(frame.features) {}

  void move(Point2& p) const { p = p + xy(by); }
  void number(std::size_t& feature) const { feature = features[feature]; }
  void number(std::optional<std::size_t>& feature) const {
    if (feature) number(*feature);
  }
};

void place(segment::Segmentation& chosen, const Way& way) {
  for (auto& face : chosen.faces) {
    face.height += way.by.z;
    way.number(face.feature);
  }
  for (auto& part : chosen.parts) {
    geometry::move(part.polygon, xy(way.by));
    part.height += way.by.z;
    way.number(part.feature);
  }
  for (auto& one : chosen.left_out) way.number(one.feature);
}

void place(PartResult& part, const Way& way) {
  way.number(part.feature);
  move(part.plan, way.by);
  move(part.model.solid, way.by);
  for (double& z : part.roof) z += way.by.z;
}

}  // namespace

void move(model::Plan& plan, Point3 by) {
  const auto settled = [&](Point2 p) { return Point2{rounded(p.x), rounded(p.y)} + xy(by); };
  geometry::change_corners(plan.outer.points, settled);
  for (auto& hole : plan.holes) geometry::change_corners(hole.points, settled);
  plan.base = rounded(plan.base) + by.z;
}

void move(model::Solid& solid, Point3 by) {
  // Corners are on the grid of the files (with_grid): the double nearest to it is what a file gives back.
  using model::quanta_per_metre;
  const auto moved = [](double x, double shift) {
    return std::round((x + shift) * quanta_per_metre) / quanta_per_metre;
  };
  for (Point3& v : solid.vertices) v = {moved(v.x, by.x), moved(v.y, by.y), moved(v.z, by.z)};
}

void place(report::SegmentedBlock& block, const block::OwnFrame& frame) {
  const Way way(frame);
  for (auto& feature : block.features) way.number(feature);
  std::ranges::sort(block.features);
  for (auto& edge : block.sweep_edges) {
    way.move(edge.segment.start);
    way.move(edge.segment.end);
    edge.low += way.by.z;
    edge.high += way.by.z;
  }
  for (Point2& vertex : block.arrangement.vertices) way.move(vertex);
  if (block.segmentation) place(*block.segmentation, way);
}

void place(BlockResult& result, const block::OwnFrame& frame) {
  const Way way(frame);
  for (auto& part : result.parts) place(part, way);
  std::ranges::stable_sort(result.parts, {}, &PartResult::feature);
  for (auto& [feature, made] : result.solids) {
    way.number(feature);
    for (auto& solid : made.solids) move(solid.model.solid, way.by);
  }
  way.move(result.map.origin);
  for (auto& feature : result.covered) way.number(feature);
  for (auto& [feature, why] : result.failed) way.number(feature);
  for (auto& [feature, why] : result.unchecked) way.number(feature);
  for (auto& [feature, why] : result.doubts) way.number(feature);
  for (auto& one : result.left_out) way.number(one.feature);
  for (auto& [feature, attributes] : result.measures) way.number(feature);
  for (auto& [feature, evidence] : result.evidence) way.number(feature);
  for (auto& [feature, search] : result.searches) way.number(feature);
  if (result.segmented) place(*result.segmented, frame);
}

}  // namespace mansard::pipeline::detail
