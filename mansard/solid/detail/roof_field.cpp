#include "mansard/solid/detail/roof_field.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/uniting.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using model::FaceClass;
using model::LabelledSolid;

constexpr double quantum = 1 / model::quanta_per_metre;

auto area_in_plan(const std::vector<std::vector<Point3>>& loops) -> double {
  double twice = 0;
  for (const auto& loop : loops)
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) twice += cross(xy(loop[i] - loop[0]), xy(loop[i + 1] - loop[0]));
  return twice / 2;
}

/// Through the outer loop, from its corners: normals that were read from a file are rounded.
auto plane_of(const std::vector<Point3>& loop) -> RoofPlane {
  Point3 sum, middle;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sum = sum + cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
    middle = middle + loop[i];
  }
  return {(1.0 / static_cast<double>(loop.size())) * middle, geometry::normalised(sum)};
}

/// An edge of a face, and whether a face of the same piece is beyond it.
struct Border {
  std::uint32_t face = 0;
  geometry::Segment2 segment;
};

using PointPair = std::pair<Point3, Point3>;

auto edges_of(const RoofField& field) -> std::map<PointPair, std::uint32_t> {
  std::map<PointPair, std::uint32_t> edges;
  for (std::uint32_t f = 0; f < field.faces.size(); ++f)
    for (const auto& loop : field.faces[f].loops)
      for (std::size_t i = 0; i < loop.size(); ++i) edges.emplace(PointPair{loop[i], loop[(i + 1) % loop.size()]}, f);
  return edges;
}

auto borders_of(const RoofField& field) -> std::vector<Border> {
  std::vector<Border> out;
  const auto edges = edges_of(field);
  for (const auto& [edge, face] : edges)
    if (!edges.contains({edge.second, edge.first})) out.push_back({face, {xy(edge.first), xy(edge.second)}});
  return out;
}

}  // namespace

auto RoofField::area_of(std::uint32_t piece) const -> double {
  double sum = 0;
  for (const auto& face : faces)
    if (face.piece == piece) sum += face.area;
  return sum;
}

auto RoofField::contacts() const -> std::vector<Contact> {
  constexpr double beside = 2 * quantum, least = 1e-3;  // m
  const auto borders = borders_of(*this);
  std::vector<geometry::Box2> boxes;
  for (const auto& border : borders) boxes.push_back(geometry::Box2::of(border.segment));
  const geometry::BoxIndex index(boxes);
  std::vector<Contact> out;
  for (std::uint32_t b = 0; b < borders.size(); ++b) {
    const auto& own = borders[b];
    const Point2 run = own.segment.end - own.segment.start;
    const double length = geometry::length(run);
    if (!(length > least)) continue;
    const Point2 along = (1 / length) * run;
    for (const auto o : index.overlapping(boxes[b].grown(beside))) {
      const auto& other = borders[o];
      if (other.face == own.face) continue;
      const Point2 from = other.segment.start - own.segment.start, to = other.segment.end - own.segment.start;
      if (std::abs(cross(along, from)) > beside || std::abs(cross(along, to)) > beside) continue;
      // The other face is on the right, so its edge runs back.
      const double first = std::max(0.0, dot(along, to)), last = std::min(length, dot(along, from));
      if (last - first > least)
        out.push_back({own.face, other.face, last - first, own.segment.start + (0.5 * (first + last)) * along});
    }
  }
  return out;
}

auto RoofField::seams() const -> std::vector<Contact> {
  std::vector<Contact> out;
  const auto edges = edges_of(*this);
  for (const auto& [edge, face] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (back == edges.end() || back->second == face) continue;
    const Point2 run = xy(edge.second) - xy(edge.first);
    const double length = geometry::length(run);
    if (!(length > 0)) continue;
    const Point2 middle = xy(edge.first) + 0.5 * run, beyond = middle - (1 / length) * geometry::left_of(run);
    out.push_back({face, back->second, length, middle,
                   faces[back->second].plane.height(beyond) - faces[face].plane.height(beyond)});
  }
  return out;
}

void RoofField::connect() {
  base::DisjointSets sets(faces.size());
  const auto edges = edges_of(*this);
  for (const auto& [edge, face] : edges)
    if (const auto back = edges.find({edge.second, edge.first}); back != edges.end()) sets.join(face, back->second);
  std::map<std::size_t, std::uint32_t> number;
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    faces[f].piece = number.try_emplace(sets.of(f), static_cast<std::uint32_t>(number.size())).first->second;
  pieces = static_cast<std::uint32_t>(number.size());
  outline.assign(pieces, 0);
  for (const auto& border : borders_of(*this))
    outline[faces[border.face].piece] += length(border.segment.end - border.segment.start);
}

