#include "mansard/pipeline/detail/assemble.hpp"
#include "mansard/solid/solid.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "mansard/report/attributes.hpp"
#include "mansard/report/measures.hpp"

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
  for (auto& warning : made.warnings) {
    warning.subject = building.id;
    if (warning.code != "solid-not-united" && warning.code != "solid-parted" && warning.code != "pipeline-overhang")
      report.outcome = report::Outcome::fallback;
    report.reasons.push_back(std::move(warning));
  }
  if (building.parts.empty()) report.outcome = report::Outcome::refused;
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
  add_eaves(part.eaves, out);
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
  double simpler = 0;  // parts
};
void take(PartResult part, const report::BlockReport& block, double z0, const model::Footprint& footprint,
          model::Building& building, report::BuildingReport& report, Account& account) {
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
  account.simpler += part.full ? 0 : 1;
  if (!part.full) report.outcome = report::Outcome::fallback;
  for (auto reason : part.reasons) {
    if (reason.subject.empty()) reason.subject = building.id;
    report.reasons.push_back(std::move(reason));
  }
  auto attributes = attributes_of(part, block, z0);
  building.parts.push_back(
      {footprint.part_id(report.parts), std::move(part.plan), std::move(part.model), std::move(attributes)});
}

}  // namespace

void add_attributes(model::Building& building, const report::BuildingReport& report, const model::Attributes& measures,
                    const Options& options, double z0) {
  auto& attributes = building.attributes;
  const std::string outcome(to_string(report.outcome));
  auto own = report::building_measures(building, z0, options.roof.level_height,
                                       report.ground_mean ? std::optional(*report.ground_mean - z0) : std::nullopt);
  attributes.emplace_back("ms_outcome", outcome);
  attributes.emplace_back("ms_success", report.parts > 0);
  report::add_quality(outcome, report::failed_checks(outcome, measures, report.ground_source), report.confidence,
                      attributes);
  report::set_reasons(attributes, report.reasons);
  if (!options.survey_source.empty()) attributes.emplace_back("ms_source", options.survey_source);
  if (!options.survey_date.empty()) attributes.emplace_back("ms_source_date", options.survey_date);
  std::ranges::move(own, std::back_inserter(attributes));
  attributes.insert(attributes.end(), measures.begin(), measures.end());
  if (report.parts == 0) return report::round_measures(attributes);
  attributes.emplace_back("ms_h_ground", report.ground);
  if (report.ground_mean) attributes.emplace_back("ms_h_ground_mean", *report.ground_mean);
  if (report.ground_max) attributes.emplace_back("ms_h_ground_max", *report.ground_max);
  attributes.emplace_back("ms_ground_source", report.ground_source);
  attributes.emplace_back("ms_h_roof_max", report.roof_max);
  attributes.emplace_back("ms_volume_lod22", report.volume);
  if (report.rmse) attributes.emplace_back("ms_rmse_lod22", *report.rmse);
  if (report.left_out > 0) attributes.emplace_back("ms_area_left_out", report.left_out);
  report::round_measures(attributes);
}

namespace {

/// Why the height of a building's ground is less sure than others; none where something shows it.
auto doubt_of(block::GroundSource source) -> std::optional<base::Diagnostic> {
  using enum block::GroundSource;
  if (source == lowest)
    return base::warning("block-ground-unseen",
                         "the scan shows no level ground around this building; its base is the lowest surface beside "
                         "it, and may be too high. Give a terrain model (--dtm) or --ground-height");
  if (source == assumed)
    return base::warning("block-ground-assumed",
                         "nothing shows the ground here; its base is assumed to be a storey below the lowest roof. "
                         "Heights above ground and volumes are not measured. Give a terrain model (--dtm), "
                         "--ground-attribute or --ground-height");
  return std::nullopt;
}

/// m; how much higher a model is than the attributes of its footprint say; 0 where they say nothing. Where they say
/// storeys, heights that these allow are right: of 2.4 m each, the least that is lived in, or of 4 m with a roof of 6.
auto above_stated(const model::Building& building, const report::BuildingReport& report, const Options& options)
    -> double {
  constexpr double lowest_storey = 2.4, highest_storey = 4, highest_roof = 6;
  const auto form = roof::form_of(building.attributes, options.roof).form;
  const double made = report.roof_max - report.ground;
  switch (form.source) {
    case roof::Source::height: return made - form.height;
    case roof::Source::levels: {
      const double storeys = form.height / options.roof.level_height;
      return made - std::clamp(made, storeys * lowest_storey, storeys * highest_storey + highest_roof);
    }
    case roof::Source::assumed: break;
  }
  return 0;
}

/// What speaks most against a model before what else there is to say of it, but for why it is simpler than others. What
/// the scan does not cover is said once.
void put_first(std::vector<base::Diagnostic> doubts, report::BuildingReport& report) {
  if (report.outcome == report::Outcome::refused || report.outcome == report::Outcome::covered) return;
  const auto partly = std::ranges::find(report.reasons, "pipeline-partly-seen", &base::Diagnostic::code);
  const auto unseen = std::ranges::find(doubts, "confidence-unseen", &base::Diagnostic::code);
  if (partly != report.reasons.end() && unseen != doubts.end()) {
    *unseen = std::move(*partly);
    report.reasons.erase(partly);
  }
  for (auto& doubt : doubts) doubt.subject = report.id;
  const bool simpler = report.outcome == report::Outcome::fallback;
  report.reasons.insert(simpler ? report.reasons.end() : report.reasons.begin(),
                        std::make_move_iterator(doubts.begin()), std::make_move_iterator(doubts.end()));
}

/// A feature before anything is made of it.
auto begun(const model::Scene& scene, std::size_t feature) -> Finished {
  const auto& footprint = scene.feature(feature);
  Finished out;
  out.building.id = out.report.id = footprint.id;
  out.report.derived = footprint.derived;
  out.building.attributes = footprint.attributes;
  out.building.footprint = footprint.polygons;
  if (footprint.defect) {
    out.report.outcome = report::Outcome::refused;
    out.report.reasons.push_back(*footprint.defect);
  }
  return out;
}

}  // namespace

