#include "mansard/extrude/detail/surface.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "mansard/extrude/detail/chart.hpp"

namespace mansard::extrude::detail {

auto ExactSurface::exact(std::uint32_t point) const -> ExactPlace { return exact_place(planes, points[point]); }

auto Trace::point(TracePoint point) -> std::uint32_t {
  geometry::Point3 p = planes.nearest(point.planes);
  if (point.on_level) p.z = static_cast<double>(point.level);
  places_.push_back(quantum * p);
  points_.push_back(point);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

auto Trace::node(FaceNode node) -> std::uint32_t {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  own_names_.push_back(node.provenance);
  nodes_.push_back(std::move(node));
  sets_.grow();
  return index;
}

auto Trace::root(std::uint32_t node) const -> std::uint32_t { return sets_.of(node); }

void Trace::unite(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  // The face is named after the first of the edges that sweep it.
  if (nodes_[b].provenance < nodes_[a].provenance) std::swap(nodes_[a].provenance, nodes_[b].provenance);
  sets_.join(a, b);
  if (b < a) nodes_[b].provenance = nodes_[a].provenance;
}

void Trace::arc(std::uint32_t from, std::uint32_t to, std::uint32_t left, std::uint32_t right) {
  if (from != to) arcs_.push_back({from, to, left, right});
}

void Trace::cut_at(std::int64_t level) {
  if (cuts_.empty() || cuts_.back() != level) cuts_.push_back(level);
}

namespace {

/// The directed boundary edges of one face, sorted by start.
using Boundary = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// What a face walks both ways is inside it, or a zero-width part of it: no boundary.
auto without_opposites(Boundary edges) -> Boundary {
  // By the undirected edge, one direction before the other: equal numbers of both cancel.
  std::ranges::sort(edges, [](const auto& p, const auto& q) {
    return std::tuple(std::minmax(p.first, p.second), p.first > p.second) <
           std::tuple(std::minmax(q.first, q.second), q.first > q.second);
  });
  Boundary left;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i, forth = 0;
    for (; j < edges.size() &&
           std::minmax(edges[j].first, edges[j].second) == std::minmax(edges[i].first, edges[i].second);
         ++j)
      forth += edges[j].first < edges[j].second;
    const std::size_t back = j - i - forth, common = std::min(forth, back);
    for (std::size_t k = common; k < forth; ++k) left.push_back(edges[i]);
    for (std::size_t k = common; k < back; ++k) left.push_back(edges[j - 1]);
    i = j;
  }
  std::ranges::sort(left);
  return left;
}

/// Walks the boundary, keeping to one wedge of the interior where it touches itself.
auto walk(const Boundary& edges, const Chart& chart) -> std::vector<Loop> {
  std::vector<bool> used(edges.size(), false);
  const auto leaving = [&](std::uint32_t v) {
    return std::ranges::equal_range(edges, v, {}, [](const auto& e) { return e.first; });
  };
  const auto next_of = [&](std::size_t edge) -> std::size_t {
    const auto [u, v] = edges[edge];
    const auto out = leaving(v);
    if (out.empty()) throw Broken("a face with an open boundary");
    const auto first = static_cast<std::size_t>(out.begin() - edges.begin());
    if (out.size() == 1) return first;
    // The first outgoing ray clockwise from the way back.
    const auto turned = [&](std::uint32_t p) -> int {  // 0: within half a turn clockwise of the way back, 1: beyond
      const int c = chart.cross_sign(v, u, v, p);
      if (c != 0) return c < 0 ? 0 : 1;
      return chart.dot_sign(v, u, v, p) < 0 ? 1 : 2;
    };
    std::size_t best = first;
    for (std::size_t i = first + 1; i < first + out.size(); ++i) {
      const std::uint32_t at = edges[i].second, champion = edges[best].second;
      const int p = turned(at), q = turned(champion);
      if (p != q ? p < q : chart.cross_sign(v, champion, v, at) > 0) best = i;
    }
    return best;
  };
  std::vector<Loop> loops;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (used[start]) continue;
    Loop loop;
    for (std::size_t e = start; !used[e]; e = next_of(e)) {
      used[e] = true;
      loop.push_back(edges[e].first);
    }
    // A loop that comes back to a point is two loops that touch there.
    Loop sorted = loop;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) == sorted.end()) {
      loops.push_back(std::move(loop));
      continue;
    }
    Loop open;
    for (const std::uint32_t v : loop) {
      const auto seen = std::ranges::find(open, v);
      if (seen != open.end()) {
        loops.emplace_back(seen, open.end());
        open.erase(seen, open.end());
      }
      open.push_back(v);
    }
    loops.push_back(std::move(open));
  }
  for (const Loop& loop : loops)
    if (loop.size() < 3) throw Broken("a face with two corners");
  return loops;
}

