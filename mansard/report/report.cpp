// run.json: what was done, with counts, times, and every building's outcome and reason.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/report/report.hpp"

namespace mansard::report {
namespace {

using Json = nlohmann::ordered_json;

auto json_of(const base::Diagnostic& d) -> Json {
  return {{"severity", d.severity == base::Severity::error ? "error" : "warning"},
          {"code", d.code},
          {"subject", d.subject},
          {"message", d.message}};
}

auto json_of(const std::vector<base::Diagnostic>& all) -> Json {
  Json out = Json::array();
  for (const auto& d : all) out.push_back(json_of(d));
  return out;
}

auto json_of(const base::Spent& spent) -> Json {
  const auto shown = [](double seconds) { return std::round(seconds * 1e4) / 1e4; };
  return {{"cpu_seconds", shown(spent.cpu_seconds)}, {"wall_seconds", shown(spent.wall_seconds)}};
}

auto json_of(const Times& times) -> Json {
  Json stages = Json::object();
  for (const auto& time : times.stages) stages[time.stage] = json_of(time.spent);
  Json out = json_of(times.total);
  out["stages"] = std::move(stages);
  return out;
}

/// Of blocks, or of the tasks in which footprints without a mesh are extruded.
auto json_of(const Reuse& reuse, const std::string& what) -> Json {
  Json made = Json::object();
  for (const auto& [name, why] : reuse.made) made[why].push_back(name);
  return {{what + "_taken_over", reuse.blocks}, {what + "_made_again", std::move(made)}};
}

auto json_of(const evaluate::InsideScores& s) -> Json {
  return {{"mse_m2", s.mse}, {"median_absolute_m", s.median_absolute}, {"cells", s.cells}};
}

auto json_of(const evaluate::Scores& s) -> Json {
  return {{"vertical_mse_m2", s.mse},
          {"cells", s.cells},
          {"footprint_mse_m2", s.footprint_mse},
          {"footprint_cells", s.footprint_cells},
          {"footprint_median_absolute_m", s.footprint_median_absolute},
          {"inside", json_of(s.inside)},
          {"inside_each", json_of(s.inside_each)},
          {"median_m", s.median},
          {"median_absolute_m", s.median_absolute},
          {"p95_absolute_m", s.p95_absolute},
          {"missed_m2", s.missed},
          {"invented_m2", s.invented}};
}

/// What was not measured is null; what is assumed in its place is in the options.
auto json_of(const model::Accuracy& a) -> Json {
  const auto if_measured = [](std::size_t from, double value) { return from > 0 ? Json(value) : Json(nullptr); };
  return {{"noise_m", a.noise},
          {"correlated_area_m2", a.correlated_area},
          {"spacing_m", a.spacing},
          {"point_area_m2", a.point_area > 0 ? Json(a.point_area) : Json(nullptr)},
          {"blur_m", a.blur},
          {"edge_noise_m", a.edge_noise},
          {"walls_seen", a.walls},
          {"offset_m", a.edges > 0 ? Json{a.offset.x, a.offset.y} : Json(nullptr)},
          {"offset_error_m", if_measured(a.edges, a.offset_error)},
          {"offset_spread_m", if_measured(a.edges, a.offset_spread)},
          {"measured", {{"discs", a.windows}, {"transects", a.transects}, {"edges", a.edges}}}};
}

/// Scores are of models; blocks that are only segmented have none.
auto json_of(const BlockReport& b, bool with_scores) -> Json {
  Json objective = Json::object();
  for (const auto& info : segment::terms()) objective[std::string(info.name)] = b.terms[info.term];
  objective.update({{"total", b.objective},
                    {"bound", b.bound},
                    {"gap", b.objective - b.bound},
                    {"relative_gap", relative_gap(b)},
                    {"status", b.status},
                    {"rounds", b.rounds},
                    {"nodes", b.nodes}});
  Json out{{"name", b.name},
           {"buildings", b.buildings},
           {"parts", b.parts},
           {"triangles", b.triangles},
           {"slices", b.slices},
           {"slice_segments", b.slice_segments},
           {"sweep_edges", b.sweep_edges},
           {"faces", b.faces},
           {"inside_faces", b.inside_faces},
           {"candidate_edges", b.candidates},
           {"variables", b.variables},
           {"conflicts", b.conflicts},
           {"objective", std::move(objective)},
           {"accuracy", json_of(b.accuracy)}};
  if (with_scores) out["scores"] = json_of(b.scores);
  out["times"] = json_of(b.times);
  return out;
}

auto json_of(const std::vector<BlockReport>& blocks, bool with_scores) -> Json {
  Json out = Json::array();
  for (const auto& block : blocks) out.push_back(json_of(block, with_scores));
  return out;
}

auto json_of(const BuildingReport& b) -> Json {
  Json out{{"id", b.id},
           {"block", b.block},
           {"outcome", to_string(b.outcome)},
           {"reasons", json_of(b.reasons)},
           {"parts", b.parts}};
  if (b.derived) out["derived"] = true;
  if (b.parts > 0) {
    out["ground_m"] = b.ground;
    if (!b.ground_source.empty()) out["ground_source"] = b.ground_source;
    out["roof_min_m"] = b.roof_min;
    out["roof_max_m"] = b.roof_max;
    out["volume_m3"] = b.volume;
    out["areas_m2"] = {{"wall", b.areas.wall},           {"party_wall", b.areas.party_wall},
                       {"roof_flat", b.areas.roof_flat}, {"roof_sloped", b.areas.roof_sloped},
                       {"soffit", b.areas.soffit},       {"ground", b.areas.ground}};
  }
  if (b.evidence) {
    Json measures = Json::object();
    for (std::size_t m = 0; m < confidence::measures; ++m)
      measures[std::string(confidence::name_of(static_cast<confidence::Measure>(m)))] =
          std::round(b.evidence->of[m] * 1e4) / 1e4;
    out["evidence"] = std::move(measures);
  }
  if (b.confidence) {
    const auto digits = [](double value, double per_unit) { return std::round(value * per_unit) / per_unit; };
    out["confidence"] = {{"right", digits(b.confidence->right, 1e3)},
                         {"error_m", digits(b.confidence->error, 1e3)},
                         {"class", confidence::class_of(b.confidence->right)}};
  }
  if (b.search)
    out["search"] = {{"samples", b.search->samples},
                     {"corners", b.search->corners},
                     {"work", b.search->work},
                     {"bound", b.search->bound}};
  if (b.left_out > 0) out["left_out_m2"] = b.left_out;
  if (!b.roof.empty()) out["roof"] = b.roof;
  if (!b.height_from.empty()) out["height_from"] = b.height_from;
  out["rmse_m"] = b.rmse ? Json(*b.rmse) : Json(nullptr);
  return out;
}

/// In memory, or in cells on disk.
auto has_mesh(const model::Scene& scene) -> bool {
  return !scene.mesh.triangles.empty() || scene.mesh_counts.triangles > 0;
}

/// What every report begins with: how it was made, and of what.
auto head(const model::MadeBy& made_by, const model::Scene& scene) -> Json {
  Json out;
  out["mansard"] = made_by.version;
  Json inputs = Json::array();
  for (const auto& input : scene.inputs)
    inputs.push_back({{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  out["inputs"] = inputs;
  out["crs"] = scene.frame.crs.empty() ? Json(nullptr) : Json(scene.frame.crs);
  out["origin"] = scene.frame.origin;
  Json options = Json::object();
  for (const auto& [name, value] : made_by.every_option.empty() ? made_by.options : made_by.every_option)
    options[name] = value;
  out["options"] = options;
  out["footprints_derived"] = std::ranges::any_of(scene.footprints, &model::Footprint::derived);
  const auto& m = scene.mesh_counts;
  if (has_mesh(scene))
    out["mesh"] = {{"vertices", m.vertices},
                   {"triangles", m.triangles},
                   {"dropped_not_finite", m.not_finite},
                   {"dropped_out_of_range", m.out_of_range},
                   {"dropped_degenerate", m.degenerate},
                   {"dropped_duplicate", m.duplicate},
                   {"non_manifold_edges", m.non_manifold_edges},
                   {"boundary_edges", m.boundary_edges},
                   {"flipped_edges", m.flipped_edges}};
  return out;
}

/// The input's, then the blocks'.
auto all_warnings(const model::Scene& scene, const std::vector<base::Diagnostic>& own) -> Json {
  std::vector<base::Diagnostic> warnings = scene.warnings;
  warnings.insert(warnings.end(), own.begin(), own.end());
  return json_of(warnings);
}

auto text_of(const Json& report) -> std::string {
  return report.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// One more item of an array that is a member of the whole, as text_of would have it.
void append_item(const Json& item, bool& first, base::Sink& sink) {
  std::string text = first ? "\n  " : ",\n  ";
  first = false;
  for (const char c : item.dump(1, ' ', false, Json::error_handler_t::replace)) {
    text += c;
    if (c == '\n') text += "  ";  // a line break within a string is escaped
  }
  sink.append(text);
}

}  // namespace

auto to_string(Outcome outcome) -> std::string_view {
  switch (outcome) {
    case Outcome::full: return "full";
    case Outcome::fallback: return "fallback";
    case Outcome::covered: return "covered";
    case Outcome::refused: return "refused";
  }
  return "";
}

auto relative_gap(const BlockReport& block) -> double {
  const double gap = block.objective - block.bound;
  return gap > 0 && block.objective != 0 ? gap / std::abs(block.objective) : 0;
}

auto parts_by_feature(const model::Scene& scene, const std::vector<SegmentedBlock>& blocks)
    -> std::vector<std::size_t> {
  std::vector<std::size_t> parts(scene.footprints.size(), 0);
  for (const auto& block : blocks) {
    if (!block.segmentation) continue;
    for (const auto& part : block.segmentation->parts)
      if (part.feature && *part.feature < parts.size()) ++parts[*part.feature];
  }
  return parts;
}

void Outcomes::add(Outcome outcome) {
  switch (outcome) {
    case Outcome::full: ++full; break;
    case Outcome::fallback: ++fallback; break;
    case Outcome::covered: ++covered; break;
    case Outcome::refused: ++refused; break;
  }
}

auto outcomes(const Reconstruction& reconstruction) -> Outcomes {
  Outcomes out;
  for (const auto& building : reconstruction.buildings) out.add(building.outcome);
  return out;
}

auto accuracy_of(const Summary& summary) -> std::optional<model::Accuracy> {
  std::vector<model::Accuracy> all;
  for (const auto& block : summary.blocks) all.push_back(block.accuracy);
  if (all.empty()) return std::nullopt;
  return accuracy::combined(all);
}

RunJson::RunJson(const Summary& s, const Outcomes& outcomes, const model::MadeBy& made_by, const model::Scene& scene,
                 base::Sink& sink)
    : sink_(sink) {
  Json out = head(made_by, scene);
  const bool scanned = has_mesh(scene);
  out["counts"] = {{"footprints", outcomes.all()}, {"full", outcomes.full},       {"fallback", outcomes.fallback},
                   {"covered", outcomes.covered},  {"refused", outcomes.refused}, {"blocks", s.blocks.size()}};
  if (scanned) {
    out["scores"] = json_of(s.scores);
    if (const auto all = accuracy_of(s)) out["accuracy"] = json_of(*all);
  }
  out["times"] = json_of(s.times);
  if (s.reuse.blocks > 0 || !s.reuse.made.empty())
    out["times"]["reuse"] = json_of(s.reuse, s.blocks.empty() ? "tasks" : "blocks");
  out["warnings"] = all_warnings(scene, s.warnings);
  std::string text = text_of(out);
  text.resize(text.rfind("\n}"));  // there is more to come
  sink_.append(text);
  if (scanned) {
    bool first = true;
    sink_.append(",\n \"blocks\": [");
    for (const auto& block : s.blocks) append_item(json_of(block, true), first, sink_);
    sink_.append(first ? "]" : "\n ]");
  }
  sink_.append(",\n \"buildings\": [");
}

void RunJson::add(const BuildingReport& building) { append_item(json_of(building), first_, sink_); }

void RunJson::finish() { sink_.append(first_ ? "]\n}\n" : "\n ]\n}\n"); }

auto run_json(const Reconstruction& r, const model::Scene& scene) -> std::string {
  base::TextSink text;
  RunJson out(r, outcomes(r), r.city.made_by, scene, text);
  for (const auto& building : r.buildings) out.add(building);
  out.finish();
  return std::move(text.text);
}

auto run_json(const Segmented& s, const model::Scene& scene) -> std::string {
  Json out = head(s.made_by, scene);
  const auto parts = parts_by_feature(scene, s.segmented);
  const auto refused = std::ranges::count_if(scene.footprints, [](const auto& f) { return f.defect.has_value(); });
  out["counts"] = {{"footprints", scene.footprints.size()},
                   {"refused", refused},
                   {"without_part", std::ranges::count(parts, 0U) - refused},
                   {"blocks", s.blocks.size()}};
  out["times"] = json_of(s.times);
  out["warnings"] = all_warnings(scene, s.warnings);
  out["blocks"] = json_of(s.blocks, false);
  return text_of(out);
}

}  // namespace mansard::report
