#include "mansard/segment/detail/rings.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace mansard::segment::detail {
namespace {

using geometry::Point2;

auto visits(const std::vector<CornerRing>& rings) -> std::map<std::uint32_t, int> {
  std::map<std::uint32_t, int> count;
  for (const CornerRing& ring : rings)
    for (const Corner& c : ring) ++count[c.vertex];
  return count;
}

auto points_of(const CornerRing& ring) -> geometry::Ring {
  geometry::Ring points;
  for (const Corner& c : ring) points.push_back(c.at);
  return points;
}

}  // namespace

auto trace(const fracture::Arrangement& arrangement, const std::vector<std::uint32_t>& faces,
           const std::vector<std::optional<std::uint32_t>>& label_of_face) -> std::vector<CornerRing> {
  const auto& half_edges = arrangement.half_edges;
  const auto label = label_of_face[faces.front()];
  const auto mine = [&](std::uint32_t h) { return half_edges[h].face && label_of_face[*half_edges[h].face] == label; };
  const auto is_boundary = [&](std::uint32_t h) { return mine(h) && !mine(half_edges[h].twin); };

  std::vector<std::uint32_t> boundary;
  for (const std::uint32_t f : faces) {
    std::uint32_t h = arrangement.faces[f].edge;
    do {
      if (is_boundary(h)) boundary.push_back(h);
      h = half_edges[h].next;
    } while (h != arrangement.faces[f].edge);
  }
  std::ranges::sort(boundary);

  std::vector<bool> done(boundary.size(), false);
  const auto index = [&](std::uint32_t h) {
    return static_cast<std::size_t>(std::ranges::lower_bound(boundary, h) - boundary.begin());
  };
  std::vector<CornerRing> rings;
  for (const std::uint32_t first : boundary) {
    if (done[index(first)]) continue;
    CornerRing ring;
    std::uint32_t h = first;
    do {
      done[index(h)] = true;
      const std::uint32_t v = half_edges[h].from;
      ring.push_back({arrangement.vertices[v], v});
      // Around the vertex through the part's faces: stays in one wedge of the part.
      h = half_edges[h].next;
      while (!is_boundary(h)) h = half_edges[half_edges[h].twin].next;
    } while (h != first);
    rings.push_back(std::move(ring));
  }
  // Only the outer ring runs counter-clockwise.
  const auto outer = std::ranges::max_element(
      rings, {}, [](const CornerRing& ring) { return geometry::signed_area(points_of(ring)); });
  std::rotate(rings.begin(), outer, outer + 1);
  return rings;
}

auto straightened(std::vector<CornerRing> rings, double tolerance) -> std::vector<CornerRing> {
  const auto count = visits(rings);
  for (CornerRing& ring : rings) {
    // dropped[i]: what lies between corner i and the next.
    std::vector<std::vector<Point2>> dropped(ring.size());
    const auto deviation = [&](std::size_t i) {
      const std::size_t before = (i + ring.size() - 1) % ring.size(), after = (i + 1) % ring.size();
      const geometry::Segment2 chord{ring[before].at, ring[after].at};
      double most = geometry::distance(chord, ring[i].at);
      for (const Point2 p : dropped[before]) most = std::max(most, geometry::distance(chord, p));
      for (const Point2 p : dropped[i]) most = std::max(most, geometry::distance(chord, p));
      return most;
    };
    while (ring.size() > 3) {
      std::optional<std::tuple<double, Point2, std::size_t>> least;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (count.at(ring[i].vertex) > 1) continue;
        const double d = deviation(i);
        if (d > tolerance) continue;
        // By coordinates, so that the parts on both sides of a common wall drop the same corners of it.
        const std::tuple found{d, ring[i].at, i};
        if (!least || found < *least) least = found;
      }
      if (!least) break;
      const std::size_t i = std::get<2>(*least), before = (i + ring.size() - 1) % ring.size();
      dropped[before].push_back(ring[i].at);
      dropped[before].insert(dropped[before].end(), dropped[i].begin(), dropped[i].end());
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
      dropped.erase(dropped.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return rings;
}

auto opened(std::vector<CornerRing> rings, double by) -> std::vector<CornerRing> {
  const auto count = visits(rings);
  std::map<std::uint32_t, int> met;
  for (CornerRing& ring : rings) {
    const geometry::Ring before = points_of(ring);
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (count.at(ring[i].vertex) < 2 || met[ring[i].vertex]++ == 0) continue;
      const Point2 in = geometry::normalised(before[i] - before[(i + n - 1) % n]);
      const Point2 out = geometry::normalised(before[(i + 1) % n] - before[i]);
      // The middle of the wedge on the left, from `out` round to −`in`.
      Point2 middle = geometry::left_of(in) + geometry::left_of(out);
      if (geometry::length(middle) < 1e-6) middle = geometry::cross(in, out) > 0 ? out : in;
      ring[i].at = ring[i].at + by * geometry::normalised(middle);
    }
  }
  return rings;
}

auto polygon_of(const std::vector<CornerRing>& rings) -> geometry::Polygon {
  geometry::Polygon polygon;
  for (const CornerRing& ring : rings) {
    if (&ring == &rings.front()) polygon.outer = points_of(ring);
    else polygon.holes.push_back(points_of(ring));
  }
  return polygon;
}

}  // namespace mansard::segment::detail
