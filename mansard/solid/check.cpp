// Everything that can be wrong with a solid, looked for without trust in how it was made.
#include <algorithm>
#include <cmath>
#include <utility>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/base/text.hpp"
#include "mansard/solid/detail/connectivity.hpp"
#include "mansard/solid/detail/delaunay.hpp"
#include "mansard/solid/detail/fitted_plane.hpp"
#include "mansard/solid/detail/flatness.hpp"
#include "mansard/solid/detail/intersect.hpp"
#include "mansard/solid/detail/measure.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/triangulator.hpp"

namespace mansard::solid {
namespace {

using geometry::Point3;

auto place(Point3 p) -> std::string {
  return "(" + base::to_text(p.x, 3) + ", " + base::to_text(p.y, 3) + ", " + base::to_text(p.z, 3) + ")";
}

/// m²; twice an area below this is none, wherever the face is.
constexpr double no_area = 1e-12;
/// How much of twice a face's area may be rounding. Coordinates are decimals, off by u = 2⁻⁵³ of themselves; the
/// differences that area_vector multiplies by others, below the face's extent, are off by 2 u of the largest
/// coordinate, and there are two such products in each of the three components: less than 2 · 2 · √3 · 2 u a corner. 16
/// u is more.
constexpr double area_rounding = 16 * 0x1.0p-53;

/// Of the faces with more corners than three, the least width as a share of the length at which val3dity 2.6 finds the
/// plane: strips of 1.2 mm by 14 m and of 1.1 mm by 34 m bend by 0.3 mm to it (8e-5 and 4e-5).
constexpr double narrowest = 2e-4;

class Check {
 public:
  Check(const model::Solid& solid, const Rules& rules) : solid_(solid), rules_(rules), planar_(rules.planar) {}

  auto all() -> std::vector<base::Diagnostic> {
    if (solid_.faces.empty()) fault("solid-degenerate", "the solid has no faces");
    if (!find_degenerate()) return std::move(faults_);  // broken loops cannot be checked further
    find_open_edges();
    find_split_vertices();
    find_bent_faces();
    find_inside_out();
    find_intersections();
    find_needles();
    if (rules_.snap > 0) {
      find_near_vertices();
      find_touching_courtyards();
    }
    if (rules_.one_shell) find_several_shells();
    return std::move(faults_);
  }

 private:
  /// One diagnostic a kind, with its first place.
  void fault(std::string code, std::string message) {
    if (std::ranges::none_of(faults_, [&](const auto& f) { return f.code == code; }))
      faults_.push_back(base::error(std::move(code), std::move(message)));
  }

