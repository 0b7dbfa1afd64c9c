// The planes, lines and structures of a roof that two models of one place have in common.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "mansard/base/statistics.hpp"
#include "mansard/evaluate/detail/degree.hpp"
#include "mansard/evaluate/detail/middle.hpp"
#include "mansard/evaluate/form.hpp"
#include "mansard/geometry/angles.hpp"

namespace mansard::evaluate {
namespace {

using detail::degree;
using detail::Middle;
using geometry::Point2;
using geometry::Point3;

constexpr std::size_t no_building = ~std::size_t{0};

/// The buildings of one model that may be those of the other: each with the one with which it shares most ground.
/// Several buildings of one model may be one of the other.
class SameBuildings {
 public:
  SameBuildings(const model::Model& truth, const model::Model& model, std::size_t& unchecked)
      : true_outlines_(outlines_of(truth)) {
    const auto outlines = outlines_of(model);
    std::vector<double> most_of_truth(true_outlines_.size(), 0), most_of_model(outlines.size(), 0);
    model_of_.assign(true_outlines_.size(), no_building);
    truth_of_.assign(outlines.size(), no_building);
    for (std::size_t t = 0; t < true_outlines_.size(); ++t)
      for (std::size_t m = 0; m < outlines.size(); ++m) {
        const auto common = true_outlines_[t] && outlines[m] ? common_area(*true_outlines_[t], *outlines[m])
                                                             : base::Result<double>(0.0);
        if (!common || !true_outlines_[t] || !outlines[m]) ++unchecked;
        if (!common || *common <= 0) continue;
        if (*common > most_of_truth[t]) most_of_truth[t] = *common, model_of_[t] = m;
        if (*common > most_of_model[m]) most_of_model[m] = *common, truth_of_[m] = t;
      }
  }
  [[nodiscard]] auto same(std::size_t truth, std::size_t model) const -> bool {
    return model_of_[truth] == model || truth_of_[model] == truth;
  }
  [[nodiscard]] auto true_outline(std::size_t truth) const -> const base::Result<Outline>& {
    return true_outlines_[truth];
  }

