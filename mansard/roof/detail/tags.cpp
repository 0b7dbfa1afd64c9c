#include "mansard/roof/detail/tags.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "mansard/base/text.hpp"
#include "mansard/roof/detail/shape_list.hpp"

namespace mansard::roof::detail {
namespace {

auto trimmed(std::string_view text) -> std::string_view {
  constexpr std::string_view blank = " \t\r\n";
  const auto from = text.find_first_not_of(blank);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(blank) - from + 1);
}

/// The number at the start, which is taken off; a comma is a decimal point.
auto take_number(std::string_view& text) -> std::optional<double> {
  std::size_t end = 0;
  bool point = false;
  std::string digits;
  if (end < text.size() && (text[end] == '+' || text[end] == '-')) digits += text[end++];
  for (; end < text.size(); ++end) {
    const char c = text[end];
    if (c >= '0' && c <= '9') {
      digits += c;
    } else if ((c == '.' || c == ',') && !point) {
      digits += '.';
      point = true;
    } else {
      break;
    }
  }
  const auto number = base::to_number(digits);
  if (number) text.remove_prefix(end);
  return number;
}

auto text_of(const model::Value& value) -> std::string {
  if (const auto* text = std::get_if<std::string>(&value)) return std::string(trimmed(*text));
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return base::to_text(*number, 6);
  return {};
}

}  // namespace

auto plain(std::string_view name) -> std::string {
  std::string out = base::lower(name);
  for (char& c : out)
    if (c == ':' || c == '-' || c == '.' || c == ' ') c = '_';
  return out;
}

namespace keys {

// The second half of each list: names in Overture Maps and elsewhere, then what a Shapefile's ten letters leave.
auto height() -> const Key& {
  static const Key key{"height", {"height", "building_height", "building_h"}, &Options::building_height_attribute};
  return key;
}
auto levels() -> const Key& {
  static const Key key{
      "building:levels", {"building_levels", "num_floors", "building_l"}, &Options::building_levels_attribute};
  return key;
}
auto min_height() -> const Key& {
  static const Key key{"min_height", {"min_height", "building_min_height"}, &Options::min_height_attribute};
  return key;
}
auto min_level() -> const Key& {
  static const Key key{
      "building:min_level", {"building_min_level", "min_floor", "building_m"}, &Options::min_level_attribute};
  return key;
}
auto shape() -> const Key& {
  static const Key key{"roof:shape", {"roof_shape", "building_roof_shape"}, &Options::shape_attribute};
  return key;
}
auto roof_height() -> const Key& {
  static const Key key{"roof:height", {"roof_height", "roof_heigh"}, &Options::height_attribute};
  return key;
}
auto roof_levels() -> const Key& {
  static const Key key{"roof:levels", {"roof_levels", "roof_level"}, &Options::levels_attribute};
  return key;
}
auto angle() -> const Key& {
  static const Key key{"roof:angle", {"roof_angle"}, &Options::angle_attribute};
  return key;
}
auto orientation() -> const Key& {
  static const Key key{"roof:orientation", {"roof_orientation", "roof_orien"}, &Options::orientation_attribute};
  return key;
}
auto direction() -> const Key& {
  static const Key key{
      "roof:direction", {"roof_direction", "roof_direc", "roof_slope_direction"}, &Options::direction_attribute};
  return key;
}
auto ground() -> const Key& {
  static const Key key{"ground", {}, &Options::ground_attribute};
  return key;
}
// Both spellings, and Overture's words.
auto wall_colour() -> const Key& {
  static const Key key{"building:colour", {"building_colour", "building_color", "facade_color"}};
  return key;
}
auto wall_material() -> const Key& {
  static const Key key{"building:material", {"building_material", "building_facade_material", "facade_material"}};
  return key;
}
auto roof_colour() -> const Key& {
  static const Key key{"roof:colour", {"roof_colour", "roof_color", "building_roof_colour", "roof_colou"}};
  return key;
}
auto roof_material() -> const Key& {
  static const Key key{"roof:material", {"roof_material", "building_roof_material", "roof_mater"}};
  return key;
}
auto all() -> const std::vector<const Key*>& {
  static const std::vector<const Key*> keys{&height(),        &levels(),      &min_height(),   &min_level(),
                                            &shape(),         &roof_height(), &roof_levels(),  &angle(),
                                            &orientation(),   &direction(),   &ground(),       &wall_colour(),
                                            &wall_material(), &roof_colour(), &roof_material()};
  return keys;
}

}  // namespace keys

Tags::Tags(const model::Attributes& attributes, const Options& options) : options_(options) {
  entries_.reserve(attributes.size());
  for (const auto& [name, value] : attributes)
    if (!std::holds_alternative<std::monostate>(value)) entries_.push_back({plain(name), &name, &value});
}

