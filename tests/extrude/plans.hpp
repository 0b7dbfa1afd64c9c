// Plans for the extrusion tests: built by hand, turned, mirrored, made at random; and measures of solids taken
// separately from the module's own code.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"

namespace plans {

using namespace mansard;  // a test's own namespace, in which modules have short names
using geometry::Point2;
using geometry::Point3;
using geometry::Ring;
using model::Plan;
using model::Profile;

inline const Profile hip{{0, 0}, {0, 3}, {1, 4}};  // wall of 3 m, roof at 45°
inline const Profile wall{{0, 0}, {0, 3}};         // upright
inline const Profile tent{{0, 0}, {1, 1}};         // roof from the ground at 45°
inline const Profile two_pitch{{0, 0}, {0, 3}, {1, 5}, {3, 6}};
inline const Profile setback{{0, 0}, {0, 3}, {2, 3}, {2, 6}};

inline auto plan(Ring outer, std::vector<Profile> profiles, std::vector<std::uint32_t> of_edge = {}, double cap = 100,
                 std::vector<Ring> holes = {}) -> Plan {
  Plan p;
  p.profiles = std::move(profiles);
  of_edge.resize(std::max(of_edge.size(), outer.size()), 0);
  p.outer = {std::move(outer), std::move(of_edge)};
  for (Ring& hole : holes) {
    std::vector<std::uint32_t> same(hole.size(), 0);
    p.holes.push_back({std::move(hole), std::move(same)});
  }
  p.cap = cap;
  return p;
}

inline auto box(double w, double d) -> Ring { return {{0, 0}, {w, 0}, {w, d}, {0, d}}; }
inline auto turned_in(Ring ring) -> Ring {
  std::ranges::reverse(ring);
  return ring;
}

/// Applies a map of points that keeps orientation to all rings.
template <class Map>
auto mapped(Plan p, Map map) -> Plan {
  for (Point2& v : p.outer.points) v = map(v);
  for (auto& hole : p.holes)
    for (Point2& v : hole.points) v = map(v);
  return p;
}
inline auto turned(const Plan& p, double angle) -> Plan {
  const double c = std::cos(angle), s = std::sin(angle);
  return mapped(p, [=](Point2 v) { return Point2{c * v.x - s * v.y, s * v.x + c * v.y}; });
}
inline auto shifted(const Plan& p, Point2 by) -> Plan {
  return mapped(p, [=](Point2 v) { return v + by; });
}
/// Mirrored in the y axis; rings walked the other way so that they keep their orientation.
inline auto mirrored(Plan p) -> Plan {
  const auto flip = [](model::PlanRing& ring) {
    for (Point2& v : ring.points) v.x = -v.x;
    std::ranges::reverse(ring.points);
    std::ranges::reverse(ring.profile_of_edge);
    std::ranges::rotate(ring.profile_of_edge, ring.profile_of_edge.begin() + 1);
  };
  flip(p.outer);
  for (auto& hole : p.holes) flip(hole);
  return p;
}
/// The same ring from another start vertex.
inline auto rotated_start(Plan p, std::size_t by) -> Plan {
  const auto at = static_cast<std::ptrdiff_t>(by % p.outer.points.size());
  std::ranges::rotate(p.outer.points, p.outer.points.begin() + at);
  std::ranges::rotate(p.outer.profile_of_edge, p.outer.profile_of_edge.begin() + at);
  return p;
}

/// A star around the origin: simple, with reflex corners.
inline auto star(base::Random& random, std::size_t corners) -> Ring {
  Ring ring;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(i) + random.uniform(0.1, 0.9)) / static_cast<double>(corners);
    const double r = random.uniform(4, 12);
    ring.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return ring;
}

/// The outline of a connected set of cells of a grid with few different spacings: full of ties. Empty when the set has
/// a hole or touches itself in a point.
inline auto rectilinear(base::Random& random, std::size_t cells) -> Ring {
  constexpr int side = 6;
  std::set<std::pair<int, int>> taken{{side / 2, side / 2}};
  while (taken.size() < cells) {
    auto at = taken.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(random.index(taken.size())));
    constexpr std::array<std::pair<int, int>, 4> steps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto [dx, dy] = steps[random.index(4)];
    const std::pair<int, int> next{at->first + dx, at->second + dy};
    if (next.first >= 0 && next.second >= 0 && next.first < side && next.second < side) taken.insert(next);
  }
  std::array<double, side + 1> xs{}, ys{};
  for (int i = 0; i < side; ++i) {
    xs[i + 1] = xs[i] + (random.index(2) == 0 ? 2 : 3);
    ys[i + 1] = ys[i] + (random.index(2) == 0 ? 2 : 3);
  }
  std::set<std::array<int, 4>> edges;  // directed, interior on the left
  for (const auto& [x, y] : taken) {
    if (!taken.contains({x, y - 1})) edges.insert({x, y, x + 1, y});
    if (!taken.contains({x + 1, y})) edges.insert({x + 1, y, x + 1, y + 1});
    if (!taken.contains({x, y + 1})) edges.insert({x + 1, y + 1, x, y + 1});
    if (!taken.contains({x - 1, y})) edges.insert({x, y + 1, x, y});
  }
  Ring ring;
  std::array<int, 4> at = *edges.begin();
  const auto start = at;
  do {
    ring.push_back({xs[at[0]], ys[at[1]]});
    const auto next = edges.lower_bound({at[2], at[3], -1, -1});
    if (next == edges.end() || (*next)[0] != at[2] || (*next)[1] != at[3]) return {};
    at = *next;
  } while (at != start && ring.size() <= edges.size());
  if (ring.size() != edges.size() || !geometry::is_simple({ring, {}})) return {};
  return ring;
}