 private:
  static auto outlines_of(const model::Model& model) -> std::vector<base::Result<Outline>> {
    std::vector<base::Result<Outline>> out(model.buildings.size(), Outline());
    base::parallel_for(out.size(), [&](std::size_t b) { out[b] = outline_of(model.buildings[b].parts); });
    return out;
  }
  std::vector<base::Result<Outline>> true_outlines_;
  std::vector<std::size_t> model_of_, truth_of_;
};

auto plan_area(const RoofPlane& plane) -> double {
  double sum = 0;
  for (const auto& polygon : plane.plan) sum += geometry::area(polygon);
  return sum;
}

/// What two planes share, seen from above.
auto shared(const RoofPlane& a, const RoofPlane& b) -> base::Result<Middle> {
  Middle common;
  for (const auto& p : a.plan)
    for (const auto& q : b.plan) {
      if (!geometry::bounds(p.outer).overlaps(geometry::bounds(q.outer))) continue;
      const auto both = geometry::intersect(p, q);
      if (!both) return both.failure();
      common.add(*both);
    }
  return common;
}

/// m; a − b.
auto height_between(const RoofPlane& a, const RoofPlane& b, Point2 at) -> double {
  return detail::height_at(a, at) - detail::height_at(b, at);
}

/// Whether two planes that face the same way are one.
auto same_plane(const RoofPlane& a, const RoofPlane& b) -> base::Result<bool> {
  if (dot(a.normal, b.normal) < geometry::cosine(found_angle * degree)) return false;
  const auto common = shared(a, b);
  if (!common) return common.failure();
  if (!(common->area > 0) || common->area < 0.5 * std::min(plan_area(a), plan_area(b))) return false;
  return std::abs(height_between(a, b, common->centre())) <= found_height;
}

using PlaneResults = std::vector<ComparedPlane::Result>;

/// The planes of both models, by their numbers.
struct PlanesFound {
  PlaneResults truth, model;
};

auto compare_planes(const RoofPlanes& truth, const RoofPlanes& model, const SameBuildings& buildings,
                    std::size_t& unchecked) -> PlanesFound {
  using enum ComparedPlane::Result;
  const auto before = [](const RoofPlanes& of) {
    PlaneResults out;
    for (const auto& plane : of.planes) out.push_back(plane.area < found_least_area ? too_small : not_found);
    return out;
  };
  PlanesFound out{before(truth), before(model)};
  for (std::size_t t = 0; t < truth.planes.size(); ++t)
    for (std::size_t m = 0; m < model.planes.size(); ++m) {
      const auto &a = truth.planes[t], &b = model.planes[m];
      if (out.truth[t] == too_small || out.model[m] == too_small || !buildings.same(a.building, b.building)) continue;
      const auto same = same_plane(a, b);
      unchecked += same ? 0 : 1;
      if (same && *same) out.truth[t] = out.model[m] = found;
    }
  return out;
}

auto sum_of(const RoofPlanes& planes, const PlaneResults& results) -> Found {
  Found sum;
  for (std::size_t p = 0; p < results.size(); ++p) {
    const double area = planes.planes[p].area;
    const bool found = results[p] == ComparedPlane::Result::found;
    if (results[p] != ComparedPlane::Result::too_small) sum.add(area, found ? area : 0, found);
  }
  return sum;
}

/// Of planes of the other model in the same buildings. What cannot be intersected is left out: it has been counted.
auto nearest_of(const RoofPlane& plane, const std::vector<const RoofPlane*>& others)
    -> std::optional<ComparedPlane::Nearest> {
  std::optional<ComparedPlane::Nearest> best;
  for (const auto* other : others) {
    const auto common = shared(plane, *other);
    if (!common || !(common->area > (best ? best->shared : 0))) continue;
    const double cosine = std::clamp(dot(plane.normal, other->normal), -1.0, 1.0);
    best = {geometry::arc_cosine(cosine), height_between(plane, *other, common->centre()), common->area};
  }
  return best;
}

/// The numbers of the planes of each building.
auto planes_by_building(const RoofPlanes& planes, std::size_t buildings) -> std::vector<std::vector<std::uint32_t>> {
  std::vector<std::vector<std::uint32_t>> out(buildings);
  for (std::size_t p = 0; p < planes.planes.size(); ++p)
    out[planes.planes[p].building].push_back(static_cast<std::uint32_t>(p));
  return out;
}

auto lowest_corner(const model::ModelBuilding& building) -> double {
  double low = std::numeric_limits<double>::infinity();
  for (const auto& part : building.parts)
    for (const auto& face : part.faces)
      for (const auto& loop : face.loops)
        for (const auto& at : loop) low = std::min(low, at.z);
  return std::isfinite(low) ? low : 0;
}

/// Adds planes of one model to those of a building; `others` are the building's planes of the other model.
void append(std::vector<ComparedPlane>& out, const RoofPlanes& planes, const std::vector<std::uint32_t>& numbers,
            const PlaneResults& results, const RoofPlanes& other, const std::vector<std::uint32_t>& others) {
  std::vector<const RoofPlane*> candidates;
  for (const auto p : others)
    if (other.planes[p].area >= found_least_area) candidates.push_back(&other.planes[p]);
  for (const auto p : numbers) {
    ComparedPlane one{planes.planes[p], results[p], {}};
    if (one.result == ComparedPlane::Result::not_found) one.nearest = nearest_of(one.plane, candidates);
    out.push_back(std::move(one));
  }
}

/// The buildings of both models with their planes, each by itself.
class BuildingsCompared {
 public:
  BuildingsCompared(const FormInput& truth, const FormInput& model, const SameBuildings& same, const PlanesFound& found)
      : truth_(truth),
        model_(model),
        same_(same),
        found_(found),
        true_planes_(planes_by_building(truth.planes, truth.model.buildings.size())),
        model_planes_(planes_by_building(model.planes, model.model.buildings.size())),
        shares_(model.model.buildings.size(), 0) {
    for (std::size_t m = 0; m < shares_.size(); ++m)
      for (std::size_t t = 0; t < true_planes_.size(); ++t) shares_[m] += same.same(t, m) ? 1 : 0;
  }
  [[nodiscard]] auto all() const -> std::vector<ComparedBuilding> {
    std::vector<ComparedBuilding> out(true_planes_.size());
    base::parallel_for(out.size(), [&](std::size_t t) { out[t] = of_truth(t); });
    for (std::size_t m = 0; m < shares_.size(); ++m)
      if (shares_[m] == 0) out.push_back(of_model(m));
    return out;
  }

