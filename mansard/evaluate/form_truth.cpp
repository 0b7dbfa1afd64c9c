// The planes, lines and structures of a roof that two models of one place have in common.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "mansard/base/statistics.hpp"
#include "mansard/evaluate/detail/degree.hpp"
#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::evaluate {
namespace {

using detail::degree;
using geometry::Point2;
using geometry::Point3;

constexpr std::size_t no_building = ~std::size_t{0};

/// The buildings of one model that may be those of the other: each with the one with which it shares most ground.
/// Several buildings of one model may be one of the other.
class SameBuildings {
 public:
  SameBuildings(const model::Model& truth, const model::Model& model, std::size_t& unchecked) {
    const auto true_outlines = outlines_of(truth), outlines = outlines_of(model);
    std::vector<double> most_of_truth(true_outlines.size(), 0), most_of_model(outlines.size(), 0);
    model_of_.assign(true_outlines.size(), no_building);
    truth_of_.assign(outlines.size(), no_building);
    for (std::size_t t = 0; t < true_outlines.size(); ++t)
      for (std::size_t m = 0; m < outlines.size(); ++m) {
        const auto common =
            true_outlines[t] && outlines[m] ? common_area(*true_outlines[t], *outlines[m]) : base::Result<double>(0.0);
        if (!common || !true_outlines[t] || !outlines[m]) ++unchecked;
        if (!common || *common <= 0) continue;
        if (*common > most_of_truth[t]) most_of_truth[t] = *common, model_of_[t] = m;
        if (*common > most_of_model[m]) most_of_model[m] = *common, truth_of_[m] = t;
      }
  }
  [[nodiscard]] auto same(std::size_t truth, std::size_t model) const -> bool {
    return model_of_[truth] == model || truth_of_[model] == truth;
  }

 private:
  static auto outlines_of(const model::Model& model) -> std::vector<base::Result<Outline>> {
    std::vector<base::Result<Outline>> out(model.buildings.size(), Outline());
    base::parallel_for(out.size(), [&](std::size_t b) { out[b] = outline_of(model.buildings[b].parts); });
    return out;
  }
  std::vector<std::size_t> model_of_, truth_of_;
};

/// The area of polygons, and their centre.
struct Middle {
  double area = 0;
  Point2 sum;

  void add(const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
      const double twice = cross(a, b);
      area += twice / 2;
      sum = sum + (twice / 6) * (a + b) + (twice / 2) * ring[0];
    }
  }
  void add(const std::vector<geometry::Polygon>& polygons) {
    for (const auto& polygon : polygons) {
      add(polygon.outer);
      for (const auto& hole : polygon.holes) add(hole);
    }
  }
};

auto height_at(const RoofPlane& plane, Point2 p) -> double {
  const Point2 d = p - xy(plane.point);
  return plane.point.z - dot(xy(plane.normal), d) / plane.normal.z;
}

auto plan_area(const RoofPlane& plane) -> double {
  double sum = 0;
  for (const auto& polygon : plane.plan) sum += geometry::area(polygon);
  return sum;
}

/// Whether two planes that face the same way are one.
auto same_plane(const RoofPlane& a, const RoofPlane& b) -> base::Result<bool> {
  if (dot(a.normal, b.normal) < geometry::cosine(found_angle * degree)) return false;
  if (a.plan.empty() || b.plan.empty()) return false;
  Middle common;
  for (const auto& p : a.plan)
    for (const auto& q : b.plan) {
      if (!geometry::bounds(p.outer).overlaps(geometry::bounds(q.outer))) continue;
      const auto both = geometry::intersect(p, q);
      if (!both) return both.failure();
      common.add(*both);
    }
  if (!(common.area > 0) || common.area < 0.5 * std::min(plan_area(a), plan_area(b))) return false;
  const Point2 at = (1 / common.area) * common.sum;
  return std::abs(height_at(a, at) - height_at(b, at)) <= found_height;
}

