// The wavefront in doubles: where its vertices and edges are over t, how far off that may be, and which of them may
// meet when. What is certain here is decided here; everything else is left to the exact predicates.
//
// Every bound below is proven in the model of IEEE 754 doubles, round to nearest: x ∘ y = (x ∘' y)(1 + δ), |δ| ≤ u =
// 2⁻⁵³. Products of such factors are added up in units of u; what is left out is of order u² and covered by the room
// that every bound has. Underflow changes a product by less than 2⁻¹⁰⁷⁴, far less than any bound here that is not 0:
// coefficients that are not 0 are at least 2⁻⁴² (offsets of planes that events have made 2⁻³⁰⁰).
//
// Inputs, with their errors (Plane): nx, ny within 1 u, relative; offset c within 8 u of `size`, speed s within 8 u of
// |s|. For a line that stands still at the height h of a terrace, c + s h is off by 5 u |c| + 6 u |s h| + 1 u of the
// sum, less than 8 u of size = |c| + |s h|. cross(p, m) is an integer below 2⁸³, rounded once, over a product of
// two integers below 2⁴¹, rounded once: the sine of the angle between two lines is within 3 u, relative.
#include <cmath>

#include "mansard/extrude/detail/wavefront.hpp"

namespace mansard::extrude::detail {
namespace {

/// Of a vertex: x0 = (c_p ny_m − ny_p c_m) / sine, and likewise x1, y0, y1. Each product has 8 + 1 u from its factors
/// and 1 u of its own, their difference 1 u, and |ny| ≤ 1: 11 u (size_p + size_m). The quotient adds 3 u of the sine
/// and 1 u of its own to a numerator of at most size_p + size_m: 15 u (size_p + size_m) / |sine|. 16 would do; 64
/// leaves room of a factor 4, which `pace` and the bounds on products with t below make use of.
constexpr double vertex_error = 64 * unit_roundoff;

/// Of a place along an edge: ux x + uy y with (ux, uy) within 1 u. x and y are off by at most their `error0` (or
/// `error1`) each, together √2 of that, taken as 2; the products have 1 + 1 u, the sum 1 u: 3 u (|x| + |y|). 16 leaves
/// room for the product with t and its sum, 2 u more.
constexpr double coordinate_factor = 2;
constexpr double along_error = 16 * unit_roundoff;

/// Of how far a vertex is in front of a line: nx x + ny y − c. As above 3 u (|x| + |y|); the offset is off by 8 u size,
/// the difference by 1 u of all: 9 u (|x| + |y| + size). The same of its rate with s in place of c. 32 leaves room as
/// above.
constexpr double gap_error = 32 * unit_roundoff;

/// Of a sum or difference of two, and of t at the end: 1 u, and 1 u for the ends of the interval around it.
constexpr double sum_error = 4 * unit_roundoff;

/// A rate counts as known where it is at least this many times its own error b: then the true rate g + b is at least
/// (1 − 1/4) |g|, and the time t = −L / g of a length L with error a is off by |a + t b| / |g + b| ≤ 4/3 (|a| + |t|
/// |b|) / |g|. A slower approach is left to the exact predicates.
constexpr double sure_rate = 4;
/// At least 1 / (1 − 1 / sure_rate) = 4/3, and 12 % for the rounding of the bound itself.
constexpr double time_factor = 1.5;
static_assert(time_factor > 1.1 / (1 - 1 / sure_rate));

}  // namespace

auto Wavefront::seen_plane(PlaneId plane) const -> Seen {
  const Plane& p = planes_[plane];
  return {p.nx, p.ny, p.c, p.s, std::abs(p.c), &p.direction};
}

auto Wavefront::seen(std::uint32_t index) const -> Seen {
  if (!terraces_) return seen_plane(lines[index].plane);
  if (const TerraceMotion* motion = terraces_->motion_of(index)) return seen_plane(motion->plane);
  const Plane& p = planes_[lines[index].plane];
  const double moved = p.s * static_cast<double>(height);
  return {p.nx, p.ny, p.c + moved, 0, std::abs(p.c) + std::abs(moved), &p.direction};
}

void Wavefront::aim_vertex(std::uint32_t edge) {
  WaveEdge& e = edges[edge];
  const Seen p = e.joint != none ? seen_plane(e.joint) : seen(edges[e.prev].line), m = seen(e.line);
  const Int128 turned = cross(*p.direction, *m.direction);
  if (turned == 0) throw Broken("parallel neighbours in the wavefront");
  const double sine =
      static_cast<double>(turned) / (static_cast<double>(p.direction->l) * static_cast<double>(m.direction->l));
  e.x0 = (p.c * m.ny - p.ny * m.c) / sine;
  e.x1 = (p.s * m.ny - p.ny * m.s) / sine;
  e.y0 = (p.nx * m.c - p.c * m.nx) / sine;
  e.y1 = (p.nx * m.s - p.s * m.nx) / sine;
  e.error0 = vertex_error * (p.size + m.size) / std::abs(sine);
  e.error1 = vertex_error * (std::abs(p.s) + std::abs(m.s)) / std::abs(sine);
  // x1 and y1 are each off by a quarter of error1 at most: no vertex is faster.
  e.pace = std::abs(e.x1) + std::abs(e.y1) + e.error1;
  set_pointed(edge, turned < 0 || e.joint != none);
}

void Wavefront::aim_edge(std::uint32_t edge) {
  WaveEdge& e = edges[edge];
  const WaveEdge& end = edges[e.next];
  const Seen m = seen(e.line);
  fronts_[e.place] = {m.nx, m.ny, m.c, m.s, m.size, edge};
  const double ux = m.ny, uy = -m.nx;
  e.from0 = ux * e.x0 + uy * e.y0;
  e.from1 = ux * e.x1 + uy * e.y1;
  e.to0 = ux * end.x0 + uy * end.y0;
  e.to1 = ux * end.x1 + uy * end.y1;
  const double size0 = std::abs(e.x0) + std::abs(e.y0) + std::abs(end.x0) + std::abs(end.y0);
  const double size1 = std::abs(e.x1) + std::abs(e.y1) + std::abs(end.x1) + std::abs(end.y1);
  e.span_error0 = coordinate_factor * (e.error0 + end.error0) + along_error * size0;
  e.span_error1 = coordinate_factor * (e.error1 + end.error1) + along_error * size1;
  e.span_pace = e.pace + end.pace;
}

void Wavefront::aim_all() {
  const std::vector<std::uint32_t> all = alive();
  for (const std::uint32_t i : all) aim_vertex(i);
  for (const std::uint32_t i : all) aim_edge(i);
}

void Wavefront::try_collapse(std::uint32_t edge) {
  const WaveEdge& e = edges[edge];
  const double growth = e.to1 - e.from1, unsure = e.span_error1 + sum_error * (std::abs(e.to1) + std::abs(e.from1));
  if (growth > unsure) return;
  if (e.span_pace == 0) return;
  const double length = e.to0 - e.from0;
  if (growth >= -sure_rate * unsure) return push(now.lo, horizon, {edge, edge}, false);
  const double t = -length / growth;
  const double off = time_factor *
                         (e.span_error0 + sum_error * (std::abs(e.to0) + std::abs(e.from0)) + std::abs(t) * unsure) /
                         -growth +
                     sum_error * std::abs(t);
  push(t - off, t + off, {edge, edge}, t - off > now.hi);
}

auto Wavefront::never_meet(std::uint32_t vertex, std::uint32_t edge) const -> bool {
  const WaveEdge &v = edges[vertex], &e = edges[edge];
  const Line& line = lines[e.line];
  const Rational& speed = speed_of(e.line);
  const bool still = speed == 0;
  if (v.pace == 0 && still) return true;
  const auto keeps_off = [&](std::uint32_t other) {
    return (lines[other].towards == line.towards && speed_of(other) == speed) ||
           (lines[other].towards == line.away && still && speed_of(other) == 0);
  };
  return keeps_off(v.line) || (v.joint == none && keeps_off(edges[v.prev].line));
}

void Wavefront::try_hit(const Tip& v, const Front& e) {
  const double approach = e.nx * v.x1 + e.ny * v.y1 - e.s;
  const double unsure1 = coordinate_factor * v.error1 + gap_error * (v.pace + std::abs(e.s));
  if (approach > unsure1 || v.edge == e.edge) return;
  const WaveEdge& edge = edges[e.edge];
  if (edge.next == v.edge) return;
  if (approach >= -sure_rate * unsure1) {
    if (!never_meet(v.edge, e.edge)) push(now.lo, horizon, {v.edge, e.edge}, false);
    return;
  }
  const double gap = e.nx * v.x0 + e.ny * v.y0 - e.c;
  const double t = -gap / approach;
  const double unsure0 = coordinate_factor * v.error0 + gap_error * (std::abs(v.x0) + std::abs(v.y0) + e.size);
  const double off = time_factor * (unsure0 + std::abs(t) * unsure1) / -approach + sum_error * std::abs(t);
  if (t + off < now.lo || t - off > horizon) return;
  const double w = e.ny * (v.x0 + v.x1 * t) - e.nx * (v.y0 + v.y1 * t);
  // Where along the edge the vertex and both ends are when they meet, at most `off` from t. The vertex: its error at t
  // as in along_error, and pace · off for the time. Rounding of w: 5 u (|x0| + |y0|), which unsure0 has room for, and 5
  // u |t|
  // (|x1| + |y1|) ≤ 10 u |t| (|s_p| + |s_m|) / |sine|, which coordinate_factor · |t| · error1 has: (2 − √2) · 64 u of
  // the same.
  const double margin = coordinate_factor * (v.error0 + std::abs(t) * v.error1 + v.pace * off) + edge.span_error0 +
                        std::abs(t) * edge.span_error1 + edge.span_pace * off + unsure0;
  const double from = edge.from0 + edge.from1 * t, to = edge.to0 + edge.to1 * t;
  if (w < from - margin || w > to + margin) return;
  const bool inside = w > from + margin && w < to - margin;
  push(t - off, t + off, {v.edge, e.edge, inside}, inside && t - off > now.hi);
}

}  // namespace mansard::extrude::detail
