#include "mansard/block/detail/neighbours.hpp"

#include <algorithm>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::block::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;
using geometry::Segment2;

auto edges_within(const Polygons& polygons, const Box2& reach) -> std::vector<Segment2> {
  std::vector<Segment2> out;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Segment2 edge{ring[i], ring[(i + 1) % ring.size()]};
      if (Box2::of(edge).overlaps(reach)) out.push_back(edge);
    }
  };
  for (const auto& polygon : polygons) {
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
  }
  return out;
}

auto total(const Polygons& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

/// Grown and shrunk again: what is narrower than twice `by` stays filled.
auto closed(const Polygons& shapes, double by) -> base::Result<Polygons> {
  Polygons grown;
  for (const auto& shape : shapes) {
    auto more = geometry::buffer(shape, by);
    if (!more) return more;
    grown.insert(grown.end(), more->begin(), more->end());
  }
  auto united = geometry::unite(grown);
  if (!united) return united;
  Polygons shrunk;
  for (const auto& polygon : *united) {
    auto less = geometry::buffer(polygon, -by);
    if (!less) return less;
    shrunk.insert(shrunk.end(), less->begin(), less->end());
  }
  return shrunk;
}

/// Growing and shrinking moves points by rounding: those that were there before get their place back.
void restore(Polygons& polygons, const Polygons& originals) {
  std::vector<Point2> known;
  for (const auto& polygon : originals) {
    known.insert(known.end(), polygon.outer.begin(), polygon.outer.end());
    for (const auto& hole : polygon.holes) known.insert(known.end(), hole.begin(), hole.end());
  }
  std::ranges::sort(known);
  // GEOS computes an offset point from coordinates below 2²³ m (half a unit in the last place: 2⁻³⁰ m) in a few dozen
  // operations: 64 · 2⁻³⁰ m < 1e-7 m; ten times that, and far below any two corners of a footprint.
  constexpr double rounding = 1e-6;
  const auto settle = [&](Ring& ring) {
    for (auto& p : ring) {
      const auto first = std::ranges::lower_bound(known, Point2{p.x - rounding, p.y - rounding});
      for (auto at = first; at != known.end() && at->x <= p.x + rounding; ++at)
        if (std::abs(at->y - p.y) <= rounding) {
          p = *at;
          break;
        }
    }
  };
  for (auto& polygon : polygons) {
    settle(polygon.outer);
    for (auto& hole : polygon.holes) settle(hole);
  }
}

}  // namespace

auto distance(const Segment2& a, const Segment2& b) -> double {
  if (geometry::meet(a, b)) return 0;
  return std::min({geometry::distance(a, b.start), geometry::distance(a, b.end), geometry::distance(b, a.start),
                   geometry::distance(b, a.end)});
}

auto are_near(const Polygons& a, const Polygons& b, double touch) -> bool {
  const Box2 reach_a = geometry::bounds(a).grown(touch), reach_b = geometry::bounds(b).grown(touch);
  if (a.empty() || b.empty() || !reach_a.overlaps(geometry::bounds(b))) return false;
  const auto edges_a = edges_within(a, reach_b), edges_b = edges_within(b, reach_a);
  for (const auto& edge : edges_a) {
    const Box2 reach = Box2::of(edge).grown(touch);
    for (const auto& other : edges_b) {
      if (!reach.overlaps(Box2::of(other))) continue;
      if (const double apart = distance(edge, other); apart == 0 || apart < touch) return true;
    }
  }
  return std::ranges::any_of(a, [&b](const Polygon& p) { return geometry::contains(b, p.outer.front()); }) ||
         std::ranges::any_of(b, [&a](const Polygon& p) { return geometry::contains(a, p.outer.front()); });
}

auto groups_of(const std::vector<Box2>& boxes, const ShapeOf& shape_of, double touch)
    -> std::vector<std::vector<std::size_t>> {
  std::vector<Box2> reaches;
  reaches.reserve(boxes.size());
  for (const auto& box : boxes) reaches.push_back(box.grown(touch / 2));
  const geometry::BoxIndex index(reaches);
  base::DisjointSets sets(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    for (const std::uint32_t j : index.overlapping(reaches[i])) {
      if (j >= i) break;  // ascending; the others are found from their side
      if (sets.of(i) != sets.of(j) && are_near(shape_of(i), shape_of(j), touch)) sets.join(i, j);
    }
  std::vector<std::vector<std::size_t>> groups(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) groups[sets.of(i)].push_back(i);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

auto outline_of(const Polygons& shapes, double touch, double gap_area, std::vector<base::Diagnostic>& warnings)
    -> Polygons {
  const auto warn = [&](const char* what, const base::Diagnostic& why) {
    warnings.push_back(base::warning("block-outline", what + (" (" + why.message) + ")"));
  };
  auto united = geometry::unite(shapes);
  if (!united) {
    warn("the union of the footprints could not be computed; each has an outline of its own", united.error());
    return shapes;
  }
  if (touch <= 0) return std::move(*united);
  auto filled = closed(*united, touch / 2);
  if (!filled) warn("the gaps between the footprints could not be closed", filled.error());
  if (!filled || filled->empty()) return std::move(*united);
  // Mitres are cut off where corners are sharp; what that took from the shapes is put back.
  restore(*filled, *united);
  Polygons both = *united;
  both.insert(both.end(), filled->begin(), filled->end());
  auto whole = geometry::unite(both);
  if (!whole) warn("the gaps between the footprints could not be closed", whole.error());
  const bool simple = std::ranges::all_of(*united, [](const Polygon& p) { return geometry::is_simple(p); });
  if (!whole || (simple && whole->size() == united->size() && total(*whole) - total(*united) < gap_area))
    return std::move(*united);
  return std::move(*whole);
}

}  // namespace mansard::block::detail
