// Roofs and classes of a model against those of the truth.
#include <algorithm>
#include <cmath>

#include "mansard/base/statistics.hpp"
#include "mansard/evaluate/detail/grid.hpp"
#include "mansard/evaluate/detail/normals.hpp"
#include "mansard/evaluate/truth.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::evaluate {
namespace {

using geometry::Point3;
using model::SurfaceClass;

/// A model, ready to be looked at from above.
struct RoofsFromAbove {
  model::ModelSurface surface;
  std::vector<Point3> normals;
  rays::Scene scene;

  explicit RoofsFromAbove(const model::Model& model)
      : surface(model::surface_of(model)), normals(detail::normals_of(surface.mesh)), scene(surface.mesh) {}
};

/// One place on a true roof plane.
struct Place {
  std::uint32_t plane = 0;
  bool bare = true, amid = false;  ///< amid: its four neighbours lie on the same plane
  double angle = 0, offset = 0;
};

/// Radians between the normals, whichever way the faces are turned.
auto angle_between(Point3 a, Point3 b) -> double {
  return geometry::arc_cosine(std::clamp(std::abs(dot(a, b)), 0.0, 1.0));
}

/// The places of one building of the truth, on the grid over it.
auto places_of(std::uint32_t building, const geometry::Box2& box, const RoofsFromAbove& truth, const Planes& planes,
               const RoofsFromAbove& model, double grid) -> std::vector<Place> {
  constexpr double least_area = 2;  // m²; less is a dormer's cheek or a sliver
  constexpr std::uint32_t none = ~0U;
  std::vector<Place> places;
  const auto cells = detail::grid_over(box, grid);
  std::vector<std::uint32_t> plane_at(static_cast<std::size_t>(cells.rows * cells.columns), none);
  std::vector<std::size_t> where;
  for (std::int64_t j = 0; j < cells.rows; ++j)
    for (std::int64_t i = 0; i < cells.columns; ++i) {
      const auto at = cells.centre(i, j);
      const auto real = truth.scene.seen_from_above(at);
      if (!real || truth.surface.buildings[real->triangle] != building) continue;
      if (truth.surface.classes[real->triangle] != SurfaceClass::roof) continue;
      const auto plane = planes.of_face[truth.surface.faces[real->triangle]];
      if (planes.planes[plane].area < least_area) continue;
      Place place{plane};
      where.push_back(static_cast<std::size_t>(j * cells.columns + i));
      plane_at[where.back()] = plane;
      if (const auto built = model.scene.seen_from_above(at)) {
        place.bare = false;
        place.angle = angle_between(truth.normals[real->triangle], model.normals[built->triangle]);
        place.offset = built->z - real->z;
      }
      places.push_back(place);
    }
  const auto columns = static_cast<std::size_t>(cells.columns);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::size_t at = where[k], column = at % columns;
    const auto same = [&](std::size_t other) { return plane_at[other] == places[k].plane; };
    places[k].amid = column > 0 && column + 1 < columns && at >= columns && at + columns < plane_at.size() &&
                     same(at - 1) && same(at + 1) && same(at - columns) && same(at + columns);
  }
  return places;
}

auto places_on(const RoofsFromAbove& truth, std::size_t buildings, const Planes& planes, const RoofsFromAbove& model,
               double grid) -> std::vector<Place> {
  std::vector<geometry::Box2> boxes(buildings);
  for (std::size_t t = 0; t < truth.surface.mesh.triangles.size(); ++t)
    for (const auto v : truth.surface.mesh.triangles[t])
      boxes[truth.surface.buildings[t]].add(xy(truth.surface.mesh.vertices[v]));
  std::vector<std::vector<Place>> of_building(buildings);
  base::parallel_for(buildings, [&](std::size_t b) {
    of_building[b] = places_of(static_cast<std::uint32_t>(b), boxes[b], truth, planes, model, grid);
  });
  std::vector<Place> places;
  for (const auto& own : of_building) places.insert(places.end(), own.begin(), own.end());
  return places;
}

}  // namespace

