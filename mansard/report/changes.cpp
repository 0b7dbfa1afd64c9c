#include "mansard/report/changes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"
#include "mansard/model/value_text.hpp"
#include "mansard/report/attributes.hpp"

namespace mansard::report {
namespace {

using base::to_text;
using compare::Change;
using compare::Kind;
using Json = nlohmann::ordered_json;

constexpr std::array all_kinds{Kind::built,   Kind::gone,     Kind::raised,    Kind::lowered, Kind::extended,
                               Kind::reduced, Kind::reroofed, Kind::unchanged, Kind::unseen};

/// sRGB; those of the layer's style in QGIS.
auto colour_of(Kind kind) -> const char* {
  switch (kind) {
    case Kind::built: return "#2e8b57";
    case Kind::gone: return "#c83030";
    case Kind::raised: return "#3464a8";
    case Kind::lowered: return "#8a6fc8";
    case Kind::extended: return "#7fc25a";
    case Kind::reduced: return "#e2942c";
    case Kind::reroofed: return "#d9629c";
    case Kind::unchanged: return "#e4e5e8";
    case Kind::unseen: break;
  }
  return "#ffffff";
}

auto joined(const std::vector<std::string>& texts, const char* between) -> std::string {
  std::string out;
  for (const auto& text : texts) out += (out.empty() ? "" : between) + text;
  return out;
}

auto ids_of(const compare::State& state, const std::vector<std::uint32_t>& buildings) -> std::string {
  std::vector<std::string> ids;
  for (const auto b : buildings) ids.push_back(state.buildings[b].id);
  return joined(ids, " ");
}

auto outline_of(const Changes& changes, const Change& change) -> std::vector<geometry::Polygon> {
  return change.now.empty() ? changes.old.buildings[change.old.front()].outline
                            : changes.now.buildings[change.now.front()].outline;
}

auto json_of(const model::Value& value) -> Json {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return nullptr;
}

auto csv_cell(const std::string& text) -> std::string {
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

auto rounded(double value) -> double { return rounded_measure(value); }

/// Two significant digits are all that a probability of this kind has.
auto chance_in_digits(double chance) -> double {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), chance, std::chars_format::scientific, 1).ptr;
  return chance > 1e-300 ? base::to_number({text.data(), end}).value_or(chance) : 0;
}

}  // namespace

