#include "mansard/extrude/detail/wavefront.hpp"

#include <algorithm>

namespace mansard::extrude::detail {
namespace {

auto unit(std::int64_t part, std::int64_t l) -> Interval {
  if (part == 0) return {0.0};
  return Interval(static_cast<double>(part)) / Interval(static_cast<double>(l));
}

/// Sine or cosine between two directions from their exact product.
auto ratio(Int128 product, const Direction& p, const Direction& q) -> Interval {
  if (product == 0) return {0.0};
  const auto d = static_cast<double>(product);
  return Interval::outward(d, d) / (Interval(static_cast<double>(p.l)) * Interval(static_cast<double>(q.l)));
}

}  // namespace

void Wavefront::merge_planes() {
  std::vector<bool> gone(edges.size(), false);
  const auto one_plane = [&](std::uint32_t i, std::uint32_t j) {
    const Line &a = line_of(i), &b = line_of(j);
    // Two connectors in line never move: they are one wall.
    return a.direction == b.direction && a.plane == b.plane;
  };
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    if (gone[i]) continue;
    while (one_plane(i, edges[i].next)) {
      const std::uint32_t j = edges[i].next;
      if (j == i) throw Broken("a loop of one edge");
      trace_.unite(edges[i].node, edges[j].node);
      gone[j] = true;
      edges[i].next = edges[j].next;
      edges[edges[i].next].prev = i;
    }
  }
  std::vector<std::uint32_t> index(edges.size());
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    index[i] = kept;
    if (gone[i]) continue;
    if (kept != i) edges[kept] = std::move(edges[i]);
    ++kept;
  }
  edges.resize(kept);
  for (WaveEdge& e : edges) {
    e.prev = index[e.prev];
    e.next = index[e.next];
  }
}

void Wavefront::connect() {
  merge_planes();
  const auto count = static_cast<std::uint32_t>(edges.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t before = edges[i].prev;
    if (line_of(before).direction != line_of(i).direction) continue;
    if (!edges[i].start) throw Broken("neighbours on one line without a known joint");
    const ExactPoint& p = *edges[i].start;
    const Line& behind = line_of(before);
    const bool steps_out = behind.S > line_of(i).S;  // the edge before runs ahead: step back outwards to this one
    Line line;
    line.connector = true;
    line.direction = steps_out ? behind.direction.left().reversed() : behind.direction.left();
    const Rational along = Rational(behind.direction.a) * p.x + Rational(behind.direction.b) * p.y;
    line.move(steps_out ? along : Rational(-along), 0);
    line.plane = UINT32_MAX;
    WaveEdge edge;
    edge.line = static_cast<std::uint32_t>(lines_.size());
    edge.node = trace_.node({FaceKind::connector, {}, line.direction, 0});
    edge.origin = edges[i].origin;
    edge.prev = before;
    edge.next = i;
    const auto index = static_cast<std::uint32_t>(edges.size());
    edges[before].next = edges[i].prev = index;
    lines_.push_back(std::move(line));
    edges.push_back(std::move(edge));
  }
  prepare();
}

void Wavefront::prepare() {
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    WaveEdge& e = edges[i];
    e.start.reset();
    const Line &p = line_of(e.prev), &m = lines_[e.line];
    const Int128 turn = cross(p.direction, m.direction);
    if (turn == 0) throw Broken("parallel neighbours in the wavefront");
    e.reflex = turn < 0;
    const Interval sine = ratio(turn, p.direction, m.direction),
                   cosine = ratio(dot(p.direction, m.direction), p.direction, m.direction);
    const Interval pa = unit(p.direction.a, p.direction.l), pb = unit(p.direction.b, p.direction.l);
    const Interval ma = unit(m.direction.a, m.direction.l), mb = unit(m.direction.b, m.direction.l);
    e.x0 = (p.c * ma - pa * m.c) / sine;
    e.x1 = (p.s * ma - pa * m.s) / sine;
    e.y0 = (mb * p.c - pb * m.c) / sine;
    e.y1 = (mb * p.s - pb * m.s) / sine;
    e.from0 = (p.c - m.c * cosine) / sine;
    e.from1 = (p.s - m.s * cosine) / sine;
    WaveEdge& before = edges[e.prev];
    before.to0 = (m.c - p.c * cosine) / -sine;
    before.to1 = (m.s - p.s * cosine) / -sine;
  }
}

auto Wavefront::motion_of(std::uint32_t edge) const -> Motion {
  const Line &p = line_of(edges[edge].prev), &m = line_of(edge);
  const Int128 turn = cross(p.direction, m.direction);
  if (turn == 0) throw Broken("parallel neighbours in the wavefront");
  const Rational inverse(1, to_integer(turn));
  Rational scale = inverse;
  scale.canonicalize();
  const Rational pa(p.direction.a), pb(p.direction.b), ma(m.direction.a), mb(m.direction.b);
  return {(p.C * ma - pa * m.C) * scale, (p.S * ma - pa * m.S) * scale, (mb * p.C - pb * m.C) * scale,
          (mb * p.S - pb * m.S) * scale};
}

auto Wavefront::start_of(std::uint32_t edge, const Rational& t) const -> ExactPoint {
  if (edges[edge].start) return *edges[edge].start;
  const Line &p = line_of(edges[edge].prev), &m = line_of(edge);
  const Int128 turn = cross(p.direction, m.direction);
  if (turn == 0) throw Broken("parallel neighbours in the wavefront");
  const Rational rp = p.C + p.S * t, rm = m.C + m.S * t;
  const Rational divisor(to_integer(turn));
  return {(rp * m.direction.a - rm * p.direction.a) / divisor, (rp * m.direction.b - rm * p.direction.b) / divisor};
}

