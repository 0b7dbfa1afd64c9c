#include "mansard/extrude/detail/source.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/corner_edges.hpp"
#include "mansard/extrude/detail/grid.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

auto polygon_of(const Source& source) -> geometry::Polygon {
  geometry::Polygon polygon{source.rings[0].points, {}};
  for (std::size_t r = 1; r < source.rings.size(); ++r) polygon.holes.push_back(source.rings[r].points);
  return polygon;
}

/// Error bound, m: profiles reach 1e6 m at most, where doubles are 1.2e-10 m apart; a few sums of such are below 1e-9
/// m.
constexpr double profile_rounding = 1e-9;

/// What is wrong with a profile; nothing if it is as Plan defines it. Rounding is let pass.
auto fault_of(const model::Profile& profile) -> const char* {
  if (profile.size() < 2) return "has fewer than two points";
  for (const auto& p : profile) {
    if (!std::isfinite(p.inward) || !std::isfinite(p.height)) return "has a point that is not finite";
    if (std::max(std::abs(p.inward), std::abs(p.height)) > 1e6)
      return "reaches beyond 1,000 km; profiles are in metres";
  }
  if (std::abs(profile[0].inward) > profile_rounding || std::abs(profile[0].height) > profile_rounding)
    return "does not start at (0, 0)";
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (profile[i].inward < profile[i - 1].inward - profile_rounding) return "leans outwards";
    if (profile[i].height < profile[i - 1].height - profile_rounding) return "goes down";
  }
  return nullptr;
}

auto ring_of(const model::PlanRing& ring, Point2 origin, bool outer, std::size_t& repeated) -> SourceRing {
  SourceRing out;
  const GridRing grid = on_fine_grid(ring.points, origin);
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    if (grid[i] == grid[i + 1 < grid.size() ? i + 1 : 0]) {  // an edge without length
      ++repeated;
      continue;
    }
    out.points.push_back(ring.points[i]);
    out.profile.push_back(ring.profile_of_edge[i]);
    out.edge.push_back(i);
  }
  if (!out.points.empty() && (twice_area(on_fine_grid(out.points, origin)) > 0) != outer) {
    std::ranges::reverse(out.points);
    // Edge i now runs from the old point n − 1 − i to the one before: the old edge n − 2 − i.
    std::ranges::reverse(out.profile);
    std::ranges::reverse(out.edge);
    std::ranges::rotate(out.profile, out.profile.begin() + 1);
    std::ranges::rotate(out.edge, out.edge.begin() + 1);
  }
  return out;
}

auto text(Point2 p) -> std::string { return "(" + base::to_text(p.x, 3) + ", " + base::to_text(p.y, 3) + ")"; }

auto ring_name(std::size_t r) -> std::string { return r == 0 ? "the outline" : "hole " + std::to_string(r); }

/// What a meeting of edges is, where, and what to do about it.
auto in_words(const Source& source, const Meetings& meetings, std::size_t most, Point2 origin) -> std::string {
  if (!meetings.first) return {};
  const Meeting& m = *meetings.first;
  const auto name = [&](const Meeting::Edge& e) { return std::to_string(source.rings[e.ring].edge[e.index]); };
  std::string a = "edge " + name(m.a), b = "edge " + name(m.b);
  const bool one_ring = m.a.ring == m.b.ring;
  if (m.a.ring != 0) a += " of hole " + std::to_string(m.a.ring);
  if (m.b.ring != 0) b += " of hole " + std::to_string(m.b.ring);
  const std::string where = " at " + text(m.at + origin);
  std::string out;
  switch (m.kind) {
    case Meeting::Kind::crossing:
      out = a + " and " + b + " cross" + where +
            (one_ring ? "; swap corners that are out of order, or cut the outline there into two"
                      : "; merge the hole with the outside, or move it in");
      break;
    case Meeting::Kind::touch:
      out =
          a + " and " + b + " touch" + where +
          (one_ring ? "; a ring may not touch itself: make two parts of it there, or move the corner by a millimetre"
                    : "; rings may not touch: open the hole to the outside there, or move the corner by a millimetre");
      break;
    case Meeting::Kind::overlap:
      out = a + " and " + b + " lie on each other" + where +
            (one_ring ? "; remove the strip without width, or make two parts of the outline"
                      : "; open the hole to the outside along them");
      break;
    case Meeting::Kind::spike:
      out = a + " and " + b + " fold back on each other" + where + "; remove the corner";
      break;
  }
  if (meetings.count > 1)
    out +=
        " (" + std::string(meetings.count < most ? "" : "at least ") + std::to_string(meetings.count) + " such places)";
  return out;
}

/// What is wrong with the heights of a plan; empty if nothing is.
auto fault_of_heights(const model::Plan& plan) -> std::string {
  if (!std::isfinite(plan.base)) return "the base is not finite";
  if (!std::isfinite(plan.cap)) return "the cap is not finite";
  if (plan.cap < 2 * quantum)
    return "the cap is " + base::to_text(plan.cap, 6) + " m above the base; it must be above it by at least 0.1 mm";
  if (plan.cap > highest_cap)
    return "the cap is " + base::to_text(plan.cap, 0) + " m above the base, and the maximum is " +
           base::to_text(highest_cap, 0) + " m; lower the cap, or make the last pitch of the profiles less steep";
  return {};
}

}  // namespace

