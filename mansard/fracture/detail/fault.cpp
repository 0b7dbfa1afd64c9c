#include <algorithm>
#include <numeric>

#include "mansard/base/text.hpp"
#include "mansard/fracture/detail/faces.hpp"
#include "mansard/geometry/predicates.hpp"

namespace mansard::fracture::detail {
namespace {

using Fault = std::optional<std::string>;

auto name(const char* what, std::size_t number) -> std::string { return what + (" " + std::to_string(number)); }

auto fault_of_links(const Arrangement& a) -> Fault {
  const std::size_t count = a.half_edges.size();
  for (std::size_t h = 0; h < count; ++h) {
    const HalfEdge& edge = a.half_edges[h];
    if (edge.twin != (h ^ 1) || edge.next >= count || edge.previous >= count || edge.from >= a.vertices.size())
      return name("numbers out of order at half-edge", h);
    if (a.half_edges[edge.next].previous != h || a.half_edges[edge.next].from != a.to(static_cast<std::uint32_t>(h)) ||
        a.half_edges[edge.next].face != edge.face)
      return name("broken link after half-edge", h);
    const auto& other = a.half_edges[edge.twin].origins;
    if (edge.origins.empty() || !std::ranges::is_sorted(edge.origins) || other.size() != edge.origins.size())
      return name("origins missing on half-edge", h);
    for (Origin origin : edge.origins) {
      origin.along = !origin.along;
      if (!std::ranges::binary_search(other, origin)) return name("twin without the origins of half-edge", h);
    }
    const bool border = std::ranges::find(edge.origins, Kind::border, &Origin::kind) != edge.origins.end();
    if (border != (!edge.face || !a.half_edges[edge.twin].face)) return name("border astray at half-edge", h);
  }
  return std::nullopt;
}

/// Closed, simple rings, one a face, which sum up to the inside of the border.
auto fault_of_faces(const Arrangement& a) -> Fault {
  std::vector<std::size_t> seen(a.vertices.size(), a.faces.size() + 1);
  std::size_t inside = 0;
  double sum = 0;
  for (std::uint32_t f = 0; f < a.faces.size(); ++f) {
    std::uint32_t h = a.faces[f].edge;
    do {
      if (a.half_edges[h].face != f || seen[a.half_edges[h].from] == f) return name("not simple: face", f);
      seen[a.half_edges[h].from] = f;
      ++inside;
      h = a.half_edges[h].next;
    } while (h != a.faces[f].edge);
    if (!(a.faces[f].area > 0)) return name("no area: face", f);
    sum += a.faces[f].area;
  }
  geometry::Ring outline;
  std::uint32_t rim = 0;
  while (rim < a.half_edges.size() && a.half_edges[rim].face) ++rim;
  if (rim == a.half_edges.size()) return "no outside";
  std::uint32_t h = rim;
  do {
    if (outline.size() > a.half_edges.size()) return "the outside does not close";
    outline.push_back(a.vertices[a.half_edges[h].from]);
    h = a.half_edges[h].next;
  } while (h != rim);
  if (inside + outline.size() != a.half_edges.size()) return "half-edges of no face";
  const double whole = -geometry::signed_area(outline);
  if (std::abs(sum - whole) > 1e-9 * whole) return "faces of " + base::to_text(sum) + " m² in " + base::to_text(whole);
  // Euler: one component when vertices − edges + faces, the outside counted, is 2.
  if (a.vertices.size() + a.faces.size() + 1 != a.half_edges.size() / 2 + 2) return "not connected";
  return std::nullopt;
}

auto fault_of_distances(const Arrangement& a, double snap) -> Fault {
  std::vector<std::uint32_t> by_x(a.vertices.size());
  std::iota(by_x.begin(), by_x.end(), 0U);
  const auto x = [&](std::uint32_t v) { return a.vertices[v].x; };
  std::ranges::sort(by_x, {}, x);
  for (std::size_t i = 0; i < by_x.size(); ++i)
    for (std::size_t j = i + 1; j < by_x.size() && x(by_x[j]) - x(by_x[i]) < snap; ++j)
      if (squared_distance(a.vertices[by_x[i]], a.vertices[by_x[j]]) < square(snap))
        return name("vertices too near:", by_x[i]) + name(" and", by_x[j]);

  std::vector<std::uint32_t> edges;
  for (std::uint32_t h = 0; h < a.half_edges.size(); h += 2) edges.push_back(h);
  const auto low = [&](std::uint32_t h) { return std::min(a.segment(h).start.x, a.segment(h).end.x); };
  const auto high = [&](std::uint32_t h) { return std::max(a.segment(h).start.x, a.segment(h).end.x); };
  std::ranges::sort(edges, {}, low);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::uint32_t e = edges[i], from = a.half_edges[e].from, to = a.to(e);
    const Segment2 segment = a.segment(e);
    const double bottom = std::min(segment.start.y, segment.end.y), top = std::max(segment.start.y, segment.end.y);
    for (auto v = std::ranges::lower_bound(by_x, low(e) - snap, {}, x); v != by_x.end() && x(*v) < high(e) + snap;
         ++v) {
      if (*v == from || *v == to || a.vertices[*v].y < bottom - snap || a.vertices[*v].y > top + snap) continue;
      if (squared_distance(segment, a.vertices[*v]) < square(snap))
        return name("vertex too near:", *v) + name(" to half-edge", e);
    }
    for (std::size_t j = i + 1; j < edges.size() && low(edges[j]) <= high(e); ++j) {
      const Segment2 other = a.segment(edges[j]);
      if (std::max(other.start.y, other.end.y) < bottom || std::min(other.start.y, other.end.y) > top) continue;
      const std::uint32_t c = a.half_edges[edges[j]].from, d = a.to(edges[j]);
      // Two that share an end overlap only if the other end of one lies on the other, which was seen above.
      if (c == from || c == to || d == from || d == to) continue;
      if (geometry::meet(segment, other)) return name("edges meet:", e) + name(" and", edges[j]);
    }
  }
  return std::nullopt;
}

}  // namespace

auto fault_of(const Arrangement& arrangement, double snap) -> std::optional<std::string> {
  if (auto fault = fault_of_links(arrangement)) return fault;
  if (auto fault = fault_of_faces(arrangement)) return fault;
  return fault_of_distances(arrangement, snap);
}

}  // namespace mansard::fracture::detail
