// A plan cut along a line: what of the line lies inside becomes walls, and the outlines are traced again.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/edit/detail/trace.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::edit {
namespace {

using detail::Edge;
using detail::snap;
using geometry::Point2;
using geometry::Segment2;

/// A place of the line: on the outline or within it.
struct Stop {
  Point2 at;
  std::optional<std::size_t>
      edge;  ///< of the plan, that the place lies on (at its start, or within); none: not on the outline
};

auto segment_of(const Edge& edge) -> Segment2 { return {edge.from, edge.to}; }

/// The place itself, or where the outline is if that is within a centimetre: a corner first.
auto moved_onto(Point2 p, std::span<const Edge> edges) -> Stop {
  Stop nearest{p, std::nullopt};
  double least = snap;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (const double d = length(edges[i].from - p); d <= least) {
      least = d;
      nearest = {edges[i].from, i};
    }
  if (nearest.edge) return nearest;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Segment2 s = segment_of(edges[i]);
    if (const double d = geometry::distance(s, p); d <= least) {
      least = d;
      nearest = {s.start + std::clamp(geometry::parameter(s, p), 0.0, 1.0) * (s.end - s.start), i};
    }
  }
  return nearest;
}

/// Where a segment of the line meets the outline between its ends, in order.
auto crossings(const Stop& a, const Stop& b, std::span<const Edge> edges) -> std::vector<Stop> {
  const Segment2 line{a.at, b.at};
  const Point2 along = line.end - line.start;
  std::vector<std::pair<double, Stop>> found;
  const auto is_end = [&](Point2 p) { return length(p - a.at) <= snap || length(p - b.at) <= snap; };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Segment2 edge = segment_of(edges[i]);
    const double t = geometry::parameter(line, edge.start);
    if (geometry::distance(line, edge.start) <= snap) {
      if (t > 0 && t < 1 && !is_end(edge.start)) found.push_back({t, {edge.start, i}});
      continue;
    }
    if (geometry::distance(line, edge.end) <= snap || !geometry::meet(line, edge)) continue;
    const double before = cross(along, edge.start - line.start), after = cross(along, edge.end - line.start);
    if (before == after) continue;
    const Point2 at = edge.start + (before / (before - after)) * (edge.end - edge.start);
    if (!is_end(at)) found.push_back({geometry::parameter(line, at), {at, i}});
  }
  std::ranges::sort(found, {}, [](const auto& entry) { return std::pair(entry.first, entry.second.at); });
  std::vector<Stop> stops;
  for (auto& entry : found)
    if (stops.empty() || stops.back().at != entry.second.at) stops.push_back(entry.second);
  return stops;
}

/// Every place of the line that counts, in order: its own points and those where it crosses the outline.
auto stops_of(std::span<const Point2> line, std::span<const Edge> edges) -> std::vector<Stop> {
  std::vector<Stop> own;
  for (const Point2 p : line)
    if (auto stop = moved_onto(p, edges); own.empty() || stop.at != own.back().at) own.push_back(stop);
  std::vector<Stop> stops;
  for (std::size_t i = 0; i < own.size(); ++i) {
    stops.push_back(own[i]);
    if (i + 1 == own.size()) break;
    const auto between = crossings(own[i], own[i + 1], edges);
    stops.insert(stops.end(), between.begin(), between.end());
  }
  return stops;
}

auto crosses_itself(std::span<const Stop> stops) -> bool {
  for (std::size_t i = 0; i + 1 < stops.size(); ++i)
    for (std::size_t j = i + 1; j + 1 < stops.size(); ++j) {
      const Segment2 a{stops[i].at, stops[i + 1].at}, b{stops[j].at, stops[j + 1].at};
      if (j > i + 1 ? geometry::meet(a, b)
                    : geometry::orientation(a.start, a.end, b.end) == 0 && dot(a.end - a.start, b.end - b.start) < 0)
        return true;
    }
  return false;
}

/// The stretches of the line that go through the inside from outline to outline.
auto chains_of(const std::vector<Stop>& stops, const geometry::Polygon& polygon) -> std::vector<std::vector<Point2>> {
  constexpr double inside = 1e-3;  // m; nearer to the outline it runs along it
  std::vector<std::vector<Point2>> chains;
  std::vector<Point2> open;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const Point2 middle = 0.5 * (stops[i].at + stops[i + 1].at);
    if (stops[i].edge) open = {stops[i].at};
    if (!geometry::contains(polygon, middle) || geometry::boundary_distance(polygon, middle) <= inside) open.clear();
    if (open.empty()) continue;
    open.push_back(stops[i + 1].at);
    if (!stops[i + 1].edge) continue;
    chains.push_back(std::move(open));
    open.clear();
  }
  return chains;
}

/// The outline with corners where chains begin and end.
auto with_corners(const std::vector<Edge>& edges, const std::vector<Stop>& stops) -> std::vector<Edge> {
  std::vector<std::vector<Point2>> on(edges.size());
  for (const auto& stop : stops)
    if (stop.edge && stop.at != edges[*stop.edge].from && stop.at != edges[*stop.edge].to)
      on[*stop.edge].push_back(stop.at);
  return detail::broken_at(edges, std::move(on));
}

