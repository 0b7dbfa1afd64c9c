#include "mansard/evaluate/planes.hpp"

#include "mansard/evaluate/detail/plan_of_face.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace mansard::evaluate {
namespace {

using geometry::Point3;
using Corner = std::array<std::int64_t, 3>;
using Edge = std::pair<Corner, Corner>;

constexpr std::uint32_t none = ~0U;

auto to_millimetres(Point3 p) -> Corner {
  return {std::llround(p.x * 1e3), std::llround(p.y * 1e3), std::llround(p.z * 1e3)};
}

/// One building's faces, and which of them share an edge.
struct Faces {
  std::vector<const model::ModelFace*> faces;
  std::vector<Point3> normals;
  std::vector<double> areas;
  std::vector<std::vector<std::uint32_t>> neighbours;

  explicit Faces(const model::ModelBuilding& building) {
    for (const auto& part : building.parts)
      for (const auto& face : part.faces) {
        const Point3 twice = detail::area_vector(face);
        faces.push_back(&face);
        normals.push_back(normalised(twice));
        areas.push_back(length(twice) / 2);
      }
    neighbours.resize(faces.size());
    std::map<Edge, std::vector<std::uint32_t>> at;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      for (const auto& loop : faces[f]->loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const Corner a = to_millimetres(loop[i]), b = to_millimetres(loop[(i + 1) % loop.size()]);
          at[std::minmax(a, b)].push_back(f);
        }
    for (const auto& [edge, sharing] : at)
      for (const auto f : sharing)
        for (const auto g : sharing)
          if (f != g) neighbours[f].push_back(g);
  }
};

auto lies_in(const model::ModelFace& face, Point3 normal, const Plane& plane, const PlaneOptions& options) -> bool {
  if (face.kind != plane.kind || dot(normal, plane.normal) < geometry::cosine(options.angle)) return false;
  return std::ranges::all_of(
      face.loops.front(), [&](Point3 p) { return std::abs(dot(p - plane.point, plane.normal)) <= options.distance; });
}

}  // namespace

auto planes_of(const model::Model& model, const PlaneOptions& options) -> Planes {
  Planes out;
  for (std::uint32_t b = 0; b < model.buildings.size(); ++b) {
    const Faces building(model.buildings[b]);
    const auto first = out.of_face.size();
    out.of_face.resize(first + building.faces.size(), none);
    const auto plane_of = [&](std::uint32_t f) -> std::uint32_t& { return out.of_face[first + f]; };
    // The largest faces first: their planes are the surest.
    std::vector<std::uint32_t> order(building.faces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::uint32_t f) { return building.areas[f]; });
    for (const auto seed : order) {
      if (plane_of(seed) != none) continue;
      const auto number = static_cast<std::uint32_t>(out.planes.size());
      Plane plane{building.normals[seed], building.faces[seed]->loops[0][0], 0, building.faces[seed]->kind, b};
      std::vector<std::uint32_t> open{seed};
      plane_of(seed) = number;
      while (!open.empty()) {
        const auto f = open.back();
        open.pop_back();
        plane.area += building.areas[f];
        for (const auto g : building.neighbours[f])
          if (plane_of(g) == none && lies_in(*building.faces[g], building.normals[g], plane, options)) {
            plane_of(g) = number;
            open.push_back(g);
          }
      }
      out.planes.push_back(plane);
    }
  }
  return out;
}

}  // namespace mansard::evaluate
