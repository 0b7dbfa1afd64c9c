#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/solid/solid.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mansard/report/attributes.hpp"

namespace mansard::pipeline::detail {

void add(label::Areas& sum, const label::Areas& more) {
  sum.wall += more.wall;
  sum.party_wall += more.party_wall;
  sum.roof_flat += more.roof_flat;
  sum.roof_sloped += more.roof_sloped;
  sum.soffit += more.soffit;
  sum.ground += more.ground;
}

auto version() -> std::string { return MANSARD_VERSION; }

auto made_by(const model::Scene& scene, const Options& options) -> model::MadeBy {
  model::MadeBy out;
  out.version = version();
  out.inputs = scene.inputs;
  Options copy = options, defaults;
  const auto used = option_lists(copy), usual = option_lists(defaults);
  for (std::size_t l = 0; l < used.size(); ++l)
    for (const auto& option : used[l].options()) {
      out.every_option.emplace_back(used[l].module() + "." + option.name, option.get());
      if (!option.advanced || option.get() != usual[l].find(option.name)->get())
        out.options.push_back(out.every_option.back());
    }
  return out;
}

namespace {

/// The attributes of a part whose model has become another one.
void measure_again(model::Part& part, const std::string& code, double z0) {
  const auto& solid = part.model.solid;
  const auto areas = label::areas(part.model);
  const std::map<std::string_view, model::Value> now{{"ms_h_roof_max", z0 + report::top_of(solid)},
                                                     {"ms_h_roof_min", z0 + report::top_of(solid)},
                                                     {"ms_h_ridge", std::monostate()},
                                                     {"ms_roof_type", report::roof_type(part.model)},
                                                     {"ms_volume_lod22", solid::volume(solid)},
                                                     {"ms_area_roof_flat", areas.roof_flat},
                                                     {"ms_area_roof_sloped", areas.roof_sloped},
                                                     {"ms_area_wall", areas.wall},
                                                     {"ms_area_party_wall", areas.party_wall},
                                                     {"ms_fallback", code}};
  for (auto& [name, value] : part.attributes)
    if (const auto found = now.find(name); found != now.end()) value = found->second;
  report::round_measures(part.attributes);
}

}  // namespace

void add_solids(model::Building& building, report::BuildingReport& report, SolidsOf made, double z0) {
  building.solids = std::move(made.solids);
  for (const std::size_t p : made.simplified) measure_again(building.parts[p], "solid-simplified", z0);
  if (!made.simplified.empty()) {
    report.volume = 0;
    for (const auto& part : building.parts) report.volume += solid::volume(part.model.solid);
  }
  for (auto& warning : made.warnings) {
    warning.subject = building.id;
    if (warning.code != "solid-not-united") report.outcome = report::Outcome::fallback;
    report.reasons.push_back(std::move(warning));
  }
}

namespace {

/// The attributes of outputs.md, in the file's heights.
auto attributes_of(const PartResult& part, const report::BlockReport& block, double z0) -> model::Attributes {
  const std::string why = part.reasons.empty() ? "unknown" : part.reasons.front().code;
  auto out = report::model_attributes(part.model, part.plan, part.roof, part.mse, part.full ? std::string() : why, z0);
  if (!part.changes.empty()) {
    std::string words;
    for (const auto& change : part.changes) words += (words.empty() ? "" : "; ") + change;
    out.emplace_back("ms_refined", words);
  }
  out.emplace_back("ms_block", block.name);
  out.emplace_back("ms_opt_status", block.status);
  out.emplace_back("ms_opt_gap", block.objective - block.bound);
  report::round_measures(out);
  return out;
}

/// Adds a part to its building and to the building's report.
struct Account {
  double squared = 0;  // Σ mse × area, for the building's RMSE
  double area = 0;
};
void take(PartResult part, const report::BlockReport& block, double z0, model::Building& building,
          report::BuildingReport& report, Account& account) {
  report.roof_min = report.parts == 0 ? z0 + part.roof.front() : std::min(report.roof_min, z0 + part.roof.front());
  const double top = z0 + report::top_of(part.model.solid);
  report.roof_max = report.parts == 0 ? top : std::max(report.roof_max, top);
  ++report.parts;
  report.volume += solid::volume(part.model.solid);
  const auto areas = label::areas(part.model);
  add(report.areas, areas);
  if (part.mse) {
    const double rmse = report::rounded_measure(std::sqrt(*part.mse));  // as its attribute says
    account.squared += rmse * rmse * areas.ground;
    account.area += areas.ground;
  }
  if (!part.full) report.outcome = report::Outcome::fallback;
  for (auto reason : part.reasons) {
    if (reason.subject.empty()) reason.subject = building.id;
    report.reasons.push_back(std::move(reason));
  }
  auto attributes = attributes_of(part, block, z0);
  building.parts.push_back({building.id + "-" + std::to_string(report.parts), std::move(part.plan),
                            std::move(part.model), std::move(attributes)});
}

}  // namespace

auto assemble(const model::Scene& scene, const std::vector<block::Block>& blocks, std::vector<BlockResult> results,
              const Options& options) -> report::Reconstruction {
  report::Reconstruction out;
  const auto z0 = static_cast<double>(scene.frame.origin[2]);
  const std::size_t count = scene.footprints.size() + scene.surroundings.size();
  std::vector<model::Building> buildings(count);
  std::vector<report::BuildingReport> reports(count);
  std::vector<Account> accounts(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& footprint = scene.feature(i);
    buildings[i].id = reports[i].id = footprint.id;
    reports[i].derived = footprint.derived;
    buildings[i].attributes = footprint.attributes;
    buildings[i].footprint = footprint.polygons;
    if (footprint.defect) {
      reports[i].outcome = report::Outcome::refused;
      reports[i].reasons.push_back(*footprint.defect);
    }
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (const auto& member : blocks[b].members) {
      reports[member.feature].block = blocks[b].name;
      reports[member.feature].ground = z0 + member.ground;
      buildings[member.feature].ground = member.ground;
    }
    for (auto& part : results[b].parts) {
      const std::size_t f = part.feature;
      take(std::move(part), results[b].report, z0, buildings[f], reports[f], accounts[f]);
    }
    for (auto& [f, made] : results[b].solids) add_solids(buildings[f], reports[f], std::move(made), z0);
    for (const std::size_t f : results[b].covered) {
      reports[f].outcome = report::Outcome::covered;
      reports[f].reasons.push_back(base::warning(
          "pipeline-covered", "the ground of this footprint went to its neighbours' models", reports[f].id));
    }
    for (const auto& [f, why] : results[b].failed) {
      reports[f].outcome = reports[f].parts == 0 ? report::Outcome::refused : report::Outcome::fallback;
      reports[f].reasons.push_back(base::warning(why.code, why.message, reports[f].id));
    }
    for (const auto& one : results[b].left_out) {
      reports[one.feature].left_out = one.area;
      reports[one.feature].reasons.push_back(base::warning("pipeline-left-out", one.what, reports[one.feature].id));
    }
    for (auto& [f, warning] : results[b].unchecked) {
      warning.subject = reports[f].id;
      reports[f].reasons.push_back(warning);
      if (f < scene.footprints.size()) out.warnings.push_back(std::move(warning));
    }
    out.blocks.push_back(std::move(results[b].report));
    out.error_maps.push_back(std::move(results[b].map));
    out.warnings.insert(out.warnings.end(), results[b].warnings.begin(), results[b].warnings.end());
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (accounts[i].area > 0) reports[i].rmse = std::sqrt(accounts[i].squared / accounts[i].area);
    auto& attributes = buildings[i].attributes;
    attributes.emplace_back("ms_outcome", std::string(to_string(reports[i].outcome)));
    if (reports[i].parts > 0) {
      attributes.emplace_back("ms_h_ground", reports[i].ground);
      attributes.emplace_back("ms_h_roof_max", reports[i].roof_max);
      attributes.emplace_back("ms_volume_lod22", reports[i].volume);
      if (reports[i].rmse) attributes.emplace_back("ms_rmse_lod22", *reports[i].rmse);
      if (reports[i].left_out > 0) attributes.emplace_back("ms_area_left_out", reports[i].left_out);
      report::round_measures(attributes);
    }
  }
  buildings.resize(scene.footprints.size());
  reports.resize(scene.footprints.size());
  out.city.frame = scene.frame;
  out.city.made_by = made_by(scene, options);
  out.city.buildings = std::move(buildings);
  out.buildings = std::move(reports);
  return out;
}

}  // namespace mansard::pipeline::detail
