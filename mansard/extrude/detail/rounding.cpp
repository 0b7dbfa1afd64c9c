#include "mansard/extrude/detail/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mansard/solid/triangulator.hpp"

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using Indices = std::vector<std::uint32_t>;

/// m; of the 1e-4 m within which check() takes a face to be planar. Rounding to the 1e-4 m of files takes up to √3 / 2
/// of that, 8.7e-5 m, where a face looks along all three axes alike, so that this is more than a proof would allow: the
/// check that follows decides, and a solid that it refuses is made again with every arc.
constexpr double planar_budget = 4e-5;

/// Pulls a point that its planes leave free towards where it was: planes with an angle α between them weigh sin² α, so
/// that from 1e-3 rad on they are stronger. What it costs on planes at real angles is a millionth of the way.
constexpr double hold = 1e-6;

auto normal_of(const FaceNode& node) -> Point3 {
  if (node.kind == model::FaceKind::base || node.kind == model::FaceKind::soffit) return {0, 0, -1};
  if (node.kind == model::FaceKind::cap || node.kind == model::FaceKind::terrace) return {0, 0, 1};
  const Point2 inward = left_of(node.direction.approximate());
  const double slope = node.kind == model::FaceKind::connector ? 0 : node.slope.get_d();
  return normalised(Point3{-inward.x, -inward.y, slope});
}

/// Where each face's plane lies along its normal: the exact points are on it, so that their doubles agree to rounding.
auto offsets_of(const model::Solid& solid) -> std::vector<double> {
  std::vector<double> offsets;
  offsets.reserve(solid.faces.size());
  for (const model::Face& face : solid.faces) {
    double least = dot(face.normal, solid.vertices[face.loops[0][0]]), most = least;
    for (const auto& loop : face.loops)
      for (const std::uint32_t v : loop) {
        const double d = dot(face.normal, solid.vertices[v]);
        least = std::min(least, d);
        most = std::max(most, d);
      }
    offsets.push_back((least + most) / 2);
  }
  return offsets;
}

auto has_short_arc(const model::Solid& solid, double short_arc) -> bool {
  for (const model::Face& face : solid.faces)
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point3 d = solid.vertices[loop[i + 1 == loop.size() ? 0 : i + 1]] - solid.vertices[loop[i]];
        if (dot(d, d) < short_arc * short_arc) return true;
      }
  return false;
}

auto holds(const Indices& list, std::uint32_t item) -> bool { return std::ranges::find(list, item) != list.end(); }
void unite(Indices& list, std::uint32_t item) {
  if (!holds(list, item)) list.push_back(item);
}
auto is_corner(const model::Face& face, std::uint32_t v) -> bool {
  return std::ranges::any_of(face.loops, [v](const auto& loop) { return holds(loop, v); });
}

/// Draws short arcs together, one after the other, shortest first. Faces that vanish keep their place without loops.
class Collapse {
 public:
  Collapse(model::Solid& solid, const std::vector<double>& offsets, double short_arc)
      : vertices_(solid.vertices), faces_(solid.faces), offsets_(offsets), short_arc_(short_arc), triangulator_(solid) {
    around_.resize(vertices_.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      for (const auto& loop : faces_[f].loops)
        for (const std::uint32_t v : loop) unite(around_[v], f);
  }

  /// How many were.
  auto run() -> std::size_t {
    std::size_t before = 0;
    do {
      before = joined_;
      pass();
    } while (joined_ > before);
    return joined_;
  }

 private:
  /// Tries every short arc once.
  void pass() {
    std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> arcs;
    for (const model::Face& face : faces_)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
          const double l = length(vertices_[b] - vertices_[a]);
          if (a < b && l < short_arc_) arcs.emplace_back(l, a, b);
        }
    std::ranges::sort(arcs);
    for (const auto& [l, a, b] : arcs)
      if (topology_allows(a, b) && join(a, b)) ++joined_;
  }

  static auto follows(const model::Face& face, std::uint32_t a, std::uint32_t b) -> bool {
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (loop[i] == a && loop[(i + 1) % loop.size()] == b) return true;
    return false;
  }

