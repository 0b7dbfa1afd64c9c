// The report on a file as text.
#include <algorithm>

#include "apps/cli/info.hpp"
#include "apps/cli/layout.hpp"
#include "mansard/base/text.hpp"
#include "mansard/cloud/classes.hpp"

namespace mansard::cli {
namespace {

constexpr std::size_t text_width = 80, margin = 14;
constexpr std::size_t few = 5;  // of a list that --json has in full: a tileset has thousands of files

/// Terms at the left, their values in a second column, broken between words.
class Lines {
 public:
  explicit Lines(const std::string& title) : text_(base::on_one_line(title) + "\n") {}

  void add(const std::string& term, const std::string& words) {
    if (!words.empty()) text_ += term_and_text("  " + term, base::on_one_line(words), margin, text_width);
  }
  [[nodiscard]] auto text() const -> const std::string& { return text_; }

 private:
  std::string text_;
};

auto whole(const Json& number) -> std::string { return std::to_string(number.get<std::int64_t>()); }

auto size_in_words(const Json& bytes) -> std::string {
  const auto n = bytes.get<double>();
  if (n < 1e4) return whole(bytes) + " bytes";
  if (n < 1e7) return base::to_text(n / 1e3, 0) + " kB";
  return n < 1e10 ? base::to_text(n / 1e6, 0) + " MB" : base::to_text(n / 1e9, 1) + " GB";
}

/// "x 1.0 to 2.0, y 3.0 to 4.0, z …".
auto extent_in_words(const Json& extent) -> std::string {
  const std::size_t axes = extent.size() / 2;
  // Degrees need more digits than metres.
  double largest = 0;
  for (const auto& value : extent) largest = std::max(largest, std::abs(value.get<double>()));
  const int decimals = largest <= 180 && axes == 2 ? 5 : 2;
  std::string words;
  for (std::size_t i = 0; i < axes; ++i)
    words += std::string(i > 0 ? ", " : "") + "xyz"[i] + " " + base::to_text(extent[i].get<double>(), decimals) +
             " to " + base::to_text(extent[i + axes].get<double>(), decimals);
  return words;
}

auto json_list(const Json& words) -> std::string {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : ", ") + word.get<std::string>();
  return all;
}

/// "wall 12, roof 8".
auto counted(const Json& counts) -> std::string {
  std::string all;
  for (const auto& [name, count] : counts.items())
    if (count.get<std::int64_t>() > 0) all += (all.empty() ? "" : ", ") + name + " " + whole(count);
  return all;
}

auto what(const Json& info) -> std::string {
  std::string words = info["kind"].get<std::string>() + ", " + info["format"].get<std::string>();
  if (info.contains("by")) words += info["by"] == "mansard" ? ", by mansard " : ", by another producer";
  if (info.contains("made_by")) words += info["made_by"]["version"].get<std::string>();
  if (info.contains("bytes")) words += ", " + size_in_words(info["bytes"]);
  return words;
}

void add_counts(const Json& counts, Lines& lines) {
  if (counts.contains("buildings"))
    lines.add("buildings", whole(counts["buildings"]) + ", with " + whole(counts["parts"]) + " parts and " +
                               whole(counts["faces"]) + " faces");
  std::string words = whole(counts["triangles"]);
  if (counts.contains("vertices")) words += ", over " + whole(counts["vertices"]) + " vertices";
  if (counts.contains("triangles_read") && counts["triangles_read"] != counts["triangles"])
    words += " (of " + whole(counts["triangles_read"]) + " in the file)";
  lines.add("triangles", words);
  std::string faults;
  for (const auto& [name, label] :
       {std::pair{"not_finite", "not finite"}, std::pair{"out_of_range", "with missing corners"},
        std::pair{"degenerate", "without area"}, std::pair{"duplicate", "duplicate"}})
    if (counts.contains(name) && counts[name] > 0)
      faults += (faults.empty() ? "" : ", ") + whole(counts[name]) + " " + label;
  if (!faults.empty()) lines.add("left out", faults);
  if (counts.contains("boundary_edges"))
    lines.add("edges", whole(counts["boundary_edges"]) + " at the boundary, " + whole(counts["non_manifold_edges"]) +
                           " non-manifold, " + whole(counts["flipped_edges"]) +
                           " between triangles of opposite orientation");
}

void add_validity(const Json& validity, Lines& lines) {
  lines.add("valid",
            whole(validity["valid"]) + " of " + whole(validity["solids"]) + " solids (planarity tolerance 0.1 mm)");
  std::size_t told = 0;
  for (const auto& solid : validity["invalid"]) {
    if (++told > 10) {
      lines.add("", "--json lists the others");
      break;
    }
    const auto& reason = solid["reasons"][0];
    lines.add("", solid["part"].get<std::string>() + ": " + reason["code"].get<std::string>() + ", " +
                      reason["message"].get<std::string>());
  }
}

void add_overlaps(const Json& overlaps, Lines& lines) {
  std::size_t told = 0;
  for (const auto& overlap : overlaps) {
    if (++told > few) {
      lines.add("", "--json lists the others");
      break;
    }
    const auto solid = overlap["solid"].get<std::string>();
    lines.add(told == 1 ? "overlaps" : "", (solid.empty() ? "" : solid + ": ") + overlap["message"].get<std::string>());
  }
}

void add_made_by(const Json& made_by, Lines& lines) {
  const bool all = made_by.contains("options");
  const auto& options = made_by[all ? "options" : "options_not_default"];
  const char* term = "options";
  for (const auto& [name, value] : options.items()) {
    lines.add(term, name + " = " + value.get<std::string>());
    term = "";
  }
  if (options.empty()) lines.add(term, all ? "not recorded" : "defaults");
  term = "inputs";
  std::size_t told = 0;
  const auto& inputs = made_by["inputs"];
  for (const auto& input : inputs) {
    if (told++ == few) {
      lines.add("", "and " + std::to_string(inputs.size() - few) + " more, which --json lists");
      break;
    }
    lines.add(term, input["path"].get<std::string>() + ", " + size_in_words(input["bytes"]));
    lines.add("", input["sha256"].get<std::string>());
    term = "";
  }
}

void add_tileset(const Json& tileset, Lines& lines) {
  lines.add("tileset", "3D Tiles " + tileset["version"].get<std::string>() +
                           (tileset["placed_on_the_earth"] == true ? ", georeferenced" : ", without a transform"));
  if (tileset.contains("tilesets_within")) lines.add("", whole(tileset["tilesets_within"]) + " tilesets within it");
  std::size_t depth = 0;
  constexpr std::size_t most = 12;
  for (const auto& level : tileset["levels"]) {
    if (depth == most) {
      lines.add("", "and " + std::to_string(tileset["levels"].size() - most) + " deeper levels, which --json lists");
      break;
    }
    const auto& errors = level["geometric_error_m"];
    std::string words = whole(level["tiles"]) + (level["tiles"] == 1 ? " tile, " : " tiles, ") +
                        whole(level["contents"]) + " with content";
    if (!errors.is_null()) {
      words += ", geometric error " + base::to_text(errors[0].get<double>(), 2);
      if (errors[0] != errors[1]) words += " to " + base::to_text(errors[1].get<double>(), 2);
      words += " m";
    }
    lines.add("level " + std::to_string(depth++), words);
  }
}

void add_layer(const Json& layer, Lines& lines) {
  std::string words = layer["name"].get<std::string>() + ": ";
  words += layer["features"].is_null() ? "" : whole(layer["features"]) + " features, ";
  lines.add("layer", words + layer["geometry"].get<std::string>());
  lines.add("  CRS", layer["crs"] == "" ? "none" : layer["crs"].get<std::string>());
  if (!layer["extent"].is_null()) lines.add("  extent", extent_in_words(layer["extent"]));
  std::string fields;
  for (const auto& field : layer["fields"])
    fields +=
        (fields.empty() ? "" : ", ") + field["name"].get<std::string>() + " (" + field["type"].get<std::string>() + ")";
  if (!fields.empty()) lines.add("  fields", fields);
}

void add_layer_names(const Json& layers, Lines& lines) {
  std::string names;
  for (const auto& layer : layers)
    names += (names.empty() ? "" : ", ") + layer["name"].get<std::string>() +
             (layer["features"].is_null() ? "" : " " + whole(layer["features"]));
  lines.add("layers", names);
}

/// As the LAS specification calls them.
auto class_name(const std::string& number) -> std::string {
  const auto name = cloud::class_name(static_cast<std::uint8_t>(std::stoi(number)));
  return name.empty() ? number : number + " " + std::string(name);
}

void add_points(const Json& info, Lines& lines) {
  const auto& points = info["points"];
  std::string words = whole(points["points"]);
  if (!info["density"].is_null()) words += ", " + base::to_text(info["density"].get<double>(), 2) + " per m²";
  if (info.contains("point_format")) words += ", point format " + whole(info["point_format"]);
  lines.add("points", words);
  std::string left_out;
  for (const auto& [name, label] : {std::pair{"withheld", "withheld"}, std::pair{"not_finite", "not finite"}})
    if (points[name] > 0) left_out += (left_out.empty() ? "" : ", ") + whole(points[name]) + " " + label;
  lines.add("left out", left_out);
  if (!info.contains("classes")) return;
  std::string classes;
  for (const auto& [name, count] : info["classes"].items())
    classes += (classes.empty() ? "" : ", ") + class_name(name) + ": " + whole(count);
  lines.add("classes", classes);
}

void add_raster(const Json& info, Lines& lines) {
  lines.add("cells", whole(info["columns"]) + " × " + whole(info["rows"]) + " of " +
                         base::to_text(info["cell"][0].get<double>()) + " × " +
                         base::to_text(info["cell"][1].get<double>()) + ", " + whole(info["bands"]) + " bands");
  if (!info["nodata"].is_null()) lines.add("no-data", base::to_text(info["nodata"].get<double>()));
  if (info["unit"] != "") lines.add("unit", info["unit"].get<std::string>());
}

}  // namespace

