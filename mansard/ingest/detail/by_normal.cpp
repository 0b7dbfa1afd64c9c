#include "mansard/ingest/detail/by_normal.hpp"
#include "mansard/geometry/angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mansard::ingest::detail {
namespace {

using geometry::Point3;

struct Heights {
  double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
  void add(const model::ModelFace& face) {
    for (const Point3 p : face.loops.front()) {
      least = std::min(least, p.z);
      most = std::max(most, p.z);
    }
  }
};

auto class_of(const model::ModelFace& face, const Heights& building) -> model::SurfaceClass {
  constexpr double wall_angle = 0.2;  // rad from vertical; as label::Options has it
  constexpr double foot = 0.1;        // m; so near to the lowest point is at it
  constexpr double storey = 1.0;      // m; what is lower has no roof above its ground
  const Point3 normal = geometry::normalised(model::area_vector(face.loops.front()));
  if (std::abs(normal.z) <= geometry::sine(wall_angle)) return model::SurfaceClass::wall;
  Heights own;
  own.add(face);
  // Not by looking down: many files turn their faces either way.
  const bool at_foot = own.most - building.least <= foot && building.most - building.least > storey;
  return at_foot ? model::SurfaceClass::ground : model::SurfaceClass::roof;
}

}  // namespace

auto classify_by_normal(model::ModelBuilding& building) -> std::size_t {
  Heights heights;
  for (const auto& part : building.parts)
    for (const auto& face : part.faces) heights.add(face);
  std::size_t count = 0;
  for (auto& part : building.parts)
    for (auto& face : part.faces) {
      if (!face.by_normal) continue;
      face.kind = class_of(face, heights);
      ++count;
    }
  return count;
}

}  // namespace mansard::ingest::detail
