#include "mansard/accuracy/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "mansard/accuracy/detail/noise.hpp"
#include "mansard/accuracy/detail/transects.hpp"
#include "mansard/base/statistics.hpp"

namespace mansard::accuracy {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr std::size_t most_places = 700;
constexpr double finest = 0.5;  // m between places
/// m: in smaller discs, the noise of points that were matched is one error, and looks like none.
constexpr double least_of_points = 1;
constexpr double least_noise = 1e-3;  // m: of less no scan was measured
constexpr double upright = 1e-6;      // cosine from above of what is an exact wall, with rounding
constexpr double coarse = 0.6;        // m: of a mesh whose vertices are farther apart, few discs hold one roof alone

/// Three digits: what a logarithm's last bit says is not that of another processor.
auto rounded(double value) -> double {
  if (!(value > 0)) return 0;
  const double scale = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return std::round(value / scale) * scale;
}

/// The vertices of what faces up.
auto roof_vertices(const geometry::Mesh& mesh) -> std::vector<Point3> {
  std::vector<Point3> normals(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const Point3 n = cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const auto v : t) normals[v] = normals[v] + n;
  }
  std::vector<Point3> out;
  for (std::size_t v = 0; v < normals.size(); ++v)
    if (std::abs(normals[v].z) > detail::faces_up * length(normals[v])) out.push_back(mesh.vertices[v]);
  return out;
}

/// So many of them, evenly.
template <class T>
auto thinned(const std::vector<T>& all, std::size_t most) -> std::vector<T> {
  std::vector<T> out;
  const std::size_t every = std::max<std::size_t>(1, all.size() / most);
  for (std::size_t i = 0; i < all.size(); i += every) out.push_back(all[i]);
  return out;
}

/// Streets and yards are of the same scan as roofs, and of a single house there is too little roof. The mesh of a block
/// ends 5 m from it.
constexpr double near_outline = 4;  // m
auto is_near(std::span<const geometry::Polygon> outline, Point2 at) -> bool {
  return std::ranges::any_of(outline, [&](const geometry::Polygon& polygon) {
    return geometry::bounds(polygon.outer).grown(near_outline).contains(at) &&
           (geometry::contains(polygon, at) || geometry::boundary_distance(polygon, at) < near_outline);
  });
}

/// On a grid over the outline and what is near it.
auto places_over(std::span<const geometry::Polygon> outline) -> std::vector<Point2> {
  const auto box = geometry::bounds(outline).grown(near_outline);
  if (box.empty()) return {};
  const Point2 size = box.most - box.least;
  const double apart = std::max(finest, std::sqrt(size.x * size.y / most_places));
  std::vector<Point2> out;
  const Point2 first{std::floor(box.least.x), std::floor(box.least.y)};  // a shift by whole metres moves all of them
  for (double y = first.y + apart / 2; y < box.most.y; y += apart)
    for (double x = first.x + apart / 2; x < box.most.x; x += apart) {
      const Point2 at{x, y};
      if (is_near(outline, at)) out.push_back(at);
    }
  return out;
}

void put_noise(const std::optional<detail::Noise>& found, model::Accuracy& out) {
  if (!found) return;
  out.noise = rounded(found->noise);
  out.correlated_area = rounded(found->correlated_area);
  out.windows = found->discs;
}

/// What noise is measured by: the points of a cloud, the vertices of a surface.
auto samples_of(const geometry::Mesh& mesh) -> detail::Cells {
  return detail::Cells(mesh.points.empty() ? roof_vertices(mesh) : mesh.points);
}

/// Some of the samples, evenly.
auto places_on(const detail::Cells& samples) -> std::vector<Point2> {
  std::vector<Point2> out;
  for (const Point3 p : thinned(samples.points(), most_places)) out.push_back(xy(p));
  return out;
}

void put_noise_of_points(const detail::Cells& points, std::span<const Point2> places, double ground,
                         model::Accuracy& out) {
  put_noise(detail::noise_from(points.residuals(places, ground, least_of_points), ground), out);
}

