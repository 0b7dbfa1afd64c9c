// What an evaluation found, as JSON and as a table.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mansard/base/text.hpp"
#include "mansard/report/detail/degrees.hpp"
#include "mansard/report/detail/form.hpp"
#include "mansard/report/evaluation.hpp"

namespace mansard::report {
namespace {

using Json = nlohmann::ordered_json;
using base::to_text;
using detail::degrees;

auto inside_json(const evaluate::InsideScores& s) -> Json {
  if (s.cells == 0) return nullptr;
  return {{"mse_m2", s.mse}, {"median_absolute_m", s.median_absolute}, {"cells", s.cells}};
}

/// Missed and invented area mean something only where others say where buildings are.
auto json_of(const evaluate::Scores& s, bool independent) -> Json {
  Json out{{"vertical_mse_m2", s.mse},
           {"rmse_m", std::sqrt(s.mse)},
           {"cells", s.cells},
           {"median_m", s.median},
           {"median_absolute_m", s.median_absolute},
           {"p95_absolute_m", s.p95_absolute},
           {"footprint_mse_m2", s.footprint_mse},
           {"footprint_rmse_m", std::sqrt(s.footprint_mse)},
           {"footprint_cells", s.footprint_cells},
           {"footprint_median_absolute_m", s.footprint_median_absolute},
           {"inside", inside_json(s.inside)},
           {"inside_each", inside_json(s.inside_each)}};
  out["missed_m2"] = independent ? Json(s.missed) : Json(nullptr);
  out["invented_m2"] = independent ? Json(s.invented) : Json(nullptr);
  return out;
}

/// Of prisms: they miss and invent nothing, and each is measured by itself, so that party walls are boundaries.
auto json_of_prism(const evaluate::Scores& s) -> Json {
  return {{"footprint_mse_m2", s.footprint_mse},
          {"footprint_cells", s.footprint_cells},
          {"footprint_median_absolute_m", s.footprint_median_absolute},
          {"inside_each", inside_json(s.inside_each)}};
}

/// Which buildings would be better as a prism.
template <class Worse>
auto ids_of(const std::vector<BuildingScores>& buildings, Worse worse) -> std::vector<std::string> {
  std::vector<std::string> ids;
  for (const auto& building : buildings)
    if (worse(building)) ids.push_back(building.id);
  return ids;
}

auto json_of(const BuildingScores& b, bool independent) -> Json {
  // Over one footprint alone, nothing is invented and its boundary is the only one.
  const auto own = [&](const evaluate::Scores& s) {
    Json scores = json_of(s, independent);
    scores.erase("invented_m2");
    scores.erase("inside");
    return scores;
  };
  Json prism = json_of_prism(b.prism.scores);
  prism["height_m"] = b.prism.height;
  Json out{{"id", b.id},
           {"block", b.block},
           {"modelled", b.modelled},
           {"scores", own(b.scores)},
           {"prism", std::move(prism)},
           {"worse_than_prism", worse_than_prism(b)}};
  if (b.from_truth && b.prism_from_truth) {
    Json truth = own(*b.from_truth);
    truth["prism_footprint_mse_m2"] = b.prism_from_truth->footprint_mse;
    truth["worse_than_prism"] = worse_than_prism_from_truth(b);
    out["truth"] = std::move(truth);
  }
  return out;
}

auto json_of(const evaluate::Spread& s) -> Json {
  return {{"samples", s.samples}, {"mean_m", s.mean}, {"rms_m", s.rms}, {"p95_m", s.p95}, {"max_m", s.most}};
}

auto json_of(const evaluate::Partition& p) -> Json {
  const auto share = [&](std::size_t of) {
    return of > 0 ? static_cast<double>(p.matched) / static_cast<double>(of) : 0;
  };
  return {{"truth", p.truth},
          {"model", p.model},
          {"matched", p.matched},
          {"recall", share(p.truth)},
          {"precision", share(p.model)},
          {"mean_iou", p.iou},
          {"splits", p.splits},
          {"merges", p.merges}};
}

auto ratio(double part, double whole) -> Json { return whole > 0 ? Json(part / whole) : Json(nullptr); }

auto json_of(const TruthScores& t) -> Json {
  const auto& r = t.roofs;
  Json confusion = Json::object();
  for (std::size_t i = 0; i < t.classes.area.size(); ++i)
    for (std::size_t j = 0; j < t.classes.area.size(); ++j)
      confusion[std::string(model::to_string(static_cast<model::SurfaceClass>(i)))]
               [std::string(model::to_string(static_cast<model::SurfaceClass>(j)))] = t.classes.area[i][j];
  return {{"scores", json_of(t.scores, true)},
          {"prism", json_of_prism(t.prism)},
          {"parts", json_of(t.parts)},
          {"buildings", json_of(t.buildings)},
          {"party_walls",
           {{"truth_m", t.party_walls.truth},
            {"recall", ratio(t.party_walls.found, t.party_walls.truth)},
            {"model_m", t.party_walls.model},
            {"precision", ratio(t.party_walls.right, t.party_walls.model)}}},
          {"roofs",
           {{"planes", r.planes},
            {"planes_found", r.found},
            {"planes_broad", r.broad},
            {"planes_broad_found", r.broad_found},
            {"places", r.places},
            {"bare", r.bare},
            {"angle_mean_deg", degrees(r.angle_mean)},
            {"angle_median_deg", degrees(r.angle_median)},
            {"offset_median_m", r.offset_median},
            {"offset_p95_absolute_m", r.offset_p95_absolute},
            {"share_within_3_deg", r.right_angle},
            {"share_within_0.25_m", r.right_height},
            {"share_within_both", r.right}}},
          {"classes",
           {{"accuracy", t.classes.accuracy()}, {"beyond_1_m_m2", t.classes.beyond}, {"confusion_m2", confusion}}}};
}

auto json_of(const ModelCounts& c) -> Json {
  Json areas = Json::object();
  for (std::size_t i = 0; i < c.area.size(); ++i)
    areas[std::string(model::to_string(static_cast<model::SurfaceClass>(i)))] = c.area[i];
  return {{"buildings", c.buildings}, {"parts", c.parts}, {"faces", c.faces}, {"planes", c.planes}, {"area_m2", areas}};
}

auto warnings_json(const std::vector<base::Diagnostic>& all) -> Json {
  Json out = Json::array();
  for (const auto& d : all) out.push_back({{"code", d.code}, {"subject", d.subject}, {"message", d.message}});
  return out;
}

/// One line of the table: what it is, then what it came to.
auto line(const std::string& what, const std::string& value) -> std::string {
  constexpr std::size_t width = 36;
  // Characters, not bytes: continuation bytes of UTF-8 take no room.
  const auto size = static_cast<std::size_t>(std::ranges::count_if(what, [](char c) { return (c & 0xC0) != 0x80; }));
  return what + std::string(size < width ? width - size : 1, ' ') + value + "\n";
}

auto in_words(const evaluate::Spread& s) -> std::string {
  if (s.samples == 0) return "nothing to measure";
  return "mean " + to_text(s.mean, 3) + ", RMS " + to_text(s.rms, 3) + ", 95 % " + to_text(s.p95, 3) + ", most " +
         to_text(s.most, 2) + " m";
}

auto percent(double part, double whole) -> std::string {
  return whole > 0 ? to_text(100 * part / whole, 1) + " %" : std::string("-");
}

auto in_words(const evaluate::Partition& p) -> std::string {
  return std::to_string(p.matched) + " of " + std::to_string(p.truth) + " matched (" + std::to_string(p.model) +
         " in the model), mean IoU " + to_text(p.iou, 3) + ", " + std::to_string(p.splits) + " split, " +
         std::to_string(p.merges) + " merged";
}

auto in_words(const evaluate::InsideScores& s) -> std::string {
  return to_text(s.mse, 4) + " m², median absolute " + to_text(s.median_absolute, 3) + " m";
}

/// The lines of what lies inside, where it was measured, and of the prisms.
auto inside_lines(const evaluate::Scores& s, double inset) -> std::string {
  if (s.inside.cells == 0) return {};
  const std::string deep = to_text(inset, 2) + " m";
  return line("  " + deep + " inside them", in_words(s.inside)) +
         line("  " + deep + " inside each", in_words(s.inside_each));
}

template <class Worse>
auto prism_lines(const evaluate::Scores& prism, const std::vector<BuildingScores>& buildings, Worse worse)
    -> std::string {
  const auto ids = ids_of(buildings, worse);
  std::string named;
  constexpr std::size_t most_named = 8;  // about one line more; all of them are in the report
  for (std::size_t i = 0; i < std::min(ids.size(), most_named); ++i) named += (i == 0 ? ": " : ", ") + ids[i];
  if (ids.size() > most_named) named += " and " + std::to_string(ids.size() - most_named) + " more";
  return line("  flat prisms in its place", to_text(prism.footprint_mse, 4) + " m²") +
         line("  worse than their prism",
              std::to_string(ids.size()) + " of " + std::to_string(buildings.size()) + " buildings" + named);
}

auto table_of(const Evaluation& e, const TruthScores& t, double inset) -> std::string {
  const auto& r = t.roofs;
  std::string out = "\nagainst the truth\n";
  out += line("  over the footprints", to_text(t.scores.footprint_mse, 4) + " m², median absolute " +
                                           to_text(t.scores.footprint_median_absolute, 3) + " m");
  out += inside_lines(t.scores, inset);
  out += prism_lines(t.prism, e.buildings, worse_than_prism_from_truth);
  out += line("  buildings", in_words(t.buildings));
  out += line("  parts", in_words(t.parts));
  out += line("  party walls found", percent(t.party_walls.found, t.party_walls.truth) + " of " +
                                         to_text(t.party_walls.truth / 2, 1) + " m; " +
                                         percent(t.party_walls.right, t.party_walls.model) + " of the model's " +
                                         to_text(t.party_walls.model / 2, 1) + " m are right");
  out += line("  roof planes found", std::to_string(r.found) + " of " + std::to_string(r.planes));
  out += line("  roof within 3°, 0.25 m, both",
              percent(r.right_angle, 1) + ", " + percent(r.right_height, 1) + ", " + percent(r.right, 1));
  out += line("  roof angle, height", "median " + to_text(degrees(r.angle_median), 2) + "°, median " +
                                          to_text(r.offset_median, 3) + " m, 95 % within " +
                                          to_text(r.offset_p95_absolute, 3) + " m");
  out += line("  classes right", percent(t.classes.accuracy(), 1) + " of the area within 1 m of the truth (" +
                                     to_text(t.classes.beyond, 1) + " m² beyond)");
  out += "form against the truth\n";
  for (const auto& [what, value] : detail::lines_of(t.form, e.form)) out += line(what, value);
  return out + "\n" + confusion_table(t.classes.area);
}

}  // namespace

auto confusion_table(const ClassAreas& area) -> std::string {
  const auto cell = [](const std::string& text) {
    constexpr std::size_t width = 11;
    return std::string(text.size() < width ? width - text.size() : 1, ' ') + text;
  };
  const auto name = [](std::size_t c) { return std::string(model::to_string(static_cast<model::SurfaceClass>(c))); };
  std::string out = "  m², truth \\ given";
  for (std::size_t c = 0; c < area.size(); ++c) out += cell(name(c));
  out += "\n";
  for (std::size_t t = 0; t < area.size(); ++t) {
    out += "  " + name(t) + std::string(16 - name(t).size(), ' ');
    for (const double m2 : area[t]) out += cell(to_text(m2, 1));
    out += "\n";
  }
  return out;
}

auto to_string(Reference reference) -> std::string_view {
  switch (reference) {
    case Reference::footprints: return "footprints";
    case Reference::truth: return "truth";
    case Reference::model: return "model";
  }
  return "";
}

auto worse_than_prism(const BuildingScores& building) -> bool {
  return building.scores.footprint_mse > building.prism.scores.footprint_mse + worse_by;
}

auto worse_than_prism_from_truth(const BuildingScores& building) -> bool {
  return building.from_truth && building.prism_from_truth &&
         building.from_truth->footprint_mse > building.prism_from_truth->footprint_mse + worse_by;
}

auto evaluation_json(const Evaluation& e, const EvaluationInput& input) -> std::string {
  const bool independent = input.reference != Reference::model;
  Json out;
  out["mansard"] = e.version;
  Json inputs = Json::array();
  for (const auto& file : input.scene.inputs)
    inputs.push_back({{"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}});
  out["inputs"] = inputs;
  out["crs"] = input.scene.frame.crs.empty() ? Json(nullptr) : Json(input.scene.frame.crs);
  out["lod"] = input.model.lod.empty() ? Json(nullptr) : Json(input.model.lod);
  out["grid_m"] = e.options.grid;
  out["inset_m"] = e.options.inset;
  out["seed"] = e.seed;
  out["footprints_of"] = to_string(input.reference);
  out["model"] = json_of(e.counts);
  out["form"] = detail::json_of(e.form);
  out["scores"] = json_of(e.scores, independent);
  out["distances"] = {{"model_to_mesh", json_of(e.from_model)}, {"mesh_to_model", json_of(e.from_scan)}};
  if (e.points)
    out["building_points"] = {{"points", e.points->points},
                              {"without_model", e.points->without_model},
                              {"median_m", e.points->median},
                              {"median_absolute_m", e.points->median_absolute},
                              {"rmse_m", e.points->rmse},
                              {"within_10cm", e.points->within_10cm},
                              {"within_25cm", e.points->within_25cm},
                              {"within_50cm", e.points->within_50cm}};
  out["prism"] = json_of_prism(e.prism);
  out["worse_than_prism"] = ids_of(e.buildings, worse_than_prism);
  if (e.truth) {
    out["truth"] = json_of(*e.truth);
    out["truth"]["form"] = detail::json_of(e.truth->form, e.form);
    out["truth"]["form"]["planes_by_building"] = detail::compared_json(e.truth->form, input);
    out["truth"]["worse_than_prism"] = ids_of(e.buildings, worse_than_prism_from_truth);
  }
  out["beside_all_footprints"] = e.beside;
  auto warnings = input.scene.warnings;
  warnings.insert(warnings.end(), e.warnings.begin(), e.warnings.end());
  out["warnings"] = warnings_json(warnings);
  out["blocks"] = Json::array();
  for (const auto& block : e.blocks)
    out["blocks"].push_back({{"name", block.name},
                             {"buildings", block.buildings},
                             {"model_buildings", block.model_buildings},
                             {"scores", json_of(block.scores, independent)},
                             {"model_to_mesh", json_of(block.from_model)},
                             {"mesh_to_model", json_of(block.from_scan)}});
  out["buildings"] = Json::array();
  for (const auto& building : e.buildings) out["buildings"].push_back(json_of(building, independent));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

auto evaluation_table(const Evaluation& e, const EvaluationInput& input) -> std::string {
  const double inset = e.options.inset;
  const auto& s = e.scores;
  const auto& c = e.counts;
  const std::string whose = input.reference == Reference::footprints ? "the footprints given"
                            : input.reference == Reference::truth    ? "the truth's footprints"
                                                                     : "the model's own footprints";
  std::string out;
  out += line("model", std::to_string(c.buildings) + " buildings, " + std::to_string(c.parts) + " parts, " +
                           std::to_string(c.faces) + " faces, " + std::to_string(c.planes) + " planes" +
                           (input.model.lod.empty() ? "" : ", LoD " + input.model.lod));
  out += line("measured over", whose + ": " + std::to_string(e.buildings.size()) + " in " +
                                   std::to_string(e.blocks.size()) + (e.blocks.size() == 1 ? " block" : " blocks"));
  out += line("vertical error", to_text(s.mse, 4) + " m² where both have a surface (RMSE " +
                                    to_text(std::sqrt(s.mse), 3) + " m; " + std::to_string(s.cells) + " cells)");
  out += line("  over the footprints", to_text(s.footprint_mse, 4) + " m², what is missing counted as ground (RMSE " +
                                           to_text(std::sqrt(s.footprint_mse), 3) + " m)");
  out += inside_lines(s, inset);
  out += prism_lines(e.prism, e.buildings, worse_than_prism);
  out += line("  median, 95 %", to_text(s.median, 3) + " m (model - mesh), " + to_text(s.p95_absolute, 3) + " m");
  if (input.reference == Reference::model)
    out += line("missed, invented", "not measured: give --truth or --footprints");
  else out += line("missed, invented", to_text(s.missed, 1) + " m², " + to_text(s.invented, 1) + " m²");
  if (!e.beside.empty()) out += line("on no footprint", std::to_string(e.beside.size()) + " buildings of the model");
  out += line("model to mesh", in_words(e.from_model));
  out += line("mesh to model", in_words(e.from_scan));
  if (e.points) {
    const auto& p = *e.points;
    const auto percent = [](double share) { return to_text(100 * share, 1) + " %"; };
    out += line("building points", "RMSE " + to_text(p.rmse, 3) + " m, median " + to_text(p.median, 3) +
                                       " m (point - model); within 0.1, 0.25, 0.5 m " + percent(p.within_10cm) + ", " +
                                       percent(p.within_25cm) + ", " + percent(p.within_50cm));
    out += line("  of buildings", std::to_string(p.points - p.without_model) + " over the model, " +
                                      std::to_string(p.without_model) + " beside it");
  }
  out += "form\n";
  for (const auto& [what, value] : detail::lines_of(e.form)) out += line(what, value);
  if (e.truth) out += table_of(e, *e.truth, inset);
  return out;
}

}  // namespace mansard::report
