#include "mansard/compare/detail/matching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/change.hpp"

namespace mansard::compare::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;

auto area_of(const std::vector<Polygon>& outline) -> double {
  double sum = 0;
  for (const auto& polygon : outline) sum += geometry::area(polygon);
  return sum;
}

/// m² of ground that two outlines have in common. Where that cannot be computed, they count as the same.
auto common_area(const std::vector<Polygon>& a, const std::vector<Polygon>& b, Point2 shift_of_a) -> double {
  double sum = 0;
  for (auto p : a) {
    geometry::move(p, shift_of_a);
    for (const auto& q : b) {
      const auto common = geometry::intersect(p, q);
      sum += common ? area_of(*common) : std::min(geometry::area(p), geometry::area(q));
    }
  }
  return sum;
}

auto centre_of(const std::vector<Polygon>& outline) -> Point2 {
  double area = 0;
  Point2 sum;
  const auto add = [&](const geometry::Ring& ring) {
    if (ring.empty()) return;
    const Point2 first = ring.front();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 p = ring[i] - first, q = ring[(i + 1) % ring.size()] - first;
      const double twice = cross(p, q);
      area += twice / 2;
      sum = sum + (twice / 6) * (p + q) + (twice / 2) * first;
    }
  };
  for (const auto& polygon : outline) {
    add(polygon.outer);
    std::ranges::for_each(polygon.holes, add);
  }
  return area != 0 ? (1 / area) * sum : Point2{};
}

}  // namespace

Outlines::Outlines(const State& state) {
  for (const auto& building : state.buildings) {
    boxes_.push_back(geometry::bounds(building.outline));
    areas_.push_back(area_of(building.outline));
  }
  index_ = geometry::BoxIndex(boxes_);
}

auto Outlines::near(const geometry::Box2& box) const -> std::vector<std::uint32_t> { return index_.overlapping(box); }

auto matched(const State& old, const Outlines& old_outlines, const State& now, const Outlines& new_outlines,
             Point2 shift) -> Matching {
  Matching out;
  out.of_new.resize(now.buildings.size());
  out.of_old.resize(old.buildings.size());
  base::parallel_for(now.buildings.size(), [&](std::size_t n) {
    const auto number = static_cast<std::uint32_t>(n);
    auto box = new_outlines.box(number);
    if (box.empty()) return;
    box = {box.least - shift, box.most - shift};
    for (const auto o : old_outlines.near(box)) {
      const double area = common_area(old.buildings[o].outline, now.buildings[n].outline, shift);
      const double smaller = std::min(old_outlines.area(o), new_outlines.area(number));
      if (area > 0 && area >= 0.5 * smaller) out.of_new[n].push_back({o, area});
    }
    // Ids decide only between equal areas: their order in the file is no evidence.
    std::ranges::sort(out.of_new[n], [&](const Shared& a, const Shared& b) {
      if (a.area != b.area) return a.area > b.area;
      const bool same_a = old.buildings[a.building].id == now.buildings[n].id,
                 same_b = old.buildings[b.building].id == now.buildings[n].id;
      return same_a != same_b ? same_a : old.buildings[a.building].id < old.buildings[b.building].id;
    });
  });
  for (std::size_t n = 0; n < out.of_new.size(); ++n)
    for (const auto& shared : out.of_new[n])
      out.of_old[shared.building].push_back({static_cast<std::uint32_t>(n), shared.area});
  for (auto& of : out.of_old)
    std::ranges::stable_sort(of, [&](const Shared& a, const Shared& b) {
      if (a.area != b.area) return a.area > b.area;
      return now.buildings[a.building].id < now.buildings[b.building].id;
    });
  return out;
}

auto middle_of(std::vector<double> values) -> Middle {
  if (values.empty()) return {};
  constexpr double normal = 1.4826;  // standard deviation over the median absolute deviation, of a normal distribution
  Middle out;
  out.value = base::mean_median(values);
  const auto count = static_cast<double>(values.size());
  for (auto& value : values) value = std::abs(value - out.value);
  out.spread = normal * base::mean_median(std::move(values));
  out.error = out.spread * std::sqrt(std::numbers::pi / 2 / count);  // of a median, for many normal values
  return out;
}

auto displacement(const State& old, const Outlines& old_outlines, const State& now, const Outlines& new_outlines,
                  const Matching& matching) -> Offset {
  constexpr double alike = 0.8;  // intersection over union: what is extended or cut has another centre
  std::vector<double> x, y;
  for (std::size_t n = 0; n < matching.of_new.size(); ++n) {
    const auto& of = matching.of_new[n];
    if (of.size() != 1 || matching.of_old[of.front().building].size() != 1) continue;
    const auto o = of.front().building;
    const double all = old_outlines.area(o) + new_outlines.area(static_cast<std::uint32_t>(n)) - of.front().area;
    if (of.front().area < alike * all) continue;
    const auto by = centre_of(now.buildings[n].outline) - centre_of(old.buildings[o].outline);
    x.push_back(by.x);
    y.push_back(by.y);
  }
  Offset out;
  out.outlines = x.size();
  const auto east = middle_of(std::move(x)), north = middle_of(std::move(y));
  out.plan = {east.value, north.value};
  out.plan_error = {east.error, north.error};
  return out;
}

}  // namespace mansard::compare::detail