  [[nodiscard]] auto area_error(const model::Face& face) const -> double {
    const Point3 o = solid_.vertices[face.loops[0][0]];
    double far = 0, extent = 0;
    std::size_t corners = 0;
    for (const auto& loop : face.loops)
      for (const std::uint32_t v : loop) {
        const Point3 p = solid_.vertices[v], d = p - o;
        far = std::max({far, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        extent = std::max({extent, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        ++corners;
      }
    return area_rounding * static_cast<double>(corners) * far * extent;
  }

  auto find_degenerate() -> bool {
    for (const Point3 p : solid_.vertices)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return fault("solid-degenerate", "a vertex is not finite"), false;
    const auto name = [](std::size_t f) { return "face " + std::to_string(f); };
    std::vector<std::uint32_t> last_loop(solid_.vertices.size(), 0), used;
    std::uint32_t loops = 0;
    areas_.reserve(solid_.faces.size());
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const model::Face& face = solid_.faces[f];
      if (face.loops.empty()) return fault("solid-degenerate", name(f) + " has no boundary"), false;
      for (const auto& loop : face.loops) {
        if (loop.size() < 3)
          return fault("solid-degenerate", name(f) + " has a loop of fewer than three vertices"), false;
        ++loops;
        for (const std::uint32_t v : loop) {
          if (v >= solid_.vertices.size())
            return fault("solid-degenerate", name(f) + " names a vertex that is not there"), false;
          if (last_loop[v] == loops)
            fault("solid-degenerate", name(f) + " comes to " + place(solid_.vertices[v]) + " twice");
          if (last_loop[v] == 0) used.push_back(v);
          last_loop[v] = loops;
        }
      }
      areas_.push_back(detail::area_vector(solid_, face));
      if (length(areas_.back()) < std::max(no_area, area_error(face)))
        fault("solid-degenerate", name(f) + " has no area");
    }
    std::ranges::sort(used, {}, [&](std::uint32_t v) { return solid_.vertices[v]; });
    for (std::size_t i = 0; i + 1 < used.size(); ++i)
      if (solid_.vertices[used[i]] == solid_.vertices[used[i + 1]])
        fault("solid-degenerate", "two vertices lie at " + place(solid_.vertices[used[i]]));
    return faults_.empty();
  }

  void find_open_edges() {
    connectivity_ = detail::connectivity(solid_);
    const auto& [edges, open, crowded] = connectivity_;
    const auto ends = [&](std::uint32_t h) { return std::pair(edges.origin[h], edges.target(h)); };
    const auto where = [&](std::uint32_t h) {
      const auto [from, to] = ends(h);
      return "at the edge from " + place(solid_.vertices[from]) + " to " + place(solid_.vertices[to]);
    };
    const bool open_first = !open.empty() && (crowded.empty() || ends(open.front()) < ends(crowded.front()));
    if (open_first) fault("solid-open", "a face has no neighbour " + where(open.front()));
    if (!crowded.empty()) fault("solid-non-manifold", "more than two faces meet " + where(crowded.front()));
    if (!open.empty()) fault("solid-open", "a face has no neighbour " + where(open.front()));
  }

  /// At every vertex the corners of its faces must form one fan.
  void find_split_vertices() {
    if (const auto v = detail::split_vertex(solid_, connectivity_.half_edges))
      fault("solid-non-manifold", "faces that are no neighbours share the vertex " + place(solid_.vertices[*v]));
  }

  /// A courtyard that touches the outline in a point: four walls meet there in one vertical line, or lie beside each
  /// other on it within rounding. All faces are in one fan around that vertex, and no edge need be in more than two.
  void find_touching_courtyards() {
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const auto& loops = solid_.faces[f].loops;
      if (loops.size() < 2 || areas_[f].z >= 0) continue;
      corners.clear();
      for (const auto& loop : loops) corners.insert(corners.end(), loop.begin(), loop.end());
      std::ranges::sort(corners);
      const auto twice = std::ranges::adjacent_find(corners);
      if (twice == corners.end()) continue;
      fault("solid-non-manifold", "a courtyard touches the outline at " + place(solid_.vertices[*twice]));
      return;
    }
  }

  void find_bent_faces() {
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const model::Face& face = solid_.faces[f];
      if (rules_.fitted) {
        if (face.loops.size() == 1 && face.loops[0].size() == 3) continue;
        const auto& [middle, normal, furthest, narrow] = detail::fitted_plane(solid_, face);
        if (narrow < narrowest)
          fault("solid-not-planar", "face " + std::to_string(f) + " is too narrow for its plane to be found");
        if (furthest > planar_)
          fault("solid-not-planar", "face " + std::to_string(f) + " bends by " + base::to_text(furthest, 5) + " m");
        continue;
      }
      // The given normal is nearly always near enough; whether the face is planar does not depend on it.
      double bend = detail::bend(solid_, face, length(face.normal) > 0 ? face.normal : areas_[f]);
      if (bend > planar_) bend = detail::least_bend(solid_, face, areas_[f], planar_);
      if (bend > planar_)
        fault("solid-not-planar", "face " + std::to_string(f) + " bends by " + base::to_text(bend, 4) + " m");
    }
  }

  /// Every shell must hold a positive volume, and every face's normal agree with its boundary.
  void find_inside_out() {
    for (std::size_t f = 0; f < solid_.faces.size(); ++f) {
      const model::Face& face = solid_.faces[f];
      if (length(face.normal) > 0 && dot(face.normal, areas_[f]) <= 0)
        fault("solid-orientation", "the normal of face " + std::to_string(f) + " is against its boundary");
    }
    base::DisjointSets shells(solid_.faces.size());
    const HalfEdges& edges = connectivity_.half_edges;
    for (std::uint32_t h = 0; h < edges.size(); ++h)
      if (edges.twin[h] != HalfEdges::none) shells.join(edges.face[h], edges.face[edges.twin[h]]);
    std::vector<double> volumes(solid_.faces.size(), 0);
    const Point3 o = solid_.vertices[solid_.faces[0].loops[0][0]];
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f)
      volumes[shells.of(f)] += dot(areas_[f], solid_.vertices[solid_.faces[f].loops[0][0]] - o) / 6;
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f)
      if (shells.of(f) == f && volumes[f] <= 0)
        fault("solid-orientation", "the shell of face " + std::to_string(f) + " is inside out");
  }

