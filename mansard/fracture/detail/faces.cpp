#include "mansard/fracture/detail/faces.hpp"

#include <algorithm>

#include "mansard/geometry/predicates.hpp"

namespace mansard::fracture::detail {
namespace {

/// Counter-clockwise from east around the first end, exactly.
auto before(Point2 centre, Point2 a, Point2 b) -> bool {
  const auto lower = [&](Point2 p) { return p.y < centre.y || (p.y == centre.y && p.x < centre.x); };
  if (lower(a) != lower(b)) return lower(b);
  return geometry::orientation(centre, a, b) > 0;
}

auto origins_of(const Edge& edge, const std::vector<Cut>& cuts, bool turned) -> std::vector<Origin> {
  std::vector<Origin> origins;
  if (edge.border) origins.push_back({Kind::border, 0, !turned});
  for (const Trace& trace : edge.traces) origins.push_back({trace.kind, cuts[trace.cut].source, trace.along != turned});
  std::ranges::sort(origins);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
  return origins;
}

void link(Arrangement& result) {
  std::vector<std::vector<std::uint32_t>> leaving(result.vertices.size());
  for (std::uint32_t h = 0; h < result.half_edges.size(); ++h) leaving[result.half_edges[h].from].push_back(h);
  for (std::size_t v = 0; v < leaving.size(); ++v) {
    auto& around = leaving[v];
    std::ranges::sort(around, [&](std::uint32_t g, std::uint32_t h) {
      return before(result.vertices[v], result.vertices[result.to(g)], result.vertices[result.to(h)]);
    });
    for (std::size_t i = 0; i < around.size(); ++i) {
      const std::uint32_t arriving = result.half_edges[around[(i + 1) % around.size()]].twin;
      result.half_edges[arriving].next = around[i];
      result.half_edges[around[i]].previous = arriving;
    }
  }
}

void find_faces(Arrangement& result) {
  std::vector<bool> seen(result.half_edges.size(), false);
  for (std::uint32_t first = 0; first < result.half_edges.size(); ++first) {
    if (seen[first]) continue;
    geometry::Ring ring;
    for (std::uint32_t h = first; !seen[h]; h = result.half_edges[h].next) {
      seen[h] = true;
      ring.push_back(result.vertices[result.half_edges[h].from]);
    }
    const double area = geometry::signed_area(ring);
    if (area <= 0) continue;  // the outside, seen from inside
    const auto face = static_cast<std::uint32_t>(result.faces.size());
    result.faces.push_back({first, area});
    std::uint32_t h = first;
    do {
      result.half_edges[h].face = face;
      h = result.half_edges[h].next;
    } while (h != first);
  }
}

}  // namespace

auto faces_of(const Graph& graph, const std::vector<Cut>& cuts) -> Arrangement {
  Arrangement result;
  std::vector<std::uint32_t> renumbered(graph.vertices().size());
  for (std::size_t v = 0; v < graph.vertices().size(); ++v) {
    if (!graph.vertices()[v].alive) continue;
    renumbered[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(graph.vertices()[v].at);
  }
  for (const Edge& edge : graph.edges()) {
    if (!edge.alive) continue;
    const auto here = static_cast<std::uint32_t>(result.half_edges.size());
    result.half_edges.push_back({renumbered[edge.a], here + 1, 0, 0, {}, origins_of(edge, cuts, false)});
    result.half_edges.push_back({renumbered[edge.b], here, 0, 0, {}, origins_of(edge, cuts, true)});
  }
  link(result);
  find_faces(result);
  return result;
}

}  // namespace mansard::fracture::detail
