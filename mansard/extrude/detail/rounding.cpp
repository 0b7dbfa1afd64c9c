#include "mansard/extrude/detail/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace mansard::extrude::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

auto normal_of(const FaceNode& node) -> Point3 {
  if (node.kind == FaceKind::base) return {0, 0, -1};
  if (node.kind == FaceKind::cap || node.kind == FaceKind::terrace) return {0, 0, 1};
  const Point2 inward = left_of(node.direction.approximate());
  const double slope = node.kind == FaceKind::connector ? 0 : node.slope.get_d();
  return normalised(Point3{-inward.x, -inward.y, slope});
}

/// The face seen from outside along the axis nearest to its normal.
auto seen(Point3 normal, Point3 p) -> Point2 {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (z >= x && z >= y) return normal.z > 0 ? Point2{p.x, p.y} : Point2{p.y, p.x};
  if (x >= y) return normal.x > 0 ? Point2{p.y, p.z} : Point2{p.z, p.y};
  return normal.y > 0 ? Point2{p.z, p.x} : Point2{p.x, p.z};
}

/// Draws short edges together, one after the other, shortest first.
class Collapse {
 public:
  Collapse(std::vector<Point3>& vertices, std::vector<Face>& faces) : vertices_(vertices), faces_(faces) {
    around_.resize(vertices.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      const Point3 n = faces[f].normal;
      double least = dot(n, vertices[faces[f].loops[0][0]]), most = least;
      for (const auto& loop : faces[f].loops)
        for (const std::uint32_t v : loop) {
          around_[v].insert(f);
          least = std::min(least, dot(n, vertices[v]));
          most = std::max(most, dot(n, vertices[v]));
        }
      offsets_.push_back((least + most) / 2);
    }
  }

  void run() {
    while (pass()) {
    }
    std::erase_if(faces_, [](const Face& face) { return face.loops.empty(); });
  }

