#include "mansard/extrude/detail/source.hpp"

#include <algorithm>
#include <cmath>

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

auto polygon_of(const Source& source) -> geometry::Polygon {
  geometry::Polygon polygon{source.rings[0].points, {}};
  for (std::size_t r = 1; r < source.rings.size(); ++r) polygon.holes.push_back(source.rings[r].points);
  return polygon;
}

/// What is wrong with a profile; nothing if it is as Plan defines it. Rounding below a nanometre is let pass.
auto fault_of(const geometry::Profile& profile) -> const char* {
  constexpr double rounding = 1e-9;
  if (profile.size() < 2) return "has fewer than two points";
  for (const auto& p : profile)
    if (!std::isfinite(p.inward) || !std::isfinite(p.height)) return "has a point that is not finite";
  if (std::abs(profile[0].inward) > rounding || std::abs(profile[0].height) > rounding)
    return "does not start at (0, 0)";
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (profile[i].inward < profile[i - 1].inward - rounding) return "leans outwards";
    if (profile[i].height < profile[i - 1].height - rounding) return "goes down";
  }
  return nullptr;
}

auto ring_of(const geometry::PlanRing& ring, bool outer) -> SourceRing {
  SourceRing out;
  for (std::uint32_t i = 0; i < ring.points.size(); ++i) {
    const Point2 next = ring.points[(i + 1) % ring.points.size()];
    if (ring.points[i] == next) continue;  // an edge without length
    out.points.push_back(ring.points[i]);
    out.profile.push_back(ring.profile_of_edge[i]);
    out.edge.push_back(i);
  }
  if (!out.points.empty() && (geometry::signed_area(out.points) > 0) != outer) {
    std::ranges::reverse(out.points);
    // Edge i now runs from the old point n − 1 − i to the one before: the old edge n − 2 − i.
    std::ranges::reverse(out.profile);
    std::ranges::reverse(out.edge);
    std::ranges::rotate(out.profile, out.profile.begin() + 1);
    std::ranges::rotate(out.edge, out.edge.begin() + 1);
  }
  return out;
}

}  // namespace

auto prepared(const geometry::Plan& plan) -> base::Result<Source> {
  if (!std::isfinite(plan.cap) || !std::isfinite(plan.base) || plan.cap < 2 * quantum || plan.cap > 1e5)
    return base::error("extrude-cap", "the cap must lie above the base");
  Source source;
  source.profiles = plan.profiles;
  for (std::size_t p = 0; p < plan.profiles.size(); ++p)
    if (const char* fault = fault_of(plan.profiles[p]))
      return base::error("extrude-profile", "profile " + std::to_string(p) + " " + fault);
  const auto take = [&](const geometry::PlanRing& ring, bool outer) -> std::optional<base::Diagnostic> {
    if (ring.profile_of_edge.size() != ring.points.size())
      return base::error("extrude-profile", "a ring does not name one profile per edge");
    for (const std::uint32_t p : ring.profile_of_edge)
      if (p >= plan.profiles.size()) return base::error("extrude-profile", "an edge names a profile that is not there");
    for (const Point2 p : ring.points)
      if (!std::isfinite(p.x) || !std::isfinite(p.y))
        return base::error("extrude-not-simple", "a corner is not finite");
    source.rings.push_back(ring_of(ring, outer));
    return std::nullopt;
  };
  if (auto fault = take(plan.outer, true)) return *fault;
  for (const auto& hole : plan.holes)
    if (auto fault = take(hole, false)) return *fault;

  const geometry::Polygon polygon = polygon_of(source);
  if (polygon.outer.size() < 3 || std::abs(geometry::signed_area(polygon.outer)) < 1e-6)
    return base::error("extrude-no-area", "the footprint has no area");
  if (!geometry::is_simple(polygon)) return base::error("extrude-not-simple", "the footprint's edges cross or touch");
  for (std::size_t h = 0; h < polygon.holes.size(); ++h) {
    if (!geometry::contains(polygon.outer, polygon.holes[h][0]))
      return base::error("extrude-not-simple", "a hole lies outside of the footprint");
    for (std::size_t other = 0; other < polygon.holes.size(); ++other)
      if (other != h && geometry::contains(polygon.holes[other], polygon.holes[h][0]))
        return base::error("extrude-not-simple", "a hole lies in another hole");
  }
  if (geometry::area(polygon) < 1e-6) return base::error("extrude-no-area", "the footprint has no area");
  return source;
}

