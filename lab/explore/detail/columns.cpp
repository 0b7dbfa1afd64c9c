#include "lab/explore/detail/columns.hpp"

#include <algorithm>
#include <cassert>

#include "mansard/base/text.hpp"

namespace mansard::explore::detail {
namespace {

auto count(std::string key, std::string heading, std::size_t Numbers::*member, bool shown = true) -> Column {
  return {std::move(key), std::move(heading), 0, shown,
          [member](const Numbers& n) { return static_cast<double>(n.*member); }};
}

auto real(std::string key, std::string heading, int decimals, bool shown, std::function<double(const Numbers&)> value)
    -> Column {
  return {std::move(key), std::move(heading), decimals, shown, std::move(value)};
}

auto before_terms() -> std::vector<Column> {
  return {
      count("triangles", "triangles", &Numbers::triangles, false),
      count("footprints", "footprints", &Numbers::footprints),
      count("full", "in full", &Numbers::full),
      count("fallback", "fell back", &Numbers::fallback, false),
      count("covered", "covered", &Numbers::covered, false),
      count("refused", "refused", &Numbers::refused, false),
      count("sweep_edges", "sweep-edges", &Numbers::sweep_edges),
      count("faces", "faces", &Numbers::faces, false),
      count("inside_faces", "faces inside", &Numbers::inside_faces),
      count("candidates", "candidate edges", &Numbers::candidates, false),
      count("conflicts", "conflicts", &Numbers::conflicts, false),
      count("reference_variables", "variables, reference", &Numbers::reference_variables),
      count("variables", "variables, ours", &Numbers::variables),
      count("parts", "parts", &Numbers::parts),
      count("model_faces", "faces of models", &Numbers::model_faces),
      count("blocks", "blocks", &Numbers::blocks),
      count("optimal", "proven optimal", &Numbers::optimal),
      real("objective", "objective", 1, true, [](const auto& n) { return n.objective; }),
      real("bound", "bound", 1, false, [](const auto& n) { return n.bound; }),
  };
}

auto after_terms() -> std::vector<Column> {
  return {
      real("vertical_mse_m2", "vertical MSE, m²", 3, true, [](const auto& n) { return n.scores.mse; }),
      real("footprint_mse_m2", "over footprints, m²", 3, true, [](const auto& n) { return n.scores.footprint_mse; }),
      real("median_m", "median, m", 3, false, [](const auto& n) { return n.scores.median; }),
      real("median_absolute_m", "median abs., m", 3, true, [](const auto& n) { return n.scores.median_absolute; }),
      real("p95_absolute_m", "95 % abs., m", 3, false, [](const auto& n) { return n.scores.p95_absolute; }),
      real("missed_m2", "missed, m²", 1, false, [](const auto& n) { return n.scores.missed; }),
      real("invented_m2", "invented, m²", 1, false, [](const auto& n) { return n.scores.invented; }),
      real("optimise_cpu_s", "optimise, CPU s", 3, true, [](const auto& n) { return n.optimise_cpu_seconds; }),
      real("cpu_s", "CPU s", 2, true, [](const auto& n) { return n.cpu_seconds; }),
  };
}

}  // namespace

auto columns() -> const std::vector<Column>& {
  static const std::vector<Column> all = [] {
    auto columns = before_terms();
    for (const auto& info : segment::terms())
      columns.push_back(real(std::string(info.name), std::string(info.symbol), 1, false,
                             [term = info.term](const Numbers& n) { return n.terms[term]; }));
    for (auto& column : after_terms()) columns.push_back(std::move(column));
    return columns;
  }();
  return all;
}

auto column(std::string_view key) -> const Column& {
  const auto at = std::ranges::find(columns(), key, &Column::key);
  assert(at != columns().end());
  return *at;
}

auto exact(const Column& column, const Numbers& numbers) -> std::string {
  const double value = column.value(numbers);
  return column.decimals == 0 ? base::to_text(value, 0) : base::to_text(value);
}

}  // namespace mansard::explore::detail
