#include "mansard/report/page.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"
#include "mansard/confidence/confidence.hpp"

namespace mansard::report {
namespace {

using base::markup_escaped;
using base::to_text;

constexpr auto page_style = R"(
@page { size: A4; margin: 16mm 15mm; }
body { margin: 0 auto; padding: 1rem; max-width: 60rem; color: #1d1f23; background: #ffffff;
  font: 15px/1.45 "Liberation Sans", Arial, sans-serif; }
h1 { font-size: 1.7rem; margin: 0 0 .2rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 1.8rem 0 .5rem; border-bottom: 2px solid #1d1f23; break-after: avoid; }
h3 { font-size: 1rem; margin: 0 0 .3rem; overflow-wrap: anywhere; }
p, ul { margin: .4rem 0; } .quiet { color: #4d535d; }
table { border-collapse: collapse; width: 100%; margin: .6rem 0 1rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: bold; padding-bottom: .2rem; break-after: avoid; }
th, td { text-align: left; vertical-align: top; padding: .22rem .6rem .22rem 0; border-bottom: 1px solid #c9cdd4; }
tbody th, td.long { overflow-wrap: anywhere; min-width: 6rem; }
thead th { border-bottom: 1px solid #1d1f23; } tbody th { font-weight: normal; }
th.number, td.number { text-align: right; } td.number { white-space: nowrap; } td.long { font-size: .85em; }
tr, figure, footer, table.short { break-inside: avoid; } h2 + p { break-after: avoid; }
figure { margin: 1rem 0 1.4rem; } figcaption ul { padding-left: 1.2rem; }
img, svg { display: block; width: 100%; height: auto; } img { border: 1px solid #c9cdd4; box-sizing: border-box; }
.map { border: 1px solid #c9cdd4; }
.scale { margin: .3rem .6rem; } .bar { display: inline-block; height: 0; border-top: 3px solid #1d1f23; vertical-align: middle; }
.legend { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1.4rem; }
.swatch { display: inline-block; width: 1em; height: .8em; margin-right: .4em; border: 1px solid #33363c;
  print-color-adjust: exact; -webkit-print-color-adjust: exact; }
@media screen and (max-width: 46rem) { td.number { white-space: normal; } tbody th, td.long { min-width: 4rem; } }
@media print { body { max-width: none; padding: 0; font-size: 10pt; } figure { margin: .5rem 0; }
  img { width: auto; max-width: 100%; max-height: 7cm; } }
)";

auto digits(double value, int decimals) -> std::string { return to_text(value, decimals); }
auto count_of(std::size_t n) -> std::string { return std::to_string(n); }
auto times(std::size_t n, const std::string& one, const std::string& many) -> std::string {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}
auto share_text(std::size_t part, std::size_t whole) -> std::string {
  return whole == 0 ? std::string("–") : digits(100 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}
auto or_dash(const std::optional<double>& value, int decimals) -> std::string {
  return value ? digits(*value, decimals) : std::string("–");
}

auto base64(std::string_view bytes) -> std::string {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? letters[group >> (18U - 6U * static_cast<unsigned>(k)) & 63U] : '=';
  }
  return out;
}

/// Tables and paragraphs, escaped where they hold what files say.
class Html {
 public:
  void raw(std::string_view text) { out_ += text; }
  void heading(std::string_view words) { out_ += "<h2>" + markup_escaped(words) + "</h2>\n"; }
  void paragraph(std::string_view words, std::string_view kind = {}) {
    out_ += kind.empty() ? "<p>" : "<p class=\"" + std::string(kind) + "\">";
    out_ += markup_escaped(words) + "</p>\n";
  }

  enum class Kind : std::uint8_t { words, number, code };  ///< codes are broken anywhere
  struct Column {
    std::string name;
    Kind kind = Kind::words;
  };
  /// The first cell of a row names it.
  void table(std::string_view caption, const std::vector<Column>& columns,
             const std::vector<std::vector<std::string>>& rows) {
    if (rows.empty()) return;
    constexpr std::size_t short_rows = 15;  // of a table that is not worth a page break in it: a third of a page
    out_ += rows.size() > short_rows ? "<table>" : "<table class=\"short\">";
    out_ += "<caption>" + markup_escaped(caption) + "</caption>\n";
    const auto kind = [](const Column& column) {
      return column.kind == Kind::number ? " class=\"number\"" : column.kind == Kind::code ? " class=\"long\"" : "";
    };
    if (std::ranges::any_of(columns, [](const Column& column) { return !column.name.empty(); })) {
      out_ += "<thead><tr>";
      for (const auto& column : columns)
        out_ += (column.name.empty() ? "<td" : "<th scope=\"col\"") + std::string(kind(column)) + ">" +
                markup_escaped(column.name) + (column.name.empty() ? "</td>" : "</th>");
      out_ += "</tr></thead>\n";
    }
    out_ += "<tbody>\n";
    for (const auto& row : rows) {
      out_ += "<tr>";
      for (std::size_t c = 0; c < row.size(); ++c)
        out_ += (c == 0 ? "<th scope=\"row\"" : "<td" + std::string(kind(columns[c]))) + ">" + markup_escaped(row[c]) +
                (c == 0 ? "</th>" : "</td>");
      out_ += "</tr>\n";
    }
    out_ += "</tbody></table>\n";
  }
  auto take() -> std::string { return std::move(out_); }

 private:
  std::string out_;
};

auto count_at(const RunFile& run, std::string_view name) -> std::size_t {
  const auto at = run.counts.find(name);
  return at == run.counts.end() ? 0 : at->second;
}

/// "93.2 % ± 1.1 %"
auto with_error(const std::pair<double, double>& share) -> std::string {
  return digits(100 * share.first, 1) + " % ± " + digits(100 * share.second, 1) + " %";
}

void add_summary(const RunPage& page, Html& html) {
  const auto& run = page.run;
  const auto all = count_at(run, "footprints"), full = count_at(run, "full"), simple = count_at(run, "fallback");
  std::string text = times(all, "building", "buildings") + ": " + count_of(full) + " with a full model, " +
                     count_of(simple) + " with a simpler one, " + count_of(all - full - simple) + " without a model.";
  if (page.expected_right)
    text += " Expected share of models that are right: " + with_error(*page.expected_right) + " of " +
            times(page.rated, "model", "models") + ".";
  if (run.scores && run.scores->footprint)
    text += " Root mean square vertical error over the footprints, against the scan: " +
            digits(std::sqrt(run.scores->footprint->mse), 3) + " m.";
  html.paragraph(text);
  if (page.edited_since)
    html.paragraph(
        "The models were edited in the workbench after this run. The edits are not in this report: it is of the models "
        "as the run made them.");
}

void add_extent(const RunPage& page, Html& html) {
  html.heading("Extent");
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"Coordinate reference system", page.run.crs.empty() ? "local frame, metres" : page.run.crs});
  if (!page.extent.empty()) {
    rows.push_back({"x", digits(page.extent.least.x, 2) + " to " + digits(page.extent.most.x, 2) + " m"});
    rows.push_back({"y", digits(page.extent.least.y, 2) + " to " + digits(page.extent.most.y, 2) + " m"});
  }
  if (page.heights)
    rows.push_back({"z, lowest ground to highest roof",
                    digits(page.heights->first, 2) + " to " + digits(page.heights->second, 2) + " m"});
  rows.push_back({"Buildings, parts", count_of(page.buildings) + ", " + count_of(page.parts)});
  if (page.footprint_area > 0) rows.push_back({"Area of the footprints", digits(page.footprint_area, 0) + " m²"});
  if (page.volume > 0) rows.push_back({"Volume of LoD 2.2", digits(page.volume, 0) + " m³"});
  html.table("Where the models are", {{""}, {""}}, rows);
}

void add_sources(const RunPage& page, Html& html) {
  html.heading("Sources");
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < page.run.inputs.size(); ++i) {
    const auto& input = page.run.inputs[i];
    rows.push_back(
        {input.path, i < page.inputs.size() ? page.inputs[i] : std::string(), count_of(input.bytes), input.sha256});
  }
  html.table("Files that the models were made from",
             {{"File"}, {"Content"}, {"Bytes", Html::Kind::number}, {"SHA-256", Html::Kind::code}}, rows);
  if (!page.source.empty() || !page.source_date.empty())
    html.paragraph("Survey: " + page.source + (page.source.empty() || page.source_date.empty() ? "" : ", ") +
                   page.source_date + ".");
  if (!page.run.accuracy) {
    html.paragraph("The models were made without a scan: nothing was measured.");
    return;
  }
  std::vector<std::vector<std::string>> measured;
  for (const auto& [name, value] : accuracy::in_words(*page.run.accuracy)) measured.push_back({name, value});
  if (measured.empty()) html.paragraph("Of the accuracy of the scan nothing could be measured.");
  html.table("Measured accuracy of the scan", {{""}, {""}}, measured);
}

void add_counts(const RunPage& page, Html& html) {
  html.heading("Models");
  const auto& run = page.run;
  const auto all = count_at(run, "footprints");
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const char* name, const char* words) {
    rows.push_back({words, count_of(count_at(run, name)), share_text(count_at(run, name), all)});
  };
  row("full", "full: every part was extruded along its full profiles");
  row("fallback", "fallback: some part is simpler");
  row("covered", "covered: its ground is part of its neighbours' models");
  row("refused", "refused: the footprint cannot be used, or the scan does not cover it");
  html.table("Buildings by outcome", {{"Outcome"}, {"Buildings", Html::Kind::number}, {"Share", Html::Kind::number}},
             rows);
  rows.clear();
  for (const auto& level : page.levels)
    rows.push_back({"LoD " + level.lod, count_of(level.buildings), count_of(level.valid)});
  html.table("Buildings by level of detail",
             {{"Level of detail"}, {"Buildings", Html::Kind::number}, {"Of these valid", Html::Kind::number}}, rows);
  if (page.rated > 0) {
    rows.clear();
    const auto models = page.by_class[0] + page.by_class[1] + page.by_class[2] + page.by_class[3];
    constexpr std::array words{"high: probability of 0.85 or more to be right", "medium: 0.5 or more",
                               "low: less than 0.5", "without a probability"};
    for (std::size_t c = 0; c < words.size(); ++c)
      if (c < 3 || page.by_class[c] > 0)
        rows.push_back({words[c], count_of(page.by_class[c]), share_text(page.by_class[c], models)});
    html.table("Models by confidence", {{"Confidence"}, {"Models", Html::Kind::number}, {"Share", Html::Kind::number}},
               rows);
  }
  rows.clear();
  for (const auto& [check, count] : page.failed_checks) rows.push_back({check, count_of(count)});
  html.table("Checks that failed", {{"Check"}, {"Buildings", Html::Kind::number}}, rows);
}

void add_accuracy(const RunPage& page, Html& html) {
  if (!page.run.scores && !page.expected_right && page.standard_errors.empty()) return;
  html.heading("Accuracy");
  std::vector<std::vector<std::string>> rows;
  if (page.expected_right)
    rows.push_back({"Share of the models that are right, expected", with_error(*page.expected_right),
                    "of " + times(page.rated, "model", "models") +
                        "; right: a mean squared vertical error of at most " + digits(confidence::wrong_above, 1) +
                        " m² against what is really there"});
  if (!rows.empty())
    html.table("Against what is really there, by the evidence of each model",
               {{""}, {"Value ± standard error", Html::Kind::number}, {""}}, rows);
  rows.clear();
  if (page.run.scores) {
    const auto& scores = *page.run.scores;
    const auto add = [&](const char* what, std::optional<MeanSquare> RunScores::*score,
                         const std::optional<double>& median) {
      const auto& value = scores.*score;
      if (!value) return;
      const auto error = standard_error(page.run.blocks, score);
      const double rmse = std::sqrt(value->mse);
      const auto plus_minus = [&](double e, int decimals) {
        return error ? " ± " + digits(e, decimals) : std::string();
      };
      rows.push_back({what, digits(value->mse, 4) + plus_minus(error.value_or(0), 4),
                      digits(rmse, 3) + plus_minus(rmse > 0 ? error.value_or(0) / (2 * rmse) : 0, 3),
                      or_dash(median, 3), digits(value->cells, 0)});
    };
    add("Where models and scan both have a surface", &RunScores::vertical, scores.median_absolute);
    add("Over the footprints; a missing model counts as the ground", &RunScores::footprint,
        scores.footprint_median_absolute);
    add("Away from the outline of each block, the roofs", &RunScores::inside, scores.inside_median);
    add("Away from the outline of each building", &RunScores::inside_each, scores.inside_each_median);
    html.table("Vertical error against the scan, as 'mansard evaluate' measures it",
               {{"Over"},
                {"Mean square, m²", Html::Kind::number},
                {"Root mean square, m", Html::Kind::number},
                {"Median absolute of a block, mean, m", Html::Kind::number},
                {"Cells", Html::Kind::number}},
               rows);
    if (std::ranges::count_if(page.run.blocks, [](const auto& b) { return b.vertical.has_value(); }) > 1)
      html.paragraph("± is the standard error over " + times(page.run.blocks.size(), "block", "blocks") +
                         ", which are independent of each other.",
                     "quiet");
    else html.paragraph("With one block there is no standard error of these.", "quiet");
    rows.clear();
    if (scores.vertical) {
      rows.push_back({"Median of model − scan in a block, mean", or_dash(scores.median, 3) + " m"});
      rows.push_back({"95 % of a block are within, mean", or_dash(scores.p95_absolute, 3) + " m"});
    }
    if (scores.missed) rows.push_back({"Area of the footprints without a model", or_dash(scores.missed, 1) + " m²"});
    if (scores.invented) rows.push_back({"Area of models outside the footprints", or_dash(scores.invented, 1) + " m²"});
    html.table("Bias, large errors, and areas", {{""}, {"", Html::Kind::number}}, rows);
  }
  const auto quantiles = [&](const char* caption, const std::vector<Quantiles>& all) {
    rows.clear();
    for (const auto& one : all)
      rows.push_back({one.what + (one.unit.empty() ? "" : ", " + one.unit), digits(one.median, 3),
                      digits(one.ninth_tenth, 3), count_of(one.count)});
    html.table(caption,
               {{""},
                {"Half have at most", Html::Kind::number},
                {"90 % have at most", Html::Kind::number},
                {"Buildings", Html::Kind::number}},
               rows);
  };
  quantiles("Error of single buildings", page.errors);
  quantiles("Standard errors of heights, volume and areas of single buildings", page.standard_errors);
}

void add_map(const RunPage& page, Html& html) {
  if (page.map.empty()) return;
  html.heading("Map");
  html.raw("<figure><div class=\"map\">\n" + page.map + "</div>\n<figcaption><ul class=\"legend\">");
  for (const auto& [colour, words] : page.legend)
    html.raw("<li><span class=\"swatch\" style=\"background:" + colour + "\"></span>" + markup_escaped(words) +
             "</li>");
  html.raw("</ul>");
  if (!page.worst.empty())
    html.raw("<p class=\"quiet\">Numbers are those of the models that are least sure, below.</p>");
  html.raw("</figcaption></figure>\n");
}

void add_worst(const RunPage& page, Html& html) {
  if (page.worst.empty()) return;
  const bool rated = page.worst.front().run.right.has_value();
  html.heading(rated ? "The models that are least sure" : "The models with the largest error");
  html.paragraph(rated ? "By their probability to be right, the lowest first."
                       : "By their root mean square vertical error against the scan, the largest first.");
  if (!page.scan_note.empty()) html.paragraph(page.scan_note);
  for (std::size_t i = 0; i < page.worst.size(); ++i) {
    const auto& worst = page.worst[i];
    const std::string number = count_of(i + 1);
    html.raw("<figure>\n<h3>" + number + ". " + markup_escaped(worst.run.id) + "</h3>\n");
    if (!worst.png.empty())
      html.raw("<img src=\"data:image/png;base64," + base64(worst.png) + "\" width=\"" + count_of(worst.width) +
               "\" height=\"" + count_of(worst.height) + "\" alt=\"" +
               markup_escaped("Building " + worst.run.id + " from two sides: " +
                              (worst.with_scan ? "the scan on the left, the model on the right" : "the model")) +
               "\">\n");
    std::string facts;
    const auto fact = [&](const std::string& text) { facts += (facts.empty() ? "" : " · ") + text; };
    if (worst.run.right) fact("probability to be right " + digits(*worst.run.right, 3));
    if (worst.run.error) fact("error to expect " + digits(*worst.run.error, 3) + " m");
    if (worst.run.rmse) fact("root mean square distance from the scan " + digits(*worst.run.rmse, 3) + " m");
    if (worst.run.outcome == "fallback") fact("some part is simpler than its profiles");
    html.raw("<figcaption><p>" + markup_escaped(facts) + "</p>");
    if (!worst.run.reasons.empty()) {
      html.raw("<ul>");
      for (const auto& [code, message] : worst.run.reasons) html.raw("<li>" + markup_escaped(message) + "</li>");
      html.raw("</ul>");
    }
    html.raw("</figcaption></figure>\n");
  }
}

void add_without(const RunPage& page, Html& html) {
  if (page.without_model.empty()) return;
  html.heading("Buildings without a model");
  std::vector<std::vector<std::string>> rows;
  for (const auto& [code, what] : page.without_model) rows.push_back({code, count_of(what.first), what.second});
  html.table("By the main reason", {{"Code"}, {"Buildings", Html::Kind::number}, {"As it is said of the first"}}, rows);
  rows.clear();
  for (const auto& building : page.without_model_first)
    rows.push_back(
        {building.id, building.outcome, building.reasons.empty() ? std::string() : building.reasons.front().second});
  html.table(rows.size() < count_at(page.run, "covered") + count_at(page.run, "refused")
                 ? "The first " + count_of(rows.size())
                 : "All of them",
             {{"Building"}, {"Outcome"}, {"Reason"}}, rows);
}

void add_review(const RunPage& page, Html& html) {
  html.heading("Review");
  const auto& reviewed = page.reviewed;
  std::size_t holds = 0;
  for (const auto n : reviewed.holds) holds += n;
  if (!reviewed.known || holds + reviewed.lapsed == 0) {
    html.paragraph("No decisions of people about these models are known.");
    return;
  }
  html.paragraph("People have decided on " + count_of(holds) + " of " + times(page.buildings, "building", "buildings") +
                 (reviewed.last.empty() ? "" : ", the last time at " + reviewed.last) + ".");
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const std::string& name, const auto& counts) {
    std::vector<std::string> cells{name};
    for (const auto n : counts) cells.push_back(count_of(n));
    rows.push_back(std::move(cells));
  };
  row("all", reviewed.holds);
  for (const auto& [name, counts] : reviewed.by_reviewer) row(name.empty() ? "no name" : name, counts);
  std::vector<Html::Column> columns{{"Decided by", Html::Kind::words}};
  for (const auto name : verdict_names) columns.push_back({std::string(name), Html::Kind::number});
  html.table("Decisions that hold", columns, rows);
  if (reviewed.rated > 0)
    html.paragraph("Of " + times(reviewed.rated, "model", "models") + " that were found right or wrong, " +
                   count_of(reviewed.rated_right) + " are right; by their probabilities " +
                   digits(reviewed.expected_right, 1) + " were expected.");
  if (reviewed.lapsed > 0)
    html.paragraph(times(reviewed.lapsed, "decision has", "decisions have") +
                   " lapsed: the models are other ones since.");
  if (reviewed.missing > 0)
    html.paragraph(times(reviewed.missing, "decision is", "decisions are") + " on buildings that are not in this run.");
}

void add_changes(const RunPage& page, Html& html) {
  const auto& changed = page.changed;
  if (changed.by_kind.empty() && changed.kept_from.empty()) return;
  html.heading("What has changed");
  if (!changed.since.empty()) html.paragraph("Compared with " + changed.since + ".");
  std::vector<std::vector<std::string>> rows;
  for (const auto& [kind, count] : changed.by_kind) rows.push_back({kind, count_of(count)});
  html.table("Buildings by what has changed", {{""}, {"Buildings", Html::Kind::number}}, rows);
  rows.clear();
  for (const auto& [run, count] : changed.kept_from) rows.push_back({run, count_of(count)});
  html.table("Models that were kept because nothing has changed there", {{"Run"}, {"Buildings", Html::Kind::number}},
             rows);
}

void add_made(const RunPage& page, Html& html) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [code, what] : page.run.warnings) rows.push_back({code, count_of(what.first), what.second});
  if (!rows.empty()) {
    html.heading("Warnings of the run");
    html.table("By their code", {{"Code"}, {"Number", Html::Kind::number}, {"As it is said first"}}, rows);
  }
  html.raw("<footer>");
  html.paragraph("Made by mansard " + page.run.version +
                     ". Lengths are metres. The errors against the scan are those of run.json; their meaning is in "
                     "docs/evaluate.md, that of probabilities in docs/confidence.md, that of standard errors in "
                     "docs/accuracy.md of mansard.",
                 "quiet");
  html.raw("</footer>\n");
}

}  // namespace

