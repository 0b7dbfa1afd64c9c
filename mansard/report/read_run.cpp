#include "mansard/report/read_run.hpp"

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
  if (const auto at = json.find("offset_m");
      at != json.end() && at->is_array() && at->size() == 2 && at->at(0).is_number() && at->at(1).is_number())
    out.offset = {at->at(0).get<double>(), at->at(1).get<double>()};
  return out;
}

}  // namespace

auto read_run(std::string_view text, const std::string& subject) -> base::Result<EarlierRun> {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object())
    return base::error("report-run", "is not the report of a run; run 'mansard reconstruct' again", subject);
  EarlierRun out;
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

}  // namespace mansard::report
