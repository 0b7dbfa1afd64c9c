#include "mansard/formats/cityjson/cityjson_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mansard/formats/cityjson/cityjson_document.hpp"
#include "mansard/formats/cityjson/quantised.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::formats::detail {
namespace {

using geometry::Point3;
using model::FaceClass;
using model::FaceKind;

/// Half the distance between the two planes of that normal that hold all corners between them.
auto bend_of(const model::Solid& solid, const std::vector<std::uint32_t>& corners, Point3 normal) -> double {
  const Point3 start = solid.vertices[corners[0]];
  double least = 0, most = 0;
  for (const auto v : corners) {
    const double off = dot(normal, solid.vertices[v] - start);
    least = std::min(least, off);
    most = std::max(most, off);
  }
  return 0.5 * (most - least);
}

/// The normal whose plane is nearest to the corners by least squares of that weight each, near one that is given. The
/// weights come to be those of the next step of Lawson's algorithm, which ends at the plane of the least bend.
auto fitted(const model::Solid& solid, const std::vector<std::uint32_t>& corners, Point3 normal,
            std::vector<double>& weights) -> Point3 {
  const Point3 aside = std::abs(normal.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
  const Point3 u = geometry::normalised(cross(normal, aside)), v = cross(normal, u);
  Point3 middle;
  double all = 0;
  for (const double weight : weights) all += weight;
  for (std::size_t i = 0; i < corners.size(); ++i) middle = middle + (weights[i] / all) * solid.vertices[corners[i]];
  geometry::SlopeEquations equations;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point3 d = solid.vertices[corners[i]] - middle;
    equations.add(dot(u, d), dot(v, d), dot(normal, d), weights[i] / all);
  }
  const double size = equations.xx + equations.yy;
  if (!(equations.determinant() > 1e-9 * size * size)) return normal;  // nearly on one line
  const auto [a, b] = equations.slopes();
  const Point3 best = geometry::normalised(normal - (a * u + b * v));
  for (std::size_t i = 0; i < corners.size(); ++i)
    weights[i] *= std::abs(dot(best, solid.vertices[corners[i]] - middle));
  return best;
}

/// Newell's normal of the outer loop, or that of the plane through all corners that bends the face least: in the
/// rounded corners of a narrow face Newell's is further off than a face may bend. Up where there is no area.
auto normal_of(const model::Solid& solid, const std::vector<std::vector<std::uint32_t>>& loops) -> Point3 {
  const auto& outer = loops[0];
  const Point3 start = solid.vertices[outer[0]];
  Point3 sum;
  for (std::size_t i = 1; i + 1 < outer.size(); ++i)
    sum = sum + cross(solid.vertices[outer[i]] - start, solid.vertices[outer[i + 1]] - start);
  const Point3 newell = geometry::normalised(sum);
  if (!(length(newell) > 0.5)) return {0, 0, 1};
  std::vector<std::uint32_t> corners;
  for (const auto& loop : loops) corners.insert(corners.end(), loop.begin(), loop.end());
  constexpr double rounding = 0.5e-4;  // m; with less there is nothing to gain
  Point3 best = newell;
  double bend = bend_of(solid, corners, newell);
  std::vector<double> weights(corners.size(), 1);
  for (int step = 0; step < 32 && bend > rounding; ++step) {
    const Point3 next = fitted(solid, corners, newell, weights);
    if (const double less = bend_of(solid, corners, next); less < bend) best = next, bend = less;
    if (std::ranges::all_of(weights, [](double weight) { return weight < 1e-300; })) break;
  }
  return best;
}

/// Of a roof: the measured normal, moved no further than it takes to be written with the same slope and azimuth again.
/// Two decimals of a degree alone would be up to a millimetre beside a face of ten metres, more than a face may bend.
auto roof_normal(const Json& semantics, Point3 measured) -> Point3 {
  const Json &slope = formats::member(semantics, "ms_slope"), &azimuth = formats::member(semantics, "ms_azimuth");
  if (!slope.is_number()) return measured;
  const bool looks = azimuth.is_number();
  // Half a hundredth to either side; on the border of what counts as flat (0.5°) on the side where it was.
  constexpr double half = 0.00499, border = 0.5, little = 1e-9, radians = std::numbers::pi / 180;
  const double lowest = looks ? border + little : 0, highest = looks ? 90 : border - little;
  const double across = std::hypot(measured.x, measured.y);
  const double written = slope.get<double>();
  const double steep =
      std::clamp(std::clamp(std::atan2(across, measured.z) / radians, written - half, written + half), lowest, highest);
  double towards = std::atan2(measured.x, measured.y) / radians;
  if (looks)
    towards -= [&] {
      const double off = std::remainder(towards - azimuth.get<double>(), 360);
      return off - std::clamp(off, -half, half);
    }();
  if (steep == 0) return {0, 0, 1};
  const double run = std::sin(steep * radians);
  return {run * std::sin(towards * radians), run * std::cos(towards * radians), std::cos(steep * radians)};
}

auto class_of(const Json& semantics, Point3 normal) -> FaceClass {
  const std::string name = text_of(formats::member(semantics, "type"));
  if (name == "RoofSurface") return FaceClass::roof;
  if (name == "GroundSurface") return FaceClass::ground;
  if (name == "OuterCeilingSurface") return FaceClass::soffit;
  if (name == "WallSurface")
    return formats::member(semantics, "ms_party_wall") == true ? FaceClass::party_wall : FaceClass::wall;
  constexpr double upright = 0.2;  // as label::Options::wall_angle
  return normal.z > upright ? FaceClass::roof : normal.z < -upright ? FaceClass::ground : FaceClass::wall;
}

auto kind_of(FaceClass c, Point3 normal) -> FaceKind {
  switch (c) {
    case FaceClass::ground: return FaceKind::base;
    case FaceClass::soffit: return FaceKind::soffit;
    case FaceClass::roof: return normal.z == 1 ? FaceKind::cap : FaceKind::side;
    default: return FaceKind::side;
  }
}

template <class Work>
void each_geometry(const Item& object, std::string_view lod, std::string_view type, Work work) {
  if (!object.has("geometry")) return;
  object.member("geometry").each([&](const Item& geometry) {
    if (geometry.json.is_object() && geometry.has("lod") && geometry.json["lod"] == lod && geometry.has("type") &&
        geometry.json["type"] == type)
      work(geometry);
  });
}

/// Each surface; throws a Defect if the boundaries are missing or not lists.
template <class Work>
void each_strict_surface(const Item& geometry, Work work) {
  (void)geometry.member("boundaries");
  each_shell(geometry, [&](const CityShell& shell) {
    if (!shell.surfaces.json.is_array()) shell.surfaces.refuse("an array");
    each_surface(shell, work);
  });
}

}  // namespace