auto info_text(const Json& info) -> std::string {
  Lines lines(info["file"].get<std::string>());
  lines.add("type", what(info));
  if (info.contains("header") && info["header"] != "") lines.add("header", info["header"].get<std::string>());
  if (info.contains("crs")) lines.add("CRS", info["crs"] == "" ? "none" : info["crs"].get<std::string>());
  if (info.contains("extent") && !info["extent"].is_null()) lines.add("extent", extent_in_words(info["extent"]));
  if (info.contains("accuracy") && !info["accuracy"].is_null()) {
    std::string words;
    for (const auto& [name, value] : info["accuracy"]["words"].items())
      words += (words.empty() ? "" : "; ") + name + " " + value.get<std::string>();
    lines.add("accuracy", words);
  }
  if (info.contains("columns")) add_raster(info, lines);
  if (info.contains("counts")) add_counts(info["counts"], lines);
  if (info.contains("outcomes")) lines.add("outcomes", counted(info["outcomes"]));
  if (info.contains("points")) add_points(info, lines);
  else if (info.contains("classes")) lines.add("classes", counted(info["classes"]));
  if (info.contains("lods") && !info["lods"].empty()) lines.add("LoD", json_list(info["lods"]));
  if (info.contains("validity")) add_validity(info["validity"], lines);
  if (info.value("raised", false)) lines.add("", "rebuilt from the plans in the file");
  if (info.contains("validity")) add_overlaps(info["validity"]["overlaps"], lines);
  if (info.contains("fallbacks") && !info["fallbacks"].empty()) lines.add("fallbacks", counted(info["fallbacks"]));
  if (info.contains("footprints"))
    lines.add("footprints", whole(info["footprints"]["surveyed"]) + " surveyed, " +
                                whole(info["footprints"]["derived"]) + " derived from the mesh");
  if (info.contains("tileset") && !info["tileset"].is_null()) add_tileset(info["tileset"], lines);
  if (info.contains("layers") && info["kind"] == "models") add_layer_names(info["layers"], lines);
  else if (info.contains("layers"))
    for (const auto& layer : info["layers"]) add_layer(layer, lines);
  if (info.contains("made_by")) add_made_by(info["made_by"], lines);
  if (info.contains("files") && info["files"].size() > 1) lines.add("files", std::to_string(info["files"].size()));
  if (info.contains("warnings")) {
    const auto& warnings = info["warnings"];
    for (std::size_t i = 0; i < std::min(few, warnings.size()); ++i)
      lines.add("warning", warnings[i]["message"].get<std::string>());
    if (warnings.size() > few)
      lines.add("", "and " + std::to_string(warnings.size() - few) + " more warnings, which --json lists");
  }
  return lines.text();
}

}  // namespace mansard::cli