  void find_intersections() {
    Triangulator triangulator(solid_);
    for (std::uint32_t f = 0; f < solid_.faces.size(); ++f) {
      if (!triangulator.append(solid_.faces[f], areas_[f], triangles_))
        fault("solid-self-intersection", "the boundary of face " + std::to_string(f) + " crosses itself");
      face_of_.resize(triangles_.size(), f);
    }
    find_crowded_diagonals();
    const auto [p, q] = detail::first_intersection(solid_, triangles_, face_of_);
    if (p < triangles_.size())
      fault("solid-self-intersection", "faces " + std::to_string(face_of_[p]) + " and " + std::to_string(face_of_[q]) +
                                           " meet near " + place(solid_.vertices[triangles_[p][0]]));
  }

  /// An edge that runs through the inside of a face from corner to corner: triangles that share corners there do not
  /// intersect, but three or four of them meet in one edge.
  void find_crowded_diagonals() {
    std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> edges;  // with a face
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(triangles_[t][i], triangles_[t][(i + 1) % 3]);
        edges.push_back({{a, b}, face_of_[t]});
      }
    std::ranges::sort(edges);
    for (std::size_t i = 2; i < edges.size(); ++i)
      if (edges[i].first == edges[i - 2].first)
        fault("solid-self-intersection", "faces " + std::to_string(edges[i - 2].second) + " and " +
                                             std::to_string(edges[i].second) + " meet near " +
                                             place(solid_.vertices[edges[i].first[0]]));
  }

  /// A face may be flat within tolerance and yet have triangles, as wide as that tolerance, that look anywhere. Viewers
  /// shade them, and val3dity refuses them (204). Faces that are allowed to bend more are not checked.
  void find_needles() {
    constexpr double flat = 1e-4;                // m; the default of `planar`
    constexpr double least_cosine = 0.93969262;  // of 20°, val3dity's tolerance of normals
    if (planar_ > flat) return;
    if (rules_.fitted) cut_as_validators_do();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t];
      const Point3 o = solid_.vertices[a], n = cross(solid_.vertices[b] - o, solid_.vertices[c] - o);
      const Point3 area = areas_[face_of_[t]];
      if (!(dot(n, area) >= least_cosine * length(n) * length(area)))
        fault("solid-needle", "a triangle of face " + std::to_string(face_of_[t]) + " looks aside near " + place(o));
    }
  }

  void cut_as_validators_do() {
    std::vector<Corners> of_face;
    for (std::size_t first = 0, last = 0; first < triangles_.size(); first = last) {
      while (last < triangles_.size() && face_of_[last] == face_of_[first]) ++last;
      if (last - first < 2) continue;
      const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first);
      of_face.assign(begin, triangles_.begin() + static_cast<std::ptrdiff_t>(last));
      detail::make_delaunay(solid_, areas_[face_of_[first]], of_face);
      std::ranges::copy(of_face, begin);
    }
  }

  void find_near_vertices() {
    std::vector<std::uint8_t> is_used(solid_.vertices.size(), 0);
    for (const auto& face : solid_.faces)
      for (const auto& loop : face.loops)
        for (const auto v : loop) is_used[v] = 1;
    std::vector<Point3> used;
    for (std::size_t v = 0; v < is_used.size(); ++v)
      if (is_used[v] != 0) used.push_back(solid_.vertices[v]);
    std::ranges::sort(used);
    for (std::size_t i = 0; i < used.size(); ++i)
      for (std::size_t k = i; k-- > 0 && used[i].x - used[k].x < rules_.snap;)
        if (length(used[i] - used[k]) < rules_.snap)
          return fault("solid-near-vertices", "two vertices are " + base::to_text(length(used[i] - used[k]), 5) +
                                                  " m apart at " + place(used[i]));
  }

  void find_several_shells() {
    base::DisjointSets sets(solid_.vertices.size());
    for (const auto& face : solid_.faces)
      for (const auto& loop : face.loops)
        for (const auto v : loop) sets.join(v, face.loops[0][0]);
    const std::uint32_t first = sets.of(solid_.faces[0].loops[0][0]);
    for (std::size_t f = 0; f < solid_.faces.size(); ++f)
      if (sets.of(solid_.faces[f].loops[0][0]) != first)
        return fault("solid-several-shells", "face " + std::to_string(f) + " is not connected with the first face");
  }

  const model::Solid& solid_;
  const Rules rules_;
  const double planar_;
  detail::Connectivity connectivity_;
  std::vector<Point3> areas_;  ///< Newell's vectors of the faces
  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> face_of_;  ///< of each triangle
  std::vector<base::Diagnostic> faults_;
};

}  // namespace

auto written_rules() -> Rules {
  constexpr double snap = 1.05e-3;  // m; val3dity's default is 1 mm, and a distance of 1 mm is none to it
  return {1e-4, true, snap, true};
}

auto check(const model::Solid& solid, const Rules& rules) -> std::vector<base::Diagnostic> {
  return Check(solid, rules).all();
}

}  // namespace mansard::solid