auto standard_error(const std::vector<RunScores>& blocks, std::optional<MeanSquare> RunScores::*score)
    -> std::optional<double> {
  double sum = 0, cells = 0;
  std::size_t count = 0;
  for (const auto& block : blocks)
    if (const auto& own = block.*score) {
      sum += own->mse * own->cells;
      cells += own->cells;
      ++count;
    }
  if (count < 2) return std::nullopt;
  double squares = 0;
  for (const auto& block : blocks)
    if (const auto& own = block.*score) squares += std::pow(own->cells * (own->mse - sum / cells), 2);
  const auto n = static_cast<double>(count);
  return std::sqrt(n / (n - 1) * squares) / cells;
}

auto page_html(const RunPage& page) -> std::string {
  Html html;
  const std::string title = page.title.empty() ? "Building models of " + page.name : page.title;
  html.raw(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>" +
      markup_escaped(title) + "</title>\n<style>" + page_style + "</style>\n</head>\n<body>\n<main>\n<h1>" +
      markup_escaped(title) + "</h1>\n");
  html.paragraph("Report of the run " + page.name + (page.date.empty() ? "" : ", " + page.date), "quiet");
  add_summary(page, html);
  add_extent(page, html);
  add_sources(page, html);
  add_counts(page, html);
  add_accuracy(page, html);
  add_map(page, html);
  add_worst(page, html);
  add_without(page, html);
  add_review(page, html);
  add_changes(page, html);
  add_made(page, html);
  html.raw("</main>\n</body>\n</html>\n");
  return html.take();
}

}  // namespace mansard::report
