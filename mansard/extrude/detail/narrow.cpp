#include "mansard/extrude/detail/narrow.hpp"

#include <algorithm>

#include "mansard/base/text.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;

/// m; wider places are no reason to give up: the kernel's own bounds are far below, and files are rounded to 0.1 mm.
constexpr double narrow = 5e-3;

auto millimetres(double metres) -> std::string { return base::to_text(1000 * metres, 4) + " mm"; }
auto at(Point2 p) -> std::string { return " at (" + base::to_text(p.x, 3) + ", " + base::to_text(p.y, 3) + ")"; }
auto of_ring(const SourceRing& ring) -> std::string {
  return ring.ring == 0 ? std::string() : " of hole " + std::to_string(ring.ring);
}
auto next(const SourceRing& ring, std::size_t i) -> std::size_t { return i + 1 < ring.points.size() ? i + 1 : 0; }

/// A corner and an edge that does not end in it.
struct Gap {
  double width = narrow;  ///< m
  const SourceRing *of_corner = nullptr, *of_edge = nullptr;
  std::size_t corner = 0, edge = 0;
};

auto narrowest(const Source& source) -> Gap {
  Gap gap;
  for (const auto& p : source.rings)
    for (std::size_t i = 0; i < p.points.size(); ++i)
      for (const auto& q : source.rings)
        for (std::size_t e = 0; e < q.points.size(); ++e) {
          if (&p == &q && (e == i || next(q, e) == i)) continue;
          const double width = geometry::distance({q.points[e], q.points[next(q, e)]}, p.points[i]);
          if (width < gap.width) gap = {width, &p, &q, i, e};
        }
  return gap;
}

/// Area over half of the length of all edges, m: the width of a strip.
auto mean_width(const Source& source) -> double {
  double area = 0, around = 0;
  for (const auto& ring : source.rings) {
    area += geometry::signed_area(ring.points);
    for (std::size_t i = 0; i < ring.points.size(); ++i)
      around += geometry::length(ring.points[next(ring, i)] - ring.points[i]);
  }
  return 2 * area / around;
}

}  // namespace

auto narrow_place(const Source& source) -> std::string {
  if (const double width = mean_width(source); width < narrow)
    return "the outline near " + at(source.rings[0].points[0]).substr(4) + " is a sliver, on average " +
           millimetres(width) + " wide; remove it, or merge it with a neighbour";
  const Gap gap = narrowest(source);
  if (gap.of_corner == nullptr) return {};
  const auto &p = *gap.of_corner, &q = *gap.of_edge;
  for (std::size_t e = 0; e < p.points.size(); ++e)
    if (&p == &q && (gap.corner == e || gap.corner == next(p, e)) &&
        geometry::length(p.points[next(p, e)] - p.points[e]) <= 2 * gap.width)
      return "edge " + std::to_string(p.edge[e]) + of_ring(p) + at(p.points[e]) + " is " +
             millimetres(geometry::length(p.points[next(p, e)] - p.points[e])) + " long; remove it";
  return "corner " + std::to_string(p.edge[gap.corner]) + of_ring(p) + at(p.points[gap.corner]) + " is " +
         millimetres(gap.width) + " from edge " + std::to_string(q.edge[gap.edge]) + of_ring(q) +
         ", too close for two walls; widen that place to " + millimetres(narrow) + ", or cut it off";
}

namespace {

/// The roof that rises along an edge of the plan, m².
auto roof_along(const model::Solid& solid, std::uint32_t ring, std::uint32_t edge) -> double {
  double area = 0;
  for (const auto& face : solid.faces)
    if (face.kind == model::FaceKind::side && face.normal.z > 0 && face.provenance && face.provenance->ring == ring &&
        face.provenance->edge == edge)
      area += solid::area(solid, face);
  return area;
}

}  // namespace

auto small_edges(const Source& source, const model::Solid& solid, double size) -> std::string {
  std::vector<Track> tracks;
  for (const auto& profile : source.profiles) tracks.push_back(track_of(profile));
  std::string worst;
  double most = -1;
  std::size_t count = 0;
  for (const auto& ring : source.rings)
    for (std::size_t i = 0, n = ring.points.size(); i < n; ++i) {
      const double length = geometry::length(ring.points[next(ring, i)] - ring.points[i]);
      const auto alike = [&](std::size_t other) {
        return same_shape(tracks[ring.profile[i]], tracks[ring.profile[other]]);
      };
      if (length >= size || alike((i + n - 1) % n) || alike(next(ring, i))) continue;
      ++count;
      const double roof = roof_along(solid, ring.ring, ring.edge[i]);
      if (roof <= most) continue;
      most = roof;
      worst = "edge " + std::to_string(ring.edge[i]) + of_ring(ring) + at(ring.points[i]) + " is only " +
              base::to_text(length, 3) + " m long and has a profile of its own, along which " + base::to_text(roof, 2) +
              " m² of roof rise; give it the profile of a neighbour, or remove it";
    }
  if (count > 1) worst += " (" + std::to_string(count) + " such edges)";
  return worst;
}

}  // namespace mansard::extrude::detail
