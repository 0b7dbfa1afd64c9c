// The report of the sensitivity experiment: the page, and every number as JSON and CSV.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/explore/detail/measure.hpp"
#include "lab/explore/detail/page.hpp"
#include "lab/explore/sensitivity.hpp"
#include "mansard/base/text.hpp"

namespace mansard::explore {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view headings = "dataset,parameter,value,rmse_m,rmse_inside_m,faces,parts,cpu_s,models,failure";

auto one_line_cell(const std::string& text) -> std::string {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : c == '\n' || c == '\r' ? " " : std::string(1, c);
  return out + "\"";
}

/// The cells of one line.
auto cells_of(std::string_view line) -> std::vector<std::string> {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[i++];
    else if (line[i] == '"') quoted = !quoted;
    else if (line[i] == ',' && !quoted) cells.emplace_back();
    else cells.back() += line[i];
  }
  return cells;
}

auto json_of(const Trial& trial) -> Json {
  Json out{{"dataset", trial.dataset}};
  if (!trial.failure.empty()) out["failure"] = trial.failure;
  else
    out.update({{"rmse_m", trial.rmse},
                {"rmse_inside_m", trial.rmse_inside},
                {"faces", trial.faces},
                {"parts", trial.parts},
                {"models", trial.models},
                {"seconds", {{"cpu", trial.cpu_seconds}}}});
  return out;
}

auto results_json(const Sensitivity& result) -> std::string {
  Json usual = Json::array(), effects = Json::array();
  for (const auto& trial : result.usual) usual.push_back(json_of(trial));
  for (const auto& effect : result.effects) {
    Json runs = Json::array();
    for (const auto& trial : effect.trials) runs.push_back(json_of(trial));
    effects.push_back({{"parameter", effect.key},
                       {"usual", effect.usual},
                       {"value", effect.value},
                       {"effect", effect.largest},
                       {"no_effect", effect.none},
                       {"runs", std::move(runs)}});
  }
  const Json out{{"experiment", "sensitivity"},
                 {"version", result.version},
                 {"command", result.command},
                 {"usual", std::move(usual)},
                 {"effects", std::move(effects)}};
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

auto results_csv(const Sensitivity& result) -> std::string {
  std::string out = "parameter,usual,value,effect,no_effect,";
  out += std::string(headings.substr(0, headings.find(','))) + ",rmse_m,rmse_inside_m,faces,parts,cpu_s,failure\n";
  const auto add = [&](const std::string& first, const Trial& t) {
    out += first + "," + one_line_cell(t.dataset) + "," + base::to_text(t.rmse) + "," + base::to_text(t.rmse_inside) +
           "," + std::to_string(t.faces) + "," + std::to_string(t.parts) + "," + base::to_text(t.cpu_seconds, 3) + "," +
           one_line_cell(t.failure) + "\n";
  };
  for (const auto& trial : result.usual) add(",,,,", trial);
  for (const auto& effect : result.effects)
    for (const auto& trial : effect.trials)
      add(one_line_cell(effect.key) + "," + one_line_cell(effect.usual) + "," + one_line_cell(effect.value) + "," +
              base::to_text(effect.largest) + "," + (effect.none ? "yes" : "no"),
          trial);
  return out;
}

}  // namespace

auto trials_head(const SensitivityRequest& request) -> std::string {
  std::string line = "# mansard " + request.version;
  for (const auto& [key, value] : detail::values_of(request.options)) line += " " + key + "=" + value;
  std::ranges::replace(line, '\n', ' ');
  return line + "\n" + std::string(headings) + "\n";
}

auto trial_line(const Trial& t) -> std::string {
  return one_line_cell(t.dataset) + "," + one_line_cell(t.key) + "," + one_line_cell(t.value) + "," +
         base::to_text(t.rmse) + "," + base::to_text(t.rmse_inside) + "," + std::to_string(t.faces) + "," +
         std::to_string(t.parts) + "," + base::to_text(t.cpu_seconds, 3) + "," + t.models + "," +
         one_line_cell(t.failure) + "\n";
}

auto trials_from(std::string_view text, const SensitivityRequest& request) -> std::vector<Trial> {
  std::vector<Trial> trials;
  const auto head = trials_head(request);
  if (!text.starts_with(head)) return trials;
  text.remove_prefix(head.size());
  for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
    const auto cells = cells_of(text.substr(0, end));
    if (cells.size() != 10) continue;
    const auto rmse = base::to_number(cells[3]), inside = base::to_number(cells[4]),
               seconds = base::to_number(cells[7]);
    const auto faces = base::to_integer(cells[5]), parts = base::to_integer(cells[6]);
    if (!rmse || !inside || !seconds || !faces || !parts) continue;
    trials.push_back({cells[0], cells[1], cells[2], *rmse, *inside, static_cast<std::size_t>(*faces),
                      static_cast<std::size_t>(*parts), *seconds, cells[8], cells[9]});
  }
  return trials;
}

auto report(const Sensitivity& result) -> std::vector<std::pair<std::string, std::string>> {
  return {{"index.html", detail::sensitivity_html(result)},
          {"results.json", results_json(result)},
          {"results.csv", results_csv(result)}};
}

}  // namespace mansard::explore
