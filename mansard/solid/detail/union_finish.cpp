// The last step of a union: straight lines without corners in between, and faces that are planar, or cut into pieces
// that are.
#include <algorithm>
#include <cmath>
#include <set>

#include "mansard/solid/detail/delaunay.hpp"
#include "mansard/solid/detail/fitted_plane.hpp"
#include "mansard/solid/detail/measure.hpp"
#include "mansard/solid/detail/planar_pieces.hpp"
#include "mansard/solid/detail/union_faces.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point3;

/// m; a corner that lies this near the line between its neighbours was put there by rounding: 0.07 mm in plan and as
/// much in height, a little more.
constexpr double straight = 1.2e-4;
/// Cosine of 12°: validators refuse faces with triangles whose normals are 20° apart, and cut faces in other ways.
constexpr double least_cosine = 0.978;

class Straightening {
 public:
  Straightening(model::Solid& solid, const std::vector<std::uint8_t>& pinned) : solid_(solid), pinned_(pinned) {
    neighbours_.resize(solid.vertices.size());
    faces_.resize(solid.vertices.size());
    for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
      for (const auto& loop : solid.faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
          neighbours_[a].insert(b);
          neighbours_[b].insert(a);
          faces_[a].insert(f);
        }
  }

  void run() {
    for (std::uint32_t v = 0; v < neighbours_.size(); ++v)
      if (neighbours_[v].size() == 2 && pinned_[v] == 0) try_out(v);
  }

 private:
  void try_out(std::uint32_t v) {
    const std::uint32_t a = *neighbours_[v].begin(), b = *neighbours_[v].rbegin();
    if (neighbours_[a].contains(b)) return;
    const Point3 p = solid_.vertices[a], along = solid_.vertices[b] - p, to = solid_.vertices[v] - p;
    const double t = dot(to, along) / dot(along, along);
    if (!(t > 0 && t < 1) || length(to - t * along) > straight) return;
    for (const std::uint32_t f : faces_[v])
      for (const auto& loop : solid_.faces[f].loops)
        if (loop.size() < 4 && std::ranges::find(loop, v) != loop.end()) return;
    for (const std::uint32_t f : faces_[v])
      for (auto& loop : solid_.faces[f].loops) std::erase(loop, v);
    neighbours_[v].clear();
    neighbours_[a].erase(v), neighbours_[a].insert(b);
    neighbours_[b].erase(v), neighbours_[b].insert(a);
  }

  model::Solid& solid_;
  const std::vector<std::uint8_t>& pinned_;
  std::vector<std::set<std::uint32_t>> neighbours_, faces_;
};

auto unit_normal(const model::Solid& solid, const Corners& t) -> Point3 {
  const Point3 o = solid.vertices[t[0]];
  return geometry::normalised(cross(solid.vertices[t[1]] - o, solid.vertices[t[2]] - o));
}

/// Cut as validators cut it.
auto has_needle(const model::Solid& solid, Point3 normal, std::vector<Corners> triangles) -> bool {
  make_delaunay(solid, normal, triangles);
  for (const Corners& t : triangles)
    if (!(dot(unit_normal(solid, t), unit_normal(solid, triangles.front())) >= least_cosine)) return true;
  return false;
}

/// A corner of a face nearer than this to the line between its neighbours makes a needle, m.
constexpr double thin = 1.2e-3;

/// Cuts off the triangles at corners of the outer loop that stand out by less than `thin`: what another wall that ends
/// on a side leaves there by rounding. They become faces of their own.
auto without_thin_corners(const model::Solid& solid, const std::vector<std::uint8_t>& pinned, model::Face& face)
    -> std::vector<model::Face> {
  std::vector<model::Face> cut;
  const Point3 normal = fitted_plane(solid, face).normal;
  // Cut off at a wall that another solid of the building has, too, what is left of a roof would hang over that wall.
  // And upright, to within what coordinates are rounded to, what is cut off would lie in the wall, over edges that end
  // there.
  constexpr double rounded = 1e-4;  // m
  const auto is_of_wall = [&](const std::array<std::uint32_t, 3>& t, Point3 area, double length2) {
    if (normal.z <= 0) return false;
    if (area.z > 0) return area.z * area.z < rounded * rounded * length2;
    return std::ranges::any_of(t, [&](auto v) { return pinned[v] == of_a_solid; });
  };
  auto& loop = face.loops[0];
  for (std::size_t i = 0; i < loop.size() && loop.size() > 3;) {
    const std::size_t n = loop.size();
    const std::array<std::uint32_t, 3> t{loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]};
    const Point3 a = solid.vertices[t[0]], v = solid.vertices[t[1]] - a, along = solid.vertices[t[2]] - a;
    const double length2 = dot(along, along), at = dot(v, along);
    const Point3 area = cross(v, along);
    if (!(dot(area, normal) > 0) || !(at > 0 && at < length2) || dot(area, area) >= thin * thin * length2 ||
        dot(area, area) == 0 || is_of_wall(t, area, length2)) {
      ++i;
      continue;
    }
    cut.push_back({{{t[0], t[1], t[2]}}, face.kind, face.provenance, unit_normal(solid, t)});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return cut;
}

