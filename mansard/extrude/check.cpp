// Everything that can be wrong with a solid, looked for without trust in how it was made.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/intersect.hpp"
#include "mansard/extrude/detail/measure.hpp"
#include "mansard/extrude/extrude.hpp"

namespace mansard::extrude {
namespace {

using geometry::Point3;
using Directed = std::pair<std::uint32_t, std::uint32_t>;

auto place(Point3 p) -> std::string {
  return "(" + base::to_text(p.x, 3) + ", " + base::to_text(p.y, 3) + ", " + base::to_text(p.z, 3) + ")";
}

class Check {
 public:
  Check(const Solid& solid, double planar) : solid_(solid), planar_(planar) {}

  auto all() -> std::vector<base::Diagnostic> {
    if (solid_.faces.empty()) fault("solid-degenerate", "the solid has no faces");
    if (!find_degenerate()) return std::move(faults_);  // nothing else can be asked of broken loops
    find_open_edges();
    find_split_vertices();
    find_bent_faces();
    find_inside_out();
    find_intersections();
    return std::move(faults_);
  }

 private:
  /// One diagnostic a kind, with its first place.
  void fault(std::string code, std::string message) {
    if (std::ranges::none_of(faults_, [&](const auto& f) { return f.code == code; }))
      faults_.push_back(base::error(std::move(code), std::move(message)));
  }

  auto find_degenerate() -> bool {
    for (const Point3 p : solid_.vertices)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return fault("solid-degenerate", "a vertex is not finite"), false;
    std::vector<std::uint32_t> order;
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const Face& face = solid_.faces[f];
      const std::string name = "face " + std::to_string(f);
      if (face.loops.empty()) return fault("solid-degenerate", name + " has no boundary"), false;
      for (const auto& loop : face.loops) {
        if (loop.size() < 3) return fault("solid-degenerate", name + " has a loop of fewer than three vertices"), false;
        std::set<std::uint32_t> seen;
        for (const std::uint32_t v : loop) {
          if (v >= solid_.vertices.size())
            return fault("solid-degenerate", name + " names a vertex that is not there"), false;
          if (!seen.insert(v).second)
            fault("solid-degenerate", name + " comes to " + place(solid_.vertices[v]) + " twice");
        }
        order.insert(order.end(), loop.begin(), loop.end());
      }
      if (length(detail::area_vector(solid_, face)) < 1e-12) fault("solid-degenerate", name + " has no area");
    }
    std::ranges::sort(order);
    order.erase(std::ranges::unique(order).begin(), order.end());
    std::ranges::sort(order, {}, [&](std::uint32_t v) { return solid_.vertices[v]; });
    for (std::size_t i = 0; i + 1 < order.size(); ++i)
      if (solid_.vertices[order[i]] == solid_.vertices[order[i + 1]])
        fault("solid-degenerate", "two vertices lie at " + place(solid_.vertices[order[i]]));
    return faults_.empty();
  }