inline auto random_profile(base::Random& random) -> Profile {
  const auto half = [&](std::size_t most) { return 0.5 * static_cast<double>(random.index(most)); };
  Profile p{{0, 0}};
  const double foot = 2 + half(4);
  switch (random.index(7)) {
    case 0: return {{0, 0}, {0, foot}};
    case 1: return {{0, 0}, {0, foot}, {1 + half(3), foot + 1}};
    case 2: return {{0, 0}, {0, foot}, {0.5, foot + 1 + half(2)}, {2, foot + 3}};
    case 3: return {{0, 0}, {0, foot}, {0.5 + half(3), foot}, {0.5 + half(3) + 2, foot + 2}};
    case 4: return {{0, 0}, {0, foot}, {1 + half(2), foot}};
    case 5: return {{0, 0}, {1, 1 + half(4)}};
    default: return {{0, 0}, {0, foot}, {1, foot + 1}, {1, foot + 2}, {2, foot + 2}, {3, foot + 4}};
  }
}

inline auto random_plan(std::uint64_t seed) -> Plan {
  base::Random random(seed);
  Ring ring;
  while (ring.empty())
    ring = seed % 2 == 0 ? star(random, 4 + random.index(9)) : rectilinear(random, 2 + random.index(10));
  std::vector<Profile> profiles;
  for (int i = 0; i < 4; ++i) profiles.push_back(random_profile(random));
  profiles.push_back(hip);
  std::vector<std::uint32_t> of_edge;
  for (std::size_t i = 0; i < ring.size(); ++i)
    of_edge.push_back(static_cast<std::uint32_t>(random.index(profiles.size())));
  return plan(std::move(ring), std::move(profiles), std::move(of_edge), 4 + static_cast<double>(random.index(20)) / 2);
}

inline auto text(const Plan& p) -> std::string {
  std::string out = "cap " + std::to_string(p.cap) + " outer";
  for (std::size_t i = 0; i < p.outer.points.size(); ++i)
    out += " (" + std::to_string(p.outer.points[i].x) + " " + std::to_string(p.outer.points[i].y) + " p" +
           std::to_string(p.outer.profile_of_edge[i]) + ")";
  for (const Profile& profile : p.profiles) {
    out += " profile";
    for (const auto& k : profile) out += " (" + std::to_string(k.inward) + " " + std::to_string(k.height) + ")";
  }
  return out;
}

/// The horizontal section's area at z, from the triangles: each gives a directed piece of the outline, and Green's
/// theorem needs them in no order. z must not be a vertex's height.
inline auto section_area(const model::Solid& solid, double z) -> double {
  const auto triangulated = solid::triangulate(solid);
  if (!triangulated) return std::nan("");
  double sum = 0;
  for (const auto& t : triangulated->triangles) {
    std::vector<Point2> cut;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 a = solid.vertices[t[i]], b = solid.vertices[t[(i + 1) % 3]];
      if ((a.z < z) == (b.z < z)) continue;
      const double s = (z - a.z) / (b.z - a.z);
      cut.push_back({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)});
    }
    if (cut.size() != 2) continue;
    const Point3 n = cross(solid.vertices[t[1]] - solid.vertices[t[0]], solid.vertices[t[2]] - solid.vertices[t[0]]);
    if (dot(cut[1] - cut[0], left_of(Point2{n.x, n.y})) < 0) std::swap(cut[0], cut[1]);
    sum += cross(cut[0], cut[1]) / 2;
  }
  return sum;
}

/// ∫ section area dz, exact: between vertex heights the area is a square function, for which two Gauss points suffice.
inline auto integrated_volume(const model::Solid& solid) -> double {
  std::vector<double> heights;
  for (const Point3 p : solid.vertices) heights.push_back(p.z);
  std::ranges::sort(heights);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const double step = heights[i + 1] - heights[i];
    if (step < 1e-9) continue;
    const double middle = (heights[i] + heights[i + 1]) / 2, off = step / (2 * std::numbers::sqrt3);
    sum += step * (section_area(solid, middle - off) + section_area(solid, middle + off)) / 2;
  }
  return sum;
}

/// Heights at which a vertical line meets faces that look up.
inline auto roofs_over(const model::Solid& solid, Point2 at) -> std::vector<double> {
  std::vector<double> heights;
  const auto triangulated = solid::triangulate(solid);
  if (!triangulated) return heights;
  for (const auto& t : triangulated->triangles) {
    const Point3 a = solid.vertices[t[0]], b = solid.vertices[t[1]], c = solid.vertices[t[2]];
    const Point3 n = cross(b - a, c - a);
    if (n.z < 1e-9) continue;
    const double u = cross(xy(b) - xy(a), at - xy(a)), v = cross(xy(c) - xy(b), at - xy(b)),
                 w = cross(xy(a) - xy(c), at - xy(c));
    if (u >= 0 && v >= 0 && w >= 0) heights.push_back(a.z - (n.x * (at.x - a.x) + n.y * (at.y - a.y)) / n.z);
  }
  return heights;
}

inline auto faults(const model::Solid& solid) -> std::string {
  std::string out;
  for (const auto& fault : solid::check(solid)) out += base::to_string(fault) + "; ";
  return out;
}

inline auto count(const model::Solid& solid, model::FaceKind kind) -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count_if(solid.faces, [kind](const auto& f) { return f.kind == kind; }));
}

}  // namespace plans