 private:
  /// Tries every short edge once; whether one was drawn together.
  auto pass() -> bool {
    constexpr double short_edge = 1e-3;
    std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> edges;
    for (const Face& face : faces_)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
          const double l = length(vertices_[b] - vertices_[a]);
          if (a < b && l < short_edge) edges.emplace_back(l, a, b);
        }
    std::ranges::sort(edges);
    bool joined = false;
    for (const auto& [l, a, b] : edges)
      if (!around_[a].empty() && !around_[b].empty() && share_an_edge(a, b) && try_to_join(a, b)) joined = true;
    return joined;
  }

  [[nodiscard]] auto follows(const Face& face, std::uint32_t a, std::uint32_t b) const -> bool {
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (loop[i] == a && loop[(i + 1) % loop.size()] == b) return true;
    return false;
  }
  [[nodiscard]] auto share_an_edge(std::uint32_t a, std::uint32_t b) const -> bool {
    return std::ranges::any_of(around_[a], [&](std::uint32_t f) { return follows(faces_[f], a, b); });
  }

  [[nodiscard]] auto neighbours(std::uint32_t v) const -> std::set<std::uint32_t> {
    std::set<std::uint32_t> found;
    for (const std::uint32_t f : around_[v])
      for (const auto& loop : faces_[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
          if (loop[i] == v) {
            found.insert(loop[(i + 1) % loop.size()]);
            found.insert(loop[(i + loop.size() - 1) % loop.size()]);
          }
    return found;
  }

  /// The link condition: a and b share the two faces along their edge only, and a common neighbour only as the third
  /// corner of a triangle among these.
  [[nodiscard]] auto topology_allows(std::uint32_t a, std::uint32_t b) const -> bool {
    std::size_t triangles = 0;
    for (const std::uint32_t f : around_[a]) {
      if (!around_[b].contains(f)) continue;
      if (!follows(faces_[f], a, b) && !follows(faces_[f], b, a)) return false;
      if (faces_[f].loops.size() == 1 && faces_[f].loops[0].size() == 3) ++triangles;
      for (const auto& loop : faces_[f].loops) {
        const bool with = std::ranges::find(loop, a) != loop.end() || std::ranges::find(loop, b) != loop.end();
        if (with && loop.size() == 3 && faces_[f].loops.size() > 1) return false;
      }
    }
    const auto of_a = neighbours(a), of_b = neighbours(b);
    std::size_t common = 0;
    for (const std::uint32_t v : of_a) common += of_b.contains(v) ? 1 : 0;
    return common == triangles;
  }

  /// The point nearest to all the planes (least squares), held near `start` where they leave it free.
  [[nodiscard]] auto compromise(const std::set<std::uint32_t>& touched, Point3 start) const -> Point3 {
    constexpr double hold = 1e-6;
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

  auto try_to_join(std::uint32_t a, std::uint32_t b) -> bool {
    if (!topology_allows(a, b)) return false;
    std::set<std::uint32_t> touched = around_[a];
    touched.insert(around_[b].begin(), around_[b].end());

    const Point3 pa = vertices_[a], pb = vertices_[b];
    const auto residual = [&](Point3 p) {
      double most = 0;
      for (const std::uint32_t f : touched) most = std::max(most, std::abs(dot(faces_[f].normal, p) - offsets_[f]));
      return most;
    };
    constexpr double allowed = 4e-5;  // of the 1e-4 m within which a face is planar
    Point3 best = pa;
    for (const Point3 p : {pb, 0.5 * (pa + pb), compromise(touched, 0.5 * (pa + pb))})
      if (residual(p) < residual(best)) best = p;
    if (residual(best) > allowed) return false;

    std::vector<std::pair<std::uint32_t, Face>> before;
    for (const std::uint32_t f : touched) before.emplace_back(f, faces_[f]);
    vertices_[a] = vertices_[b] = best;
    bool sound = true;
    for (const std::uint32_t f : touched) {
      replace(faces_[f], b, a);
      sound = sound && (faces_[f].loops.empty() || is_sound(faces_[f]));
    }
    if (!sound) {
      vertices_[a] = pa;
      vertices_[b] = pb;
      for (auto& [f, face] : before) faces_[f] = std::move(face);
      return false;
    }
    for (const auto& [f, face] : before)
      for (const auto& loop : face.loops)
        for (const std::uint32_t v : loop) around_[v].erase(f);
    for (const std::uint32_t f : touched)
      for (const auto& loop : faces_[f].loops)
        for (const std::uint32_t v : loop) around_[v].insert(f);
    return true;
  }

  static void replace(Face& face, std::uint32_t old, std::uint32_t with) {
    for (auto& loop : face.loops) {
      std::ranges::replace(loop, old, with);
      const auto repeated = std::ranges::unique(loop);
      loop.erase(repeated.begin(), repeated.end());
      if (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    }
    if (face.loops[0].size() < 3) face.loops.clear();
  }

  /// Still simple and the same way round, seen along its normal; exact for the rounded points.
  [[nodiscard]] auto is_sound(const Face& face) const -> bool {
    geometry::Polygon polygon;
    for (std::size_t l = 0; l < face.loops.size(); ++l) {
      geometry::Ring ring;
      for (const std::uint32_t v : face.loops[l]) ring.push_back(seen(face.normal, vertices_[v]));
      if ((geometry::signed_area(ring) > 0) != (l == 0)) return false;
      if (l == 0) polygon.outer = std::move(ring);
      else polygon.holes.push_back(std::move(ring));
    }
    return geometry::is_simple(polygon);
  }

  std::vector<Point3>& vertices_;
  std::vector<Face>& faces_;
  std::vector<std::set<std::uint32_t>> around_;
  std::vector<double> offsets_;
};

/// Numbers the vertices in the order in which the faces name them, and leaves out those that none does.
void renumber(Solid& solid) {
  std::vector<std::uint32_t> index(solid.vertices.size(), UINT32_MAX);
  std::vector<Point3> used;
  for (Face& face : solid.faces)
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

auto rounded(const ExactSurface& surface, const Placement& placement, bool collapse) -> Solid {
  Solid solid;
  for (const Trace::Point& p : surface.points) solid.vertices.push_back({p.x.get_d(), p.y.get_d(), p.z.get_d()});
  for (const auto& face : surface.faces) {
    Face out{face.loops, face.node.kind, std::nullopt, normal_of(face.node)};
    if (out.kind == FaceKind::side || out.kind == FaceKind::terrace) out.provenance = face.node.provenance;
    solid.faces.push_back(std::move(out));
  }
  if (collapse) Collapse(solid.vertices, solid.faces).run();
  renumber(solid);
  for (Point3& p : solid.vertices) p = p + Point3{placement.origin.x, placement.origin.y, placement.base};
  return solid;
}

}  // namespace mansard::extrude::detail
