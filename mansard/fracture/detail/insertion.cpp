#include "mansard/fracture/detail/insertion.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "mansard/geometry/predicates.hpp"

namespace mansard::fracture::detail {
namespace {

/// Adds what lies on `other` to `traces`. A cut that comes back along an edge it has taken leaves it: a path that goes
/// there and back again goes nowhere.
void merge(std::vector<Trace>& traces, const std::vector<Trace>& other, bool reversed) {
  for (Trace trace : other) {
    trace.along = trace.along != reversed;
    const auto place = std::ranges::lower_bound(traces, trace.cut, {}, &Trace::cut);
    if (place == traces.end() || place->cut != trace.cut) traces.insert(place, trace);
    else if (place->along != trace.along) traces.erase(place);
    else place->kind = std::min(place->kind, trace.kind);
  }
}

}  // namespace

auto Insertion::lay(std::uint32_t cut, const Attempt& attempt) -> bool {
  const auto mark = graph_.mark();
  rigid_.clear();
  while (!try_to_lay(cut, attempt)) {
    graph_.back_to(mark);
    // What gave way here lacked the room further on: let the new cut give way to it instead.
    if (!overbent_ || std::ranges::find(rigid_, *overbent_) != rigid_.end()) return false;
    rigid_.push_back(*overbent_);
  }
  return true;
}

auto Insertion::try_to_lay(std::uint32_t cut, const Attempt& attempt) -> bool {
  cut_ = cut;
  attraction_ = attempt.attraction * tolerances_.merge;
  overbent_.reset();
  unsettled_.clear();
  waiting_.clear();
  thinned_.clear();

  auto [p, q] = lines_[cut].hard;
  const Point2 aside = (1 / distance(p, q)) * geometry::left_of(q - p);
  p = p + to_grid(attempt.shift_start * aside);
  q = q + to_grid(attempt.shift_end * aside);
  const Point2 start = reach(p, p - q, attempt.continuation), end = reach(q, q - p, attempt.continuation);
  lines_[cut].whole = {start, end};

  std::vector<std::uint32_t> chain;
  for (const Point2 corner : {p, q}) {
    const auto vertex = anchor(corner, true);
    if (!vertex) return false;
    chain.push_back(*vertex);
  }
  // The outer ends must hold on to an edge. One that ends on the spot shares the vertex there, wherever it went.
  for (const auto& [corner, inner] : {std::pair(start, p), std::pair(end, q)}) {
    const auto vertex = corner == inner ? std::optional(chain[chain.size() - 2]) : anchor(corner, false);
    if (!vertex) return false;
    chain.push_back(*vertex);
    thinned_.push_back(*vertex);
  }
  const auto& hard = lines_[cut].hard;
  if (std::max(squared_distance(graph_.place(chain[0]), hard.start),
               squared_distance(graph_.place(chain[1]), hard.end)) > square(tolerances_.drift))
    return false;
  const auto edge = [cut](Kind kind) { return Edge{0, 0, false, {{cut, kind, true}}, true}; };
  join(chain[2], chain[0], edge(Kind::continuation), true);
  join(chain[0], chain[1], edge(Kind::hard), true);
  join(chain[1], chain[3], edge(Kind::continuation), true);
  return settle() && tidy();
}

/// The end of the prolongation: `at_least` metres on, then to the first edge or vertex, or to the rectangle.
auto Insertion::reach(Point2 from, Point2 towards, double at_least) const -> Point2 {
  const Point2 direction = (1 / std::sqrt(geometry::dot(towards, towards))) * towards;
  const Point2 low = graph_.place(0), high = graph_.place(2);
  const Point2 near = from + to_grid(at_least * direction);
  const Point2 far = from + to_grid((at_least + 2 * distance(low, high)) * direction);
  const auto crossing = [&](std::uint32_t e) {
    return at(graph_.segment(e), crossing_parameter(graph_.segment(e), {from, far}));
  };
  if (!Box2{low, high}.contains(near)) {
    for (const std::uint32_t e : graph_.edges_across({from, far}))
      if (graph_.edges()[e].border) return crossing(e);
    // It leaves through a vertex of the rectangle, or starts on it.
    Point2 last = from;
    for (const std::uint32_t v : graph_.vertices_near({from, far}, tolerances_.merge))
      if (squared_distance(from, graph_.place(v)) > squared_distance(from, last)) last = graph_.place(v);
    return last;
  }
  if (!graph_.edges_near(near, tolerances_.merge).empty()) return near;
  std::optional<Point2> first;
  const auto ahead = [&](Point2 p) { return geometry::dot(p - near, direction); };
  const auto consider = [&](Point2 p) {
    if (!first || ahead(p) < ahead(*first)) first = p;
  };
  // The first one is mostly a few metres away, and the rectangle may be as wide as a city: the part of the ray that is
  // looked at grows until what comes first in it is well before its end.
  constexpr double first_part = 8;   // m
  constexpr double well_before = 1;  // m; the part is off the ray by roundings, and a vertex by the tolerance
  for (double part = first_part;; part *= 4) {
    const bool all = part >= ahead(far);
    const Segment2 ray{near, far}, looked_at{near, all ? far : near + to_grid(part * direction)};
    first.reset();
    for (const std::uint32_t e : graph_.edges_across(ray, looked_at)) consider(crossing(e));
    for (const std::uint32_t v : graph_.vertices_near(ray, tolerances_.merge, looked_at)) consider(graph_.place(v));
    if (all || (first && ahead(*first) + tolerances_.merge + well_before < part)) return first.value_or(near);
  }
}

/// The vertex an end of the cut becomes: one nearby, else on an edge nearby, else a new one if it may be `loose`.
auto Insertion::anchor(Point2 p, bool loose) -> std::optional<std::uint32_t> {
  if (const auto vertex = nearest_vertex({p, p}, tolerances_.merge)) return vertex;
  auto edges = graph_.edges_near(p, tolerances_.merge);
  if (edges.empty()) return loose ? std::optional(graph_.add_vertex(p)) : std::nullopt;
  const std::uint32_t nearest = *std::ranges::min_element(edges, {}, [&](std::uint32_t e) {
    return std::tuple(!graph_.edges()[e].border, squared_distance(graph_.segment(e), p), e);
  });
  // Better a point of the line than the nearest one: it makes no kink.
  const Segment2 segment = graph_.segment(nearest), line = lines_[cut_].whole;
  Point2 place = at(segment, foot_parameter(segment, p));
  if (geometry::orientation(line.start, line.end, segment.start) *
          geometry::orientation(line.start, line.end, segment.end) <
      0) {
    const Point2 crossing = at(segment, crossing_parameter(segment, line));
    if (squared_distance(crossing, p) < square(tolerances_.merge)) place = crossing;
  }
  const auto vertex = vertex_at(place);
  if (!vertex || !bend(nearest, *vertex) || !draw_in(*vertex)) return std::nullopt;
  return vertex;
}

/// The vertex nearby, else a new one, on the edge nearby that cannot be drawn to it if there is one.
auto Insertion::vertex_at(Point2 p) -> std::optional<std::uint32_t> {
  for (int round = 0; round < 3; ++round) {
    if (const auto vertex = nearest_vertex({p, p}, attraction_)) return vertex;
    std::optional<std::uint32_t> stiff;
    for (const std::uint32_t e : graph_.edges_near(p, tolerances_.merge)) {
      if (may_pass(graph_.edges()[e], p)) continue;
      if (!stiff || squared_distance(graph_.segment(e), p) < squared_distance(graph_.segment(*stiff), p)) stiff = e;
    }
    if (!stiff) return graph_.add_vertex(p);
    p = at(graph_.segment(*stiff), foot_parameter(graph_.segment(*stiff), p));
  }
  return std::nullopt;
}

/// A cut that goes round in circles is in the way of itself and would take for ever.
auto Insertion::settle() -> bool {
  const std::size_t most =
      tolerances_.steps + tolerances_.steps_per_crossing * graph_.edges_across(lines_[cut_].whole).size();
  for (std::size_t steps = 0; !unsettled_.empty(); ++steps) {
    if (steps > most) return false;
    const std::uint32_t edge = unsettled_.front();
    unsettled_.pop_front();
    if (!graph_.edges()[edge].alive) continue;
    const Segment2 segment = graph_.segment(edge);

    waiting_[edge] = false;
    if (const auto way = way_past(edge); !way.empty()) {
      if (!lead(edge, way)) return false;
      continue;
    }
    auto across = graph_.edges_across(segment);
    if (across.empty()) continue;
    std::ranges::sort(across, {},
                      [&](std::uint32_t e) { return std::pair(crossing_parameter(segment, graph_.segment(e)), e); });
    if (!cross(edge, across[across.size() / 2])) return false;  // the middle one: halves look at less each time
  }
  return true;
}

/// The vertices an edge must be led through so as not to pass too near to any; none when it passes freely. The way
/// that strays least among those that leave no vertex too near on its side; failing one, through the nearest vertex.
auto Insertion::way_past(std::uint32_t edge) const -> std::vector<std::uint32_t> {
  const Edge& here = graph_.edges()[edge];
  const Segment2 segment = graph_.segment(edge);
  const double reach = has_present_cut(here) ? attraction_ : tolerances_.merge;
  const auto inner = [&](std::vector<std::uint32_t> found) {
    std::erase_if(found, [&](std::uint32_t v) { return v == here.a || v == here.b; });
    return found;
  };
  const auto off = [&](std::uint32_t v) {
    double most = squared_distance(segment, graph_.place(v));
    for (const Trace& trace : here.traces) most = std::max(most, squared_distance(line_of(trace), graph_.place(v)));
    return most;
  };
  const auto near = inner(graph_.vertices_near(segment, reach));
  if (near.empty()) return {};

  // Stations: both ends and what lies beside the edge, in order along it; a link may lead from any to any later one.
  auto beside = inner(graph_.vertices_near(segment, 3 * reach));
  std::ranges::sort(beside, {},
                    [&](std::uint32_t v) { return std::pair(foot_parameter(segment, graph_.place(v)), v); });
  std::vector<std::uint32_t> stations{here.a};
  for (const std::uint32_t v : beside)
    if (may_pass(here, graph_.place(v))) stations.push_back(v);
  stations.push_back(here.b);
  const auto clear = [&](std::uint32_t a, std::uint32_t b) {
    const Segment2 link{graph_.place(a), graph_.place(b)};
    return std::ranges::none_of(beside, [&](std::uint32_t v) {
      return v != a && v != b && squared_distance(link, graph_.place(v)) < square(reach);
    });
  };
  constexpr double never = std::numeric_limits<double>::infinity();
  std::vector<double> cost(stations.size(), never);
  std::vector<std::size_t> from(stations.size(), 0);
  cost[0] = 0;
  for (std::size_t j = 1; j < stations.size(); ++j) {
    const double own = j + 1 < stations.size() ? off(stations[j]) : 0;
    for (std::size_t i = j; i-- > 0;)
      if (cost[i] + own < cost[j] && clear(stations[i], stations[j])) cost[j] = cost[i] + own, from[j] = i;
  }
  if (cost.back() < never) {
    std::vector<std::uint32_t> way;
    for (std::size_t j = from.back(); j != 0; j = from[j]) way.push_back(stations[j]);
    std::ranges::reverse(way);
    return way;
  }
  return {*std::ranges::min_element(near, {}, [&](std::uint32_t v) { return std::pair(off(v), v); })};
}

auto Insertion::cross(std::uint32_t edge, std::uint32_t other) -> bool {
  if (graph_.edges()[edge].border) std::swap(edge, other);
  const Point2 p = at(graph_.segment(other), crossing_parameter(graph_.segment(other), graph_.segment(edge)));
  const auto vertex = vertex_at(p);
  return vertex && bend(edge, *vertex) && bend(other, *vertex) && draw_in(*vertex);
}

/// Leads an edge through a vertex.
auto Insertion::bend(std::uint32_t edge, std::uint32_t vertex) -> bool {
  const Edge& old = graph_.edges()[edge];
  return !old.alive || old.a == vertex || old.b == vertex || lead(edge, {vertex});
}

/// Leads an edge through vertices, in order from its `a`.
auto Insertion::lead(std::uint32_t edge, const std::vector<std::uint32_t>& way) -> bool {
  const Edge old = graph_.edges()[edge];
  bool straight = true;
  for (const std::uint32_t v : way) {
    if (!may_pass(old, graph_.place(v))) {
      if (!old.border && !has_present_cut(old)) overbent_ = old.traces.front().cut;
      return false;
    }
    straight = straight && squared_distance(graph_.segment(edge), graph_.place(v)) <= square(grid);
  }
  const bool unsettled = !straight || waits(edge) || has_present_cut(old);
  graph_.drop_edge(edge);
  std::uint32_t last = old.a;
  for (const std::uint32_t v : way) {
    join(last, v, old, unsettled);
    last = v;
  }
  join(last, old.b, old, unsettled);
  return true;
}

/// Leads all edges too near to a new vertex through it.
auto Insertion::draw_in(std::uint32_t vertex) -> bool {
  const Point2 p = graph_.place(vertex);
  auto edges = graph_.edges_near(p, tolerances_.merge);
  std::ranges::sort(edges, {}, [&](std::uint32_t e) { return std::pair(squared_distance(graph_.segment(e), p), e); });
  return std::ranges::all_of(edges, [&](std::uint32_t e) { return bend(e, vertex); });
}

void Insertion::join(std::uint32_t a, std::uint32_t b, const Edge& like, bool unsettled) {
  if (a == b) return;
  Edge edge{a, b, like.border, like.traces, true};
  if (const auto there = graph_.find(a, b)) {
    const Edge& old = graph_.edges()[*there];
    if (!edge.border) std::tie(edge.a, edge.b) = std::pair(old.a, old.b);
    const bool reversed = edge.a != a, old_reversed = edge.a != old.a;
    edge.traces.clear();
    merge(edge.traces, old.traces, old_reversed);
    merge(edge.traces, like.traces, reversed);
    edge.border = edge.border || old.border;
    graph_.drop_edge(*there);
    unsettled = true;
    thinned_.push_back(a);
    thinned_.push_back(b);
    if (!edge.border && edge.traces.empty()) return;
  }
  const std::uint32_t added = graph_.add_edge(std::move(edge));
  if (unsettled) wait(added);
}

void Insertion::wait(std::uint32_t edge) {
  if (waiting_.size() <= edge) waiting_.resize(edge + 1, false);
  waiting_[edge] = true;
  unsettled_.push_back(edge);
}

auto Insertion::may_pass(const Edge& edge, Point2 p) const -> bool {
  if (edge.border && geometry::orientation(graph_.place(edge.a), graph_.place(edge.b), p) != 0) return false;
  const auto rigid = [&](const Trace& trace) { return std::ranges::find(rigid_, trace.cut) != rigid_.end(); };
  if (std::ranges::any_of(edge.traces, rigid) &&
      squared_distance({graph_.place(edge.a), graph_.place(edge.b)}, p) > square(grid))
    return false;
  return std::ranges::all_of(edge.traces, [&](const Trace& trace) {
    return squared_distance(line_of(trace), p) <= square(tolerances_.drift);
  });
}

auto Insertion::has_present_cut(const Edge& edge) const -> bool {
  return std::ranges::binary_search(edge.traces, cut_, {}, &Trace::cut);
}

auto Insertion::nearest_vertex(const Segment2& segment, double distance) const -> std::optional<std::uint32_t> {
  std::optional<std::uint32_t> nearest;
  for (const std::uint32_t v : graph_.vertices_near(segment, distance))
    if (!nearest || squared_distance(segment, graph_.place(v)) < squared_distance(segment, graph_.place(*nearest)))
      nearest = v;
  return nearest;
}

/// Takes away vertices left bare. False when an edge was left dangling.
auto Insertion::tidy() -> bool {
  for (const std::uint32_t v : thinned_) {
    const Vertex& vertex = graph_.vertices()[v];
    if (vertex.edges.size() == 1) return false;
    if (vertex.edges.empty() && vertex.alive) graph_.drop_vertex(v);
  }
  return true;
}

}  // namespace mansard::fracture::detail
