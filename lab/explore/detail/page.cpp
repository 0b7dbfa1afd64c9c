#include "lab/explore/detail/page.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/explore/detail/columns.hpp"
#include "lab/explore/detail/figures.hpp"
#include "lab/explore/detail/svg.hpp"
#include "mansard/base/text.hpp"

namespace mansard::explore::detail {
namespace {

constexpr auto style = R"(
:root {
  color-scheme: light dark;
  --ink: #1d1f23; --quiet: #5c636e; --line: #d5d9df; --ground: #ffffff; --raised: #f4f5f7;
}
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e8eb; --quiet: #a2a9b4; --line: #3d434c; --ground: #16181c; --raised: #202329; }
}
body { margin: 0; background: var(--ground); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 88rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem; } h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; }
p { max-width: 50rem; }
pre, code { font: 13px/1.5 ui-monospace, monospace; }
pre {
  background: var(--raised); padding: .7rem 1rem; overflow-x: auto; white-space: pre-wrap; overflow-wrap: anywhere;
}
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--quiet); padding-bottom: .4rem; }
th, td { border-bottom: 1px solid var(--line); padding: .22rem .45rem; text-align: right; vertical-align: bottom; }
th { font-weight: 600; } thead th { color: var(--quiet); font-weight: 500; }
th.name, td.name { text-align: left; } th.name { white-space: nowrap; } td.failure { text-align: left; color: #d55e00; }
td.hash { text-align: left; font: 12px ui-monospace, monospace; overflow-wrap: anywhere; }
.plots, .strip { display: flex; flex-wrap: wrap; gap: 1.2rem; align-items: flex-start; }
.matrix figure > * + * { margin-top: .3rem; }
.strip figure { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: .6rem; width: 100%; }
.strip figcaption { grid-column: 1 / -1; }
.matrix, .pictures { display: grid; gap: 1.2rem; align-items: start; }
.alone figure:first-child { grid-column: 1 / -1; }
figure { margin: 0; }
figure.beside { display: flex; flex-wrap: wrap; gap: 1.5rem; }
figcaption { color: var(--quiet); font-size: 13px; } figcaption b { color: var(--ink); }
img { box-sizing: border-box; width: 100%; height: auto; border: 1px solid var(--line); background: #ffffff; }
svg { max-width: 100%; height: auto; display: block; font: 12px system-ui, sans-serif; }
svg text { fill: var(--ink); } svg .heading { font-weight: 600; font-size: 13px; }
svg .axis { stroke: var(--quiet); } svg .grid { stroke: var(--line); } svg .cell { stroke: var(--line); }
svg text.on-dark { fill: #ffffff; } svg text.on-light { fill: #000000; }
svg .part { fill-opacity: .55; stroke: var(--ink); stroke-width: 1; stroke-linejoin: round; }
svg .gis { fill: none; stroke: var(--quiet); stroke-width: .7; stroke-dasharray: 2 2; }
.legend { padding: 0; list-style: none; }
.swatch { display: inline-block; width: .9rem; height: .7rem; margin-right: .4rem; }
)";

struct About {
  const char *title, *words;
};

auto about(Experiment experiment) -> About {
  switch (experiment) {
    case Experiment::alpha_beta:
      return {
          "Plans over α and β",
          "Figure 6 of the paper. α is paid per metre of sweep-edge left unused, β per metre of wall without one. "
          "Colours tell the parts apart; dotted lines are the GIS footprints. Each setting has its models, its plan "
          "and its vertical error (blue: the model is too low, red: too high)."};
    case Experiment::quality:
      return {"Profile quality", "Figure 7 of the paper: models and vertical errors at each quality of the profiles."};
    case Experiment::gamma:
      return {
          "Sweep-edges over γ",
          "Figure 8 of the paper. γ is the mesh area in m² that a sweep-edge must have behind it. Each setting has its "
          "models, its plan and its vertical error (blue: the model is too low, red: too high)."};
    case Experiment::datasets:
      return {"All datasets", "Figure 9 of the paper: scan with footprints, models, and vertical errors."};
    case Experiment::profiles:
      return {"All profiles", "Figure 10 of the paper: every profile of a dataset, laid over each other."};
    case Experiment::table: return {"Table 1", "Table 1 of the paper: what the program was made of, and what it gave."};
    case Experiment::grid: return {"Grid", "Every combination of the values that were asked for."};
  }
  return {};
}

auto heading_cells() -> std::string {
  std::string cells;
  for (const auto& column : columns())
    if (column.shown) cells += tag("th", escape(column.heading), {{"scope", "col"}});
  return cells;
}

auto number_cells(const Numbers& numbers) -> std::string {
  std::string cells;
  for (const auto& column : columns())
    if (column.shown)
      cells += tag("td", base::to_text(column.value(numbers), column.decimals),
                   {{"class", column.seconds() ? "seconds" : ""}});
  return cells;
}

auto shown_columns() -> std::size_t {
  return static_cast<std::size_t>(std::ranges::count_if(columns(), &Column::shown));
}

auto failure_cell(const base::Diagnostic& why, std::size_t columns) -> std::string {
  return tag("td", escape(base::to_string(why)), {{"class", "failure"}, {"colspan", std::to_string(columns)}});
}

/// "52.0116 N, 4.3571 E", or x and y where that is not known.
auto coordinates_of(const DatasetInfo& info) -> std::string {
  if (!info.angles) return base::to_text(info.centre[0], 0) + ", " + base::to_text(info.centre[1], 0);
  const auto [longitude, latitude] = *info.angles;
  constexpr int decimals = 4;  // ten metres
  return base::to_text(std::abs(latitude), decimals) + (latitude < 0 ? " S, " : " N, ") +
         base::to_text(std::abs(longitude), decimals) + (longitude < 0 ? " W" : " E");
}

/// As in the paper's Table 1.
auto place_cells(const DatasetInfo& info) -> std::string {
  return tag("td", escape(info.dataset.place), {{"class", "name"}}) +
         tag("td", info.inputs.empty() ? "" : coordinates_of(info), {{"class", "name"}});
}

auto place_headings() -> std::string {
  return tag("th", "place", {{"scope", "col"}, {"class", "name"}}) +
         tag("th", "coordinates", {{"scope", "col"}, {"class", "name"}});
}

auto has_places(const Study& study) -> bool {
  return study.experiment == Experiment::table || study.experiment == Experiment::datasets;
}

auto row_cells(const Study& study, const Row& row) -> std::string {
  auto cells = tag("th", escape(study.datasets[row.dataset].dataset.name), {{"scope", "row"}, {"class", "name"}});
  if (has_places(study)) cells += place_cells(study.datasets[row.dataset]);
  for (const auto& [key, value] : row.setting) cells += tag("td", escape(value));
  const auto missing = study.axes.size() - row.setting.size();
  return cells + (row.failure ? failure_cell(*row.failure, shown_columns() + missing) : number_cells(row.numbers));
}

auto table_of(const std::string& caption, const std::string& head, const std::string& body) -> std::string {
  return tag("div", tag("table", tag("caption", caption) + tag("thead", tag("tr", head)) + tag("tbody", body)),
             {{"class", "wide"}, {"tabindex", "0"}});
}

auto run_table(const Study& study) -> std::string {
  auto head = tag("th", "dataset", {{"scope", "col"}, {"class", "name"}});
  if (has_places(study)) head += place_headings();
  for (const auto& axis : study.axes) head += tag("th", escape(axis.key), {{"scope", "col"}});
  std::string body;
  for (const auto& row : study.rows) body += tag("tr", row_cells(study, row));
  return table_of(
      "A row a run, its blocks added up. Every number is in <a href=\"results.csv\">results.csv</a> and "
      "<a href=\"results.json\">results.json</a>, those of the blocks in the latter.",
      head + heading_cells(), body);
}

auto block_table(const Study& study) -> std::string {
  std::string body;
  for (const auto& row : study.rows)
    for (const auto& block : row.blocks)
      body +=
          tag("tr", tag("th", escape(study.datasets[row.dataset].dataset.name), {{"scope", "row"}, {"class", "name"}}) +
                        tag("td", escape(block.name), {{"class", "name"}}) + number_cells(block.numbers));
  const auto head = tag("th", "dataset", {{"scope", "col"}, {"class", "name"}}) +
                    tag("th", "block", {{"scope", "col"}, {"class", "name"}});
  return tag("details", tag("summary", "Every block for itself, as in the paper's table") +
                            table_of("A row a block.", head + heading_cells(), body));
}

constexpr auto notes =
    "<p><b>Variables, reference</b> is what the reference implementation's program would have for the same faces: "
    "6|F| + 4|H| + 6|H<sub>int</sub>| + B, with six colours a face inside, four variables a half-edge, six exclusive "
    "ors an interior half-edge, and a variable per bad pair. <b>Vertical MSE</b> is the paper's error, over the cells "
    "where model and mesh both have a surface; <b>over footprints</b> counts a missing model as ground. "
    "<b>Optimise</b> is the time from the program to the labels, <b>work</b> that of all stages; both are added up "
    "over "
    "blocks, which run side by side, and differ from run to run. The paper's own table has 466 to 19,754 variables, "
    "0.04 to 795 s and 0.35 to 6.05 m² on six blocks of other cities.</p>\n";

auto inputs_table(const Study& study) -> std::string {
  std::string body;
  for (const auto& info : study.datasets)
    for (const auto& input : info.inputs)
      body +=
          tag("tr", tag("th", escape(info.dataset.name), {{"scope", "row"}, {"class", "name"}}) +
                        tag("td", escape(input.path), {{"class", "name"}}) + tag("td", std::to_string(input.bytes)) +
                        tag("td", escape(info.crs.empty() ? "local" : info.crs), {{"class", "name"}}) +
                        tag("td", escape(input.sha256), {{"class", "hash"}}));
  std::string head;
  for (const auto* name : {"dataset", "file", "bytes", "CRS", "SHA-256"})
    head += tag("th", name, {{"scope", "col"}, {"class", "name"}});
  return table_of("What was read.", head, body);
}

auto commands(const Study& study) -> std::string {
  std::string all;
  for (const auto& row : study.rows)
    if (!row.command.empty()) all += escape(row.command) + "\n";
  return tag("details", tag("summary", "The models of every run by themselves") + tag("pre", all));
}

auto options_table(const Study& study) -> std::string {
  std::string body;
  for (const auto& [key, value] : study.options)
    body += tag("tr", tag("th", escape(key), {{"scope", "row"}, {"class", "name"}}) +
                          tag("td", escape(value), {{"class", "name"}}));
  return tag("details",
             tag("summary", "Every option") + table_of("Where an axis or a dataset does not say otherwise.",
                                                       tag("th", "option", {{"scope", "col"}, {"class", "name"}}) +
                                                           tag("th", "value", {{"scope", "col"}, {"class", "name"}}),
                                                       body));
}

auto figures(const Study& study) -> std::string {
  std::string out;
  for (std::size_t d = 0; d < study.datasets.size(); ++d) {
    const auto figure = dataset_figure(study, d);
    if (figure.empty()) continue;
    out += tag("section", tag("h2", escape(study.datasets[d].dataset.name)) + figure);
  }
  return out;
}

auto page_of(const std::string& title, const std::string& body) -> std::string {
  const auto head = std::string("<meta charset=\"utf-8\"/>\n") +
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n" +
                    tag("title", "mansard: " + title) + tag("style", style);
  return "<!DOCTYPE html>\n" + tag("html", tag("head", head) + tag("body", tag("main", body)), {{"lang", "en"}});
}

/// What a run changes of one number: "+0.012" in place of the number itself.
auto change(double value, double usual, int decimals) -> std::string {
  if (value == usual) return "";
  return (value > usual ? "+" : "") + base::to_text(value - usual, decimals);
}

auto effect_cells(const Effect& effect, const std::vector<Trial>& usual) -> std::string {
  auto cells = tag("th", escape(effect.key), {{"scope", "row"}, {"class", "name"}}) + tag("td", escape(effect.usual)) +
               tag("td", escape(effect.value)) +
               tag("td", effect.none ? "no effect" : base::to_text(100 * effect.largest, 1) + " %");
  for (std::size_t d = 0; d < usual.size(); ++d) {
    const Trial &trial = effect.trials[d], &base = usual[d];
    if (!trial.failure.empty()) {
      cells += tag("td", escape(trial.failure), {{"class", "failure"}, {"colspan", "5"}});
      continue;
    }
    cells += tag("td", change(trial.rmse, base.rmse, 3)) + tag("td", change(trial.rmse_inside, base.rmse_inside, 3)) +
             tag("td", change(static_cast<double>(trial.faces), static_cast<double>(base.faces), 0)) +
             tag("td", change(static_cast<double>(trial.parts), static_cast<double>(base.parts), 0)) +
             tag("td", base::to_text(trial.cpu_seconds, 2), {{"class", "seconds"}});
  }
  return tag("tr", cells);
}

constexpr std::array trial_names{"RMSE, m", "RMSE inside, m", "faces", "parts", "work, s"};

auto effect_table(const Sensitivity& result) -> std::string {
  std::string head, body;
  for (const auto* name : {"parameter", "usual", "value", "largest effect"})
    head += tag("th", name, {{"scope", "col"}});
  auto first =
      tag("th", "as it is", {{"scope", "row"}, {"class", "name"}}) + tag("td", "") + tag("td", "") + tag("td", "");
  for (const auto& trial : result.usual) {
    for (const auto* name : trial_names) head += tag("th", escape(trial.dataset) + ": " + name, {{"scope", "col"}});
    first += tag("td", base::to_text(trial.rmse, 3)) + tag("td", base::to_text(trial.rmse_inside, 3)) +
             tag("td", std::to_string(trial.faces)) + tag("td", std::to_string(trial.parts)) +
             tag("td", base::to_text(trial.cpu_seconds, 2), {{"class", "seconds"}});
  }
  body = tag("tr", first);
  for (const auto& effect : result.effects) body += effect_cells(effect, result.usual);
  return table_of(
      "A row a parameter and value: what it changes. Every number is in <a href=\"results.csv\">results.csv</a> and "
      "<a href=\"results.json\">results.json</a>.",
      head, body);
}

}  // namespace

auto sensitivity_html(const Sensitivity& result) -> std::string {
  return page_of(
      "Sensitivity",
      tag("h1", "Sensitivity of the parameters") +
          tag("p",
              "Each parameter halved and doubled within its range, flags and choices at every other value, one "
              "run each. Errors are those of the models against the scan, over the footprints and inside them. "
              "The largest effect is the largest relative change of either error or of the number of faces on "
              "any dataset; parameters are sorted by it. <b>No effect</b>: the models are the same bytes on "
              "every dataset.") +
          tag("pre", escape(result.command)) + effect_table(result) + tag("h2", "How it was made") +
          tag("p", "mansard " + escape(result.version)));
}

auto index_html(const Study& study) -> std::string {
  const auto what = about(study.experiment);
  const auto drawn = plots(study);
  const bool by_block = study.experiment == Experiment::table || study.experiment == Experiment::datasets;
  const auto body = tag("h1", what.title) + tag("p", what.words) + tag("pre", escape(study.command)) +
                    (drawn.empty() ? drawn : tag("h2", "Plots") + drawn) + tag("h2", "Numbers") + run_table(study) +
                    notes + (by_block ? block_table(study) : "") + figures(study) + tag("h2", "How it was made") +
                    tag("p", "mansard " + escape(study.version)) + inputs_table(study) + commands(study) +
                    options_table(study);
  return page_of(what.title, body);
}

}  // namespace mansard::explore::detail
