// The report's files: the page, and every number as JSON and CSV.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "lab/explore/detail/columns.hpp"
#include "lab/explore/detail/drawings.hpp"
#include "lab/explore/detail/page.hpp"
#include "lab/explore/explore.hpp"

namespace mansard::explore {
namespace {

using Json = nlohmann::ordered_json;

auto json_of(const Setting& setting) -> Json {
  Json out = Json::object();
  for (const auto& [key, value] : setting) out[key] = value;
  return out;
}

auto json_of(const base::Diagnostic& d) -> Json {
  return {{"code", d.code}, {"subject", d.subject}, {"message", d.message}};
}

auto json_of(const Numbers& numbers) -> Json {
  Json out = Json::object(), seconds = Json::object();
  for (const auto& column : detail::columns()) {
    const double value = column.value(numbers);
    if (column.seconds()) seconds[column.key.substr(0, column.key.size() - 2)] = value;
    else if (column.decimals == 0) out[column.key] = static_cast<std::uint64_t>(value);
    else out[column.key] = value;
  }
  out["seconds"] = seconds;
  return out;
}

auto json_of(const std::vector<Rise>& rises) -> Json {
  const auto shares = detail::shares_of(rises);
  return {{"profiles", shares.profiles},         {"edges_m", shares.length},
          {"vertical_m", shares.of_kind[0]},     {"one_pitch_m", shares.of_kind[1]},
          {"more_pitches_m", shares.of_kind[2]}, {"without_slices_m", shares.unseen},
          {"raw_slices", shares.slices},         {"raw_slices_tried", shares.attempted}};
}

auto json_of(const Row& row, const Study& study) -> Json {
  Json out{{"dataset", study.datasets[row.dataset].dataset.name},
           {"setting", json_of(row.setting)},
           {"command", row.command}};
  if (row.failure) {
    out["failure"] = json_of(*row.failure);
    return out;
  }
  out["numbers"] = json_of(row.numbers);
  if (study.experiment == Experiment::profiles) out["profiles"] = json_of(row.profiles);
  Json blocks = Json::array(), warnings = Json::array();
  for (const auto& block : row.blocks) {
    Json entry{{"name", block.name}};
    entry.update(json_of(block.numbers));
    blocks.push_back(entry);
  }
  for (const auto& warning : row.warnings) warnings.push_back(json_of(warning));
  out["blocks"] = blocks;
  out["warnings"] = warnings;
  return out;
}

auto json_of(const DatasetInfo& info) -> Json {
  Json inputs = Json::array();
  for (const auto& input : info.inputs)
    inputs.push_back({{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  Json out{{"name", info.dataset.name}};
  if (!info.dataset.place.empty()) out["place"] = info.dataset.place;
  out.update({{"crs", info.crs}, {"centre", info.centre}});
  if (info.angles) out["longitude_latitude"] = *info.angles;
  out.update({{"options", json_of(info.dataset.options)}, {"inputs", inputs}});
  return out;
}

auto results_json(const Study& study) -> std::string {
  Json axes = Json::object(), datasets = Json::array(), rows = Json::array();
  for (const auto& axis : study.axes) axes[axis.key] = axis.values;
  for (const auto& info : study.datasets) datasets.push_back(json_of(info));
  for (const auto& row : study.rows) rows.push_back(json_of(row, study));
  const Json out{{"experiment", to_string(study.experiment)},
                 {"version", study.version},
                 {"command", study.command},
                 {"axes", axes},
                 {"options", json_of(study.options)},
                 {"datasets", datasets},
                 {"runs", rows}};
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

auto csv_cell(const std::string& text) -> std::string {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

auto results_csv(const Study& study) -> std::string {
  std::string out = "dataset";
  for (const auto& axis : study.axes) out += "," + csv_cell(axis.key);
  for (const auto& column : detail::columns()) out += "," + column.key;
  out += ",failure\n";
  for (const auto& row : study.rows) {
    out += csv_cell(study.datasets[row.dataset].dataset.name);
    for (std::size_t i = 0; i < study.axes.size(); ++i)
      out += "," + (i < row.setting.size() ? csv_cell(row.setting[i].second) : "");
    for (const auto& column : detail::columns()) out += "," + (row.failure ? "" : detail::exact(column, row.numbers));
    out += "," + (row.failure ? csv_cell(base::to_string(*row.failure)) : "") + "\n";
  }
  return out;
}

}  // namespace

auto report(const Study& study) -> std::vector<std::pair<std::string, std::string>> {
  std::vector<std::pair<std::string, std::string>> files{{"index.html", detail::index_html(study)},
                                                         {"results.json", results_json(study)},
                                                         {"results.csv", results_csv(study)}};
  for (const auto& row : study.rows)
    for (const auto& picture : row.pictures) files.emplace_back(picture.name, picture.png);
  return files;
}

auto is_picture(const std::string& name) -> bool {
  constexpr std::string_view before = "run-", after = ".png";
  if (!name.starts_with(before) || !name.ends_with(after)) return false;
  const auto inner = std::string_view(name).substr(before.size(), name.size() - before.size() - after.size());
  const auto dash = inner.find('-');
  if (dash == 0 || dash == std::string_view::npos) return false;
  const auto number = inner.substr(0, dash), what = inner.substr(dash + 1);
  constexpr std::array<std::string_view, 4> kinds{"angle", "above", "error", "models"};
  return std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; }) &&
         std::ranges::find(kinds, what) != kinds.end();
}

}  // namespace mansard::explore
