#include "mansard/refine/detail/bare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/extent.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

auto width_of(const model::Solid& solid, const model::Face& face) -> double {
  std::vector<Point2> points;
  for (const auto v : face.loops.front()) points.push_back(xy(solid.vertices[v]));
  return geometry::extent_of(std::move(points)).width;
}

/// Whether every corner of the face lies in the plane of the other, and both face the same way.
auto continues(const model::Solid& solid, const model::Face& face, const model::Face& other, double noise) -> bool {
  constexpr double same_turn = 0.9994;  // the cosine of 2°: over the 3 m of a small face, half of the noise
  if (dot(face.normal, other.normal) < same_turn) return false;
  const Point3 at = solid.vertices[other.loops.front().front()];
  return std::ranges::all_of(face.loops.front(), [&](std::uint32_t v) {
    return std::abs(dot(solid.vertices[v] - at, other.normal)) <= noise;
  });
}

/// m: of a face along a curve, from its lower edge to its upper one, as it is seen from above.
auto depth_of(const model::Solid& solid, const model::Face& face) -> double {
  const Point2 up = geometry::normalised(xy(face.normal));
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const auto v : face.loops.front()) {
    const double at = dot(up, xy(solid.vertices[v]));
    least = std::min(least, at), most = std::max(most, at);
  }
  return most - least;
}

/// m², per strip, of what is measured on it and away from its edges; of steep faces only.
auto carried(const model::Solid& solid, const FaceStrips& strips, const View& view, const Site& site,
             const std::vector<bool>& steep, double noise) -> std::vector<double> {
  std::vector<double> out(strips.count, 0);
  const auto& grid = site.measured;
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const auto cell = site.cells[i];
    if (std::isnan(view.z_of(site, i))) continue;
    const auto f = view.face_of(site, i);
    if (!steep[f]) continue;
    const std::size_t column = cell % grid.columns, row = cell / grid.columns;
    if (column == 0 || row == 0 || column + 1 == grid.columns || row + 1 == grid.rows) continue;
    const auto same = [&](std::size_t other) {
      return !std::isnan(view.z[other]) && strips.of_face[view.face[other]] == strips.of_face[f];
    };
    if (!same(cell - 1) || !same(cell + 1) || !same(cell - grid.columns) || !same(cell + grid.columns)) continue;
    const double upright = solid.faces[f].normal.z;
    if (std::abs(view.z_of(site, i) - site.z[i]) * upright <= noise)
      out[strips.of_face[f]] += site.sample_area / upright;
  }
  return out;
}

}  // namespace

auto bare_faces(const FaceStrips& strips, const model::Solid& solid, const View& view, const Site& site,
                const Options& options) -> std::vector<std::uint32_t> {
  std::vector<std::uint32_t> faces_of(strips.count, 0);
  for (const auto strip : strips.of_face) ++faces_of[strip];
  const auto& o = options.bare;
  const double between = std::max(options.grid, site.of_points ? std::sqrt(site.sample_area) : 0);  // m
  const double steepest = geometry::cosine(o.steep), least = static_cast<double>(o.cells) * between;
  std::vector<std::uint32_t> wide, narrow;
  std::vector<bool> steep(solid.faces.size(), false);
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const auto& face = solid.faces[f];
    if (!(face.normal.z > wall_normal)) continue;
    // Along a curve samples are at all distances from it: together they show what is as narrow as one of them.
    const bool of_curve = faces_of[strips.of_face[f]] > 1;
    const bool is_wide = of_curve ? depth_of(solid, face) >= between : width_of(solid, face) >= least;
    (is_wide ? wide : narrow).push_back(f);
    steep[f] = is_wide && face.normal.z < steepest;
  }
  std::vector<std::uint32_t> out;
  std::vector<bool> listed(strips.count, false);
  const auto list = [&](std::uint32_t f) {
    if (!listed[strips.of_face[f]]) out.push_back(f);
    listed[strips.of_face[f]] = true;
  };
  for (const auto f : narrow)
    if (std::ranges::none_of(wide, [&](auto w) { return continues(solid, solid.faces[f], solid.faces[w], o.noise); }))
      list(f);
  if (std::ranges::find(steep, true) == steep.end()) return out;
  const auto on = carried(solid, strips, view, site, steep, o.noise);
  for (const auto f : wide)
    if (steep[f] && on[strips.of_face[f]] < o.area) list(f);
  return out;
}

}  // namespace mansard::refine::detail