auto roof_field(const LabelledSolid& solid) -> std::optional<RoofField> {
  RoofField out;
  std::optional<double> level;
  for (std::uint32_t f = 0; f < solid.solid.faces.size(); ++f) {
    const auto& face = solid.solid.faces[f];
    const auto kind = solid.classes[f];
    if (kind == FaceClass::soffit || face.kind == model::FaceKind::soffit) return std::nullopt;
    if (kind == FaceClass::ground)
      for (const auto v : face.loops[0]) {
        const double z = solid.solid.vertices[v].z;
        if (level && *level != z) return std::nullopt;
        level = z;
      }
    if (kind != FaceClass::roof) continue;
    RoofFace roof;
    roof.face = f;
    for (const auto& loop : face.loops) {
      auto& points = roof.loops.emplace_back();
      for (const auto v : loop) points.push_back(solid.solid.vertices[v]);
    }
    roof.area = area_in_plan(roof.loops);
    roof.plane = plane_of(roof.loops[0]);
    constexpr double upright = 1e-3;  // of a normal: steeper, a height field has no roof there
    if (!(roof.plane.normal.z > upright)) return std::nullopt;
    out.faces.push_back(std::move(roof));
  }
  if (out.faces.empty() || !level) return std::nullopt;
  out.connect();
  return out;
}

auto solid_below(const RoofField& field, const LabelledSolid& solid) -> std::optional<LabelledSolid> {
  LabelledSolid shape;
  std::map<Point3, std::uint32_t> numbers;
  const auto number = [&](Point3 p) {
    const auto [entry, added] = numbers.try_emplace(p, static_cast<std::uint32_t>(shape.solid.vertices.size()));
    if (added) shape.solid.vertices.push_back(p);
    return entry->second;
  };
  const auto add = [&](model::Face face, const std::vector<std::vector<Point3>>& loops, FaceClass kind) {
    face.loops.clear();
    for (const auto& points : loops) {
      auto& loop = face.loops.emplace_back();
      for (const auto p : points) loop.push_back(number(p));
    }
    shape.solid.faces.push_back(std::move(face));
    shape.classes.push_back(kind);
  };
  // Ground as it is; walls so that those that were one are put together again.
  std::set<Point2> corners;
  for (std::size_t f = 0; f < solid.solid.faces.size(); ++f) {
    if (solid.classes[f] == FaceClass::roof) continue;
    std::vector<std::vector<Point3>> loops;
    for (const auto& loop : solid.solid.faces[f].loops) {
      auto& points = loops.emplace_back();
      for (const auto v : loop) points.push_back(solid.solid.vertices[v]);
    }
    for (const auto& loop : loops)
      for (const auto p : loop) corners.insert(xy(p));
    model::Face face = solid.solid.faces[f];
    // Normals that were found from rounded corners are not quite level.
    if (solid.classes[f] == FaceClass::ground) face.normal = {0, 0, -1};
    else face.normal = geometry::normalised(Point3{face.normal.x, face.normal.y, 0});
    add(std::move(face), loops, solid.classes[f]);
  }
  for (const auto& roof : field.faces) {
    model::Face face = solid.solid.faces[roof.face];
    face.normal = roof.plane.normal;
    if (face.normal.z == 1) face.kind = model::FaceKind::cap;
    add(std::move(face), roof.loops, FaceClass::roof);
  }
  const std::array<const LabelledSolid*, 1> alone{&shape};
  for (const bool cut : {false, true}) {
    auto made = united_by(alone, Reach{.corners = cut});
    if (made.solids.size() != 1 || !made.warnings.empty() || !made.simplified.empty()) continue;
    auto& model = made.solids.front().model;
    if (model.solid.faces.size() > solid.solid.faces.size()) continue;
    bool same = true;
    for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
      if (model.classes[f] == FaceClass::ground)
        for (const auto& loop : model.solid.faces[f].loops)
          for (const auto v : loop) same = same && corners.contains(xy(model.solid.vertices[v]));
    if (same) return std::move(model);
  }
  return std::nullopt;
}

namespace {

/// Area of a triangle below a height, for corners at a ≤ b ≤ c.
auto area_below(double area, double a, double b, double c, double z) -> double {
  if (z >= c) return area;
  if (z <= a) return 0;
  if (z < b) return area * (z - a) * (z - a) / ((b - a) * (c - a));
  return area * (1 - (c - z) * (c - z) / ((c - a) * (c - b)));
}

}  // namespace

auto height_at(const std::vector<const RoofFace*>& faces, double share) -> double {
  struct Triangle {
    double area, a, b, c;  // area with the sign of a fan: together they are the face
  };
  std::vector<Triangle> all;
  double least = 0, most = 0, sum = 0;
  for (const RoofFace* face : faces)
    for (const auto& loop : face->loops)
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        std::array<double, 3> z{loop[0].z, loop[i].z, loop[i + 1].z};
        std::ranges::sort(z);
        if (all.empty()) least = z[0], most = z[2];
        least = std::min(least, z[0]), most = std::max(most, z[2]);
        all.push_back({cross(xy(loop[i] - loop[0]), xy(loop[i + 1] - loop[0])) / 2, z[0], z[1], z[2]});
        sum += all.back().area;
      }
  double low = least, high = most;
  constexpr int halvings = 48;  // of less than 1 km: to a billionth of a millimetre
  for (int step = 0; step < halvings; ++step) {
    const double middle = 0.5 * (low + high);
    double below = 0;
    for (const auto& t : all) below += area_below(t.area, t.a, t.b, t.c, middle);
    (below < share * sum ? low : high) = middle;
  }
  return high;
}

}  // namespace mansard::solid::detail
