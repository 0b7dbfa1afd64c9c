#include "mansard/solid/half_edges.hpp"

#include <cmath>

#include "mansard/solid/detail/connectivity.hpp"

namespace mansard::solid {
namespace {

using geometry::Point3;

enum class Part : std::uint8_t { base, wall, roof, flat, soffit };

/// Error bound of a component of a unit vector, and of the sine between two: normals are made from rational directions
/// and slopes in a few operations and good to 1e-15. The steepest roof that is not a wall runs a quantum over a rise of
/// 1 km: 1.5e-8.
constexpr double none_at_all = 1e-9;

auto part_of(const model::Face& face) -> Part {
  switch (face.kind) {
    case model::FaceKind::base: return Part::base;
    case model::FaceKind::soffit: return Part::soffit;
    case model::FaceKind::connector: return Part::wall;
    case model::FaceKind::terrace:
    case model::FaceKind::cap: return Part::flat;
    case model::FaceKind::side: break;
  }
  return std::abs(face.normal.z) < none_at_all ? Part::wall : Part::roof;
}

/// `along` is the line's direction with the face `left` on its left.
auto kind_of(const model::Face& left, const model::Face& right, Point3 along) -> LineKind {
  const Part p = part_of(left), q = part_of(right);
  if (p == Part::base || q == Part::base) return LineKind::foot;
  // The planes' own line is better than a short line's ends, which are rounded.
  const Point3 common = cross(left.normal, right.normal);
  if (length(common) < none_at_all) return LineKind::seam;
  const bool convex = dot(common, along) > 0;
  const Point3 direction = normalised(convex ? common : -1.0 * common);
  if (p == Part::soffit || q == Part::soffit)
    return p == Part::roof || q == Part::roof ? LineKind::eave : LineKind::soffit_line;
  const bool level = std::abs(direction.z) < none_at_all;
  const bool left_rises = cross(left.normal, direction).z > 0, right_rises = cross(right.normal, direction).z < 0;

  if (p == Part::wall && q == Part::wall) return convex ? LineKind::corner : LineKind::inner_corner;
  if (p == Part::flat || q == Part::flat) {
    if (!convex) return LineKind::upstand;
    return p == Part::wall || q == Part::wall ? LineKind::flat_edge : LineKind::flat_break;
  }
  if (p == Part::roof && q == Part::roof) {
    if (!level) return convex ? LineKind::hip : LineKind::valley;
    if (left_rises != right_rises) return LineKind::pitch_break;
    return left_rises ? LineKind::valley : LineKind::ridge;
  }
  if (!convex) return LineKind::abutment;
  if (!level) return LineKind::verge;
  return (p == Part::roof ? left_rises : right_rises) ? LineKind::eave : LineKind::mono_ridge;
}

}  // namespace

auto half_edges(const model::Solid& solid) -> base::Result<HalfEdges> {
  for (const model::Face& face : solid.faces)
    for (const auto& loop : face.loops) {
      if (loop.size() < 3) return base::error("solid-degenerate", "a face has a loop of fewer than three vertices");
      for (const std::uint32_t v : loop)
        if (v >= solid.vertices.size())
          return base::error("solid-degenerate", "a face names a vertex that is not there");
    }
  auto found = detail::connectivity(solid);
  if (!found.open.empty()) return base::error("solid-open", "a face has no neighbour at one of its edges");
  if (!found.crowded.empty()) return base::error("solid-non-manifold", "more than two faces meet at an edge");
  if (detail::split_vertex(solid, found.half_edges))
    return base::error("solid-non-manifold", "faces that are no neighbours share a vertex");
  return std::move(found.half_edges);
}

auto name(LineKind kind) -> std::string_view {
  switch (kind) {
    case LineKind::foot: return "foot";
    case LineKind::corner: return "corner";
    case LineKind::inner_corner: return "inner corner";
    case LineKind::eave: return "eave";
    case LineKind::mono_ridge: return "mono ridge";
    case LineKind::verge: return "verge";
    case LineKind::abutment: return "abutment";
    case LineKind::ridge: return "ridge";
    case LineKind::hip: return "hip";
    case LineKind::valley: return "valley";
    case LineKind::pitch_break: return "pitch break";
    case LineKind::flat_edge: return "flat edge";
    case LineKind::flat_break: return "flat break";
    case LineKind::upstand: return "upstand";
    case LineKind::soffit_line: return "soffit line";
    case LineKind::seam: return "seam";
  }
  return "";
}

auto lines(const model::Solid& solid) -> base::Result<std::vector<Line>> {
  const auto edges = half_edges(solid);
  if (!edges) return edges.error();
  std::vector<Line> result;
  result.reserve(edges->size() / 2);
  for (std::uint32_t h = 0; h < edges->size(); ++h) {
    const std::uint32_t twin = edges->twin[h];
    if (twin < h) continue;
    Line line{edges->origin[h], edges->target(h), edges->face[h], edges->face[twin], LineKind::foot};
    line.kind = kind_of(solid.faces[line.left_face], solid.faces[line.right_face],
                        solid.vertices[line.to] - solid.vertices[line.from]);
    result.push_back(line);
  }
  return result;
}

}  // namespace mansard::solid