auto compare_planes(const RoofPlanes& truth, const RoofPlanes& model, const SameBuildings& buildings,
                    std::size_t& unchecked) -> FoundBoth {
  std::vector<char> truth_found(truth.planes.size(), 0), model_found(model.planes.size(), 0);
  for (std::size_t t = 0; t < truth.planes.size(); ++t)
    for (std::size_t m = 0; m < model.planes.size(); ++m) {
      const auto &a = truth.planes[t], &b = model.planes[m];
      if (a.area < found_least_area || b.area < found_least_area || !buildings.same(a.building, b.building)) continue;
      const auto same = same_plane(a, b);
      unchecked += same ? 0 : 1;
      if (same && *same) truth_found[t] = model_found[m] = 1;
    }
  FoundBoth out;
  const auto count = [](const RoofPlanes& of, const std::vector<char>& found, Found& sum) {
    for (std::size_t p = 0; p < found.size(); ++p)
      if (const double area = of.planes[p].area; area >= found_least_area)
        sum.add(area, found[p] != 0 ? area : 0, found[p] != 0);
  };
  count(truth, truth_found, out.truth);
  count(model, model_found, out.model);
  return out;
}

auto distance(const RoofLine& line, Point3 p) -> double {
  const Point3 d = line.end - line.start;
  const double t = std::clamp(dot(p - line.start, d) / dot(d, d), 0.0, 1.0);
  return length(p - (line.start + t * d));
}

/// How much of the lines of one kind is near lines of the same kind in the other model.
auto lines_found(const std::vector<RoofLine>& lines, const std::vector<RoofLine>& others, RoofLineKind kind) -> Found {
  constexpr double step = 0.1;  // m
  Found out;
  for (const auto& line : lines) {
    const Point3 d = line.end - line.start;
    const double long_ = length(d);
    if (line.kind != kind || long_ < found_least_length) continue;
    const auto box = geometry::Box3::of(std::array{line.start, line.end}).plan().grown(found_distance);
    std::vector<const RoofLine*> near;
    for (const auto& other : others)
      if (other.kind == kind && box.overlaps(geometry::Box3::of(std::array{other.start, other.end}).plan()) &&
          std::abs(dot(normalised(d), normalised(other.end - other.start))) >= geometry::cosine(found_angle * degree))
        near.push_back(&other);
    const auto n = static_cast<std::size_t>(std::ceil(long_ / step));
    std::size_t hits = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Point3 at = line.start + ((static_cast<double>(k) + 0.5) / static_cast<double>(n)) * d;
      hits += std::ranges::any_of(near, [&](const auto* o) { return distance(*o, at) <= found_distance; }) ? 1 : 0;
    }
    out.add(long_, long_ * static_cast<double>(hits) / static_cast<double>(n), 2 * hits >= n);
  }
  return out;
}

/// Whether two structures are one: half of each in common, at about one height.
auto same_structure(const RoofStructure& a, const RoofStructure& b) -> bool {
  constexpr double off = 0.5;  // m
  const auto before = [](const auto& p, const auto& q) {
    return std::tie(p.row, p.column) < std::tie(q.row, q.column);
  };
  std::vector<double> differences;
  auto at = b.places.begin();
  for (const auto& place : a.places) {
    while (at != b.places.end() && before(*at, place)) ++at;
    if (at != b.places.end() && !before(place, *at)) differences.push_back(std::abs(place.z - at->z));
  }
  if (differences.empty() || 2 * differences.size() < std::max(a.places.size(), b.places.size())) return false;
  return base::percentile(std::move(differences), 0.5) <= off;
}

/// Of dormers, or of other structures. What is found may be of the other sort: a flat part's edge decides between them.
auto structures_found(const std::vector<RoofStructure>& of, const std::vector<RoofStructure>& others, bool dormer,
                      double cell) -> Found {
  Found out;
  for (const auto& one : of) {
    if (one.dormer != dormer) continue;
    const bool found = std::ranges::any_of(others, [&](const auto& o) { return same_structure(one, o); });
    const double area = cell * static_cast<double>(one.places.size());
    out.add(area, found ? area : 0, found);
  }
  return out;
}

}  // namespace

auto compare_form(const FormInput& truth, const FormInput& model, double grid) -> FormTruth {
  FormTruth out;
  out.buildings = truth.model.buildings.size();
  const SameBuildings buildings(truth.model, model.model, out.unchecked);
  out.planes = compare_planes(truth.planes, model.planes, buildings, out.unchecked);
  for (std::size_t k = 0; k < out.lines.size(); ++k) {
    const auto kind = static_cast<RoofLineKind>(k);
    out.lines[k] = {lines_found(truth.lines, model.lines, kind), lines_found(model.lines, truth.lines, kind)};
  }
  const auto structures = [&](bool dormer) {
    return FoundBoth{structures_found(truth.structures, model.structures, dormer, grid * grid),
                     structures_found(model.structures, truth.structures, dormer, grid * grid)};
  };
  out.dormers = structures(true);
  out.structures = structures(false);
  return out;
}

}  // namespace mansard::evaluate
