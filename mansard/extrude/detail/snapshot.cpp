// The snapshot: everything that happens at one critical moment, resolved at once by one rule.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "mansard/extrude/detail/wavefront.hpp"

namespace mansard::extrude::detail {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

struct Box {
  Interval x, y;
  [[nodiscard]] auto overlaps(const Box& o) const -> bool { return x.overlaps(o.x) && y.overlaps(o.y); }
  [[nodiscard]] auto with(const Box& o) const -> Box {
    return {{std::min(x.lo, o.x.lo), std::max(x.hi, o.x.hi)}, {std::min(y.lo, o.y.lo), std::max(y.hi, o.y.hi)}};
  }
};

/// A stretch of an edge between two sites.
struct Piece {
  std::uint32_t edge, from, to;
  bool alive = true;
  std::uint32_t next = none, prev = none;
};

}  // namespace

/// Sites are the points where something happens; a vertex that nothing touches stays quiet and is a site of its own,
/// numbered after the others, whose exact place is never needed.
struct Wavefront::Meeting {
  Wavefront& wave;
  const Rational &t, &z;
  std::uint32_t count;
  std::vector<Box> boxes;
  std::vector<std::optional<ExactPoint>> exact;
  std::vector<bool> involved;
  std::vector<std::vector<std::uint32_t>> touching;  // vertices strictly inside edge i
  std::vector<std::uint32_t> site_of;                // vertex → site
  std::vector<ExactPoint> sites;
  std::vector<std::uint32_t> points;  // site → point of the trace
  std::vector<Piece> pieces;

  Meeting(Wavefront& w, const Rational& moment, const Rational& height)
      : wave(w), t(moment), z(height), count(static_cast<std::uint32_t>(w.edges.size())) {
    const Interval when(t);
    exact.resize(count);
    involved.assign(count, false);
    touching.resize(count);
    for (const WaveEdge& e : wave.edges) boxes.push_back({e.x0 + e.x1 * when, e.y0 + e.y1 * when});
  }

  auto at(std::uint32_t vertex) -> const ExactPoint& {
    if (!exact[vertex]) exact[vertex] = wave.start_of(vertex, t);
    return *exact[vertex];
  }