  void find_open_edges() {
    for (std::size_t f = 0; f < solid_.faces.size(); ++f)
      for (const auto& loop : solid_.faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
          faces_of_[{loop[i], loop[(i + 1) % loop.size()]}].push_back(static_cast<std::uint32_t>(f));
    for (const auto& [edge, faces] : faces_of_) {
      const auto opposite = faces_of_.find({edge.second, edge.first});
      const std::string where =
          "at the edge from " + place(solid_.vertices[edge.first]) + " to " + place(solid_.vertices[edge.second]);
      if (opposite == faces_of_.end()) fault("solid-open", "a face has no neighbour " + where);
      else if (faces.size() > 1) fault("solid-non-manifold", "more than two faces meet " + where);
    }
  }

  /// At every vertex the corners of its faces must form one fan.
  void find_split_vertices() {
    struct Corner {
      std::uint32_t before, after;
    };
    std::vector<std::vector<Corner>> corners(solid_.vertices.size());
    for (const Face& face : solid_.faces)
      for (const auto& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
          corners[loop[i]].push_back({loop[(i + loop.size() - 1) % loop.size()], loop[(i + 1) % loop.size()]});
    for (std::uint32_t v = 0; v < corners.size(); ++v) {
      if (corners[v].empty()) continue;
      std::map<std::uint32_t, std::uint32_t> turn;  // from the edge out of a corner to the edge into it
      for (const Corner& c : corners[v]) turn[c.after] = c.before;
      std::size_t steps = 0;
      const std::uint32_t start = corners[v].front().after;
      std::uint32_t at = start;
      do {
        const auto next = turn.find(at);
        if (next == turn.end()) break;  // an open edge, reported as such
        at = next->second;
        ++steps;
      } while (at != start && steps <= corners[v].size());
      if (at == start && steps != corners[v].size())
        fault("solid-non-manifold", "faces that are no neighbours share the vertex " + place(solid_.vertices[v]));
    }
  }

  void find_bent_faces() {
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const Face& face = solid_.faces[f];
      const double l = length(face.normal);
      const Point3 n = l > 0 ? (1 / l) * face.normal : normalised(detail::area_vector(solid_, face));
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (const auto& loop : face.loops)
        for (const std::uint32_t v : loop) {
          const double d = dot(n, solid_.vertices[v] - solid_.vertices[face.loops[0][0]]);
          least = std::min(least, d);
          most = std::max(most, d);
        }
      if ((most - least) / 2 > planar_)
        fault("solid-not-planar",
              "face " + std::to_string(f) + " bends by " + base::to_text((most - least) / 2, 4) + " m");
    }
  }

  /// Every shell must hold a positive volume, and every face's normal agree with its boundary.
  void find_inside_out() {
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const Face& face = solid_.faces[f];
      if (length(face.normal) > 0 && dot(face.normal, detail::area_vector(solid_, face)) <= 0)
        fault("solid-orientation", "the normal of face " + std::to_string(f) + " is against its boundary");
    }
    std::vector<std::uint32_t> shell(solid_.faces.size());
    std::iota(shell.begin(), shell.end(), 0U);
    const auto root = [&](std::uint32_t f) {
      while (shell[f] != f) f = shell[f] = shell[shell[f]];
      return f;
    };
    for (const auto& [edge, faces] : faces_of_) {
      const auto opposite = faces_of_.find({edge.second, edge.first});
      if (opposite == faces_of_.end()) continue;
      const std::uint32_t a = root(faces.front()), b = root(opposite->second.front());
      shell[std::max(a, b)] = std::min(a, b);
    }
    std::map<std::uint32_t, double> volumes;
    const Point3 o = solid_.vertices[solid_.faces[0].loops[0][0]];
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f) {
      const Face& face = solid_.faces[f];
      volumes[root(f)] += dot(detail::area_vector(solid_, face), solid_.vertices[face.loops[0][0]] - o) / 6;
    }
    for (const auto& [first, volume] : volumes)
      if (volume <= 0) fault("solid-orientation", "the shell of face " + std::to_string(first) + " is inside out");
  }

  void find_intersections() {
    std::vector<detail::Corners> triangles;
    std::vector<std::uint32_t> face_of;
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f) {
      const auto part = detail::triangles_of(solid_, solid_.faces[f]);
      const geometry::Polygon flat = detail::projected(solid_, solid_.faces[f]);
      if (!part) {
        fault("solid-self-intersection", "the boundary of face " + std::to_string(f) + " crosses itself");
        continue;
      }
      const double whole = geometry::area(flat);
      double sum = 0;
      for (const auto& t : *part)
        sum += length(cross(solid_.vertices[t[1]] - solid_.vertices[t[0]],
                            solid_.vertices[t[2]] - solid_.vertices[t[0]])) /
               2;
      // On the coordinate plane the area shrinks by the normal's largest part.
      const Point3 n = detail::area_vector(solid_, solid_.faces[f]);
      const double shrink = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) / length(n);
      if (std::abs(sum * shrink - whole) > 1e-6 + 1e-6 * whole)
        fault("solid-self-intersection", "the boundary of face " + std::to_string(f) + " crosses itself");
      for (const auto& t : *part) {
        triangles.push_back(t);
        face_of.push_back(f);
      }
    }
    const auto [p, q] = detail::first_intersection(solid_.vertices, triangles, face_of);
    if (p < triangles.size())
      fault("solid-self-intersection", "faces " + std::to_string(face_of[p]) + " and " + std::to_string(face_of[q]) +
                                           " meet near " + place(solid_.vertices[triangles[p][0]]));
  }

  const Solid& solid_;
  const double planar_;
  std::map<Directed, std::vector<std::uint32_t>> faces_of_;
  std::vector<base::Diagnostic> faults_;
};

}  // namespace

auto check(const Solid& solid, double planar) -> std::vector<base::Diagnostic> { return Check(solid, planar).all(); }

}  // namespace mansard::extrude
