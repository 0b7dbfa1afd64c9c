#include "mansard/extrude/detail/surface.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace mansard::extrude::detail {

auto Trace::point(const ExactPoint& p, const Rational& z) -> std::uint32_t {
  auto& here = found_[{z.get_d(), p.x.get_d(), p.y.get_d()}];
  for (const std::uint32_t i : here)
    if (points_[i].x == p.x && points_[i].y == p.y && points_[i].z == z) return i;
  const auto index = static_cast<std::uint32_t>(points_.size());
  points_.push_back({p.x, p.y, z});
  here.push_back(index);
  return index;
}

auto Trace::node(FaceNode node) -> std::uint32_t {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(std::move(node));
  parent_.push_back(index);
  return index;
}

auto Trace::root(std::uint32_t node) const -> std::uint32_t {
  while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
  return node;
}

void Trace::unite(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  // The face is named after the first of the edges that sweep it.
  if (nodes_[b].provenance < nodes_[a].provenance) std::swap(nodes_[a].provenance, nodes_[b].provenance);
  parent_[std::max(a, b)] = std::min(a, b);
  if (b < a) nodes_[b].provenance = nodes_[a].provenance;
}

void Trace::arc(std::uint32_t from, std::uint32_t to, std::uint32_t left, std::uint32_t right) {
  if (from != to) arcs_.push_back({from, to, left, right});
}

void Trace::cut_at(const Rational& z) {
  if (cuts_.empty() || cuts_.back() != z) cuts_.push_back(z);
}