auto Tags::find(const Key& key) const -> std::optional<Tag> {
  const std::string wanted = key.attribute == nullptr ? std::string() : options_.*key.attribute;
  const auto in_attributes = [&](std::string_view name) -> std::optional<Tag> {
    for (const Entry& entry : entries_)
      if (entry.name == name)
        if (auto text = text_of(*entry.value); !text.empty()) return Tag{*entry.original, std::move(text)};
    return std::nullopt;
  };
  const auto in_texts = [&](std::string_view name) -> std::optional<Tag> {
    for (const Entry& entry : entries_) {
      if (entry.name != "other_tags" && entry.name != "all_tags" && entry.name != "tags") continue;
      const auto* text = std::get_if<std::string>(entry.value);
      if (text == nullptr) continue;
      if (auto value = in_hstore(*text, name))
        if (const auto inner = trimmed(*value); !inner.empty()) return Tag{std::string(name), std::string(inner)};
    }
    return std::nullopt;
  };
  if (!wanted.empty()) {
    if (auto tag = in_attributes(plain(wanted))) return tag;
    return in_texts(wanted);
  }
  for (const auto name : key.names)
    if (auto tag = in_attributes(name)) return tag;
  return in_texts(key.tag);
}

auto in_hstore(std::string_view text, std::string_view key) -> std::optional<std::string> {
  // Texts in quotes, in turn key and value; between them "=>" or ":", after them ",".
  std::size_t at = 0;
  const auto next = [&](std::string& out) {
    out.clear();
    if (at = text.find('"', at); at == std::string_view::npos) return false;
    for (++at; at < text.size() && text[at] != '"'; ++at) {
      if (text[at] == '\\' && at + 1 < text.size()) ++at;
      out += text[at];
    }
    if (at >= text.size()) return false;
    ++at;
    return true;
  };
  std::string name, value;
  while (next(name)) {
    // A value without quotes (NULL, or a number in JSON) ends at the comma.
    const auto sign = text.find_first_not_of(" \t=>:", at);
    if (sign != std::string_view::npos && text[sign] != '"') {
      const auto end = std::min(text.find_first_of(",}", sign), text.size());
      value = std::string(trimmed(text.substr(sign, end - sign)));
      at = end;
      if (const auto word = base::lower(value); word == "null") value.clear();
    } else if (!next(value)) {
      return std::nullopt;
    }
    if (name == key) return value;
  }
  return std::nullopt;
}

auto length_of(std::string_view text) -> std::optional<double> {
  constexpr double foot = 0.3048, inch = 0.0254;
  text = trimmed(text);
  const auto number = take_number(text);
  if (!number) return std::nullopt;
  const std::string unit = base::lower(trimmed(text));
  static constexpr std::array metres{"", "m", "m.", "meter", "meters", "metre", "metres"};
  if (std::ranges::find(metres, unit) != metres.end()) return *number;
  if (unit == "cm") return *number / 100;
  if (unit == "km") return *number * 1000;
  if (unit == "\"" || unit == "in" || unit == "''" || unit == "inch" || unit == "inches") return *number * inch;
  std::string_view rest = unit;
  bool feet = false;
  for (const std::string_view word : {"feet", "foot", "ft", "'", "\xe2\x80\xb2"})
    if (!feet && rest.starts_with(word)) {
      rest = trimmed(rest.substr(word.size()));
      feet = true;
    }
  if (!feet) return std::nullopt;
  if (rest.empty() || rest == ".") return *number * foot;
  const auto inches = take_number(rest);
  if (!inches || *inches < 0) return std::nullopt;
  rest = trimmed(rest);
  static constexpr std::array inch_words{"", "\"", "''", "in", "inch", "inches", "\xe2\x80\xb3"};
  if (std::ranges::find(inch_words, rest) == inch_words.end()) return std::nullopt;
  return *number * foot + std::copysign(*inches, *number) * inch;
}

auto count_of(std::string_view text) -> std::optional<double> {
  text = trimmed(text);
  const auto number = take_number(text);
  return number && trimmed(text).empty() ? number : std::nullopt;
}

auto angle_of(std::string_view text) -> std::optional<double> {
  text = trimmed(text);
  const auto number = take_number(text);
  const std::string unit = base::lower(trimmed(text));
  if (!number || (!unit.empty() && unit != "\xc2\xb0" && unit != "deg" && unit != "degree" && unit != "degrees"))
    return std::nullopt;
  return *number * std::numbers::pi / 180;
}

auto bearing_of(std::string_view text) -> std::optional<double> {
  constexpr double round = 2 * std::numbers::pi;
  if (const auto angle = angle_of(text)) {
    const double turned = std::fmod(*angle, round);
    return turned < 0 ? turned + round : turned;
  }
  std::string word;  // "north-east" becomes "ne"
  const std::string given = base::lower(trimmed(text));
  for (std::size_t at = 0; at < given.size();) {
    const std::string_view rest = std::string_view(given).substr(at);
    bool found = false;
    for (const std::string_view name : {"north", "east", "south", "west"})
      if (!found && rest.starts_with(name)) {
        word += name.front();
        at += name.size();
        found = true;
      }
    if (found) continue;
    if (given[at] != '-' && given[at] != ' ' && given[at] != '_') word += given[at];
    ++at;
  }
  static constexpr std::array points{"n", "nne", "ne", "ene", "e", "ese", "se", "sse",
                                     "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"};
  const auto at = std::ranges::find(points, word);
  if (at == points.end()) return std::nullopt;
  return round * static_cast<double>(at - points.begin()) / points.size();
}

auto shape_of(std::string_view text) -> std::optional<Named> {
  const std::string name = plain(trimmed(text.substr(0, text.find(';'))));
  const auto has = [&](std::span<const std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const ShapeInfo& info : shapes()) {
    if (name == info.name || has(info.same)) return Named{info.shape, true};
    if (has(info.similar)) return Named{info.shape, false};
  }
  return std::nullopt;
}

}  // namespace mansard::roof::detail