Vertices::Vertices(const Item& transform, const Item& list, const std::array<std::int64_t, 3>& origin)
    : list_(list), scale_(transform.member("scale").numbers<3>()), shift_(transform.member("translate").numbers<3>()) {
  if (!list.json.is_array()) list.refuse("an array");
  for (std::size_t axis = 0; axis < 3; ++axis) shift_[axis] -= static_cast<double>(origin[axis]);
}

auto Vertices::coordinate(double quanta, std::size_t axis) const -> double {
  const bool ours = scale_[axis] * quanta_per_metre == 1 && shift_[axis] == std::floor(shift_[axis]);
  const double steps = ours ? quanta + shift_[axis] * quanta_per_metre
                            : std::round((quanta * scale_[axis] + shift_[axis]) * quanta_per_metre);
  return steps / quanta_per_metre;
}

auto Vertices::at(const Item& index) const -> Point3 {
  const std::int64_t number = index.whole();
  if (number < 0 || static_cast<std::uint64_t>(number) >= list_.json.size()) index.refuse("the number of a vertex");
  const auto place = static_cast<std::size_t>(number);
  const auto quanta = Item{list_.json[place], {&list_.place, {}, place}}.numbers<3>();
  return {coordinate(quanta[0], 0), coordinate(quanta[1], 1), coordinate(quanta[2], 2)};
}

void read_lod_0(const Item& object, const Vertices& vertices, model::Building& building) {
  each_geometry(object, "0", "MultiSurface", [&](const Item& geometry) {
    each_strict_surface(geometry, [&](const CitySurface& surface) {
      geometry::Polygon polygon;
      surface.rings.each([&](const Item& loop) {
        auto& ring = loop.place.index == 0 ? polygon.outer : polygon.holes.emplace_back();
        loop.each([&](const Item& index) {
          const Point3 p = vertices.at(index);
          ring.push_back({p.x, p.y});
          building.ground = p.z;
        });
      });
      building.footprint.push_back(std::move(polygon));
    });
  });
}

auto read_model(const Item& object, const Vertices& vertices) -> model::LabelledSolid {
  model::LabelledSolid model;
  std::map<Point3, std::uint32_t> number_of;  // by place: a file may have one twice
  const auto number = [&](const Item& index) {
    const Point3 p = vertices.at(index);
    const auto [entry, added] = number_of.try_emplace(p, static_cast<std::uint32_t>(number_of.size()));
    if (added) model.solid.vertices.push_back(p);
    return entry->second;
  };
  each_geometry(object, "2.2", "Solid", [&](const Item& geometry) {
    const Item shells = geometry.member("boundaries");
    if (!shells.json.is_array() || shells.json.size() != 1) shells.refuse("one shell");
    each_strict_surface(geometry, [&](const CitySurface& surface) {
      model::Face face;
      surface.rings.each([&](const Item& loop) {
        auto& corners = face.loops.emplace_back();
        loop.each([&](const Item& index) { corners.push_back(number(index)); });
        if (corners.size() < 3) loop.refuse("a ring of at least 3 vertices");
      });
      if (face.loops.empty()) surface.rings.refuse("a surface with a ring");
      face.normal = normal_of(model.solid, face.loops);
      const FaceClass c = class_of(surface.semantics, face.normal);
      if (c == FaceClass::ground || c == FaceClass::soffit) face.normal = {0, 0, -1};
      if (c == FaceClass::roof) face.normal = roof_normal(surface.semantics, face.normal);
      face.kind = kind_of(c, face.normal);
      model.solid.faces.push_back(std::move(face));
      model.classes.push_back(c);
    });
  });
  return model;
}

}  // namespace mansard::formats::detail
