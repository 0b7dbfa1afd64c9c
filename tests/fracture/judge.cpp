#include "fracture/judge.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/geometry/predicates.hpp"

namespace mansard::fracture {
namespace {

using geometry::Point2;
using geometry::Segment2;

auto has(const HalfEdge& edge, Kind kind) -> bool {
  return std::ranges::any_of(edge.origins, [&](const Origin& o) { return o.kind == kind; });
}

auto comes_of(const HalfEdge& edge, std::uint32_t source) -> bool {
  return std::ranges::any_of(edge.origins,
                             [&](const Origin& o) { return o.kind != Kind::border && o.source == source; });
}

auto edges_of(const Arrangement& a, std::uint32_t source) -> std::vector<Segment2> {
  std::vector<Segment2> found;
  for (std::uint32_t h = 0; h < a.half_edges.size(); h += 2)
    if (comes_of(a.half_edges[h], source)) found.push_back(a.segment(h));
  return found;
}

auto text(Point2 p) -> std::string { return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ")"; }

}  // namespace

auto complaint(const Arrangement& a, const std::vector<Cut>& cuts, double snap) -> std::optional<std::string> {
  // 1: faces. Their rings are walked by `next` alone, so that the counts below test the links as well.
  std::vector<int> walked(a.half_edges.size(), 0);
  double sum = 0;
  for (std::uint32_t f = 0; f < a.faces.size(); ++f) {
    std::uint32_t h = a.faces[f].edge;
    for (std::size_t n = 0; n == 0 || h != a.faces[f].edge; ++n) {
      if (n > a.half_edges.size()) return "a face that does not close";
      if (a.half_edges[h].face != f) return "a half-edge of the wrong face";
      if (a.half_edges[a.half_edges[h].next].previous != h) return "next and previous disagree";
      if (a.to(h) != a.half_edges[a.half_edges[h].next].from) return "next starts elsewhere";
      ++walked[h];
      h = a.half_edges[h].next;
    }
    const auto ring = a.ring(f);
    if (!geometry::is_simple({ring, {}})) return "a face that is not simple at " + text(ring[0]);
    if (std::abs(geometry::signed_area(ring) - a.faces[f].area) > 1e-9) return "a wrong area";
    if (a.faces[f].area <= 0) return "a face inside out";
    sum += a.faces[f].area;
  }
  geometry::Box2 all;
  for (const Point2 p : a.vertices) all.add(p);
  const double whole = (all.most.x - all.least.x) * (all.most.y - all.least.y);
  if (std::abs(sum - whole) > 1e-9 * whole) return "faces that do not cover the rectangle";
  const auto edges = a.half_edges.size() / 2;
  if (a.vertices.size() + a.faces.size() + 1 != edges + 2) return "Euler: not one connected graph of simple faces";

  for (std::uint32_t h = 0; h < a.half_edges.size(); ++h) {
    const HalfEdge& edge = a.half_edges[h];
    if (edge.twin != (h ^ 1U)) return "twins not side by side";
    if (walked[h] != (edge.face ? 1 : 0)) return "a half-edge walked by no face, or by two";
    const Segment2 s = a.segment(h);
    const bool on_rim = (s.start.x == s.end.x && (s.start.x == all.least.x || s.start.x == all.most.x)) ||
                        (s.start.y == s.end.y && (s.start.y == all.least.y || s.start.y == all.most.y));
    if (on_rim != has(edge, Kind::border)) return "border origins off the border";
    if (!edge.face && !on_rim) return "the outside within";
    // 3
    if (edge.origins.empty()) return "an edge from nowhere";
    auto turned = a.half_edges[edge.twin].origins;
    for (Origin& o : turned) o.along = !o.along;
    std::ranges::sort(turned);
    if (turned != edge.origins) return "twins that do not agree on their origins";
    for (const Origin& o : edge.origins) {
      if (o.kind == Kind::border) continue;
      const auto cut = std::ranges::find(cuts, o.source, &Cut::source);
      if (cut == cuts.end()) return "an unknown origin";
      if (o.kind != Kind::hard) continue;
      const auto& line = cut->segment;
      if (geometry::distance(line, s.start) > 2 * snap || geometry::distance(line, s.end) > 2 * snap)
        return "a hard edge off its cut at " + text(s.start);
    }
  }

  // 2
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (geometry::length(a.vertices[i] - a.vertices[j]) < snap) return "vertices too near at " + text(a.vertices[i]);
  for (std::uint32_t h = 0; h < a.half_edges.size(); h += 2) {
    const Segment2 s = a.segment(h);
    geometry::Box2 around;
    around.add(s.start), around.add(s.end);
    around = around.grown(snap);
    const auto from = a.half_edges[h].from, to = a.to(h);
    for (std::uint32_t v = 0; v < a.vertices.size(); ++v)
      if (v != from && v != to && around.contains(a.vertices[v]) && geometry::distance(s, a.vertices[v]) < snap)
        return "a vertex too near to an edge at " + text(a.vertices[v]);
    for (std::uint32_t g = 0; g < h; g += 2) {
      const auto c = a.half_edges[g].from, d = a.to(g);
      if (c != from && c != to && d != from && d != to && geometry::meet(s, a.segment(g)))
        return "edges that cross near " + text(s.start);
    }
  }
  for (const Cut& cut : cuts)
    if (!is_left_out(a, cut) && drift(a, cut) > 2 * snap) return "drift of cut " + std::to_string(cut.source);
  return std::nullopt;
}

auto drift(const Arrangement& arrangement, const Cut& cut) -> double {
  const auto edges = edges_of(arrangement, cut.source);
  double most = 0;
  constexpr int steps = 200;
  for (int i = 0; i <= steps; ++i) {
    const Point2 p = cut.segment.start + (1.0 * i / steps) * (cut.segment.end - cut.segment.start);
    double least = std::numeric_limits<double>::infinity();
    for (const Segment2& edge : edges) least = std::min(least, geometry::distance(edge, p));
    most = std::max(most, least);
  }
  return most;
}

auto is_left_out(const Arrangement& arrangement, const Cut& cut) -> bool {
  return std::ranges::any_of(arrangement.warnings, [&](const base::Diagnostic& warning) {
    return warning.subject == "cut " + std::to_string(cut.source);
  });
}

auto length_of(const Arrangement& arrangement, Kind kind, std::uint32_t source) -> double {
  double sum = 0;
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); h += 2) {
    for (const Origin& o : arrangement.half_edges[h].origins) {
      if (o.source != source || o.kind != kind) continue;
      const Segment2 s = arrangement.segment(h);
      sum += geometry::length(s.end - s.start);
      break;
    }
  }
  return sum;
}

auto shape_of(const Arrangement& arrangement) -> Shape {
  Shape shape;
  shape.vertices = arrangement.vertices;
  for (std::uint32_t h = 0; h < arrangement.half_edges.size(); h += 2) {
    auto [a, b] = arrangement.segment(h);
    shape.edges.push_back({std::min(a, b), std::max(a, b)});
  }
  for (const Face& face : arrangement.faces) shape.areas.push_back(face.area);
  std::ranges::sort(shape.vertices);
  std::ranges::sort(shape.edges);
  std::ranges::sort(shape.areas);
  return shape;
}

}  // namespace mansard::fracture