auto prepared(const model::Plan& plan) -> base::Result<Source> {
  if (auto fault = fault_of_heights(plan); !fault.empty()) return base::error("extrude-cap", std::move(fault));
  for (std::size_t p = 0; p < plan.profiles.size(); ++p)
    if (const char* fault = fault_of(plan.profiles[p]))
      return base::error("extrude-profile", "profile " + std::to_string(p) + " " + fault);
  std::vector<const model::PlanRing*> rings{&plan.outer};
  for (const auto& hole : plan.holes) rings.push_back(&hole);
  geometry::Box2 box;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    if (rings[r]->profile_of_edge.size() != rings[r]->points.size())
      return base::error("extrude-profile", ring_name(r) + " does not name one profile per edge");
    for (std::size_t i = 0; i < rings[r]->points.size(); ++i) {
      const std::string place = " " + std::to_string(i) + " of " + ring_name(r);
      const Point2 p = rings[r]->points[i];
      if (rings[r]->profile_of_edge[i] >= plan.profiles.size())
        return base::error(
            "extrude-profile",
            "edge" + place + " names profile " + std::to_string(rings[r]->profile_of_edge[i]) + ", which is not there");
      if (!std::isfinite(p.x) || !std::isfinite(p.y))
        return base::error("extrude-not-simple", "corner" + place + " is not finite");
      box.add(p);
    }
  }
  if (box.empty()) return base::error("extrude-no-area", "the outline has no corners");
  if (box.most.x - box.least.x > widest || box.most.y - box.least.y > widest)
    return base::error("extrude-not-simple", "the footprint is more than 4,000 km across; coordinates must be metres");

  Source source;
  source.profiles = plan.profiles;
  const Point2 origin = origin_of(box);
  std::vector<GridRing> grid;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    source.rings.push_back(ring_of(*rings[r], origin, r == 0, source.repeated_points));
    source.rings.back().ring = static_cast<std::uint32_t>(r);
    for (auto& edge : without_corner_edges(source.rings.back(), r)) source.corner_edges.push_back(edge);
    grid.push_back(on_fine_grid(source.rings.back().points, origin));
    if (grid.back().size() < 3)
      return base::error(r == 0 ? "extrude-no-area" : "extrude-not-simple",
                         ring_name(r) + " has fewer than three different corners; remove it");
  }
  constexpr double least_area = 1e-6 / grid_step / grid_step;  // a square millimetre: no building
  constexpr std::size_t most = 100;                            // meetings that are counted for the message
  const Meetings meetings = meetings_of(grid, most);
  if (std::abs(twice_area(grid[0])) < 2 * least_area)
    return base::error("extrude-no-area", "the outline near " + text(rings[0]->points[0]) + " encloses no area" +
                                              (meetings.first ? ": " + in_words(source, meetings, most, origin) : ""));
  // Picometres of rounding can cross what does not cross as given.
  if (meetings.first && !geometry::is_simple(polygon_of(source)))
    return base::error("extrude-not-simple", in_words(source, meetings, most, origin));
  double area = twice_area(grid[0]);
  for (std::size_t h = 1; h < grid.size(); ++h) {
    area += twice_area(grid[h]);
    const auto fault = [&](const std::string& what) {
      return base::error("extrude-not-simple",
                         "hole " + std::to_string(h) + " near " + text(rings[h]->points[0]) + what);
    };
    if (!contains(grid[0], grid[h][0])) return fault(" lies outside of the footprint; remove it, or make it a part");
    for (std::size_t other = 1; other < grid.size(); ++other)
      if (other != h && contains(grid[other], grid[h][0]))
        return fault(" lies in hole " + std::to_string(other) + "; make it a part of its own");
  }
  if (area < 2 * least_area) return base::error("extrude-no-area", "the footprint has no area but its holes'");
  return source;
}

namespace {

/// A ring from which corners are taken, with the profile and edge of the edge after each.
class Thinning {
 public:
  Thinning(Source& source, double size) : source_(source), size_(size) {
    geometry::Box2 box;
    for (const auto& ring : source.rings) box.include(geometry::Box2::of(ring.points));
    const Point2 origin = origin_of(box);
    for (const auto& ring : source.rings) {
      grid_.push_back(on_fine_grid(ring.points, origin));
      alive_.emplace_back(ring.points.size(), true);
    }
    for (std::size_t r = 0; r < grid_.size(); ++r)
      for (std::size_t i = 0; i < grid_[r].size(); ++i) all_.push_back({metres(grid_[r][i]), r, i});
    std::ranges::sort(all_, {}, [](const Corner& c) { return std::tuple(c.at.x, c.ring, c.index); });
  }

