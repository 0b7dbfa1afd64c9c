// Two plans as one: corners brought together, the wall between them taken out, the outline traced again.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/edit/detail/trace.hpp"
#include "mansard/edit/edit.hpp"

namespace mansard::edit {
namespace {

using detail::Edge;
using detail::snap;
using geometry::Point2;
using geometry::Segment2;
using model::Profile;

/// The same profile for a foot that lies `by` metres lower.
auto lifted(const Profile& profile, double by) -> Profile {
  if (by == 0) return profile;
  Profile out{{0, 0}, {0, by}};
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const model::ProfilePoint next{profile[i].inward, profile[i].height + by};
    if (next.inward == 0) out.back() = next;
    else out.push_back(next);
  }
  return out;
}

/// Corners of `edges` go to the nearest corner of `to` within a centimetre.
void move_corners(std::vector<Edge>& edges, std::span<const Edge> to) {
  const auto moved = [&](Point2 p) {
    Point2 best = p;
    double least = snap;
    for (const auto& edge : to)
      if (const double d = length(edge.from - p); d < least || (d == least && edge.from < best)) {
        least = d;
        best = edge.from;
      }
    return best;
  };
  for (auto& edge : edges) edge = {moved(edge.from), moved(edge.to), edge.label};
  std::erase_if(edges, [](const Edge& edge) { return edge.from == edge.to; });
}

/// `edges` with a corner wherever one of `others` lies within a centimetre of them.
auto with_corners(const std::vector<Edge>& edges, std::span<const Edge> others) -> std::vector<Edge> {
  std::set<Point2> own;
  for (const auto& edge : edges) own.insert(edge.from);
  std::vector<std::vector<Point2>> on(edges.size());
  for (const auto& other : others) {
    if (own.contains(other.from)) continue;
    std::size_t best = edges.size();
    double least = snap;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Segment2 s{edges[i].from, edges[i].to};
      const double t = geometry::parameter(s, other.from), d = geometry::distance(s, other.from);
      if (t <= 0 || t >= 1 || d > least || (d == least && best < edges.size())) continue;
      least = d;
      best = i;
    }
    if (best < edges.size()) on[best].push_back(other.from);
  }
  return detail::broken_at(edges, std::move(on));
}

/// Takes out the edges that both have, in opposite directions; their length, and `corners` at their ends.
auto take_out_wall(std::vector<Edge>& first, std::vector<Edge>& second, std::set<Point2>& corners) -> double {
  std::map<std::pair<Point2, Point2>, std::size_t> of_first;
  for (std::size_t i = 0; i < first.size(); ++i) of_first.emplace(std::pair(first[i].from, first[i].to), i);
  std::set<std::size_t> out_of_first, out_of_second;
  double shared = 0;
  for (std::size_t j = 0; j < second.size(); ++j) {
    const auto found = of_first.find({second[j].to, second[j].from});
    if (found == of_first.end()) continue;
    out_of_first.insert(found->second);
    out_of_second.insert(j);
    shared += length(second[j].to - second[j].from);
    corners.insert(second[j].from);
    corners.insert(second[j].to);
  }
  const auto drop = [](std::vector<Edge>& edges, const std::set<std::size_t>& gone) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (!gone.contains(i)) edges[kept++] = edges[i];
    edges.resize(kept);
  };
  drop(first, out_of_first);
  drop(second, out_of_second);
  return shared;
}

/// Whether the ring goes straight on at a corner that it could do without.
auto is_straight(const model::PlanRing& ring, std::size_t i) -> bool {
  constexpr double straight = 1e-4;  // m; what files have
  const std::size_t n = ring.points.size();
  const Point2 a = ring.points[(i + n - 1) % n], b = ring.points[i], c = ring.points[(i + 1) % n];
  return dot(b - a, c - b) > 0 && geometry::distance(Segment2{a, c}, b) <= straight;
}