auto unbuilt(const model::Scene& scene, std::size_t feature, const Options& options) -> Finished {
  auto out = begun(scene, feature);
  add_attributes(out.building, out.report, {}, options, static_cast<double>(scene.frame.origin[2]));
  return out;
}

auto finish_block(const model::Scene& scene, BlockResult& result, const Options& options,
                  std::vector<base::Diagnostic>& warnings) -> std::vector<std::pair<std::size_t, Finished>> {
  const auto z0 = static_cast<double>(scene.frame.origin[2]);
  std::vector<std::pair<std::size_t, Finished>> out;
  for (const auto& [feature, ground, source, at_walls] : result.grounds) {
    auto& [building, report] = out.emplace_back(feature, begun(scene, feature)).second;
    report.block = result.report.name;
    report.ground = z0 + ground;
    building.ground = ground;
    report.ground_source = block::to_string(source);
    if (at_walls) report.ground_mean = z0 + at_walls->mean, report.ground_max = z0 + at_walls->highest;
  }
  std::vector<Account> accounts(out.size());
  const auto place_of = [&](std::size_t feature) {
    return static_cast<std::size_t>(
        std::ranges::lower_bound(out, feature, {}, [](const auto& one) { return one.first; }) - out.begin());
  };
  const auto finished = [&](std::size_t feature) -> Finished& { return out[place_of(feature)].second; };
  for (auto& part : result.parts) {
    const auto at = place_of(part.feature);
    take(std::move(part), result.report, z0, scene.feature(out[at].first), out[at].second.building,
         out[at].second.report, accounts[at]);
  }
  for (auto& [f, made] : result.solids) add_solids(finished(f).building, finished(f).report, std::move(made), z0);
  for (const std::size_t f : result.covered) {
    auto& report = finished(f).report;
    report.outcome = report::Outcome::covered;
    report.reasons.push_back(
        base::warning("pipeline-covered", "the ground of this footprint went to its neighbours' models", report.id));
  }
  for (const auto& [f, why] : result.failed) {
    auto& report = finished(f).report;
    report.outcome = report.parts == 0 ? report::Outcome::refused : report::Outcome::fallback;
    report.reasons.push_back(base::warning(why.code, why.message, report.id));
  }
  for (const auto& one : result.left_out) {
    auto& report = finished(one.feature).report;
    report.left_out = one.area;
    report.reasons.push_back(base::warning("pipeline-left-out", one.what, report.id));
  }
  for (auto& [f, doubt] : result.doubts) {
    auto& report = finished(f).report;
    doubt.subject = report.id;
    report.reasons.push_back(std::move(doubt));
  }
  for (auto& [f, warning] : result.unchecked) {
    auto& report = finished(f).report;
    warning.subject = report.id;
    report.reasons.push_back(warning);
    if (f < scene.footprints.size()) warnings.push_back(std::move(warning));
  }
  for (const auto& [f, search] : result.searches) finished(f).report.search = search;
  warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
  for (std::size_t i = 0; i < out.size(); ++i) {
    auto& [building, report] = out[i].second;
    if (auto doubt = doubt_of(result.grounds[i].source); doubt && report.parts > 0) {
      doubt->subject = report.id;
      report.reasons.push_back(*std::move(doubt));
    }
    if (const auto seen = std::ranges::find(result.evidence, out[i].first, [](const auto& one) { return one.first; });
        seen != result.evidence.end()) {
      using enum confidence::Measure;
      auto& evidence = report.evidence.emplace(seen->second);
      evidence[fallback] = accounts[i].simpler / static_cast<double>(std::max<std::size_t>(1, report.parts));
      evidence[confidence::Measure::height_off] = above_stated(building, report, options);
      evidence[doubtful] = doubt_of(result.grounds[i].source) ? 1 : 0;
      report.confidence = confidence::confidence_of(evidence);
      put_first(report.confidence->reasons, report);
    }
    if (accounts[i].area > 0) report.rmse = std::sqrt(accounts[i].squared / accounts[i].area);
    const auto known = std::ranges::find(result.measures, out[i].first, [](const auto& one) { return one.first; });
    add_attributes(building, report, known != result.measures.end() ? known->second : model::Attributes(), options, z0);
  }
  return out;
}

}  // namespace mansard::pipeline::detail