auto simplified(Source source, double size) -> Source {
  for (std::size_t r = source.rings.size(); r-- > 1;)
    if (std::abs(geometry::signed_area(source.rings[r].points)) < size * size)
      source.rings.erase(source.rings.begin() + static_cast<std::ptrdiff_t>(r));

  const auto without = [&](std::size_t r, std::size_t i) {
    SourceRing ring = source.rings[r];
    const std::size_t n = ring.points.size(), before = (i + n - 1) % n;
    const double left = length(ring.points[i] - ring.points[before]);
    const double right = length(ring.points[(i + 1) % n] - ring.points[i]);
    // The merged edge is `before`; it keeps its own profile if it was the longer one.
    if (right > left) {
      ring.profile[before] = ring.profile[i];
      ring.edge[before] = ring.edge[i];
    }
    const auto at = static_cast<std::ptrdiff_t>(i);
    ring.points.erase(ring.points.begin() + at);
    ring.profile.erase(ring.profile.begin() + at);
    ring.edge.erase(ring.edge.begin() + at);
    return ring;
  };
  for (std::size_t r = 0; r < source.rings.size(); ++r) {
    std::vector<std::pair<double, std::size_t>> order;
    const auto rank = [&] {
      order.clear();
      const auto& p = source.rings[r].points;
      const std::size_t n = p.size();
      for (std::size_t i = 0; i < n && n > 3; ++i)
        if (const double d = geometry::distance({p[(i + n - 1) % n], p[(i + 1) % n]}, p[i]); d < size)
          order.emplace_back(d, i);
      std::ranges::sort(order);
    };
    rank();
    for (std::size_t k = 0; k < order.size();) {
      SourceRing kept = std::exchange(source.rings[r], without(r, order[k].second));
      const bool right_way = (geometry::signed_area(source.rings[r].points) > 0) == (r == 0);
      if (right_way && geometry::is_simple(polygon_of(source))) {
        rank();
        k = 0;
      } else {
        source.rings[r] = std::move(kept);
        ++k;
      }
    }
  }
  return source;
}

auto two_part(Source source) -> Source {
  for (auto& profile : source.profiles) {
    const auto gutter = std::ranges::find_if(profile, [](const auto& p) { return p.inward > 0; });
    if (gutter == profile.end()) continue;  // a wall only
    const geometry::ProfilePoint foot = profile.front(), wall = *(gutter - 1), top = profile.back();
    geometry::Profile reduced{foot};
    if (wall.height > 0) reduced.push_back(wall);
    if (top.height > wall.height) reduced.push_back(top);
    if (reduced.size() < 2) reduced.push_back({0, 1});  // a setback at the ground only
    profile = std::move(reduced);
  }
  return source;
}

auto prism_of(const Source& source, double base, double cap) -> Solid {
  Solid solid;
  Face floor, roof;
  floor.kind = FaceKind::base;
  floor.normal = {0, 0, -1};
  roof.kind = FaceKind::cap;
  roof.normal = {0, 0, 1};
  for (std::uint32_t r = 0; r < source.rings.size(); ++r) {
    const auto& ring = source.rings[r];
    const auto n = static_cast<std::uint32_t>(ring.points.size()),
               first = static_cast<std::uint32_t>(solid.vertices.size());
    std::vector<std::uint32_t> below, above;
    for (std::uint32_t i = 0; i < n; ++i) {
      below.push_back(first + i);
      above.push_back(first + n + i);
      solid.vertices.push_back({ring.points[i].x, ring.points[i].y, base});
    }
    for (const Point2 p : ring.points) solid.vertices.push_back({p.x, p.y, base + cap});
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      const Point2 out = -1.0 * left_of(normalised(ring.points[j] - ring.points[i]));
      solid.faces.push_back({{{below[i], below[j], above[j], above[i]}},
                             FaceKind::side,
                             Provenance{r, ring.edge[i], 0},
                             {out.x, out.y, 0}});
    }
    roof.loops.push_back(std::move(above));
    std::ranges::reverse(below);
    floor.loops.push_back(std::move(below));
  }
  solid.faces.insert(solid.faces.begin(), std::move(floor));
  solid.faces.push_back(std::move(roof));
  return solid;
}

}  // namespace mansard::extrude::detail