/// A coarse mesh has its vertices where it bends, so that most discs over a small roof hold several of its faces.
void put_noise_of_surface(const geometry::Mesh& mesh, const detail::Cells& vertices, std::span<const Point2> places,
                          double ground, const std::function<bool(Point2)>& seen, model::Accuracy& out) {
  if (out.spacing <= coarse) put_noise(detail::noise_from(vertices.residuals(places, ground), ground), out);
  if (out.windows == 0) put_noise(detail::noise_of_vertices(mesh, seen, ground), out);
}

/// m²: the ground of one sample, which is the spacing too.
auto put_spacing(const detail::Cells& samples, std::span<const Point2> places, model::Accuracy& out) -> double {
  const double ground = samples.ground_of_one(places);
  out.spacing = rounded(std::sqrt(ground));
  return ground;
}

void put_noise(const geometry::Mesh& mesh, const detail::Cells& samples, std::span<const Point2> places,
               const std::function<bool(Point2)>& seen, model::Accuracy& out) {
  if (places.empty()) return;
  const double ground = put_spacing(samples, places, out);
  if (mesh.points.empty()) return put_noise_of_surface(mesh, samples, places, ground, seen, out);
  put_noise_of_points(samples, places, ground, out);
  // Where noise is one error over so many points, the plane through a point and its neighbours shows the noise rather
  // than the roof: a point is no measurement of its own.
  constexpr double most_points = 50;  // four dozen neighbours
  if (out.windows > 0 && out.correlated_area < most_points * ground) out.point_area = ground;
}

/// Whether the vertices of a surface are what was measured, and its triangles only what was drawn between them: every
/// vertical line meets it once; vertices are as dense everywhere, so that none were left out or put where it bends;
/// each has an error of its own; and edges are no rounder than triangles between a roof and the ground are.
auto vertices_are_points(const geometry::Mesh& mesh, const model::Accuracy& scan) -> bool {
  constexpr double of_own = 2;      // vertices over which noise is one error
  constexpr double sharp = 0.8;     // spacings: triangles between roof and ground have a blur of 0.3 to 0.75
  constexpr double one_way = 0.99;  // of the triangles: where tiles meet some may overlap
  constexpr double even = 4;        // of Delaunay triangles of random points half of the ground is in those of 1.6
  if (!mesh.points.empty() || scan.windows == 0 || mesh.triangles.empty()) return false;
  if (scan.correlated_area > of_own * scan.spacing * scan.spacing || scan.blur > sharp * scan.spacing) return false;
  std::vector<double> areas;
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]];
    const Point3 across = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    if (!(across.z > upright * length(across))) continue;
    areas.push_back(across.z / 2);
    sum += across.z / 2;
  }
  const auto count = static_cast<double>(areas.size());
  if (count < one_way * static_cast<double>(mesh.triangles.size())) return false;
  double large = 0;
  for (const double area : areas)
    if (area > even * sum / count) large += area;
  return 2 * large < sum;
}

void put(const std::optional<double>& given, double& to) { to = given.value_or(to); }

}  // namespace

auto measure_noise(const geometry::Mesh& mesh, std::span<const geometry::Polygon> outline, const Options& o)
    -> model::Accuracy {
  model::Accuracy out;
  if (!o.noise || !o.correlated_area || !o.spacing) {
    const auto places = places_over(outline);
    put_noise(
        mesh, samples_of(mesh), places, [&](Point2 at) { return is_near(outline, at); }, out);
  }
  put(o.noise, out.noise);
  put(o.correlated_area, out.correlated_area);
  put(o.spacing, out.spacing);
  if (out.point_area > 0) out.point_area = rounded(out.spacing * out.spacing);
  return out;
}

