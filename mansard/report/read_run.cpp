#include "mansard/report/read_run.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace mansard::report {
namespace {

using Json = nlohmann::ordered_json;

auto number_at(const Json& object, const char* key) -> std::optional<double> {
  const auto at = object.find(key);
  return at != object.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}
auto text_at(const Json& object, const char* key) -> std::string {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

auto accuracy_of(const Json& json) -> model::Accuracy {
  model::Accuracy out;
  const auto set = [&](const char* key, double& member) {
    if (const auto number = number_at(json, key)) member = *number;
  };
  set("noise_m", out.noise);
  set("correlated_area_m2", out.correlated_area);
  set("spacing_m", out.spacing);
  set("point_area_m2", out.point_area);
  set("blur_m", out.blur);
  set("edge_noise_m", out.edge_noise);
  set("walls_seen", out.walls);
  set("offset_error_m", out.offset_error);
  set("offset_spread_m", out.offset_spread);
  if (const auto measured = json.find("measured"); measured != json.end() && measured->is_object()) {
    const auto count = [&](const char* key) {
      return static_cast<std::size_t>(std::max(number_at(*measured, key).value_or(0), 0.0));
    };
    out.windows = count("discs");
    out.transects = count("transects");
    out.edges = count("edges");
  }
  if (const auto at = json.find("offset_m");
      at != json.end() && at->is_array() && at->size() == 2 && at->at(0).is_number() && at->at(1).is_number())
    out.offset = {at->at(0).get<double>(), at->at(1).get<double>()};
  return out;
}

auto not_a_report(const std::string& subject) -> base::Diagnostic {
  return base::error("report-run", "is not the report of a run; run 'mansard reconstruct' again", subject);
}

/// All but blocks and buildings.
auto head_of(const Json& json) -> RunFile {
  RunFile out;
  if (const auto at = json.find("inputs"); at != json.end() && at->is_array())
    for (const auto& input : *at)
      if (input.is_object())
        out.inputs.push_back({text_at(input, "path"), static_cast<std::uint64_t>(number_at(input, "bytes").value_or(0)),
                              text_at(input, "sha256")});
  if (const auto at = json.find("options"); at != json.end() && at->is_object())
    for (const auto& [name, value] : at->items())
      if (value.is_string()) out.options.emplace_back(name, value.get<std::string>());
  if (const auto at = json.find("accuracy"); at != json.end() && at->is_object()) out.accuracy = accuracy_of(*at);
  return out;
}

auto mean_square_at(const Json& object, const char* mse, const char* cells) -> std::optional<MeanSquare> {
  const auto value = number_at(object, mse), count = number_at(object, cells);
  if (!value || count.value_or(0) <= 0) return std::nullopt;
  return MeanSquare{*value, *count};
}

auto scores_of(const Json& json) -> RunScores {
  RunScores out;
  out.vertical = mean_square_at(json, "vertical_mse_m2", "cells");
  out.footprint = mean_square_at(json, "footprint_mse_m2", "footprint_cells");
  const auto within = [&](const char* name, auto& score, auto& median) {
    const auto at = json.find(name);
    if (at == json.end() || !at->is_object()) return;
    score = mean_square_at(*at, "mse_m2", "cells");
    if (score) median = number_at(*at, "median_absolute_m");
  };
  within("inside", out.inside, out.inside_median);
  within("inside_each", out.inside_each, out.inside_each_median);
  if (out.vertical) {
    out.median = number_at(json, "median_m");
    out.median_absolute = number_at(json, "median_absolute_m");
    out.p95_absolute = number_at(json, "p95_absolute_m");
  }
  if (out.footprint) out.footprint_median_absolute = number_at(json, "footprint_median_absolute_m");
  out.missed = number_at(json, "missed_m2");
  out.invented = number_at(json, "invented_m2");
  return out;
}

auto building_of(const Json& json) -> RunBuilding {
  RunBuilding out{text_at(json, "id"), text_at(json, "outcome"), {}, {}, {}, number_at(json, "rmse_m")};
  if (const auto at = json.find("reasons"); at != json.end() && at->is_array())
    for (const auto& reason : *at)
      if (reason.is_object()) out.reasons.emplace_back(text_at(reason, "code"), text_at(reason, "message"));
  if (const auto at = json.find("confidence"); at != json.end() && at->is_object()) {
    out.right = number_at(*at, "right");
    out.error = number_at(*at, "error_m");
  }
  return out;
}

}  // namespace

auto read_run(std::string_view text, const std::string& subject) -> base::Result<EarlierRun> {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return not_a_report(subject);
  return static_cast<EarlierRun&&>(head_of(json));
}

auto read_run_file(const std::filesystem::path& path, const std::function<void(RunBuilding)>& visit)
    -> base::Result<RunFile> {
  std::ifstream file(path, std::ios::binary);
  if (!file) return base::error("file-missing", "cannot be opened; is this the folder of a run?", path.string());
  std::vector<RunScores> blocks;
  decltype(RunFile::warnings) warnings;
  std::string list;  // the member of the whole that is being read
  bool has_buildings = false;
  // Items of the long lists are dropped as soon as they are whole.
  const auto take = [&](int depth, Json::parse_event_t event, Json& parsed) {
    using enum Json::parse_event_t;
    if (event == key && depth == 1) list = parsed.get<std::string>();
    if (event == array_start && depth == 1 && list == "buildings") has_buildings = true;
    if (event != object_end || depth != 2) return true;
    if (list == "buildings") {
      visit(building_of(parsed));
    } else if (list == "warnings") {
      auto& [count, first] = warnings[text_at(parsed, "code")];
      if (count++ == 0) first = text_at(parsed, "message");
    } else if (list == "blocks") {
      blocks.push_back(parsed.contains("scores") ? scores_of(parsed["scores"]) : RunScores());
    } else {
      return true;
    }
    return false;
  };
  const Json json = Json::parse(file, take, false);
  if (!json.is_object() || !has_buildings) return not_a_report(path.string());
  RunFile out = head_of(json);
  out.version = text_at(json, "mansard");
  out.crs = text_at(json, "crs");
  if (const auto at = json.find("origin"); at != json.end() && at->is_array() && at->size() == 3)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (at->at(axis).is_number()) out.origin[axis] = at->at(axis).get<std::int64_t>();
  if (const auto at = json.find("counts"); at != json.end() && at->is_object())
    for (const auto& [name, value] : at->items())
      if (value.is_number_unsigned()) out.counts[name] = value.get<std::size_t>();
  if (const auto at = json.find("scores"); at != json.end() && at->is_object()) out.scores = scores_of(*at);
  out.blocks = std::move(blocks);
  out.warnings = std::move(warnings);
  return out;
}

auto read_changed(std::string_view text, const std::string& subject) -> base::Result<Changed> {
  const Json json = Json::parse(text, nullptr, false);
  const auto old = json.find("old"), counts = json.find("counts");  // the end where it is no object
  if (old == json.end() || !old->is_object() || counts == json.end() || !counts->is_object())
    return base::error("report-changes", "is not the report of 'mansard compare'; give its changes.json or its folder",
                       subject);
  Changed out;
  out.since = text_at(*old, "models");
  for (const auto& [kind, count] : counts->items())
    if (count.is_number_unsigned() && count.get<std::size_t>() > 0)
      out.by_kind.emplace_back(kind, count.get<std::size_t>());
  return out;
}

}  // namespace mansard::report