/// Each counter-clockwise loop is a face; clockwise ones are holes of the innermost face around them.
void nest(std::vector<Loop> loops, const FaceNode& node, const Chart& chart,
          std::vector<ExactSurface::ExactFace>& faces) {
  if (loops.size() == 1) {
    faces.push_back({std::move(loops), node});
    return;
  }
  std::vector<Loop> holes;
  const std::size_t first = faces.size();
  for (Loop& loop : loops) {
    const int turn = chart.orientation(loop);
    if (turn == 0) throw Broken("a face without area");
    if (turn > 0) faces.push_back({{std::move(loop)}, node});
    else holes.push_back(std::move(loop));
  }
  const auto within = [&](const Loop& inner, const Loop& outer) {
    for (const std::uint32_t v : inner)
      if (const int side = chart.side(outer, v); side != 0) return side > 0;
    return false;
  };
  for (Loop& hole : holes) {
    std::size_t home = faces.size();
    for (std::size_t f = first; f < faces.size(); ++f) {
      if (!within(hole, faces[f].loops[0])) continue;
      if (home == faces.size() || within(faces[f].loops[0], faces[home].loops[0])) home = f;
    }
    if (home == faces.size()) throw Broken("a hole outside of every face");
    faces[home].loops.push_back(std::move(hole));
  }
}

/// Points with two neighbours only lie inside an edge (the sweep stopped there for some other reason).
void take_out_passing_points(std::vector<ExactSurface::ExactFace>& faces, const Places& places, std::size_t points) {
  constexpr std::uint32_t many = UINT32_MAX - 1;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours(points, {none, none});
  const auto meets = [&](std::uint32_t v, std::uint32_t w) {
    auto& [a, b] = neighbours[v];
    if (a == w || b == w || a == many) return;
    if (a == none) a = w;
    else if (b == none) b = w;
    else a = many;
  };
  for (const auto& face : faces)
    for (const Loop& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        meets(loop[i], loop[(i + 1) % loop.size()]);
        meets(loop[(i + 1) % loop.size()], loop[i]);
      }
  const auto straight = [&](std::uint32_t v) {
    const auto [i, j] = neighbours[v];
    if (i >= many || j >= many) return false;
    const ExactPlace &a = places(i), &m = places(v), &b = places(j);
    const Rational ux = m.x - a.x, uy = m.y - a.y, uz = m.z - a.z, vx = b.x - m.x, vy = b.y - m.y, vz = b.z - m.z;
    return ux * vy == uy * vx && uy * vz == uz * vy && ux * vz == uz * vx;
  };
  std::vector<bool> passing(points);
  bool any = false;
  for (std::uint32_t v = 0; v < points; ++v)
    if (straight(v)) any = passing[v] = true;
  if (!any) return;
  for (auto& face : faces)
    for (Loop& loop : face.loops) std::erase_if(loop, [&](std::uint32_t v) { return passing[v]; });
}

}  // namespace

/// One number for points at one place: touching vertices of the wavefront stop at points of their own.
void Trace::merge_points() {
  const Places places(planes, points_, places_);
  std::vector<std::uint32_t> order(points_.size()), first(points_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = first[i] = i;
  std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
    return std::tuple(places_[i].z, places_[i].x, places_[i].y, i) <
           std::tuple(places_[j].z, places_[j].x, places_[j].y, j);
  });
  bool merged = false;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i; j-- > 0 && places_[order[j]] == places_[order[i]];)
      if (first[order[j]] == order[j] && places.same(order[j], order[i])) {
        first[order[i]] = order[j];
        merged = true;
        break;
      }
  if (!merged) return;
  for (Arc& arc : arcs_) {
    arc.from = first[arc.from];
    arc.to = first[arc.to];
  }
  std::erase_if(arcs_, [](const Arc& arc) { return arc.from == arc.to; });
}