auto with_edges(model::Accuracy out, const geometry::Mesh& mesh, const rays::Scene& scene,
                std::span<const geometry::Polygon> outline, const Options& o) -> model::Accuracy {
  // What is assumed of edges is in proportion to the noise: of an exact surface they are exact.
  const double share = std::min(1.0, out.noise / model::Accuracy{}.noise);
  out.blur *= share;
  out.edge_noise *= share;
  if (!o.blur || !o.edge_noise || !o.walls || !o.offset_x || !o.offset_y || !o.offset_spread) {
    const auto transects = detail::across(outline, mesh, scene);
    if (const auto blur = detail::blur_from(transects)) {
      // Even triangles, larger than what a scan rounds: what looks rounded is a steep foot of the roof.
      const bool exact = mesh.points.empty() && out.spacing > coarse && out.noise < least_noise;
      out.blur = exact ? 0 : rounded(*blur);
      out.transects = transects.transects.size();
      double walls = 0;
      for (const auto& one : transects.transects) walls += one.walls;
      out.walls = rounded(walls / static_cast<double>(out.transects));
    }
    if (const auto rough = detail::roughness_of(transects)) out.edge_noise = rounded(*rough);
    if (const auto found = detail::offset_from(transects)) {
      out.offset = found->offset;
      out.offset_error = found->error;
      out.offset_spread = found->spread;
      out.edges = found->edges;
    }
  }
  put(o.blur, out.blur);
  put(o.edge_noise, out.edge_noise);
  put(o.walls, out.walls);
  put(o.offset_x, out.offset.x);
  put(o.offset_y, out.offset.y);
  put(o.offset_spread, out.offset_spread);
  if (vertices_are_points(mesh, out)) out.point_area = rounded(out.spacing * out.spacing);
  return out;
}

auto measure(const geometry::Mesh& mesh, const rays::Scene& scene, std::span<const geometry::Polygon> outline,
             const Options& options) -> model::Accuracy {
  return with_edges(measure_noise(mesh, outline, options), mesh, scene, outline, options);
}

auto measure_alone(const geometry::Mesh& mesh) -> model::Accuracy {
  model::Accuracy out;
  const auto samples = samples_of(mesh);
  put_noise(
      mesh, samples, places_on(samples), [](Point2) { return true; }, out);
  return out;
}

auto noise_of(std::vector<Point3> points) -> model::Accuracy {
  model::Accuracy out;
  const detail::Cells samples(std::move(points));
  const auto places = places_on(samples);
  if (places.empty()) return out;
  put_noise_of_points(samples, places, put_spacing(samples, places, out), out);
  out.blur = 0;
  return out;
}

auto combined(std::span<const model::Accuracy> all) -> model::Accuracy {
  model::Accuracy out;
  const auto middle = [&](auto value, auto weight) -> std::optional<double> {
    std::vector<std::pair<double, double>> values;
    for (const auto& one : all)
      if (const double w = static_cast<double>(weight(one)); w > 0) values.emplace_back(value(one), w);
    if (values.empty()) return std::nullopt;
    std::ranges::sort(values);
    using Weighed = std::pair<double, double>;
    return base::weighted_percentile_of_sorted(values, 0.5, &Weighed::first, &Weighed::second);
  };
  const auto windows = [](const auto& one) { return one.windows; };
  const auto transects = [](const auto& one) { return one.transects; };
  put(middle([](const auto& one) { return one.noise; }, windows), out.noise);
  put(middle([](const auto& one) { return one.correlated_area; }, windows), out.correlated_area);
  put(middle([](const auto& one) { return one.spacing; }, windows), out.spacing);
  put(middle([](const auto& one) { return one.point_area; }, windows), out.point_area);
  put(middle([](const auto& one) { return one.blur; }, transects), out.blur);
  put(middle([](const auto& one) { return one.edge_noise; }, transects), out.edge_noise);
  put(middle([](const auto& one) { return one.walls; }, transects), out.walls);
  // An error that was estimated from few walls may be small by chance: none counts as less than the median.
  const auto edges = [](const auto& one) { return one.edges; };
  const double usual = middle([](const auto& one) { return one.offset_error; }, edges).value_or(0);
  double weight = 0;
  Point2 sum;
  for (const auto& one : all) {
    out.windows += one.windows, out.transects += one.transects, out.edges += one.edges;
    if (one.edges == 0) continue;
    const double error = std::max({1e-3, usual, one.offset_error}), w = 1 / (error * error);
    weight += w;
    sum = sum + w * one.offset;
  }
  if (weight > 0) {
    out.offset = (1 / weight) * sum;
    out.offset_error = std::sqrt(1 / weight);
    put(middle([](const auto& one) { return one.offset_spread; }, edges), out.offset_spread);
  }
  return out;
}

}  // namespace mansard::accuracy