  void find_contacts() {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t j = wave.edges[i].next;
      if (boxes[i].overlaps(boxes[j]) && at(i) == at(j)) involved[i] = involved[j] = true;
    }
    for (std::uint32_t e = 0; e < count; ++e) {
      const std::uint32_t end = wave.edges[e].next;
      const Box reach = boxes[e].with(boxes[end]);
      const Direction& d = wave.line_of(e).direction;
      const auto l = static_cast<double>(d.l);
      const Interval a = Interval(static_cast<double>(d.a)) / l, b = Interval(static_cast<double>(d.b)) / l;
      const Interval r = wave.line_of(e).c + wave.line_of(e).s * Interval(t);
      for (std::uint32_t v = 0; v < count; ++v) {
        if (v == e || v == end || !boxes[v].overlaps(reach)) continue;
        if (!(a * boxes[v].y - b * boxes[v].x - r).holds_zero()) continue;
        contact(v, e, end);
      }
    }
  }

  void contact(std::uint32_t v, std::uint32_t e, std::uint32_t end) {
    const Line& line = wave.line_of(e);
    const Rational a(line.direction.a), b(line.direction.b);
    if (a * at(v).y - b * at(v).x != line.C + line.S * t) return;
    const auto along = [&](std::uint32_t vertex) -> Rational { return a * at(vertex).x + b * at(vertex).y; };
    const Rational w = along(v), from = along(e), to = along(end);
    if (w < from || w > to) return;
    involved[v] = true;
    if (w == from) involved[e] = true;
    if (w == to) involved[end] = true;
    if (w > from && w < to) touching[e].push_back(v);
  }

  void name_sites() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < count; ++v)
      if (involved[v]) order.push_back(v);
    std::ranges::sort(order, [&](std::uint32_t p, std::uint32_t q) {
      const int by_x = cmp(at(p).x, at(q).x);
      if (by_x != 0) return by_x < 0;
      const int by_y = cmp(at(p).y, at(q).y);
      return by_y != 0 ? by_y < 0 : p < q;
    });
    site_of.resize(count);
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i == 0 || !(at(order[i]) == sites.back())) {
        sites.push_back(at(order[i]));
        points.push_back(wave.trace_.point(sites.back(), z));
      }
      site_of[order[i]] = static_cast<std::uint32_t>(sites.size() - 1);
    }
    for (std::uint32_t v = 0; v < count; ++v)
      if (!involved[v]) site_of[v] = static_cast<std::uint32_t>(sites.size()) + v;
  }

  void end_arcs() {
    for (std::uint32_t v = 0; v < count; ++v)
      if (involved[v])
        wave.trace_.arc(wave.edges[v].origin, points[site_of[v]], wave.edges[wave.edges[v].prev].node,
                        wave.edges[v].node);
  }

  void cut_pieces() {
    for (std::uint32_t e = 0; e < count; ++e) {
      auto& inside = touching[e];
      const Direction& d = wave.line_of(e).direction;
      const Rational a(d.a), b(d.b);
      std::vector<std::pair<Rational, std::uint32_t>> stops;
      for (const std::uint32_t v : inside) stops.emplace_back(Rational(a * at(v).x + b * at(v).y), site_of[v]);
      std::ranges::sort(stops);
      std::uint32_t here = site_of[e];
      const auto go = [&](std::uint32_t to) {
        if (to != here) pieces.push_back({e, here, to});
        here = to;
      };
      for (const auto& [along, site] : stops) go(site);
      go(site_of[wave.edges[e].next]);
    }
  }

  /// Two pieces that lie on each other in opposite directions enclose nothing any more: a ridge between their faces.
  void cancel() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      if (pieces[i].from < sites.size() && pieces[i].to < sites.size()) order.push_back(i);
    const auto key = [&](std::uint32_t i) { return std::minmax(pieces[i].from, pieces[i].to); };
    std::ranges::sort(order, [&](std::uint32_t p, std::uint32_t q) {
      const std::pair<std::uint32_t, std::uint32_t> kp = key(p), kq = key(q);
      return std::tie(kp.first, kp.second, p) < std::tie(kq.first, kq.second, q);
    });
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      Piece &p = pieces[order[i]], &q = pieces[order[i + 1]];
      if (!p.alive || p.from != q.to || p.to != q.from) continue;
      p.alive = q.alive = false;
      wave.trace_.arc(points[p.to], points[p.from], wave.edges[p.edge].node, wave.edges[q.edge].node);
    }
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      const Piece &p = pieces[order[i]], &q = pieces[order[i + 1]];
      if (p.alive && q.alive && std::minmax(p.from, p.to) == std::minmax(q.from, q.to))
        throw Broken("two edges of the wavefront lie on each other");
    }
  }

  /// At every site each incoming piece goes on with the next outgoing one clockwise: the one that bounds the same wedge
  /// of interior.
  void join() {
    struct Ray {
      Direction direction;  // away from the site
      std::uint32_t piece;
      bool incoming;
    };
    std::vector<std::vector<Ray>> rays(sites.size() + count);
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      if (!pieces[i].alive) continue;
      const Direction& d = wave.line_of(pieces[i].edge).direction;
      rays[pieces[i].from].push_back({d, i, false});
      rays[pieces[i].to].push_back({d.reversed(), i, true});
    }
    for (auto& around : rays) {
      if (around.size() % 2 != 0) throw Broken("a site with more ways in than out");
      std::ranges::sort(around, [](const Ray& p, const Ray& q) {
        if (p.direction == q.direction) return p.piece < q.piece;
        return angle_less(p.direction, q.direction);
      });
      for (std::size_t i = 0; i < around.size(); ++i) {
        const Ray& in = around[i];
        if (!in.incoming) continue;
        const Ray& out = around[(i + around.size() - 1) % around.size()];
        if (out.incoming) throw Broken("the wavefront crosses itself");
        pieces[in.piece].next = out.piece;
        pieces[out.piece].prev = in.piece;
      }
    }
    for (const Piece& p : pieces)
      if (p.alive && (p.next == none || p.prev == none)) throw Broken("a site with more ways in than out");
  }

  /// Undoes cuts that changed nothing.
  void mend() {
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      if (!pieces[i].alive) continue;
      while (pieces[pieces[i].next].edge == pieces[i].edge) {
        const std::uint32_t j = pieces[i].next;
        if (j == i) throw Broken("a loop of one edge");
        pieces[j].alive = false;
        pieces[i].to = pieces[j].to;
        pieces[i].next = pieces[j].next;
        pieces[pieces[i].next].prev = i;
      }
    }
  }

  [[nodiscard]] auto rebuilt() -> std::vector<WaveEdge> {
    std::vector<std::uint32_t> index(pieces.size(), none);
    std::uint32_t alive = 0;
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      if (pieces[i].alive) index[i] = alive++;
    std::vector<WaveEdge> edges;
    edges.reserve(alive);
    for (const Piece& p : pieces) {
      if (!p.alive) continue;
      WaveEdge e;
      e.line = wave.edges[p.edge].line;
      e.node = wave.edges[p.edge].node;
      e.next = index[p.next];
      e.prev = index[p.prev];
      if (p.from < sites.size()) {
        e.origin = points[p.from];
        e.start = sites[p.from];
      } else {
        e.origin = wave.edges[p.from - sites.size()].origin;
      }
      edges.push_back(std::move(e));
    }
    for (const WaveEdge& e : edges)
      if (edges[e.next].next == static_cast<std::uint32_t>(&e - edges.data())) throw Broken("a loop of two edges");
    return edges;
  }

  /// Twice the area, and how unsure it is.
  [[nodiscard]] auto area(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& stretches) const -> Interval {
    double sum = 0, unsure = 0;
    const auto middle = [](Interval v) { return (v.lo + v.hi) / 2; };
    for (const auto& [i, j] : stretches) {
      const double xi = middle(boxes[i].x), yi = middle(boxes[i].y), xj = middle(boxes[j].x), yj = middle(boxes[j].y);
      sum += xi * yj - xj * yi;
      const double width = boxes[i].x.hi - boxes[i].x.lo + boxes[i].y.hi - boxes[i].y.lo + boxes[j].x.hi -
                           boxes[j].x.lo + boxes[j].y.hi - boxes[j].y.lo;
      unsure += (1e-12 + width) * (std::abs(xi) + std::abs(yi) + std::abs(xj) + std::abs(yj) + 1);
    }
    return {sum - unsure, sum + unsure};
  }

  /// Always-on invariant: a snapshot changes how pieces are joined, never the area they enclose.
  void compare_areas() const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> before, after;
    for (std::uint32_t i = 0; i < count; ++i) before.emplace_back(i, wave.edges[i].next);
    std::vector<std::uint32_t> vertex_of(sites.size() + count);
    for (std::uint32_t v = 0; v < count; ++v) vertex_of[site_of[v]] = v;
    for (const Piece& p : pieces)
      if (p.alive) after.emplace_back(vertex_of[p.from], vertex_of[p.to]);
    if (!area(before).overlaps(area(after))) throw Broken("a snapshot changed the area");
  }
};

void Wavefront::snapshot(const Rational& t, const Rational& z) {
  Meeting meeting(*this, t, z);
  meeting.find_contacts();
  meeting.name_sites();
  meeting.end_arcs();
  meeting.cut_pieces();
  meeting.cancel();
  meeting.join();
  meeting.mend();
  meeting.compare_areas();
  edges = meeting.rebuilt();
}

}  // namespace mansard::extrude::detail