void Wavefront::close_arc(std::uint32_t edge, const Rational& t, const Rational& z) {
  WaveEdge& e = edges[edge];
  const std::uint32_t here = trace_.point(start_of(edge, t), z);
  trace_.arc(e.origin, here, edges[e.prev].node, e.node);
  e.origin = here;
}

auto Wavefront::collapse(std::uint32_t edge) const -> std::optional<Rational> {
  const Line &e = line_of(edge), &p = line_of(edges[edge].prev), &q = line_of(edges[edge].next);
  const Rational square = Rational(e.direction.l) * e.direction.l;
  // Where neighbour k cuts the edge's line, times l: (R_k l² − R_e (k·e)) / (k×e); its offset and its speed.
  const auto cut = [&](const Line& k, const Rational& rk, const Rational& re) -> Rational {
    return (rk * square - re * Rational(to_integer(dot(k.direction, e.direction)))) /
           Rational(to_integer(cross(k.direction, e.direction)));
  };
  const Rational growth = cut(q, q.S, e.S) - cut(p, p.S, e.S);
  if (growth >= 0) return std::nullopt;
  const Rational length = cut(q, q.C, e.C) - cut(p, p.C, e.C);
  return Rational(-length / growth);
}

auto Wavefront::hit(std::uint32_t vertex, std::uint32_t edge, const Rational& now) const -> std::optional<Rational> {
  const Motion v = motion_of(vertex);
  const Line& e = line_of(edge);
  const Rational a(e.direction.a), b(e.direction.b);
  const Rational approach = a * v.y1 - b * v.x1 - e.S;
  if (approach >= 0) return std::nullopt;
  const Rational gap = a * v.y0 - b * v.x0 - e.C;
  const Rational t = -gap / approach;
  if (t <= now) return std::nullopt;
  const auto along = [&](const Motion& m) -> Rational { return a * (m.x0 + m.x1 * t) + b * (m.y0 + m.y1 * t); };
  const Rational w = along(v);
  if (w < along(motion_of(edge)) || w > along(motion_of(edges[edge].next))) return std::nullopt;
  return t;
}

auto Wavefront::next_event(const Rational& now, const Rational& limit) const -> std::optional<Rational> {
  struct Candidate {
    double earliest;
    std::uint32_t vertex, edge;  // vertex == edge: the edge collapses
  };
  const Interval present(now);
  double latest = Interval(limit).hi;  // an event surely happens by then, or nothing before the limit
  std::vector<Candidate> candidates;
  const auto count = static_cast<std::uint32_t>(edges.size());

  for (std::uint32_t i = 0; i < count; ++i) {
    const WaveEdge& e = edges[i];
    const Interval growth = e.to1 - e.from1;
    if (growth.lo >= 0) continue;
    const Interval t = -(e.to0 - e.from0) / growth;
    if (t.hi < present.lo || t.lo > latest) continue;
    if (growth.hi < 0 && t.lo > present.hi) latest = std::min(latest, t.hi);
    candidates.push_back({t.lo, i, i});
  }
  std::vector<std::uint32_t> reflex;
  for (std::uint32_t i = 0; i < count; ++i)
    if (edges[i].reflex) reflex.push_back(i);
  for (std::uint32_t j = 0; j < count && !reflex.empty(); ++j) {
    const WaveEdge& e = edges[j];
    const Line& line = lines_[e.line];
    const Interval a = unit(line.direction.a, line.direction.l), b = unit(line.direction.b, line.direction.l);
    for (const std::uint32_t i : reflex) {
      const WaveEdge& v = edges[i];
      if (i == j || v.prev == j) continue;
      const Interval approach = a * v.y1 - b * v.x1 - line.s;
      if (approach.lo >= 0) continue;
      const Interval t = -(a * v.y0 - b * v.x0 - line.c) / approach;
      if (t.hi < present.lo || t.lo > latest) continue;
      const bool parallel = line_of(i).direction == line.direction || line_of(v.prev).direction == line.direction;
      if (parallel && approach.hi >= 0) {
        // Equal speeds, told apart exactly and cheaply before the general test.
        const Line& twin = line_of(i).direction == line.direction ? line_of(i) : line_of(v.prev);
        if (twin.S >= line.S) continue;
      }
      const Interval when(std::max(t.lo, present.lo), std::min(t.hi, latest));
      const Interval w = a * (v.x0 + v.x1 * when) + b * (v.y0 + v.y1 * when);
      const Interval from = e.from0 + e.from1 * when, to = e.to0 + e.to1 * when;
      if (w.hi < from.lo || w.lo > to.hi) continue;
      if (approach.hi < 0 && t.lo > present.hi && w.lo > from.hi && w.hi < to.lo) latest = std::min(latest, t.hi);
      candidates.push_back({t.lo, i, j});
    }
  }

  std::ranges::sort(candidates, [](const Candidate& p, const Candidate& q) {
    return std::tie(p.earliest, p.vertex, p.edge) < std::tie(q.earliest, q.vertex, q.edge);
  });
  std::optional<Rational> first;
  for (const Candidate& c : candidates) {
    if (c.earliest > latest) break;
    auto t = c.vertex == c.edge ? collapse(c.edge) : hit(c.vertex, c.edge, now);
    if (!t || *t <= now || *t > limit || (first && *t >= *first)) continue;
    latest = std::min(latest, Interval(*t).hi);
    first = std::move(t);
  }
  return first;
}

}  // namespace mansard::extrude::detail
