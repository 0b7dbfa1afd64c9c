#include "mansard/formats/xyz/point_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/text.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/points/field.hpp"
#include "mansard/formats/points/in_memory.hpp"

namespace mansard::formats {
namespace {

using Column = PointField;

/// Names in lower case, without units in brackets.
constexpr std::array<std::pair<std::string_view, Column>, 42> names{{
    {"x", Column::x},
    {"e", Column::x},
    {"east", Column::x},
    {"easting", Column::x},
    {"x_coord", Column::x},
    {"y", Column::y},
    {"n", Column::y},
    {"north", Column::y},
    {"northing", Column::y},
    {"y_coord", Column::y},
    {"z", Column::z},
    {"h", Column::z},
    {"height", Column::z},
    {"elevation", Column::z},
    {"altitude", Column::z},
    {"z_coord", Column::z},
    {"class", Column::classification},
    {"classification", Column::classification},
    {"scalar_classification", Column::classification},
    {"return", Column::return_number},
    {"return_number", Column::return_number},
    {"returnnumber", Column::return_number},
    {"returns", Column::returns},
    {"number_of_returns", Column::returns},
    {"numberofreturns", Column::returns},
    {"num_returns", Column::returns},
    {"point_source", Column::source},
    {"point_source_id", Column::source},
    {"pointsourceid", Column::source},
    {"scalar_pointsourceid", Column::source},
    {"intensity", Column::intensity},
    {"i", Column::intensity},
    {"scalar_intensity", Column::intensity},
    {"red", Column::red},
    {"r", Column::red},
    {"rf", Column::red},
    {"green", Column::green},
    {"g", Column::green},
    {"gf", Column::green},
    {"blue", Column::blue},
    {"b", Column::blue},
    {"bf", Column::blue},
}};

auto trimmed(std::string_view text) -> std::string_view {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

auto unquoted(std::string_view text) -> std::string_view {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return trimmed(text.substr(1, text.size() - 2));
  return text;
}

auto column_of(std::string_view field) -> Column {
  std::string name = base::lower(unquoted(trimmed(field)));
  if (const auto bracket = name.find_first_of("[("); bracket != std::string::npos && bracket > 0) name.resize(bracket);
  name = std::string(trimmed(name));
  const auto* at = std::ranges::find(names, name, &std::pair<std::string_view, Column>::first);
  return at == names.end() ? Column::none : at->second;
}

/// ' ' stands for any number of blanks and tabs.
auto separator_of(std::string_view line) -> char {
  for (const char c : {';', '\t', ','})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

void split(std::string_view line, char separator, std::vector<std::string_view>& out) {
  out.clear();
  if (separator == ' ') {
    while (!(line = trimmed(line)).empty()) {
      const auto end = std::min(line.find_first_of(" \t"), line.size());
      out.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    return;
  }
  for (;;) {
    const auto end = line.find(separator);
    out.push_back(unquoted(trimmed(line.substr(0, end))));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  if (out.size() > 1 && out.back().empty()) out.pop_back();  // a separator at the end of the line
}

auto number_of(std::string_view field, bool decimal_commas) -> std::optional<double> {
  if (decimal_commas && field.find(',') != std::string_view::npos) {
    std::string text(field);
    std::ranges::replace(text, ',', '.');
    return base::to_number(text);
  }
  const std::string lower = field.size() == 3 ? base::lower(field) : std::string();
  if (lower == "nan") return std::numeric_limits<double>::quiet_NaN();
  return base::to_number(field);
}

/// Takes the next line that is neither empty nor a comment; counts all lines.
auto next_line(std::string_view& rest, std::size_t& number) -> std::optional<std::string_view> {
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    const auto line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++number;
    if (line.empty() || line.starts_with("//")) continue;
    if (!line.starts_with('#')) return line;
    // A header may be a comment: "# x y z".
    std::vector<std::string_view> fields;
    const auto inside = trimmed(line.substr(std::min(line.find_first_not_of('#'), line.size())));
    split(inside, separator_of(inside), fields);
    const auto has = [&](Column column) {
      return std::ranges::any_of(fields, [&](auto f) { return column_of(f) == column; });
    };
    if (has(Column::x) && has(Column::y) && has(Column::z)) return inside;
  }
  return std::nullopt;
}

/// "1,5 2,5 3,5": decimal commas between blanks. "1, 2, 3" is not.
auto has_decimal_commas(std::string_view line) -> bool {
  std::vector<std::string_view> fields;
  split(line, ' ', fields);
  return fields.size() >= 3 && std::ranges::all_of(fields, [](auto field) {
           return field.front() != ',' && field.back() != ',' && number_of(field, true);
         });
}

struct Layout {
  char separator = ' ';
  bool header = false;
  std::vector<Column> columns;
};

/// What the first line says; `what` is why it says nothing.
auto layout_of(std::string_view line, std::string& what) -> std::optional<Layout> {
  Layout out;
  out.separator = separator_of(line);
  if (out.separator == ',' && has_decimal_commas(line)) out.separator = ' ';
  const bool commas = out.separator != ',';
  std::vector<std::string_view> fields;
  split(line, out.separator, fields);
  out.header = std::ranges::any_of(fields, [&](auto field) { return !number_of(field, commas); });
  if (!out.header) {
    if (fields.size() < 3) {
      what = "has " + std::to_string(fields.size()) + " of the three numbers x, y and z";
      return std::nullopt;
    }
    out.columns.assign(fields.size(), Column::none);
    out.columns[0] = Column::x, out.columns[1] = Column::y, out.columns[2] = Column::z;
    const auto colours = fields.size() == 6 ? 3U : fields.size() == 7 ? 4U : 0U;
    if (fields.size() == 7) out.columns[3] = Column::intensity;
    if (colours > 0)
      out.columns[colours] = Column::red, out.columns[colours + 1] = Column::green,
      out.columns[colours + 2] = Column::blue;
    return out;
  }
  for (const auto field : fields) out.columns.push_back(column_of(field));
  for (const auto& [column, name] : {std::pair(Column::x, "x"), std::pair(Column::y, "y"), std::pair(Column::z, "z")}) {
    const auto count = std::ranges::count(out.columns, column);
    if (count == 1) continue;
    what = std::string("is a header ") + (count == 0 ? "without a column " : "with two columns ") + name;
    return std::nullopt;
  }
  return out;
}

auto shown(std::string_view field) -> std::string {
  constexpr std::size_t most = 40;
  return "'" + base::on_one_line(std::string(field.substr(0, most))) + (field.size() > most ? "…'" : "'");
}

constexpr const char* known_columns = "; columns are x, y, z, and class, return, returns, intensity, red, green, blue";

auto parse(std::string_view text, const std::string& name, PointInfo& info) -> base::Result<std::vector<CloudPoint>> {
  const auto wrong = [&](std::size_t line, const std::string& what) {
    return base::error("ingest-points-format", "line " + std::to_string(line) + " " + what, name);
  };
  std::size_t number = 0;
  auto line = next_line(text, number);
  if (line && base::to_integer(*line)) line = next_line(text, number);  // PTS
  if (!line) return std::vector<CloudPoint>();
  std::string what;
  const auto layout = layout_of(*line, what);
  if (!layout) return wrong(number, what + known_columns);
  for (const auto column : layout->columns) {
    info.has_classes = info.has_classes || column == Column::classification;
    info.has_returns = info.has_returns || column == Column::returns;
    info.has_colours = info.has_colours || column == Column::red;
  }
  if (layout->header) line = next_line(text, number);
  const bool commas = layout->separator != ',';
  std::vector<CloudPoint> points;
  std::vector<std::string_view> fields;
  for (; line; line = next_line(text, number)) {
    split(*line, layout->separator, fields);
    CloudPoint point;
    for (std::size_t i = 0; i < layout->columns.size(); ++i) {
      const auto column = layout->columns[i];
      if (column == Column::none) continue;
      if (i >= fields.size())
        return wrong(number, "has " + std::to_string(fields.size()) + " of " + std::to_string(layout->columns.size()) +
                                 " columns; export the points again");
      const auto value = number_of(fields[i], commas);
      if (!value)
        return wrong(number, "has " + shown(fields[i]) + " where a number is expected; export the points again");
      // Colours from 0 to 1, unless they are whole numbers, are shares.
      const bool share = is_colour(column) && fields[i].find_first_of(".,") != std::string_view::npos;
      put(point, column, share && *value <= 1 ? std::round(255 * *value) : *value);
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace

auto is_point_text(std::string_view beginning) -> bool {
  beginning = without_mark(beginning);
  if (beginning.find('\0') != std::string_view::npos) return false;
  // The last line may be cut off.
  if (const auto end = beginning.rfind('\n'); end != std::string_view::npos) beginning = beginning.substr(0, end);
  std::size_t number = 0;
  auto line = next_line(beginning, number);
  if (line && base::to_integer(*line)) line = next_line(beginning, number);
  std::string what;
  return line && layout_of(*line, what);
}

auto open_point_text(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>> {
  const std::string name = path.string();
  const auto bytes = Bytes::of(path);
  if (!bytes) return bytes.failure();
  PointInfo info;
  info.format = "text";
  auto points = parse(without_mark(bytes->view()), name, info);
  if (!points) return points.failure();
  model::InputFile input{name, bytes->view().size(), sha256(bytes->view())};
  return std::unique_ptr<PointCloud>(
      std::make_unique<CloudInMemory>(*std::move(points), std::move(info), std::move(input)));
}

}  // namespace mansard::formats