void Trace::cut_arcs() {
  for (const Rational& z : cuts_) {
    std::vector<std::uint32_t> level;
    for (std::uint32_t i = 0; i < points_.size(); ++i)
      if (points_[i].z == z) level.push_back(i);
    const std::size_t count = arcs_.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Arc arc = arcs_[k];
      const Point &a = points_[arc.from], &b = points_[arc.to];
      if (a.z != z || b.z != z) continue;
      const Rational dx = b.x - a.x, dy = b.y - a.y;
      geometry::Box2 box;
      box.add({a.x.get_d(), a.y.get_d()});
      box.add({b.x.get_d(), b.y.get_d()});
      box = box.grown(1e-6);
      std::vector<std::pair<Rational, std::uint32_t>> inside;
      for (const std::uint32_t i : level) {
        const Point& p = points_[i];
        if (i == arc.from || i == arc.to || !box.contains({p.x.get_d(), p.y.get_d()})) continue;
        const Rational px = p.x - a.x, py = p.y - a.y;
        if (px * dy != py * dx) continue;
        const Rational along = px * dx + py * dy;
        if (along > 0 && along < dx * dx + dy * dy) inside.emplace_back(along, i);
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
}

namespace {

using Loop = std::vector<std::uint32_t>;

/// The face's own plane, seen from outside, in exact coordinates.
class Chart {
 public:
  Chart(const std::vector<Trace::Point>& points, const FaceNode& node) : points_(points), node_(node) {}

  [[nodiscard]] auto operator()(std::uint32_t i) const -> ExactPoint {
    const Trace::Point& p = points_[i];
    if (node_.kind == FaceKind::base) return {p.y, p.x};
    const bool upright = node_.kind == FaceKind::connector || (node_.kind == FaceKind::side && node_.slope == 0);
    if (!upright) return {p.x, p.y};
    return {Rational(node_.direction.a) * p.x + Rational(node_.direction.b) * p.y, p.z};
  }

  [[nodiscard]] auto turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const -> int {
    const ExactPoint p = (*this)(a), q = (*this)(b), r = (*this)(c);
    return sgn(Rational((q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x)));
  }

  /// +1 counter-clockwise, judged at the loop's lowest leftmost corner, which is never straight.
  [[nodiscard]] auto orientation(const Loop& loop) const -> int {
    std::size_t least = 0;
    ExactPoint at = (*this)(loop[0]);
    for (std::size_t i = 1; i < loop.size(); ++i) {
      ExactPoint p = (*this)(loop[i]);
      if (p.x < at.x || (p.x == at.x && p.y < at.y)) {
        at = std::move(p);
        least = i;
      }
    }
    const std::size_t n = loop.size();
    return turn(loop[(least + n - 1) % n], loop[least], loop[(least + 1) % n]);
  }

  /// Whether the point lies in the loop: 1 inside, 0 on it, −1 outside.
  [[nodiscard]] auto side(const Loop& loop, std::uint32_t point) const -> int {
    const ExactPoint p = (*this)(point);
    bool inside = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const ExactPoint a = (*this)(loop[i]), b = (*this)(loop[(i + 1) % loop.size()]);
      const int area = sgn(Rational((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)));
      if (area == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
          p.y <= std::max(a.y, b.y))
        return 0;
      if ((a.y > p.y) != (b.y > p.y) && (area > 0) == (b.y > a.y)) inside = !inside;
    }
    return inside ? 1 : -1;
  }

 private:
  const std::vector<Trace::Point>& points_;
  const FaceNode& node_;
};

/// The directed boundary edges of one face, sorted by start.
using Boundary = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// What a face walks both ways is inside it, or a zero-width part of it: no boundary.
auto without_opposites(Boundary edges) -> Boundary {
  std::ranges::sort(edges);
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> left(edges.begin(), edges.end());
  for (const auto& [from, to] : edges) {
    if (from > to) continue;
    auto forth = left.find({from, to});
    auto back = left.find({to, from});
    if (forth == left.end() || back == left.end()) continue;
    left.erase(forth);
    left.erase(back);
  }
  return {left.begin(), left.end()};
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
    const ExactPoint at = chart(v), from = chart(u);
    const auto away = [&](const ExactPoint& p) { return ExactPoint{p.x - at.x, p.y - at.y}; };
    const ExactPoint back = away(from);
    const auto turned = [&](const ExactPoint& p) -> int {  // 0: within half a turn clockwise of `back`, 1: beyond
      const int c = sgn(Rational(back.x * p.y - back.y * p.x));
      if (c != 0) return c < 0 ? 0 : 1;
      return sgn(Rational(back.x * p.x + back.y * p.y)) < 0 ? 1 : 2;
    };
    std::size_t best = first;
    ExactPoint best_ray = away(chart(edges[first].second));
    for (std::size_t i = first + 1; i < first + out.size(); ++i) {
      ExactPoint ray = away(chart(edges[i].second));
      const int p = turned(ray), q = turned(best_ray);
      const bool sooner = p != q ? p < q : sgn(Rational(best_ray.x * ray.y - best_ray.y * ray.x)) > 0;
      if (!sooner) continue;
      best = i;
      best_ray = std::move(ray);
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
void nest(std::vector<Loop> loops, const FaceNode& node, const Chart& chart, ExactSurface& surface) {
  if (loops.size() == 1) {
    surface.faces.push_back({std::move(loops), node});
    return;
  }
  std::vector<Loop> holes;
  const std::size_t first = surface.faces.size();
  for (Loop& loop : loops) {
    const int turn = chart.orientation(loop);
    if (turn == 0) throw Broken("a face without area");
    if (turn > 0) surface.faces.push_back({{std::move(loop)}, node});
    else holes.push_back(std::move(loop));
  }
  const auto within = [&](const Loop& inner, const Loop& outer) {
    for (const std::uint32_t v : inner)
      if (const int side = chart.side(outer, v); side != 0) return side > 0;
    return false;
  };
  for (Loop& hole : holes) {
    std::size_t home = surface.faces.size();
    for (std::size_t f = first; f < surface.faces.size(); ++f) {
      if (!within(hole, surface.faces[f].loops[0])) continue;
      if (home == surface.faces.size() || within(surface.faces[f].loops[0], surface.faces[home].loops[0])) home = f;
    }
    if (home == surface.faces.size()) throw Broken("a hole outside of every face");
    surface.faces[home].loops.push_back(std::move(hole));
  }
}

/// Points with two neighbours only lie inside an edge (the sweep stopped there for some other reason).
void take_out_passing_points(ExactSurface& surface) {
  std::vector<std::set<std::uint32_t>> neighbours(surface.points.size());
  for (const auto& face : surface.faces)
    for (const Loop& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
        neighbours[a].insert(b);
        neighbours[b].insert(a);
      }
  const auto straight = [&](std::uint32_t v) {
    if (neighbours[v].size() != 2) return false;
    const auto &a = surface.points[*neighbours[v].begin()], &m = surface.points[v],
               &b = surface.points[*neighbours[v].rbegin()];
    const Rational ux = m.x - a.x, uy = m.y - a.y, uz = m.z - a.z, vx = b.x - m.x, vy = b.y - m.y, vz = b.z - m.z;
    return ux * vy == uy * vx && uy * vz == uz * vy && ux * vz == uz * vx;
  };
  std::vector<bool> passing(surface.points.size());
  for (std::uint32_t v = 0; v < surface.points.size(); ++v) passing[v] = straight(v);
  for (auto& face : surface.faces)
    for (Loop& loop : face.loops) std::erase_if(loop, [&](std::uint32_t v) { return passing[v]; });
}

}  // namespace

auto assemble(Trace& trace) -> ExactSurface {
  trace.cut_arcs();
  for (const Trace::Arc& arc : trace.arcs())
    if (trace.nodes()[arc.left].kind == FaceKind::terrace && trace.nodes()[arc.right].kind == FaceKind::terrace)
      trace.unite(arc.left, arc.right);

  std::vector<Boundary> boundaries(trace.nodes().size());
  for (const Trace::Arc& arc : trace.arcs()) {
    const std::uint32_t left = trace.root(arc.left), right = trace.root(arc.right);
    if (left == right) continue;
    boundaries[left].emplace_back(arc.from, arc.to);
    boundaries[right].emplace_back(arc.to, arc.from);
  }
  ExactSurface surface;
  surface.points = trace.points();
  for (std::uint32_t n = 0; n < boundaries.size(); ++n) {
    const Boundary edges = without_opposites(std::move(boundaries[n]));
    if (edges.empty()) continue;
    const FaceNode& node = trace.nodes()[n];
    const Chart chart(surface.points, node);
    nest(walk(edges, chart), node, chart, surface);
  }
  take_out_passing_points(surface);
  return surface;
}

}  // namespace mansard::extrude::detail