/// Profiles of the second (from `own` on) that are the same as one of the first get its number: where a straight edge
/// of both goes on along one and the same profile first, then each that is left the first one still free.
auto joined_numbers(const detail::Outline& outline, const std::set<Point2>& corners,
                    const std::vector<Profile>& profiles, std::size_t own) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> number_of(profiles.size());
  for (std::uint32_t p = 0; p < profiles.size(); ++p) number_of[p] = p;
  std::set<std::uint32_t> taken;
  const auto join = [&](std::uint32_t first, std::uint32_t second) {
    if (first >= own || second < own || number_of[second] != second || profiles[first] != profiles[second]) return;
    number_of[second] = first;
    taken.insert(first);
  };
  const auto look = [&](const model::PlanRing& ring) {
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      if (!corners.contains(ring.points[i]) || !is_straight(ring, i)) continue;
      const auto before = ring.profile_of_edge[(i + ring.points.size() - 1) % ring.points.size()];
      const auto after = ring.profile_of_edge[i];
      join(before, after);
      join(after, before);
    }
  };
  look(outline.outer);
  for (const auto& hole : outline.holes) look(hole);
  for (auto second = static_cast<std::uint32_t>(own); second < profiles.size(); ++second)
    for (std::uint32_t first = 0; first < own; ++first)
      if (!taken.contains(first)) join(first, second);
  return number_of;
}

/// Without those of the corners that lie on the straight line between their neighbours, with one profile on both sides.
auto without(const std::set<Point2>& corners, const std::vector<std::uint32_t>& number_of, model::PlanRing ring)
    -> model::PlanRing {
  for (auto& profile : ring.profile_of_edge) profile = number_of[profile];
  for (std::size_t i = 0; i < ring.points.size() && ring.points.size() > 3;) {
    const std::size_t before = (i + ring.points.size() - 1) % ring.points.size();
    if (!corners.contains(ring.points[i]) || ring.profile_of_edge[before] != ring.profile_of_edge[i] ||
        !is_straight(ring, i)) {
      ++i;
      continue;
    }
    ring.points.erase(ring.points.begin() + static_cast<std::ptrdiff_t>(i));
    ring.profile_of_edge.erase(ring.profile_of_edge.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return ring;
}

auto no_merge(std::string what) -> base::Diagnostic { return base::error("edit-merge", std::move(what)); }

}  // namespace

auto merge(const model::Plan& first, const model::Plan& second) -> base::Result<model::Plan> {
  constexpr double least_wall = 0.1;  // m
  const auto polygon = model::polygon_of(first), other = model::polygon_of(second);
  if (!geometry::is_simple(polygon) || !geometry::is_simple(other))
    return no_merge("the outline of one of the parts crosses itself; repair it first");
  const auto overlap = detail::overlap(polygon, other);
  if (!overlap)
    return no_merge("whether the parts overlap could not be computed (" + overlap.error().message +
                    "); move their corners together first");
  if (*overlap > detail::least_area)
    return no_merge("the parts overlap by " + base::to_text(*overlap, 2) + " m²; move their corners together first");

  const double base = std::min(first.base, second.base);
  const double rise = first.base - base, other_rise = second.base - base;
  std::vector<Profile> profiles;
  for (const auto& profile : first.profiles) profiles.push_back(lifted(profile, rise));
  for (const auto& profile : second.profiles) profiles.push_back(lifted(profile, other_rise));

  auto edges = detail::edges_of(first), more = detail::edges_of(second);
  for (auto& edge : more) edge.label += static_cast<std::uint32_t>(first.profiles.size());
  move_corners(more, edges);
  const auto before = edges;
  edges = with_corners(edges, more);
  more = with_corners(more, before);
  std::set<Point2> corners;
  const double shared = take_out_wall(edges, more, corners);
  if (shared < least_wall)
    return no_merge("the parts share " + base::to_text(shared, 3) +
                    " m of wall, less than 0.1 m; only parts side by side can be merged");

  edges.insert(edges.end(), more.begin(), more.end());
  const auto cycles = detail::cycles_of(edges);
  auto outlines = cycles ? detail::outlines_of(edges, *cycles) : std::nullopt;
  if (outlines)
    std::erase_if(*outlines, [](const auto& o) { return geometry::signed_area(o.outer.points) < detail::least_area; });
  if (!outlines || outlines->size() != 1)
    return no_merge("the parts would not be one outline; merge what lies between them first");
  auto& outline = outlines->front();
  std::erase_if(outline.holes,
                [](const auto& hole) { return -geometry::signed_area(hole.points) < detail::least_area; });
  const auto number_of = joined_numbers(outline, corners, profiles, first.profiles.size());
  outline.outer = without(corners, number_of, std::move(outline.outer));
  for (auto& hole : outline.holes) hole = without(corners, number_of, std::move(hole));
  auto plan = detail::plan_of(std::move(outline), profiles, base, std::max(first.cap + rise, second.cap + other_rise));
  detail::keep_overhangs(std::array{&first, &second}, plan);
  if (!geometry::is_simple(model::polygon_of(plan)))
    return no_merge("the outline of both would touch itself; merge what lies between them first, or move the corner");
  return plan;
}

}  // namespace mansard::edit
