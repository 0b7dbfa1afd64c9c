// Attributes of models: those of a run, and those of parts and buildings whose plans were changed after it.
#include "mansard/report/attributes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "mansard/base/statistics.hpp"
#include "mansard/evaluate/evaluate.hpp"
#include "mansard/label/label.hpp"
#include "mansard/model/find.hpp"
#include "mansard/report/measures.hpp"
#include "mansard/report/report.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::report {
namespace {

/// Those that model_attributes() makes.
constexpr std::array<std::string_view, 14> of_model{
    "ms_h_ground",         "ms_h_roof_min", "ms_h_roof_50p",      "ms_h_roof_70p", "ms_h_roof_max",
    "ms_h_ridge",          "ms_roof_type",  "ms_volume_lod22",    "ms_rmse_lod22", "ms_area_roof_flat",
    "ms_area_roof_sloped", "ms_area_wall",  "ms_area_party_wall", "ms_fallback"};
/// Those of a building that building_attributes() makes, beside those of its levels of detail.
constexpr std::array of_building{"ms_outcome",          "ms_success",     "ms_quality",
                                 "ms_checks",           "ms_confidence",  "ms_error",
                                 "ms_reasons",          "ms_h_ground",    "ms_h_roof_min",
                                 "ms_h_roof_50p",       "ms_h_roof_70p",  "ms_h_roof_max",
                                 "ms_h_eave",           "ms_h_ridge",     "ms_roof_type",
                                 "ms_roof_planes",      "ms_ridges",      "ms_parts",
                                 "ms_area_footprint",   "ms_area_ground", "ms_area_roof_flat",
                                 "ms_area_roof_sloped", "ms_area_wall",   "ms_area_party_wall",
                                 "ms_storeys",          "measuredHeight", "roofType",
                                 "storeysAboveGround"};

auto name_is_of(const model::Attributes& attributes, std::string_view name) -> bool {
  return std::ranges::any_of(attributes, [&](const auto& one) { return one.first == name; });
}

/// The attributes without those named, and the new ones where the first of them stood.
template <class Names>
auto with(const model::Attributes& before, const Names& names, model::Attributes now) -> model::Attributes {
  model::Attributes out;
  bool placed = false;
  for (const auto& attribute : before) {
    if (std::ranges::find(names, attribute.first) == names.end()) {
      out.push_back(attribute);
      continue;
    }
    if (!placed) out.insert(out.end(), now.begin(), now.end());
    placed = true;
  }
  if (!placed) out.insert(out.end(), now.begin(), now.end());
  return out;
}

}  // namespace

auto heights_over(const rays::Scene& surface, const geometry::Polygon& polygon, double grid) -> std::vector<double> {
  constexpr double most_samples = 250'000;
  const auto box = geometry::bounds(polygon.outer);
  const geometry::Point2 extent = box.most - box.least;
  const double least_grid = std::sqrt(extent.x * extent.y / most_samples);
  grid = std::max(grid, least_grid);
  constexpr double finest = 0.01;  // m; a strip may lie between two rows of samples
  std::vector<double> heights;
  for (bool any = false; !any && grid >= std::max(finest, least_grid); grid /= 2)
    for (double y = std::ceil(box.least.y / grid) * grid; y <= box.most.y; y += grid)
      for (double x = std::ceil(box.least.x / grid) * grid; x <= box.most.x; x += grid)
        if (geometry::contains(polygon, geometry::Point2{x, y})) {
          any = true;
          if (const auto z = surface.top({x, y})) heights.push_back(*z);
        }
  std::ranges::sort(heights);
  return heights;
}

auto roof_heights(const model::LabelledSolid& model, const model::Plan& plan, double grid) -> std::vector<double> {
  std::vector<double> heights;
  if (const auto triangles = solid::triangulate(model.solid)) {
    const rays::Scene roof(geometry::Mesh{model.solid.vertices, triangles->triangles});
    heights = heights_over(roof, model::polygon_of(plan), grid);
  }
  if (!heights.empty()) return heights;
  for (const auto& v : model.solid.vertices)
    if (v.z > plan.base) heights.push_back(v.z);
  std::ranges::sort(heights);
  return heights;
}

auto roof_type(const model::LabelledSolid& model) -> std::string {
  constexpr double flat = 0.9962;  // cosine of 5°
  double flat_area = 0, sloped_area = 0;
  std::vector<double> levels;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    if (model.classes[f] != model::FaceClass::roof) continue;
    const auto& face = model.solid.faces[f];
    const double area = solid::area(model.solid, face);
    if (face.normal.z < flat) {
      sloped_area += area;
      continue;
    }
    flat_area += area;
    levels.push_back(model.solid.vertices[face.loops.front().front()].z);
  }
  if (sloped_area > 0.05 * (flat_area + sloped_area)) return "slanted";
  std::ranges::sort(levels);
  return !levels.empty() && levels.back() - levels.front() > 0.5 ? "multiple horizontal" : "horizontal";
}

auto ridge_height(const model::LabelledSolid& model) -> std::optional<double> {
  std::optional<double> highest;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    const auto& face = model.solid.faces[f];
    if (face.kind != model::FaceKind::side || model.classes[f] != model::FaceClass::roof) continue;
    for (const auto v : face.loops.front()) highest = std::max(highest.value_or(-1e9), model.solid.vertices[v].z);
  }
  return highest;
}

auto top_of(const model::Solid& solid) -> double {
  return std::ranges::max(solid.vertices, {}, &geometry::Point3::z).z;
}