  void run() {
    for (std::size_t r = 0; r < grid_.size(); ++r) thin(r);
  }

 private:
  struct Corner {
    Point2 at;
    std::size_t ring, index;
  };

  void thin(std::size_t r) {
    SourceRing& ring = source_.rings[r];
    const std::size_t n = ring.points.size();
    std::vector<std::size_t> next(n), before(n);
    for (std::size_t i = 0; i < n; ++i) {
      next[i] = i + 1 < n ? i + 1 : 0;
      before[next[i]] = i;
    }
    const auto off = [&](std::size_t i) {
      return geometry::distance({ring.points[before[i]], ring.points[next[i]]}, ring.points[i]);
    };
    // Least first; a corner that cannot go now is asked again when a neighbour has gone, or in another pass.
    std::size_t left = n;
    for (bool changed = true; changed && left > 3;) {
      changed = false;
      std::set<std::pair<double, std::size_t>> order;
      std::vector<double> place(n);
      const auto offer = [&](std::size_t i) {
        order.erase({place[i], i});
        place[i] = off(i);
        if (place[i] < size_) order.insert({place[i], i});
      };
      for (std::size_t i = 0; i < n; ++i)
        if (alive_[r][i]) offer(i);
      while (!order.empty() && left > 3) {
        const std::size_t i = order.begin()->second, p = before[i], q = next[i];
        order.erase(order.begin());
        if (!is_free(r, p, i, q)) continue;
        // The merged edge is that before the corner; it keeps its own profile if it was the longer one.
        if (length(ring.points[q] - ring.points[i]) > length(ring.points[i] - ring.points[p])) {
          ring.profile[p] = ring.profile[i];
          ring.edge[p] = ring.edge[i];
        }
        alive_[r][i] = false;
        next[p] = q;
        before[q] = p;
        --left;
        changed = true;
        offer(p);
        offer(q);
      }
    }
    SourceRing kept;
    kept.ring = ring.ring;
    for (std::size_t i = 0; i < n; ++i)
      if (alive_[r][i]) {
        kept.points.push_back(ring.points[i]);
        kept.profile.push_back(ring.profile[i]);
        kept.edge.push_back(ring.edge[i]);
      }
    ring = std::move(kept);
  }

  /// Whether no other corner lies in the triangle that goes, its border included: then the new edge meets nothing.
  [[nodiscard]] auto is_free(std::size_t r, std::size_t p, std::size_t i, std::size_t q) const -> bool {
    const GridPoint a = grid_[r][p], b = grid_[r][i], c = grid_[r][q];
    const int way = turn(a, b, c);
    if (way == 0) return true;  // exactly between, for the ring is simple
    geometry::Box2 box;
    for (const GridPoint corner : {a, b, c}) box.add(metres(corner));
    const auto begin = std::ranges::lower_bound(all_, box.least.x, {}, [](const Corner& k) { return k.at.x; });
    for (auto k = begin; k != all_.end() && k->at.x <= box.most.x; ++k) {
      if (k->at.y < box.least.y || k->at.y > box.most.y || !alive_[k->ring][k->index]) continue;
      if (k->ring == r && (k->index == p || k->index == i || k->index == q)) continue;
      const GridPoint at = grid_[k->ring][k->index];
      if (turn(a, b, at) * way >= 0 && turn(b, c, at) * way >= 0 && turn(c, a, at) * way >= 0) return false;
    }
    return true;
  }

  Source& source_;
  double size_;
  std::vector<GridRing> grid_;
  std::vector<std::vector<bool>> alive_;
  std::vector<Corner> all_;  ///< of all rings, by x
};

}  // namespace

auto simplified(Source source, double size) -> Source {
  for (std::size_t r = source.rings.size(); r-- > 1;)
    if (std::abs(geometry::signed_area(source.rings[r].points)) < size * size)
      source.rings.erase(source.rings.begin() + static_cast<std::ptrdiff_t>(r));
  Thinning(source, size).run();
  return source;
}

auto two_part(Source source) -> Source {
  for (auto& profile : source.profiles) {
    const auto gutter = std::ranges::find_if(profile, [](const auto& p) { return p.inward > 0; });
    if (gutter == profile.end()) continue;  // a wall only
    const model::ProfilePoint foot = profile.front(), wall = *(gutter - 1), top = profile.back();
    model::Profile reduced{foot};
    if (wall.height > 0) reduced.push_back(wall);
    if (top.height > wall.height) reduced.push_back(top);
    if (reduced.size() < 2) reduced.push_back({0, 1});  // a setback at the ground only
    profile = std::move(reduced);
  }
  return source;
}

auto prism_of(const Source& source, double base, double cap) -> model::Solid {
  model::Solid solid;
  model::Face floor, roof;
  floor.kind = model::FaceKind::base;
  floor.normal = {0, 0, -1};
  roof.kind = model::FaceKind::cap;
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
                             model::FaceKind::side,
                             model::Provenance{ring.ring, ring.edge[i], 0},
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