/// Outline and chains in both directions; the label of these is `wall`. `first[c]` is the first edge of chain c.
auto drawing_of(std::vector<Edge> edges, const std::vector<std::vector<Point2>>& chains, std::uint32_t wall,
                std::vector<std::size_t>& first) -> std::vector<Edge> {
  first.clear();
  for (const auto& chain : chains) {
    first.push_back(edges.size());
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      edges.push_back({chain[i], chain[i + 1], wall});
      edges.push_back({chain[i + 1], chain[i], wall});
    }
  }
  return edges;
}

/// Takes out chains with one and the same ring on both sides: they end at a courtyard that nothing else leads to.
void drop_dead_ends(const std::vector<Edge>& outline, std::uint32_t wall, std::vector<std::vector<Point2>>& chains) {
  std::vector<std::size_t> first;
  const auto drawing = drawing_of(outline, chains, wall, first);
  const auto cycles = detail::cycles_of(drawing);
  if (!cycles) return;
  std::vector<std::size_t> cycle_of(drawing.size());
  for (std::size_t c = 0; c < cycles->size(); ++c)
    for (const auto edge : (*cycles)[c]) cycle_of[edge] = c;
  std::size_t kept = 0;
  for (std::size_t c = 0; c < chains.size(); ++c)
    if (cycle_of[first[c]] != cycle_of[first[c] + 1]) chains[kept++] = chains[c];
  chains.resize(kept);
}

auto no_split(std::string what) -> base::Diagnostic { return base::error("edit-split", std::move(what)); }

}  // namespace

auto split(const model::Plan& plan, std::span<const Point2> line) -> base::Result<std::vector<model::Plan>> {
  const auto polygon = model::polygon_of(plan);
  if (!std::ranges::all_of(line, [](Point2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }))
    return no_split("the line has a point that is not finite; draw it again");
  const auto edges = detail::edges_of(plan);
  if (!geometry::is_simple(polygon)) return no_split("the part's outline crosses itself; repair it first");
  const auto stops = stops_of(line, edges);
  if (crosses_itself(stops)) return no_split("the line crosses itself; draw it again");

  auto profiles = plan.profiles;
  const auto wall = static_cast<std::uint32_t>(profiles.size());
  profiles.push_back({{0, 0}, {0, plan.cap}});
  const auto outline = with_corners(edges, stops);
  auto chains = chains_of(stops, polygon);
  drop_dead_ends(outline, wall, chains);
  if (chains.empty())
    return no_split("the line does not divide the part; draw it from outside of the part to the outside again");

  // Corners only where something is divided.
  std::vector<Stop> used;
  for (const auto& stop : stops)
    for (const auto& chain : chains)
      if (stop.at == chain.front() || stop.at == chain.back()) used.push_back(stop);
  std::vector<std::size_t> first;
  const auto drawing = drawing_of(with_corners(edges, used), chains, wall, first);
  const auto cycles = detail::cycles_of(drawing);
  auto outlines = cycles ? detail::outlines_of(drawing, *cycles) : std::nullopt;
  if (!outlines || outlines->size() < 2) return no_split("the line does not divide the part; draw it again");

  std::vector<model::Plan> plans;
  double sum = 0;
  for (auto& piece : *outlines) {
    plans.push_back(detail::plan_of(std::move(piece), profiles, plan.base, plan.cap));
    detail::keep_overhangs(std::array{&plan}, plans.back());
    const auto ground = model::polygon_of(plans.back());
    const double area = geometry::area(ground);
    sum += area;
    if (area < detail::least_area)
      return no_split("the line cuts off " + base::to_text(area, 4) + " m²; move it away from the outline");
    if (!geometry::is_simple(ground)) return no_split("the line runs along the outline; move it away from it");
  }
  if (std::abs(sum - geometry::area(polygon)) > 1e-6)
    return no_split("the line runs along the outline; move it away from it");
  std::ranges::stable_sort(plans, std::greater(), [](const auto& p) { return geometry::area(model::polygon_of(p)); });
  return plans;
}

auto split(std::string_view building, std::vector<NamedPlan> parts, std::string_view part, std::span<const Point2> line)
    -> base::Result<std::vector<NamedPlan>> {
  const auto at = std::ranges::find(parts, part, &NamedPlan::id);
  if (at == parts.end())
    return base::error("edit-part", "building " + std::string(building) + " has no such part; look at it again",
                       std::string(part));
  auto pieces = split(at->plan, line);
  if (!pieces) {
    auto why = pieces.error();
    why.subject = part;
    return why;
  }
  at->plan = std::move(pieces->front());
  auto place = at + 1;
  std::size_t number = parts.size();
  for (std::size_t i = 1; i < pieces->size(); ++i) {
    std::string id;
    do id = std::string(building) + "-" + std::to_string(++number);
    while (std::ranges::find(parts, id, &NamedPlan::id) != parts.end());
    place = parts.insert(place, {std::move(id), std::move((*pieces)[i])}) + 1;
  }
  return parts;
}

}  // namespace mansard::edit