auto change_attributes(const Changes& changes, const Change& change) -> model::Attributes {
  std::vector<std::string> names;
  for (const auto& part : change.parts) {
    const std::string name(compare::to_string(part.kind));
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  model::Attributes out;
  out.emplace_back("ms_change", std::string(compare::to_string(change.kind)));
  out.emplace_back("ms_change_all", joined(names, "; "));
  const bool changed = !change.parts.empty(), seen = change.kind != Kind::unseen;
  const auto number = [&](const char* name, bool there, double value) {
    out.emplace_back(name, there ? model::Value(rounded(value)) : model::Value());
  };
  const bool compared = changed || (seen && change.common > 0);
  number("ms_change_height", compared, changed ? change.parts.front().height : change.height);
  number("ms_change_height_se", compared, changed ? change.parts.front().error : change.height_error);
  double volume = 0;
  for (const auto& part : change.parts) volume += part.volume;
  number("ms_change_area", changed, changed ? change.parts.front().area : 0);
  number("ms_change_volume", changed, volume);
  number("ms_change_sigmas", changed, changed ? std::min(change.parts.front().sigmas, 9999.0) : 0);
  out.emplace_back("ms_change_chance", seen ? model::Value(chance_in_digits(change.chance)) : model::Value());
  out.emplace_back("ms_change_doubtful", change.doubtful);
  out.emplace_back("ms_change_reasons", change.why.empty() ? model::Value() : model::Value(joined(change.why, "; ")));
  out.emplace_back("ms_change_old",
                   change.old.empty() ? model::Value() : model::Value(ids_of(changes.old, change.old)));
  return out;
}

auto change_attribute_list() -> std::vector<formats::Attribute> {
  std::vector<formats::Attribute> all;
  const auto add = [&all](const char* name, const char* type, const char* unit, const char* meaning) {
    all.push_back({name, "compare", {"Building"}, type, unit, meaning});
  };
  add("ms_change", "string", "",
      "What has changed since the old state, by the largest volume: new, gone, raised, lowered, extended, reduced, "
      "re-roofed, unchanged, or not compared; only of 'mansard compare'.");
  add("ms_change_all", "string", "", "All that has changed, the largest volume first; empty where nothing has.");
  add("ms_change_height", "number", "m",
      "Median difference of heights, new - old, over the place that has changed; of an unchanged building over its "
      "ground.");
  add("ms_change_height_se", "number", "m", "Standard error of ms_change_height.");
  add("ms_change_area", "number", "m²", "Ground of the place that has changed; absent where nothing has.");
  add("ms_change_volume", "number", "m³", "Volume gained, or lost where negative; absent where nothing has changed.");
  add("ms_change_sigmas", "number", "",
      "Mean difference of the place that has changed over its standard error; absent where nothing has.");
  add("ms_change_chance", "number", "",
      "Probability that the errors of both states alone give such a difference; absent where nothing was compared.");
  add("ms_change_doubtful", "boolean", "", "Whether the change rests on a model that is probably wrong.");
  add("ms_change_reasons", "string", "", "The evidence and the doubts, in words; absent where there are none.");
  add("ms_change_old", "string", "",
      "Ids of the old buildings on this ground, the one with the largest share first; absent where there are none.");
  return all;
}

auto changes_csv(const Changes& changes) -> std::string {
  std::string out = "id";
  for (const auto& attribute : change_attribute_list()) out += "," + attribute.name;
  out += "\r\n";
  for (const auto& change : changes.found.changes) {
    out += csv_cell(change.now.empty() ? std::string() : ids_of(changes.now, change.now));
    for (const auto& [name, value] : change_attributes(changes, change)) out += "," + csv_cell(model::text_of(value));
    out += "\r\n";
  }
  return out;
}

auto changes_layers(const Changes& changes) -> std::vector<formats::Layer> {
  using enum formats::FieldType;
  formats::Layer layer{"changes",
                       "Buildings by what has changed from " + changes.old_name + " to " + changes.new_name,
                       formats::Shape::polygons,
                       {{"building_id"}},
                       {}};
  for (const auto& attribute : change_attribute_list())
    layer.fields.push_back({attribute.name, attribute.type == "number"    ? real
                                            : attribute.type == "boolean" ? boolean
                                                                          : string});
  for (const auto& change : changes.found.changes) {
    formats::Feature feature;
    feature.polygons = outline_of(changes, change);
    feature.values.emplace_back(change.now.empty() ? model::Value() : model::Value(ids_of(changes.now, change.now)));
    for (auto& [name, value] : change_attributes(changes, change)) feature.values.push_back(std::move(value));
    layer.features.push_back(std::move(feature));
  }
  return {std::move(layer)};
}

auto changes_json(const Changes& changes) -> std::string {
  const auto& found = changes.found;
  const auto& offset = found.offset;
  const auto state = [](const std::string& name, const compare::State& of) {
    return Json{{"models", name},
                {"buildings", of.buildings.size()},
                {"scan", !of.scan.triangles.empty()},
                {"noise_m", rounded(of.accuracy.noise)},
                {"correlated_area_m2", rounded(of.accuracy.correlated_area)}};
  };
  Json counts = Json::object();
  for (const auto kind : all_kinds) counts[std::string(compare::to_string(kind))] = found.count(kind);
  Json inputs = Json::array();
  for (const auto& input : changes.inputs)
    inputs.push_back({{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}});
  Json buildings = Json::array();
  for (const auto& change : found.changes) {
    Json one = Json::object();
    one["id"] = change.now.empty() ? Json(nullptr) : Json(ids_of(changes.now, change.now));
    for (const auto& [name, value] : change_attributes(changes, change)) one[name] = json_of(value);
    Json parts = Json::array();
    for (const auto& part : change.parts)
      parts.push_back({{"kind", std::string(compare::to_string(part.kind))},
                       {"area_m2", rounded(part.area)},
                       {"height_m", rounded(part.height)},
                       {"height_se_m", rounded(part.error)},
                       {"volume_m3", rounded(part.volume)},
                       {"sigmas", rounded(std::min(part.sigmas, 9999.0))}});
    one["parts"] = parts;
    one["old_scan_share"] = rounded(change.old_seen);
    one["new_scan_share"] = rounded(change.new_seen);
    buildings.push_back(std::move(one));
  }
  const Json out{{"mansard", changes.version},
                 {"crs", changes.frame.crs.empty() ? Json(nullptr) : Json(changes.frame.crs)},
                 {"old", state(changes.old_name, changes.old)},
                 {"new", state(changes.new_name, changes.now)},
                 {"inputs", inputs},
                 {"options",
                  {{"compare.smallest", changes.options.smallest},
                   {"compare.false_share", changes.options.false_share},
                   {"compare.old_error", changes.options.old_error ? Json(*changes.options.old_error) : Json(nullptr)},
                   {"compare.new_error", changes.options.new_error ? Json(*changes.options.new_error) : Json(nullptr)},
                   {"compare.keep_offset", changes.options.keep_offset}}},
                 {"offset",
                  {{"height_m", rounded(offset.height)},
                   {"height_se_m", rounded(offset.height_error)},
                   {"plan_m", {rounded(offset.plan.x), rounded(offset.plan.y)}},
                   {"plan_se_m", {rounded(offset.plan_error.x), rounded(offset.plan_error.y)}},
                   {"buildings", offset.buildings},
                   {"removed", offset.removed}}},
                 {"model_error_m", found.model_error ? Json(rounded(*found.model_error)) : Json(nullptr)},
                 {"error_scale", rounded(found.scale)},
                 {"critical_chance", chance_in_digits(found.critical)},
                 {"counts", counts},
                 {"buildings", buildings}};
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

auto changes_summary(const Changes& changes) -> std::string {
  const auto& found = changes.found;
  const auto& offset = found.offset;
  std::string out;
  for (const auto kind : all_kinds) {
    const auto count = found.count(kind);
    if (count == 0) continue;
    double gained = 0, lost = 0;
    std::size_t doubtful = 0;
    for (const auto& change : found.changes) {
      if (change.kind != kind) continue;
      doubtful += change.doubtful && !change.parts.empty() ? 1 : 0;
      for (const auto& part : change.parts) (part.volume > 0 ? gained : lost) += part.volume;
    }
    std::string line = std::string(compare::to_string(kind));
    line.resize(14, ' ');
    std::string number = std::to_string(count);
    line += std::string(number.size() < 6 ? 6 - number.size() : 0, ' ') + number;
    if (gained > 0) line += "   +" + to_text(gained, 0) + " m³";
    if (lost < 0) line += "   " + to_text(lost, 0) + " m³";
    if (doubtful > 0) line += "   " + std::to_string(doubtful) + " doubtful";
    out += line + "\n";
  }
  const auto signed_metres = [](double value) { return (value > 0 ? "+" : "") + to_text(value, 2) + " m"; };
  if (offset.removed)
    out += "The new state is shifted by " + signed_metres(offset.plan.x) + " east, " + signed_metres(offset.plan.y) +
           " north, " + signed_metres(offset.height) + " up (median of " + std::to_string(offset.buildings) +
           " buildings); this is taken off.\n";
  else if (changes.options.keep_offset)
    out += "The new state is " + signed_metres(offset.height) +
           " up (median of all buildings); this counts as a change.\n";
  else out += "A shift of one state is not measured and not taken off: that needs five buildings that are in both.\n";
  const auto known = [](const compare::State& state, const char* which) {
    return std::string(which) + (state.scan.triangles.empty()
                                     ? ": models alone"
                                     : ": models and scan, noise " + to_text(state.accuracy.noise, 3) + " m");
  };
  out += known(changes.old, "Old") + ". " + known(changes.now, "New") + ".\n";
  return out;
}

// ---- the map

namespace {

constexpr double map_width = 1200, legend = 200, border = 20, least_height = 260;  // px

struct Map {
  geometry::Box2 box;
  double scale = 1;  ///< px per m
  [[nodiscard]] auto x(double at) const -> std::string { return to_text(border + (at - box.least.x) * scale, 1); }
  [[nodiscard]] auto y(double at) const -> std::string { return to_text(border + (box.most.y - at) * scale, 1); }
  [[nodiscard]] auto path(const std::vector<geometry::Polygon>& polygons) const -> std::string {
    std::string out;
    const auto add = [&](const geometry::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i)
        out += (i == 0 ? "M" : "L") + x(ring[i].x) + " " + y(ring[i].y) + " ";
      out += "Z";
    };
    for (const auto& polygon : polygons) {
      add(polygon.outer);
      std::ranges::for_each(polygon.holes, add);
    }
    return out;
  }
};

/// "+3.1 m" of a roof, "new, 8.2 m" of a building.
auto label_of(const Change& change) -> std::string {
  if (change.parts.empty()) return {};
  const double height = change.parts.front().height;
  const std::string metres = (height > 0 ? "+" : "−") + to_text(std::abs(height), 1) + " m";
  return change.doubtful ? metres + " ?" : metres;
}

}  // namespace

auto changes_svg(const Changes& changes) -> std::string {
  Map map;
  for (const auto& change : changes.found.changes) map.box.include(geometry::bounds(outline_of(changes, change)));
  if (map.box.empty()) map.box = {{0, 0}, {1, 1}};
  const double across = std::max(map.box.most.x - map.box.least.x, 1.0),
               along = std::max(map.box.most.y - map.box.least.y, 1.0);
  map.scale = (map_width - 2 * border) / std::max(across, along * 0.7);
  const double width = 2 * border + across * map.scale, height = std::max(2 * border + along * map.scale, least_height);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + to_text(width + legend, 0) + " " +
                    to_text(height, 0) +
                    "\" font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"#ffffff\"/>\n<g stroke=\"#3c3e44\" stroke-width=\"0.8\" fill-rule=\"evenodd\">\n";
  // What is gone lies below what is on its ground now.
  for (const bool gone : {true, false})
    for (const auto& change : changes.found.changes) {
      if (change.now.empty() != gone) continue;
      const std::string name = gone ? ids_of(changes.old, change.old) : ids_of(changes.now, change.now);
      std::string title = name + ": " + std::string(compare::to_string(change.kind));
      for (const auto& why : change.why) title += "\n" + why;
      out += "<path d=\"" + map.path(outline_of(changes, change)) + "\" fill=\"" + colour_of(change.kind) + "\"" +
             (change.doubtful && !change.parts.empty() ? " stroke-dasharray=\"4 3\"" : "") + "><title>" +
             base::markup_escaped(title) + "</title></path>\n";
    }
  out += "</g>\n<g font-size=\"13\" text-anchor=\"middle\" fill=\"#141418\" pointer-events=\"none\">\n";
  for (const auto& change : changes.found.changes) {
    const auto text = label_of(change);
    const auto box = geometry::bounds(outline_of(changes, change));
    constexpr double least_wide = 40;  // px; on what is smaller a label would hide its neighbours
    if (text.empty() || box.empty() || (box.most.x - box.least.x) * map.scale < least_wide) continue;
    const std::string at = "<text x=\"" + map.x(0.5 * (box.least.x + box.most.x)) + "\" y=\"" +
                           map.y(0.5 * (box.least.y + box.most.y)) + "\" dy=\"4\"";
    const std::string halo = " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\">";
    out += at + halo + text + "</text>" + at + ">" + text + "</text>\n";
  }
  out += "</g>\n<g font-size=\"14\" fill=\"#222428\">\n";
  double at = border + 10;
  const std::string left = to_text(width + 8, 0), beside = to_text(width + 30, 0);
  for (const auto kind : all_kinds) {
    const auto count = changes.found.count(kind);
    if (count == 0) continue;
    out += "<rect x=\"" + left + "\" y=\"" + to_text(at - 11, 0) + "\" width=\"14\" height=\"14\" fill=\"" +
           colour_of(kind) + "\" stroke=\"#3c3e44\" stroke-width=\"0.8\"/><text x=\"" + beside + "\" y=\"" +
           to_text(at + 1, 0) + "\">" + std::string(compare::to_string(kind)) + ": " + std::to_string(count) +
           "</text>\n";
    at += 24;
  }
  double bar = 1;
  for (double power = 1; power < 1e9; power *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (step * power * map.scale <= 120) bar = step * power;
  const std::string low = to_text(at + 12, 0);
  out += "<path d=\"M" + left + " " + low + " h" + to_text(bar * map.scale, 1) +
         "\" stroke=\"#222428\" stroke-width=\"2\"/><text x=\"" + left + "\" y=\"" + to_text(at + 32, 0) +
         "\" font-size=\"12\">" + to_text(bar, 0) + " m, north up</text>\n</g>\n</svg>\n";
  return out;
}

}  // namespace mansard::report
