// The roof faces of a building, grouped into planes.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mansard/evaluate/detail/degree.hpp"
#include "mansard/evaluate/detail/middle.hpp"
#include "mansard/evaluate/detail/plan_of_face.hpp"
#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/extent.hpp"

namespace mansard::evaluate {
namespace {

using detail::degree;
using geometry::Point2;
using geometry::Point3;

struct RoofFace {
  const model::ModelFace* face = nullptr;
  Point3 normal;  ///< unit, upward
  double area = 0;
  std::size_t number = 0;  ///< counted through all parts
};

auto lies_in(const RoofFace& face, const RoofPlane& plane) -> bool {
  if (dot(face.normal, plane.normal) < geometry::cosine(same_plane_angle * degree)) return false;
  return std::ranges::all_of(face.face->loops.front(), [&](Point3 p) {
    return std::abs(dot(p - plane.point, plane.normal)) <= same_plane_distance;
  });
}

auto roof_faces(const model::ModelBuilding& building, std::size_t& number) -> std::vector<RoofFace> {
  std::vector<RoofFace> faces;
  for (const auto& part : building.parts)
    for (const auto& face : part.faces) {
      const auto at = number++;
      if (face.kind != model::SurfaceClass::roof) continue;
      const Point3 twice = detail::area_vector(face);
      if (!(length(twice) > 0)) continue;
      const Point3 normal = normalised(twice);
      faces.push_back({&face, normal.z < 0 ? -1 * normal : normal, length(twice) / 2, at});
    }
  return faces;
}

auto width_of(const Outline& plan) -> double {
  std::vector<Point2> points;
  for (const auto& polygon : plan) points.insert(points.end(), polygon.outer.begin(), polygon.outer.end());
  return geometry::extent_of(std::move(points)).width;
}

/// Sets the plan and the width of a plane of these faces; false where the plan could not be computed.
auto set_plan(RoofPlane& plane, const std::vector<const model::ModelFace*>& faces) -> bool {
  std::vector<geometry::Polygon> pieces;
  for (const auto* face : faces) {
    auto flat = detail::plan_of_face(*face);
    if (!flat) return false;
    pieces.insert(pieces.end(), flat->begin(), flat->end());
  }
  auto plan = geometry::unite(pieces);
  if (!plan) return false;
  plane.plan = std::move(*plan);
  plane.width = width_of(plane.plan);
  return true;
}

}  // namespace

auto pitch_of(const RoofPlane& plane) -> double {
  return geometry::arc_tangent(length(xy(plane.normal)), plane.normal.z);
}

auto azimuth_of(const RoofPlane& plane) -> std::optional<double> {
  const Point2 down = xy(plane.normal);
  if (down == Point2{}) return std::nullopt;
  const double angle = geometry::arc_tangent(down.x, down.y);
  return angle < 0 ? angle + 360 * degree : angle;
}

auto centre_of(const RoofPlane& plane) -> std::optional<Point3> {
  detail::Middle middle;
  middle.add(plane.plan);
  if (!(middle.area > 0)) return std::nullopt;
  const Point2 at = middle.centre();
  return Point3{at.x, at.y, detail::height_at(plane, at)};
}

auto roof_planes_of(const model::Model& model) -> RoofPlanes {
  RoofPlanes out;
  std::size_t number = 0;
  std::vector<std::vector<const model::ModelFace*>> faces_of;
  for (std::uint32_t b = 0; b < model.buildings.size(); ++b) {
    auto faces = roof_faces(model.buildings[b], number);
    out.plane_of_face.resize(number, no_plane);
    // The largest faces first: their planes are the surest.
    std::ranges::stable_sort(faces, std::ranges::greater{}, &RoofFace::area);
    const auto first = out.planes.size();
    for (const auto& face : faces) {
      auto at = first;
      while (at < out.planes.size() && !lies_in(face, out.planes[at])) ++at;
      if (at == out.planes.size()) {
        out.planes.push_back({face.normal, face.face->loops[0][0], 0, {}, 0, b});
        faces_of.emplace_back();
      }
      out.planes[at].area += face.area;
      faces_of[at].push_back(face.face);
      out.plane_of_face[face.number] = static_cast<std::uint32_t>(at);
    }
  }
  std::vector<char> done(out.planes.size(), 0);
  base::parallel_for(done.size(), [&](std::size_t p) { done[p] = set_plan(out.planes[p], faces_of[p]) ? 1 : 0; });
  out.unchecked = static_cast<std::size_t>(std::ranges::count(done, 0));
  return out;
}

}  // namespace mansard::evaluate