/// Renumbers the vertices in the order in which the faces use them.
void renumber(model::Solid& solid) {
  std::vector<std::uint32_t> number(solid.vertices.size(), UINT32_MAX);
  std::vector<Point3> used;
  for (auto& face : solid.faces)
    for (auto& loop : face.loops)
      for (auto& v : loop) {
        if (number[v] == UINT32_MAX) {
          number[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(solid.vertices[v]);
        }
        v = number[v];
      }
  solid.vertices = std::move(used);
}

/// Puts corners that another building has on a side of a roof back into its plane, in height.
void level_pinned(model::LabelledSolid& model, const std::vector<std::uint8_t>& pinned) {
  constexpr double most = 2e-3;  // m
  auto& [solid, classes] = model;
  std::vector<std::uint32_t> slopes(solid.vertices.size(), 0);
  const auto is_wall = [&](std::size_t f) {
    return classes[f] == model::FaceClass::wall || classes[f] == model::FaceClass::party_wall;
  };
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    if (!is_wall(f))
      for (const auto& loop : solid.faces[f].loops)
        for (const auto v : loop) ++slopes[v];
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    if (classes[f] != model::FaceClass::roof) continue;
    model::Face others = solid.faces[f];
    for (auto& loop : others.loops) std::erase_if(loop, [&](auto v) { return pinned[v] != 0 && slopes[v] == 1; });
    std::erase_if(others.loops, [](const auto& loop) { return loop.empty(); });
    if (others.loops.empty() || others.loops[0].size() < 3) continue;
    const FittedPlane plane = fitted_plane(solid, others);
    if (std::abs(plane.normal.z) < 1e-3) continue;
    for (const auto& loop : solid.faces[f].loops)
      for (const auto v : loop) {
        if (pinned[v] == 0 || slopes[v] != 1) continue;
        Point3& p = solid.vertices[v];
        const double off = dot(plane.normal, p - plane.middle) / plane.normal.z;
        if (std::abs(off) < most) p.z = std::round((p.z - off) * quanta_per_metre) / quanta_per_metre;
      }
  }
}

/// Corners of one roof alone, where its other faces are walls, put back into its plane in height: merging points has
/// moved them in plan. Only where a roof is not planar and would be cut; its plane is that of most of its corners.
void level_corners(model::LabelledSolid& model, double planar) {
  constexpr double most = 2e-3;  // m
  auto& [solid, classes] = model;
  std::vector<std::uint32_t> slopes(solid.vertices.size(), 0);
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    if (classes[f] != model::FaceClass::wall && classes[f] != model::FaceClass::party_wall)
      for (const auto& loop : solid.faces[f].loops)
        for (const auto v : loop) ++slopes[v];
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    const model::Face& face = solid.faces[f];
    if (classes[f] != model::FaceClass::roof || face.normal.z < 1e-3) continue;
    if (fitted_plane(solid, face).furthest <= planar) continue;
    const double middle = offset_of_most(solid, face);
    for (const auto& loop : face.loops)
      for (const auto v : loop) {
        if (slopes[v] != 1) continue;
        Point3& p = solid.vertices[v];
        const double off = (dot(face.normal, p) - middle) / face.normal.z;
        if (std::abs(off) < most) p.z = std::round((p.z - off) * quanta_per_metre) / quanta_per_metre;
      }
  }
}

}  // namespace

auto finish(Union& made, double planar, bool level) -> bool {
  auto& [solid, classes] = made.model;
  Straightening(solid, made.pinned).run();
  level_pinned(made.model, made.pinned);
  if (level) level_corners(made.model, planar);
  Union out;
  out.model.solid.vertices = solid.vertices;
  Triangulator triangulator(solid);
  std::vector<Corners> triangles, of_piece;
  const auto add = [&](model::Face face, std::size_t from) {
    out.model.solid.faces.push_back(std::move(face));
    out.model.classes.push_back(classes[from]);
    out.solid_of_face.push_back(made.solid_of_face[from]);
  };
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    model::Face& face = solid.faces[f];
    if (face.loops.size() == 1 && face.loops[0].size() == 3) {
      add(std::move(face), f);
      continue;
    }
    triangles.clear();
    const FittedPlane plane = fitted_plane(solid, face);
    if (!triangulator.append(face, plane.normal, triangles)) return false;
    const auto is_flat = [&](const FittedPlane& found) {
      return found.furthest <= planar && found.narrow >= model::narrowest_face;
    };
    if (is_flat(plane) && !has_needle(solid, plane.normal, triangles)) {
      add(std::move(face), f);
      continue;
    }
    const auto good = [&](const model::Face& piece) {
      of_piece.clear();
      const FittedPlane found = fitted_plane(solid, piece);
      return is_flat(found) && triangulator.append(piece, found.normal, of_piece) &&
             !has_needle(solid, found.normal, of_piece);
    };
    model::Face rest = face;
    if (auto cut = without_thin_corners(solid, made.pinned, rest); !cut.empty() && good(rest)) {
      add(std::move(rest), f);
      for (auto& one : cut) add(std::move(one), f);
      continue;
    }
    for (auto& piece : planar_pieces(solid, face, triangles, good)) add(std::move(piece), f);
  }
  renumber(out.model.solid);
  made = std::move(out);
  return true;
}

}  // namespace mansard::solid::detail