void Trace::cut_arcs() {
  if (cuts_.empty()) return;
  const Places places(planes, points_, places_);
  std::vector<bool> used(points_.size(), false);
  for (const Arc& arc : arcs_) used[arc.from] = used[arc.to] = true;
  std::map<double, std::vector<std::uint32_t>> levels;
  for (const std::int64_t level : cuts_) levels[quantum * static_cast<double>(level)];
  for (std::uint32_t i = 0; i < points_.size(); ++i)
    if (used[i])
      if (const auto level = levels.find(places_[i].z); level != levels.end()) level->second.push_back(i);
  for (auto& [z, level] : levels)
    std::ranges::sort(level, [&](std::uint32_t i, std::uint32_t j) {
      return std::tuple(places_[i].x, i) < std::tuple(places_[j].x, j);
    });
  const std::size_t count = arcs_.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Arc arc = arcs_[k];
    const geometry::Point3 p = places_[arc.from], q = places_[arc.to];
    if (p.z != q.z) continue;
    const auto at = levels.find(p.z);
    if (at == levels.end()) continue;
    const auto& level = at->second;
    constexpr double near = 1e-6;
    const double left = std::min(p.x, q.x) - near, right = std::max(p.x, q.x) + near;
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    std::vector<std::pair<Rational, std::uint32_t>> inside;
    for (auto i = std::ranges::lower_bound(level, left, {}, [&](std::uint32_t v) { return places_[v].x; });
         i != level.end() && places_[*i].x <= right; ++i) {
      const geometry::Point3 m = places_[*i];
      if (*i == arc.from || *i == arc.to) continue;
      if (std::abs((m.x - p.x) * (q.y - p.y) - (m.y - p.y) * (q.x - p.x)) > near * length) continue;
      const ExactPlace &a = places(arc.from), &b = places(arc.to), &v = places(*i);
      if (a.z != v.z || b.z != v.z) continue;
      const Rational dx = b.x - a.x, dy = b.y - a.y, px = v.x - a.x, py = v.y - a.y;
      if (px * dy != py * dx) continue;
      Rational along = px * dx + py * dy;
      if (along > 0 && along < dx * dx + dy * dy) inside.emplace_back(std::move(along), *i);
    }
    std::ranges::sort(inside);
    std::uint32_t from = arc.from;
    for (const auto& [along, i] : inside) {
      arcs_.push_back({from, i, arc.left, arc.right});
      from = i;
    }
    arcs_[k].from = from;
  }
}

/// Faces of one plane that were united and yet came out apart each go by the edges whose sweep began with them.
void Trace::rename(std::uint32_t root_node, std::span<ExactSurface::ExactFace> faces) const {
  std::vector<std::optional<model::Provenance>> names(faces.size());
  std::vector<bool> begun(nodes_.size(), false);
  for (const Arc& arc : arcs_)
    for (const bool left : {true, false}) {
      const std::uint32_t node = left ? arc.left : arc.right;
      if (begun[node]) continue;
      begun[node] = true;  // a face begins with its first arc
      if (root(node) != root_node) continue;
      const std::uint32_t from = left ? arc.from : arc.to, to = left ? arc.to : arc.from;
      for (std::size_t f = 0; f < faces.size(); ++f)
        for (const Loop& loop : faces[f].loops) {
          const auto at = std::ranges::find(loop, from);
          if (at == loop.end() || (at + 1 == loop.end() ? loop.front() : *(at + 1)) != to) continue;
          if (!names[f] || own_names_[node] < *names[f]) names[f] = own_names_[node];
        }
    }
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (names[f]) faces[f].node.provenance = *names[f];
}

auto Trace::assemble() -> ExactSurface {
  merge_points();
  cut_arcs();
  for (const Arc& arc : arcs_)
    if (nodes_[arc.left].kind == model::FaceKind::terrace && nodes_[arc.right].kind == model::FaceKind::terrace)
      unite(arc.left, arc.right);

  std::vector<Boundary> boundaries(nodes_.size());
  for (const Arc& arc : arcs_) {
    const std::uint32_t left = root(arc.left), right = root(arc.right);
    if (left == right) continue;
    boundaries[left].emplace_back(arc.from, arc.to);
    boundaries[right].emplace_back(arc.to, arc.from);
  }
  ExactSurface surface;
  const Places places(planes, points_, places_);
  for (std::uint32_t n = 0; n < boundaries.size(); ++n) {
    const Boundary edges = without_opposites(std::move(boundaries[n]));
    if (edges.empty()) continue;
    const Chart chart(places, nodes_[n]);
    const std::size_t first = surface.faces.size();
    nest(walk(edges, chart), nodes_[n], chart, surface.faces);
    if (surface.faces.size() > first + 1 && nodes_[n].kind == model::FaceKind::side)
      rename(n, std::span(surface.faces).subspan(first));
  }
  take_out_passing_points(surface.faces, places, points_.size());
  surface.places = std::move(places_);
  surface.points = std::move(points_);
  surface.planes = std::move(planes);
  return surface;
}

}  // namespace mansard::extrude::detail
