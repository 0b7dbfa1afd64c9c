#include "mansard/roof/detail/crest.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mansard/extrude/extrude.hpp"

namespace mansard::roof::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// normal · (x, y, h) ≥ offset
struct HalfSpace {
  Point3 normal;
  double offset = 0;
};

auto met_by(const std::array<const HalfSpace*, 3>& three) -> std::optional<Point3> {
  const auto& [a, b, c] = three;
  const Point3 bc = cross(b->normal, c->normal), ca = cross(c->normal, a->normal), ab = cross(a->normal, b->normal);
  const double det = dot(a->normal, bc);
  if (std::abs(det) < 1e-12) return std::nullopt;
  return (1 / det) * (a->offset * bc + b->offset * ca + c->offset * ab);
}

/// The highest point in all half spaces. A few of them decide: begin with a box, take in what the best point violates
/// most, and look again. Nothing where they have no point in common.
auto highest_in(const std::vector<HalfSpace>& all, const geometry::Box2& box) -> std::optional<Point3> {
  const double size = std::max(box.most.x - box.least.x, box.most.y - box.least.y);
  const double slack = 1e-10 * (1 + size);
  std::vector<HalfSpace> few{{{1, 0, 0}, box.least.x},  {{-1, 0, 0}, -box.most.x}, {{0, 1, 0}, box.least.y},
                             {{0, -1, 0}, -box.most.y}, {{0, 0, -1}, -4 * size},   {{0, 0, 1}, -4 * size}};
  const auto violation = [](const HalfSpace& h, Point3 p) { return h.offset - dot(h.normal, p); };
  for (std::size_t round = 0; round <= all.size(); ++round) {
    std::optional<Point3> best;
    for (std::size_t i = 0; i < few.size(); ++i)
      for (std::size_t j = i + 1; j < few.size(); ++j)
        for (std::size_t k = j + 1; k < few.size(); ++k) {
          const auto p = met_by({&few[i], &few[j], &few[k]});
          if (!p || (best && p->z <= best->z)) continue;
          if (std::ranges::all_of(few, [&](const auto& h) { return violation(h, *p) <= slack; })) best = p;
        }
    if (!best) return std::nullopt;
    const auto worst = std::ranges::max_element(all, {}, [&](const auto& h) { return violation(h, *best); });
    if (worst == all.end() || violation(*worst, *best) <= slack) return best;
    few.push_back(*worst);
  }
  return std::nullopt;
}

auto box_of(const std::vector<Side>& sides) -> geometry::Box2 {
  geometry::Box2 box;
  for (const Side& side : sides) box.add(side.start);
  return box;
}

/// From the first corner, so that places far from the origin keep their digits.
auto local(const std::vector<Side>& sides) -> std::vector<Side> {
  std::vector<Side> out = sides;
  for (Side& side : out) {
    side.start = side.start - sides.front().start;
    side.end = side.end - sides.front().start;
  }
  return out;
}

auto is_convex(const geometry::Polygon& polygon) -> bool {
  if (!polygon.holes.empty()) return false;
  const auto& ring = polygon.outer;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()], c = ring[(i + 2) % ring.size()];
    if (cross(normalised(b - a), normalised(c - b)) < -1e-6) return false;
  }
  return true;
}

/// The planes of a convex outline, edge by edge: within a side, edges may turn a little.
auto crest_of_planes(const geometry::Polygon& polygon, const std::vector<Side>& sides, const std::vector<Sweep>& sweeps)
    -> std::optional<double> {
  const auto& ring = polygon.outer;
  const Point2 origin = ring.front();
  geometry::Box2 box;
  for (const Point2 p : ring) box.add(p - origin);
  std::vector<HalfSpace> all;
  for (std::size_t s = 0; s < sides.size(); ++s)
    for (std::size_t k = 0; k < sides[s].count; ++k) {
      const Point2 a = ring[(sides[s].first + k) % ring.size()], b = ring[(sides[s].first + k + 1) % ring.size()];
      const Point2 n = left_of(normalised(b - a));
      const double offset = dot(n, 0.5 * ((a - origin) + (b - origin)));
      all.push_back({{n.x, n.y, sweeps[s].moves ? -1.0 : 0.0}, offset - (sweeps[s].moves ? sweeps[s].lag : 0)});
    }
  const auto best = highest_in(all, box);
  return best ? std::optional(best->z) : std::nullopt;
}

auto crest_of_solid(const geometry::Polygon& polygon, const std::vector<Side>& sides, const std::vector<Sweep>& sweeps,
                    const base::Run& run) -> std::optional<double> {
  constexpr double wall = 1;
  const auto box = box_of(sides);
  const double far = box.most.x - box.least.x + box.most.y - box.least.y;
  model::Plan plan;
  plan.cap = wall + far;
  plan.profiles = {{{0, 0}, {0, plan.cap}}, {{0, 0}, {0, wall}, {far, wall + far}}};
  plan.outer = {polygon.outer, std::vector<std::uint32_t>(polygon.outer.size(), 0)};
  for (const auto& hole : polygon.holes) plan.holes.push_back({hole, std::vector<std::uint32_t>(hole.size(), 0)});
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (!sweeps[s].moves) continue;
    std::uint32_t profile = 1;
    if (sweeps[s].lag > 0) {
      profile = static_cast<std::uint32_t>(plan.profiles.size());
      plan.profiles.push_back({{0, 0}, {0, wall + sweeps[s].lag}, {far, wall + sweeps[s].lag + far}});
    }
    auto& ring = sides[s].ring == 0 ? plan.outer : plan.holes[sides[s].ring - 1];
    for (std::size_t k = 0; k < sides[s].count; ++k)
      ring.profile_of_edge[(sides[s].first + k) % ring.points.size()] = profile;
  }
  const auto crest = extrude::crest(plan, {}, run);
  if (!crest) return std::nullopt;
  return *crest - wall;
}

}  // namespace

auto crest_of(const geometry::Polygon& polygon, const std::vector<Side>& sides, const std::vector<Sweep>& sweeps,
              const base::Run& run) -> std::optional<double> {
  if (std::ranges::none_of(sweeps, &Sweep::moves)) return std::nullopt;
  if (is_convex(polygon))
    if (const auto crest = crest_of_planes(polygon, sides, sweeps)) return crest;
  return crest_of_solid(polygon, sides, sweeps, run);
}

auto deepest_of(const std::vector<Side>& sides) -> Deepest {
  const auto near = local(sides);
  std::vector<HalfSpace> all;
  for (const Side& side : near)
    all.push_back({{side.inward.x, side.inward.y, -1}, dot(side.inward, 0.5 * (side.start + side.end))});
  const auto best = highest_in(all, box_of(near));
  if (!best) return {sides.front().start, -1};
  return {sides.front().start + xy(*best), best->z};
}

}  // namespace mansard::roof::detail
