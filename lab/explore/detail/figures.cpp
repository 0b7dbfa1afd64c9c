#include "lab/explore/detail/figures.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "lab/explore/detail/charts.hpp"
#include "lab/explore/detail/columns.hpp"
#include "lab/explore/detail/drawings.hpp"
#include "lab/explore/detail/svg.hpp"
#include "mansard/base/text.hpp"

namespace mansard::explore::detail {
namespace {

constexpr std::array plotted{"sweep_edges", "parts", "model_faces", "vertical_mse_m2", "footprint_mse_m2"};
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

auto rows_of(const Study& study, std::size_t dataset) -> std::vector<const Row*> {
  std::vector<const Row*> rows;
  for (const auto& row : study.rows)
    if (row.dataset == dataset) rows.push_back(&row);
  return rows;
}

auto value_of(const Row& row, const Column& column) -> double {
  return row.failure ? nothing : column.value(row.numbers);
}

/// A dataset that could not be read has one row without a setting.
auto was_run(const Study& study, const std::vector<const Row*>& rows) -> bool {
  return !rows.empty() && rows.front()->setting.size() == study.axes.size();
}

/// The option with its unit.
auto label_of(const Axis& axis) -> std::string {
  pipeline::Options options;
  for (const auto& list : pipeline::option_lists(options))
    for (const auto& option : list.options())
      if (axis.key == list.module() + "." + option.name && !option.unit.empty()) return axis.key + ", " + option.unit;
  return axis.key;
}

/// A number that no setting changes makes no plot.
auto changes(const Series& series) -> bool {
  return std::ranges::any_of(series.points, [&](const auto& p) { return p.y != series.points.front().y; });
}

auto line_plots(const Study& study) -> std::string {
  const auto& axis = study.axes.front();
  const bool numbers = std::ranges::all_of(axis.values, [](const auto& v) { return base::to_number(v).has_value(); });
  std::string out;
  for (const auto* key : plotted) {
    const auto& what = column(key);
    LineChart chart{what.heading, label_of(axis), {}, {}};
    if (!numbers) chart.x_names = axis.values;
    for (std::size_t d = 0; d < study.datasets.size(); ++d) {
      const auto rows = rows_of(study, d);
      if (!was_run(study, rows)) continue;
      Series series{study.datasets[d].dataset.name, {}};
      for (std::size_t i = 0; i < rows.size(); ++i)
        series.points.push_back(
            {numbers ? *base::to_number(axis.values[i]) : static_cast<double>(i), value_of(*rows[i], what)});
      if (numbers) std::ranges::sort(series.points, {}, &geometry::Point2::x);
      chart.series.push_back(std::move(series));
    }
    if (std::ranges::any_of(chart.series, changes)) out += tag("figure", line_chart(chart));
  }
  return out;
}

auto heat_maps(const Study& study) -> std::string {
  std::string out;
  for (std::size_t d = 0; d < study.datasets.size(); ++d) {
    const auto rows = rows_of(study, d);
    if (!was_run(study, rows)) continue;
    for (const auto* key : {"parts", "objective", "vertical_mse_m2", "footprint_mse_m2"}) {
      const auto& what = column(key);
      HeatMap map{study.datasets[d].dataset.name + ": " + what.heading,
                  label_of(study.axes[1]),
                  label_of(study.axes[0]),
                  study.axes[1].values,
                  study.axes[0].values,
                  {},
                  what.decimals};
      for (const auto* row : rows) map.values.push_back(value_of(*row, what));
      out += tag("figure", heat_map(map));
    }
  }
  return out;
}

/// Without the names of modules, for the text below a figure.
auto setting_text(const Setting& setting) -> std::string {
  std::string text;
  for (const auto& [key, value] : setting)
    text += (text.empty() ? "" : ", ") + key.substr(key.find('.') + 1) + " = " + value;
  return text;
}

auto terms_text(const Numbers& n) -> std::string {
  const auto amount = [](double cost) { return base::to_text(cost, 0); };
  std::string text = "objective " + amount(n.objective);
  const char* before = " = ";
  for (const auto& info : segment::terms()) {
    text += before + std::string(info.caption) + " " + amount(n.terms[info.term]);
    before = " + ";
  }
  return text;
}

auto image_of(const Picture& picture, const std::string& setting) -> std::string {
  return "<img loading=\"lazy\" src=\"" + escape(picture.name) + "\" alt=\"" +
         escape(picture.alt + (setting.empty() ? "" : ", " + setting)) + "\"/>\n";
}

/// As in the paper's Figure 6: the models, the plan, the vertical error; with what was chosen and what it cost.
auto plan_of(const Study& study, const Row& row, double size) -> std::string {
  const auto title = tag("b", escape(setting_text(row.setting)));
  if (row.failure) return tag("figure", tag("figcaption", title + "<br/>" + escape(base::to_string(*row.failure))));
  const auto& n = row.numbers;
  const auto& info = study.datasets[row.dataset];
  const auto drawing = plan_drawing(row.plan, info.footprints, size,
                                    "plan of the parts of " + info.dataset.name + " with " + setting_text(row.setting));
  std::string models, errors;
  for (const auto& picture : row.pictures)
    (models.empty() ? models : errors) += image_of(picture, setting_text(row.setting));
  const auto counts = std::to_string(n.parts) + " parts of " + std::to_string(n.sweep_edges) +
                      " sweep-edges, vertical MSE " + base::to_text(n.scores.mse, 3) + " m²";
  return tag("figure",
             models + drawing + errors + tag("figcaption", title + "<br/>" + counts + "<br/>" + escape(terms_text(n))));
}

/// Two axes: the first downwards, the second to the right. One: in a row that breaks.
auto plan_matrix(const Study& study, const std::vector<const Row*>& rows) -> std::string {
  const std::size_t columns = study.axes.size() == 2 ? study.axes[1].values.size() : 0;
  std::string cells;
  for (const auto* row : rows) cells += plan_of(study, *row, columns > 0 ? 240 : 300);
  const auto style =
      columns > 0 ? "grid-template-columns: repeat(" + std::to_string(columns) + ", minmax(0, 1fr))" : "";
  return tag("div", tag("div", cells, {{"class", columns > 0 ? "matrix" : "strip"}, {"style", style}}),
             {{"class", "wide"}, {"tabindex", "0"}});
}

/// A kind of picture after the other, setting by setting, side by side where there are few settings.
auto picture_figures(const std::vector<const Row*>& rows) -> std::string {
  std::string out;
  std::size_t kinds = 0;
  for (const auto* row : rows) kinds = std::max(kinds, row->pictures.size());
  for (std::size_t kind = 0; kind < kinds; ++kind)
    for (const auto* row : rows) {
      if (kind >= row->pictures.size()) continue;
      const auto& picture = row->pictures[kind];
      const auto words = setting_text(row->setting);
      out += tag("figure", image_of(picture, words) +
                               tag("figcaption", escape((words.empty() ? "" : words + ": ") + picture.alt)));
    }
  if (out.empty()) return out;
  const std::size_t columns = std::clamp<std::size_t>(rows.size(), 2, 4);
  return tag("div", out,
             {{"class", rows.size() == 1 ? "pictures alone" : "pictures"},
              {"style", "grid-template-columns: repeat(" + std::to_string(columns) + ", 1fr)"}});
}

auto share_text(double part, double whole) -> std::string {
  return whole > 0 ? base::to_text(100 * part / whole, 1) + " %" : "–";
}

auto profile_figure(const Row& row, const std::string& name) -> std::string {
  const auto shares = shares_of(row.profiles);
  static constexpr std::array kinds{"vertical: gables, and walls of flat roofs", "one pitch", "more pitches"};
  std::string legend;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    legend +=
        tag("li", tag("span", "", {{"class", "swatch"}, {"style", "background: " + series_colour(i)}}) +
                      std::string(kinds[i]) + ": " + share_text(shares.of_kind[i], shares.length) + " of the length");
  legend += tag("li", "without a raw slice, vertical by the prior: " + share_text(shares.unseen, shares.length));
  const auto counts = std::to_string(shares.profiles) + " profiles over " + base::to_text(shares.length, 0) +
                      " m of edges, fitted to " + std::to_string(shares.slices) + " raw slices of " +
                      std::to_string(shares.attempted) + " tried; drawn up to the crest of their parts";
  return tag("figure",
             profile_drawing(row.profiles, "all profiles of " + name) +
                 tag("figcaption", counts + tag("ul", legend, {{"class", "legend"}})),
             {{"class", "beside"}});
}

}  // namespace

auto tag(std::string_view name, std::string_view inner,
         const std::vector<std::pair<std::string, std::string>>& attributes) -> std::string {
  std::string out = "<" + std::string(name);
  for (const auto& [key, value] : attributes)
    if (!value.empty()) out += " " + key + "=\"" + escape(value) + "\"";
  return out + ">" + std::string(inner) + "</" + std::string(name) + ">\n";
}

auto plots(const Study& study) -> std::string {
  const auto figures = study.axes.size() == 1   ? line_plots(study)
                       : study.axes.size() == 2 ? heat_maps(study)
                                                : std::string();
  return figures.empty() ? figures : tag("div", figures, {{"class", "plots"}});
}

auto dataset_figure(const Study& study, std::size_t dataset) -> std::string {
  const auto rows = rows_of(study, dataset);
  if (!was_run(study, rows)) return {};
  const bool plans = study.experiment != Experiment::quality &&  // which are alike
                     (study.axes.size() == 1 || study.axes.size() == 2);
  std::string out = plans ? std::string() : picture_figures(rows);
  if (study.experiment == Experiment::profiles && !rows.front()->failure)
    out += profile_figure(*rows.front(), study.datasets[dataset].dataset.name);
  if (plans) out += plan_matrix(study, rows);
  return out;
}

}  // namespace mansard::explore::detail