  [[nodiscard]] auto neighbours(std::uint32_t v) const -> Indices {
    Indices found;
    for (const std::uint32_t f : around_[v])
      for (const auto& loop : faces_[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
          if (loop[i] == v) {
            unite(found, loop[(i + 1) % loop.size()]);
            unite(found, loop[(i + loop.size() - 1) % loop.size()]);
          }
    return found;
  }

  /// The link condition for faces of any number of corners: a and b are neighbours, share no faces but the two along
  /// their arc, and share a neighbour only as the third corner of a triangle among these two; such a triangle is all of
  /// its face, which vanishes. Four faces about a and b alone, a tetrahedron, would leave nothing.
  [[nodiscard]] auto topology_allows(std::uint32_t a, std::uint32_t b) const -> bool {
    std::size_t along = 0, triangles = 0;
    for (const std::uint32_t f : around_[a]) {
      if (!holds(around_[b], f)) continue;
      const model::Face& face = faces_[f];
      const bool forth = follows(face, a, b), back = follows(face, b, a);
      if (forth == back) return false;  // apart on one face, or the arc inside of it
      ++along;
      std::size_t loops = 0;
      for (const auto& loop : face.loops) {
        if (!holds(loop, a) && !holds(loop, b)) continue;
        ++loops;
        if (loop.size() > 3) continue;
        if (face.loops.size() > 1) return false;  // the loop would vanish, its face would not
        ++triangles;
      }
      if (loops > 1) return false;  // two loops would touch
    }
    if (along != 2) return false;
    const Indices of_a = neighbours(a), of_b = neighbours(b);
    std::size_t common = 0;
    for (const std::uint32_t v : of_a) common += holds(of_b, v) ? 1 : 0;
    return common == triangles && of_a.size() + of_b.size() - 2 - common >= 3;
  }

  /// The point nearest to all the planes (least squares), held near `start` where they leave it free.
  [[nodiscard]] auto compromise(const Indices& touched, Point3 start) const -> Point3 {
    Point3 x{hold, 0, 0}, y{0, hold, 0}, z{0, 0, hold}, pull;
    for (const std::uint32_t f : touched) {
      const Point3 n = faces_[f].normal;
      const double gap = offsets_[f] - dot(n, start);
      x = x + n.x * n;
      y = y + n.y * n;
      z = z + n.z * n;
      pull = pull + gap * n;
    }
    const double det = dot(x, cross(y, z));
    return start + Point3{dot(pull, cross(y, z)) / det, dot(x, cross(pull, z)) / det, dot(x, cross(y, pull)) / det};
  }

  auto join(std::uint32_t a, std::uint32_t b) -> bool {
    Indices touched = around_[a];
    for (const std::uint32_t f : around_[b]) unite(touched, f);
    std::ranges::sort(touched);

    const Point3 pa = vertices_[a], pb = vertices_[b];
    const auto residual = [&](Point3 p) {
      double most = 0;
      for (const std::uint32_t f : touched) most = std::max(most, std::abs(dot(faces_[f].normal, p) - offsets_[f]));
      return most;
    };
    Point3 best = pa;
    for (const Point3 p : {pb, 0.5 * (pa + pb), compromise(touched, 0.5 * (pa + pb))})
      if (residual(p) < residual(best)) best = p;
    if (!(residual(best) <= planar_budget)) return false;

    std::vector<std::vector<Indices>> before;
    for (const std::uint32_t f : touched) before.push_back(faces_[f].loops);
    vertices_[a] = vertices_[b] = best;
    for (const std::uint32_t f : touched) replace(faces_[f], b, a);
    bool sound = true;
    for (std::size_t i = 0; i < touched.size(); ++i)
      if (faces_[touched[i]].loops.empty())
        for (const std::uint32_t v : before[i][0])
          if (v != a && v != b) sound = sound && take_out_passing(v);
    if (!sound || !all_sound(touched)) {
      vertices_[a] = pa;
      vertices_[b] = pb;
      for (std::size_t i = 0; i < touched.size(); ++i) faces_[touched[i]].loops = std::move(before[i]);
      return false;
    }
    for (std::size_t i = 0; i < touched.size(); ++i)
      for (const Indices& loop : before[i])
        for (const std::uint32_t v : loop)
          if (v == a || v == b || !is_corner(faces_[touched[i]], v)) std::erase(around_[v], touched[i]);
    for (const std::uint32_t f : touched)
      if (is_corner(faces_[f], a)) around_[a].push_back(f);
    return true;
  }

  static void replace(model::Face& face, std::uint32_t old, std::uint32_t with) {
    for (auto& loop : face.loops) {
      std::ranges::replace(loop, old, with);
      const auto repeated = std::ranges::unique(loop);
      loop.erase(repeated.begin(), repeated.end());
      if (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    }
    if (face.loops[0].size() < 3) face.loops.clear();
  }

  /// A corner of three faces, of which one has vanished, lies inside an arc now: taken out. False where that leaves
  /// nothing of a loop.
  auto take_out_passing(std::uint32_t v) -> bool {
    Indices left;
    for (const std::uint32_t f : around_[v])
      if (is_corner(faces_[f], v)) left.push_back(f);
    if (left.size() != 2) return true;
    for (const std::uint32_t f : left)
      for (auto& loop : faces_[f].loops)
        if (std::erase(loop, v) > 0 && loop.size() < 3) return false;
    return true;
  }

  /// No face turned over or crossing itself; exact for the rounded points.
  auto all_sound(const Indices& touched) -> bool {
    return std::ranges::all_of(touched, [&](std::uint32_t f) {
      triangles_.clear();
      return faces_[f].loops.empty() || triangulator_.append(faces_[f], faces_[f].normal, triangles_);
    });
  }

  std::vector<Point3>& vertices_;
  std::vector<model::Face>& faces_;
  const std::vector<double>& offsets_;
  double short_arc_;             ///< m
  std::vector<Indices> around_;  ///< the faces at each vertex
  solid::Triangulator triangulator_;
  std::vector<solid::Corners> triangles_;
  std::size_t joined_ = 0;
};

/// Numbers the vertices in the order in which the faces name them, and leaves out those that none does.
void renumber(model::Solid& solid) {
  Indices index(solid.vertices.size(), UINT32_MAX);
  std::vector<Point3> used;
  used.reserve(solid.vertices.size());
  for (model::Face& face : solid.faces)
    for (auto& loop : face.loops)
      for (std::uint32_t& v : loop) {
        if (index[v] == UINT32_MAX) {
          index[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(solid.vertices[v]);
        }
        v = index[v];
      }
  solid.vertices = std::move(used);
}

}  // namespace

auto on_grid(Point3 p, double grid) -> Point3 {
  if (grid <= 0) return p;
  // An integer number of steps per metre gives the double that a file's decimals give.
  const double steps = std::round(1 / grid);
  const auto round = [&](double v) { return steps >= 1 ? std::round(v * steps) / steps : std::round(v / grid) * grid; };
  return {round(p.x), round(p.y), round(p.z)};
}

auto rounded(const ExactSurface& surface, const Placement& placement, double short_arc) -> Rounded {
  Rounded result;
  model::Solid& solid = result.solid;
  solid.vertices = surface.places;
  solid.faces.reserve(surface.faces.size());
  for (const auto& face : surface.faces) {
    model::Face out{face.loops, face.node.kind, std::nullopt, normal_of(face.node)};
    if (out.kind == model::FaceKind::side || out.kind == model::FaceKind::terrace)
      out.provenance = face.node.provenance;
    solid.faces.push_back(std::move(out));
  }
  const auto offsets = offsets_of(solid);
  if (has_short_arc(solid, short_arc)) result.collapsed = Collapse(solid, offsets, short_arc).run();
  renumber(solid);

  const Point3 shift{placement.origin.x, placement.origin.y, placement.base};
  for (Point3& p : solid.vertices) p = on_grid(p + shift, placement.grid);
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    for (const auto& loop : solid.faces[f].loops)
      for (const std::uint32_t v : loop)
        result.residual =
            std::max(result.residual, std::abs(dot(solid.faces[f].normal, solid.vertices[v] - shift) - offsets[f]));
  std::erase_if(solid.faces, [](const model::Face& face) { return face.loops.empty(); });
  return result;
}

}  // namespace mansard::extrude::detail