auto compare_roofs(const model::Model& truth_model, const model::Model& model_model, double grid) -> Roofs {
  constexpr double right_angle = 3 * 0.017453292519943295, right_offset = 0.25;
  const RoofsFromAbove truth(truth_model), model(model_model);
  const auto planes = planes_of(truth_model);
  const auto places = places_on(truth, truth_model.buildings.size(), planes, model, grid);

  Roofs out;
  std::vector<std::size_t> seen(planes.planes.size(), 0), good(planes.planes.size(), 0);
  std::vector<bool> broad(planes.planes.size(), false);
  std::vector<double> angles, offsets;
  std::size_t by_angle = 0, by_height = 0, by_both = 0;
  for (const auto& place : places) {
    ++seen[place.plane];
    if (place.amid) broad[place.plane] = true;
    if (place.bare) {
      ++out.bare;
      continue;
    }
    angles.push_back(place.angle);
    offsets.push_back(place.offset);
    const bool turned = place.angle > right_angle, off = std::abs(place.offset) > right_offset;
    if (!turned) ++by_angle;
    if (!off) ++by_height;
    if (turned || off) continue;
    ++by_both;
    ++good[place.plane];
  }
  for (std::size_t p = 0; p < seen.size(); ++p) {
    out.planes += seen[p] > 0 ? 1 : 0;
    const bool found = seen[p] > 0 && 2 * good[p] >= seen[p];
    out.found += found ? 1 : 0;
    out.broad += broad[p] ? 1 : 0;
    out.broad_found += broad[p] && found ? 1 : 0;
  }
  out.places = places.size();
  if (places.empty()) return out;
  const auto all = static_cast<double>(places.size());
  out.right_angle = static_cast<double>(by_angle) / all;
  out.right_height = static_cast<double>(by_height) / all;
  out.right = static_cast<double>(by_both) / all;
  for (const double angle : angles) out.angle_mean += angle / static_cast<double>(angles.size());
  if (angles.empty()) return out;
  out.angle_median = base::percentile(std::move(angles), 0.5);
  out.offset_median = base::percentile(offsets, 0.5);
  for (double& offset : offsets) offset = std::abs(offset);
  out.offset_p95_absolute = base::percentile(std::move(offsets), 0.95);
  return out;
}

auto Confusion::accuracy() const -> double {
  double right = 0, all = 0;
  for (std::size_t t = 0; t < area.size(); ++t)
    for (std::size_t m = 0; m < area.size(); ++m) {
      all += area[t][m];
      right += t == m ? area[t][m] : 0;
    }
  return all > 0 ? right / all : 0;
}

auto compare_classes(const model::ModelSurface& truth, const model::ModelSurface& model, const SampleOptions& options,
                     std::uint64_t seed, const base::Run& run) -> Confusion {
  constexpr double turned = 0.2;  // m
  const rays::Scene scene(truth.mesh);
  const auto true_normals = detail::normals_of(truth.mesh), normals = detail::normals_of(model.mesh);
  const auto samples = open_samples(model, options, seed, run);
  constexpr std::uint8_t none = model::surface_class_count;
  std::vector<std::uint8_t> real(samples.size(), none);
  base::parallel_for(samples.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const Point3 own = normals[samples[i].triangle];
    const auto near = scene.nearest(samples[i].point, confusion_reach,
                                    [&](std::uint32_t t) { return turned * (1 - dot(own, true_normals[t])); });
    if (near) real[i] = static_cast<std::uint8_t>(truth.classes[near->triangle]);
  });
  const double each = area_per_sample(model.mesh, options);
  Confusion out;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto as = static_cast<std::size_t>(model.classes[samples[i].triangle]);
    (real[i] == none ? out.beyond : out.area[real[i]][as]) += each;
  }
  return out;
}

}  // namespace mansard::evaluate
