#include "mansard/accuracy/accuracy.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/accuracy/detail/noise.hpp"
#include "mansard/accuracy/detail/transects.hpp"
#include "mansard/base/run.hpp"
#include "mansard/base/statistics.hpp"

namespace mansard::accuracy {
namespace {

using geometry::Point2;
using geometry::Point3;

constexpr std::size_t most_places = 700;
constexpr double most_samples = 40'000;
constexpr double finest = 0.5;                               // m between places
constexpr double coarse = 0.6;                               // m: a mesh whose vertices are farther apart is sampled
constexpr double triangles = 1.5, largest_of_several = 2.5;  // spacings, and m
constexpr double faces_up = 0.5;                             // cosine of 60°: steeper is no roof

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
    if (std::abs(normals[v].z) > faces_up * length(normals[v])) out.push_back(mesh.vertices[v]);
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

/// On a grid over the outline and what is near it: streets and yards are of the same scan as roofs, and of a single
/// house there is too little roof.
auto places_over(std::span<const geometry::Polygon> outline, double most) -> std::vector<Point2> {
  constexpr double beside = 4;  // m; the mesh of a block ends 5 m from it
  const auto box = geometry::bounds(outline).grown(beside);
  if (box.empty()) return {};
  const Point2 size = box.most - box.least;
  const double apart = std::max(finest, std::sqrt(size.x * size.y / most));
  std::vector<Point2> out;
  const Point2 first{std::floor(box.least.x), std::floor(box.least.y)};  // a shift by whole metres moves all of them
  for (double y = first.y + apart / 2; y < box.most.y; y += apart)
    for (double x = first.x + apart / 2; x < box.most.x; x += apart) {
      const Point2 at{x, y};
      const auto near = [&](const geometry::Polygon& polygon) {
        return geometry::bounds(polygon.outer).grown(beside).contains(at) &&
               (geometry::contains(polygon, at) || geometry::boundary_distance(polygon, at) < beside);
      };
      if (std::ranges::any_of(outline, near)) out.push_back(at);
    }
  return out;
}

void put_noise(const detail::Cells& cells, std::span<const Point2> places, model::Accuracy& out, double least = 0) {
  if (places.empty()) return;
  const double ground = cells.ground_of_one(places);
  out.spacing = rounded(std::sqrt(ground));
  const auto found = detail::noise_from(cells.residuals(places, ground, least), ground);
  if (!found) return;
  out.noise = rounded(found->noise);
  out.correlated_area = rounded(found->correlated_area);
  out.windows = found->discs;
}

/// The surface of a coarse mesh: its vertices are where it bends, so that they say little of the faces between.
auto sampled(const rays::Scene& scene, std::span<const Point2> places) -> std::vector<Point3> {
  std::vector<std::optional<double>> heights(places.size());
  base::parallel_for(places.size(), [&](std::size_t i) { heights[i] = scene.top(places[i]); });
  std::vector<Point3> out;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (heights[i]) out.push_back({places[i].x, places[i].y, *heights[i]});
  return out;
}

void put(const std::optional<double>& given, double& to) { to = given.value_or(to); }

/// What was measured of the surface of a cloud, said of its points: a vertex is the mean of some, and where the noise
/// of vertices is independent, so is that of points. Where it is correlated over so many points that the plane through
/// a point's neighbours shows the noise rather than the roof, a point is no measurement of its own.
auto as_points(model::Accuracy out, const std::vector<Point3>& points, std::span<const Point2> places)
    -> model::Accuracy {
  constexpr double independent = 1.5, most_points = 50;  // of the ground of a vertex; four dozen neighbours
  if (out.windows == 0) return out;
  const double ground = detail::Cells(points).ground_of_one(places);
  if (out.correlated_area <= independent * out.spacing * out.spacing) {
    out.noise = rounded(out.noise * std::sqrt(out.correlated_area / ground));
    out.correlated_area = rounded(ground);
  }
  out.spacing = rounded(std::sqrt(ground));
  if (out.correlated_area < most_points * ground) out.point_area = ground;
  return out;
}

}  // namespace

auto measure_noise(const geometry::Mesh& mesh, const rays::Scene& scene, std::span<const geometry::Polygon> outline,
                   const Options& o) -> model::Accuracy {
  model::Accuracy out;
  if (!o.noise || !o.correlated_area || !o.spacing) {
    const auto places = places_over(outline, most_places);
    const bool of_points = !mesh.points.empty();
    put_noise(detail::Cells(roof_vertices(mesh)), places, out);
    if (!of_points && !places.empty() && (out.windows == 0 || out.spacing > coarse)) {
      const double spacing = out.spacing;
      out = {};
      // A triangle is even, whatever the noise: a disc says something where it has several.
      const double several = std::min(largest_of_several, triangles * spacing);
      put_noise(detail::Cells(sampled(scene, places_over(outline, most_samples))), places, out, several);
      out.spacing = spacing;
      if (out.windows > 0) out.correlated_area = std::max(out.correlated_area, rounded(spacing * spacing));
    }
    if (of_points) out = as_points(out, mesh.points, places);
  }
  put(o.noise, out.noise);
  put(o.correlated_area, out.correlated_area);
  put(o.spacing, out.spacing);
  if (out.point_area > 0) out.point_area = rounded(out.spacing * out.spacing);
  return out;
}

auto with_edges(model::Accuracy out, const geometry::Mesh& mesh, const rays::Scene& scene,
                std::span<const geometry::Polygon> outline, const Options& o) -> model::Accuracy {
  if (!o.blur || !o.edge_noise || !o.walls || !o.offset_x || !o.offset_y || !o.offset_spread) {
    const auto transects = detail::across(outline, mesh, scene);
    if (const auto blur = detail::blur_from(transects)) {
      out.blur = rounded(*blur);
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
  return out;
}

auto measure(const geometry::Mesh& mesh, const rays::Scene& scene, std::span<const geometry::Polygon> outline,
             const Options& options) -> model::Accuracy {
  return with_edges(measure_noise(mesh, scene, outline, options), mesh, scene, outline, options);
}

auto measure_alone(const geometry::Mesh& mesh) -> model::Accuracy {
  model::Accuracy out;
  const detail::Cells cells(roof_vertices(mesh));
  std::vector<Point2> places;
  for (const Point3 v : thinned(cells.points(), most_places)) places.push_back(xy(v));
  put_noise(cells, places, out);
  return out;
}

auto noise_of(std::vector<Point3> points) -> model::Accuracy {
  model::Accuracy out;
  const detail::Cells cells(std::move(points));
  std::vector<Point2> places;
  for (const Point3 p : thinned(cells.points(), most_places)) places.push_back(xy(p));
  put_noise(cells, places, out);
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
  double weight = 0;
  Point2 sum;
  for (const auto& one : all) {
    out.windows += one.windows, out.transects += one.transects, out.edges += one.edges;
    if (one.edges == 0) continue;
    const double w = 1 / std::max(1e-6, one.offset_error * one.offset_error);
    weight += w;
    sum = sum + w * one.offset;
  }
  if (weight > 0) {
    out.offset = (1 / weight) * sum;
    out.offset_error = std::sqrt(1 / weight);
    put(middle([](const auto& one) { return one.offset_spread; }, [](const auto& one) { return one.edges; }),
        out.offset_spread);
  }
  return out;
}

}  // namespace mansard::accuracy