auto model_attributes(const model::LabelledSolid& model, const model::Plan& plan, const std::vector<double>& roof,
                      const std::optional<double>& mse, const std::string& fallback, double z0) -> model::Attributes {
  const auto areas = label::areas(model);
  model::Attributes out;
  out.emplace_back("ms_h_ground", z0 + plan.base);
  out.emplace_back("ms_h_roof_min", z0 + roof.front());
  out.emplace_back("ms_h_roof_50p", z0 + base::percentile_of_sorted(roof, 0.5));
  out.emplace_back("ms_h_roof_70p", z0 + base::percentile_of_sorted(roof, 0.7));
  out.emplace_back("ms_h_roof_max", z0 + top_of(model.solid));
  if (const auto ridge = ridge_height(model)) out.emplace_back("ms_h_ridge", z0 + *ridge);
  out.emplace_back("ms_roof_type", roof_type(model));
  out.emplace_back("ms_volume_lod22", solid::volume(model.solid));
  if (mse) out.emplace_back("ms_rmse_lod22", std::sqrt(*mse));
  out.emplace_back("ms_area_roof_flat", areas.roof_flat);
  out.emplace_back("ms_area_roof_sloped", areas.roof_sloped);
  out.emplace_back("ms_area_wall", areas.wall);
  out.emplace_back("ms_area_party_wall", areas.party_wall);
  if (fallback.empty()) out.emplace_back("ms_fallback", std::monostate{});
  else out.emplace_back("ms_fallback", fallback);
  return out;
}

auto rounded_measure(double value) -> double {
  constexpr double unit = 1e4;
  return std::floor(value * unit + 0.5) / unit;  // halves go up everywhere, so that heights can be shifted by metres
}

void round_measures(model::Attributes& attributes) {
  for (auto& [name, value] : attributes)
    if (auto* number = std::get_if<double>(&value); number != nullptr && name.starts_with("ms_"))
      *number = rounded_measure(*number);
}

auto part_attributes(const model::Part& part, const std::string& fallback, const rays::Scene* mesh, double z0,
                     const Sampling& sampling) -> model::Attributes {
  std::optional<double> mse;
  if (mesh != nullptr) {
    const double error = evaluate::error_over(part.model.solid, model::polygon_of(part.plan), *mesh, sampling.error);
    if (std::isfinite(error)) mse = error;
  }
  const auto roof = roof_heights(part.model, part.plan, sampling.roof_grid);
  auto now = model_attributes(part.model, part.plan, roof, mse, fallback, z0);
  round_measures(now);
  return with(part.attributes, of_model, std::move(now));
}

auto building_attributes(const model::Building& building, double z0) -> model::Attributes {
  double volume = 0, squared = 0, area = 0;
  std::optional<double> highest;
  bool full = true;
  for (const auto& part : building.parts) {
    volume += solid::volume(part.model.solid);
    if (const auto* z = model::find<double>(part.attributes, "ms_h_roof_max"))
      highest = std::max(highest.value_or(*z), *z);
    if (const auto* rmse = model::find<double>(part.attributes, "ms_rmse_lod22")) {
      const double ground = label::areas(part.model).ground;
      squared += *rmse * *rmse * ground;
      area += ground;
    }
    full = full && model::find<std::string>(part.attributes, "ms_fallback") == nullptr;
  }
  const auto outcome = building.parts.empty() ? Outcome::covered : full ? Outcome::full : Outcome::fallback;
  // CityGML's three are made anew, unless the source has them: then their place is before ours.
  model::Building plain{building.id, {}, building.footprint, building.ground, building.parts, building.solids};
  bool ours = false;
  for (const auto& [name, value] : building.attributes) {
    ours = ours || name.starts_with("ms_");
    if (!ours) plain.attributes.emplace_back(name, value);
  }
  model::Attributes levels, now;
  if (!building.parts.empty())
    levels = level_measures(plain, {{0, 0, static_cast<std::int64_t>(z0)}, {}}, {}, nullptr, {});
  now.emplace_back("ms_outcome", std::string(to_string(outcome)));
  now.emplace_back("ms_success", !building.parts.empty());
  const auto source = std::ranges::find(building.attributes, "ms_ground_source", &model::Attributes::value_type::first);
  const auto* ground = source == building.attributes.end() ? nullptr : std::get_if<std::string>(&source->second);
  // What the scan said was said of another model.
  add_quality(to_string(outcome), failed_checks(to_string(outcome), levels, ground == nullptr ? "" : *ground),
              std::nullopt, now);
  constexpr double storey = 3;  // m; the default of roof.level_height
  // The ground was not edited.
  const auto* mean = model::find<double>(building.attributes, "ms_h_ground_mean");
  for (auto& measure : building_measures(plain, z0, storey, mean ? std::optional(*mean - z0) : std::nullopt))
    now.push_back(std::move(measure));
  for (auto& measure : levels) now.push_back(std::move(measure));
  if (!building.parts.empty()) {
    now.emplace_back("ms_h_ground", z0 + building.ground);
    if (highest) now.emplace_back("ms_h_roof_max", *highest);
    now.emplace_back("ms_volume_lod22", volume);
    if (area > 0) now.emplace_back("ms_rmse_lod22", std::sqrt(squared / area));
  }
  round_measures(now);
  // All that was measured of the model before; errors of the coarser levels of detail are not measured again.
  std::vector<std::string> names;
  for (const auto* name : of_building)
    if (!name_is_of(plain.attributes, name)) names.emplace_back(name);
  // Nor do standard errors stay: they are of the model that was there before.
  for (const auto& [name, value] : building.attributes)
    if (name.starts_with("ms_") && name.ends_with("_se")) names.push_back(name);
  for (const auto& level : level_names())
    for (const auto* name : {level.volume, level.surface, level.rmse, level.val3dity}) names.emplace_back(name);
  return with(building.attributes, names, std::move(now));
}

}  // namespace mansard::report