 private:
  [[nodiscard]] auto of_truth(std::size_t t) const -> ComparedBuilding {
    ComparedBuilding out;
    out.truth = static_cast<std::uint32_t>(t);
    out.ground = lowest_corner(truth_.model.buildings[t]);
    std::vector<std::uint32_t> model_planes, all_model_planes;
    for (std::size_t m = 0; m < shares_.size(); ++m) {
      if (!same_.same(t, m)) continue;
      out.model.push_back(static_cast<std::uint32_t>(m));
      for (const auto p : model_planes_[m]) {
        all_model_planes.push_back(p);
        if (shares_[m] == 1 || is_on(model_.planes.planes[p], t)) model_planes.push_back(p);
      }
    }
    append(out.truth_planes, truth_.planes, true_planes_[t], found_.truth, model_.planes, all_model_planes);
    append(out.model_planes, model_.planes, model_planes, found_.model, truth_.planes, true_planes_[t]);
    return out;
  }
  [[nodiscard]] auto of_model(std::size_t m) const -> ComparedBuilding {
    ComparedBuilding out;
    out.model = {static_cast<std::uint32_t>(m)};
    out.ground = lowest_corner(model_.model.buildings[m]);
    append(out.model_planes, model_.planes, model_planes_[m], found_.model, truth_.planes, {});
    return out;
  }
  /// Whether a plane of a building that is several true ones belongs to this one. Where it cannot be computed it does:
  /// no plane is lost.
  [[nodiscard]] auto is_on(const RoofPlane& plane, std::size_t truth) const -> bool {
    constexpr double least_share = 0.25;
    const auto& outline = same_.true_outline(truth);
    if (!outline) return true;
    const auto common = common_area(plane.plan, *outline);
    if (!common) return true;
    double ground = 0;
    for (const auto& polygon : *outline) ground += geometry::area(polygon);
    return *common > 0 && *common >= least_share * std::min(plan_area(plane), ground);
  }

  const FormInput &truth_, &model_;
  const SameBuildings& same_;
  const PlanesFound& found_;
  std::vector<std::vector<std::uint32_t>> true_planes_, model_planes_;
  std::vector<std::size_t> shares_;  ///< per building of the model: of how many true ones it is
};

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

auto ComparedBuilding::every_plane_right() const -> bool {
  const auto right = [](const ComparedPlane& plane) { return plane.result != ComparedPlane::Result::not_found; };
  return truth && !model.empty() && std::ranges::all_of(truth_planes, right) &&
         std::ranges::all_of(model_planes, right);
}

auto compare_form(const FormInput& truth, const FormInput& model, double grid) -> FormTruth {
  FormTruth out;
  out.buildings = truth.model.buildings.size();
  const SameBuildings buildings(truth.model, model.model, out.unchecked);
  const auto found = compare_planes(truth.planes, model.planes, buildings, out.unchecked);
  out.planes = {sum_of(truth.planes, found.truth), sum_of(model.planes, found.model)};
  out.compared = BuildingsCompared(truth, model, buildings, found).all();
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
