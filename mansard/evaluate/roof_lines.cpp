// Ridges, hips, valleys and eaves of a model of any producer.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>

#include "mansard/evaluate/detail/corners.hpp"
#include "mansard/evaluate/detail/plan_of_face.hpp"
#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::evaluate {
namespace {

using detail::Corners;
using geometry::Point2;
using geometry::Point3;

constexpr double level_slope = 0.05;  // 3°: lines and roofs below it count as level

/// A face along a piece of an edge.
struct Side {
  std::uint32_t plane = no_plane;
  std::uint32_t part = 0;
  double slope = 0;    ///< of a roof: how it rises from the edge, m per m
  bool below = false;  ///< of a wall: some of it is below the edge
};
using Pieces = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>>;

/// How a roof rises from an edge from `a` to `b`, with the face on the left where `left`.
auto slope_from(Point3 a, Point3 b, Point3 normal, bool left) -> double {
  const Point2 along = normalised(xy(b) - xy(a));
  const Point2 into = left ? geometry::left_of(along) : -1 * geometry::left_of(along);
  return -(normal.x * into.x + normal.y * into.y) / normal.z;
}

auto pieces_of(const model::ModelBuilding& building, const Corners& corners, const RoofPlanes& planes,
               std::uint32_t part, std::size_t face_number) -> Pieces {
  Pieces pieces;
  std::size_t corner = 0;
  for (const auto& p : building.parts) {
    for (const auto& face : p.faces) {
      const auto plane = planes.plane_of_face[face_number++];
      const bool roof = plane != no_plane && planes.planes[plane].normal.z > 0.01;
      const bool up = detail::area_vector(face).z > 0;
      double lowest = std::numeric_limits<double>::infinity();
      for (const auto q : face.loops.front()) lowest = std::min(lowest, q.z);
      for (const auto& loop : face.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const auto from = corners.of_corner[corner + i], to = corners.of_corner[corner + (i + 1) % loop.size()];
          const auto along = corners.along(from, to);
          for (std::size_t k = 0; k + 1 < along.size(); ++k) {
            const auto a = along[k], b = along[k + 1];
            Side side{roof ? plane : no_plane, part, 0,
                      lowest < std::min(corners.points[a].z, corners.points[b].z) - 0.01};
            if (roof && xy(corners.points[a]) != xy(corners.points[b]))
              side.slope = slope_from(corners.points[a], corners.points[b], planes.planes[plane].normal, up);
            if (roof || face.kind == model::SurfaceClass::wall) pieces[std::minmax(a, b)].push_back(side);
          }
        }
        corner += loop.size();
      }
    }
    ++part;
  }
  return pieces;
}

/// The line that a piece is of, and the planes that it is between.
struct Meeting {
  RoofLineKind kind = RoofLineKind::ridge;
  std::uint32_t first = no_plane, second = no_plane, part = 0;
};

auto between_roofs(const Side& a, const Side& b, bool level) -> std::optional<RoofLineKind> {
  const bool convex = a.slope + b.slope<-level_slope, reflex = a.slope + b.slope> level_slope;
  if (!level)
    return convex ? std::optional(RoofLineKind::hip) : reflex ? std::optional(RoofLineKind::valley) : std::nullopt;
  if (a.slope < -level_slope && b.slope < -level_slope) return RoofLineKind::ridge;
  if (a.slope > level_slope && b.slope > level_slope) return RoofLineKind::valley;
  return std::nullopt;
}

auto meeting_at(Point3 a, Point3 b, const std::vector<Side>& sides) -> std::optional<Meeting> {
  const Side *first = nullptr, *second = nullptr;
  bool wall_below = false, wall = false;
  for (const auto& side : sides) {
    if (side.plane == no_plane) wall = true, wall_below = wall_below || side.below;
    else if (!first) first = &side;
    else if (side.plane != first->plane && !second) second = &side;
    else if (side.plane == first->plane && !second) return std::nullopt;  // the plane goes on
  }
  const double run = length(xy(b) - xy(a));
  if (!first || !(run > 0)) return std::nullopt;
  const bool level = std::abs(b.z - a.z) <= level_slope * run;
  if (second) {
    const auto kind = between_roofs(*first, *second, level);
    if (!kind) return std::nullopt;
    return Meeting{*kind, std::min(first->plane, second->plane), std::max(first->plane, second->plane),
                   std::min(first->part, second->part)};
  }
  if (!level || first->slope <= level_slope || (wall && !wall_below)) return std::nullopt;
  return Meeting{RoofLineKind::eave, first->plane, no_plane, first->part};
}

/// Joins a piece to the line that it goes on from.
void extend(std::vector<RoofLine>& lines, const RoofLine& piece) {
  constexpr double touch = 0.02;  // m
  const Point3 along = normalised(piece.end - piece.start);
  for (auto& line : lines)
    if (length(line.end - piece.start) <= touch &&
        dot(normalised(line.end - line.start), along) > geometry::cosine(std::numbers::pi / 180)) {
      line.end = piece.end;
      return;
    }
  lines.push_back(piece);
}

}  // namespace

auto to_string(RoofLineKind kind) -> std::string_view {
  static constexpr std::array<std::string_view, roof_line_kinds> names{"ridge", "hip", "valley", "eave"};
  return names[static_cast<std::size_t>(kind)];
}

auto roof_lines_of(const model::Model& model, const RoofPlanes& planes) -> std::vector<RoofLine> {
  std::vector<std::uint32_t> first_part;
  std::vector<std::size_t> first_face;
  std::uint32_t parts = 0;
  std::size_t faces = 0;
  for (const auto& building : model.buildings) {
    first_part.push_back(parts);
    first_face.push_back(faces);
    for (const auto& part : building.parts) ++parts, faces += part.faces.size();
  }
  std::vector<std::vector<RoofLine>> of_building(model.buildings.size());
  base::parallel_for(of_building.size(), [&](std::size_t b) {
    const Corners corners(model.buildings[b]);
    // West to east, so that a line grows from its west end.
    using Key = std::tuple<RoofLineKind, std::uint32_t, std::uint32_t>;
    std::map<Key, std::vector<RoofLine>> found;
    for (const auto& [ends, sides] : pieces_of(model.buildings[b], corners, planes, first_part[b], first_face[b])) {
      auto from = corners.points[ends.first], to = corners.points[ends.second];
      const auto meeting = meeting_at(from, to, sides);
      if (!meeting) continue;
      if (to < from) std::swap(from, to);
      found[{meeting->kind, meeting->first, meeting->second}].push_back(
          {meeting->kind, from, to, static_cast<std::uint32_t>(b), meeting->part});
    }
    for (auto& [key, pieces] : found) {
      std::ranges::sort(pieces, {}, &RoofLine::start);
      std::vector<RoofLine> lines;
      for (const auto& piece : pieces) extend(lines, piece);
      of_building[b].insert(of_building[b].end(), lines.begin(), lines.end());
    }
  });
  std::vector<RoofLine> out;
  for (const auto& lines : of_building) out.insert(out.end(), lines.begin(), lines.end());
  return out;
}

}  // namespace mansard::evaluate
