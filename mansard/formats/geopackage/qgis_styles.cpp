#include "mansard/formats/geopackage/qgis_styles.hpp"

#include <array>
#include <span>

#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/formats/geopackage/geopackage_tables.hpp"

namespace mansard::formats::detail {
namespace {

/// sRGB and opacity, 0 to 255.
struct Colour {
  int red = 0, green = 0, blue = 0, opacity = 255;
};

/// A colour that is not opaque at all is not drawn.
struct Look {
  Colour fill, line;
  double width = 0;  ///< of the line, mm
  bool dashed = false;
};

/// What has a value in the style's field; of the last case of a style without value, everything else.
struct Case {
  const char* value;
  const char* label;
  Look look;
};

/// `field` is null where everything looks alike.
struct LayerStyle {
  const char* layer;
  const char* field;
  const char* description;
  std::span<const Case> cases;
};

constexpr auto of(model::FaceClass c, int opacity = 255) -> Colour {
  const auto& [red, green, blue] = class_colours[static_cast<std::size_t>(c)];
  return {red, green, blue, opacity};
}

constexpr Colour none{0, 0, 0, 0}, ink{40, 44, 52}, pale{170, 174, 180}, green{70, 140, 90}, amber{226, 148, 40},
    red{200, 48, 48}, blue{52, 100, 168};

constexpr auto thin(Colour c, int opacity) -> Colour { return {c.red, c.green, c.blue, opacity}; }

constexpr std::array outcome{
    Case{"full", "Raised from its full profiles", {thin(green, 70), green, 0.3}},
    Case{"fallback", "Some part is simpler than its profiles", {thin(amber, 120), amber, 0.4}},
    Case{"covered", "Its ground went to its neighbours", {thin(pale, 120), pale, 0.3}},
    Case{"refused", "The footprint cannot be used", {thin(red, 120), red, 0.5}},
    Case{nullptr, "Not told", {none, ink, 0.3}},
};
constexpr std::array quality{
    Case{"high", "Probably right, 90 % and more", {thin(green, 70), green, 0.3}},
    Case{"medium", "To look at: 50 to 90 %, or a check failed", {thin(amber, 120), amber, 0.4}},
    Case{"low", "Probably wrong", {thin(red, 120), red, 0.5}},
    Case{"none", "No model", {thin(pale, 120), pale, 0.3}},
    Case{nullptr, "Not measured", {none, ink, 0.3}},
};
constexpr std::array gis{Case{nullptr, "Footprint as it was read", {none, ink, 0.3}}};
constexpr std::array plans{Case{nullptr, "Plan of a part", {none, {90, 48, 38}, 0.4}}};
constexpr std::array party{
    Case{"true", "Party wall", {none, of(model::FaceClass::party_wall), 0.6}},
    Case{"false", "Wall in the open", {none, ink, 0.3}},
    Case{nullptr, "No wall", {none, pale, 0.3, true}},
};
constexpr std::array roofs{
    Case{"sloped", "Sloped roof", {of(model::FaceClass::roof), {122, 64, 52}, 0.15}},
    Case{"flat", "Flat roof", {of(model::FaceClass::roof, 140), {122, 64, 52}, 0.15}},
};
// Upright, so in plan nothing but their outline is seen.
constexpr std::array walls{
    Case{"wall", "Wall", {of(model::FaceClass::wall), of(model::FaceClass::wall), 0.6}},
    Case{"party_wall", "Party wall", {of(model::FaceClass::party_wall), of(model::FaceClass::party_wall), 0.6}},
};
// Seen from above, the faces of a solid are drawn over each other.
constexpr std::array solids{Case{nullptr, "Solid", {of(model::FaceClass::roof, 60), of(model::FaceClass::wall), 0.2}}};
constexpr std::array grounds{Case{nullptr, "Ground", {of(model::FaceClass::ground, 140), ink, 0.2}}};
constexpr std::array sweep_edges{Case{nullptr, "Wall", {none, blue, 0.4}}};
constexpr std::array inside{
    Case{"true", "Inside", {thin(blue, 40), pale, 0.15}},
    Case{"false", "Outside", {none, pale, 0.15}},
};
constexpr std::array chosen{
    Case{"true", "Chosen: a wall between parts", {none, ink, 0.6}},
    Case{"false", "Not chosen", {none, pale, 0.2, true}},
};
constexpr std::array paid{
    Case{"true", "Both edges were cut: paid for", {none, red, 0.6}},
    Case{"false", "Kept apart", {none, thin(amber, 120), 0.3}},
};
constexpr std::array pieces{Case{nullptr, "Part", {thin(blue, 40), blue, 0.4}}};
constexpr std::array severity{
    Case{"error", "Error", {thin(red, 120), red, 0.5}},
    Case{"warning", "Warning", {thin(amber, 90), amber, 0.4}},
};

constexpr std::array changes{
    Case{"new", "New", {thin({46, 139, 87}, 150), {46, 139, 87}, 0.4}},
    Case{"gone", "Gone", {thin(red, 150), red, 0.4}},
    Case{"raised", "Raised", {thin(blue, 150), blue, 0.4}},
    Case{"lowered", "Lowered", {thin({138, 111, 200}, 150), {138, 111, 200}, 0.4}},
    Case{"extended", "Extended", {thin({127, 194, 90}, 150), {127, 194, 90}, 0.4}},
    Case{"reduced", "Reduced", {thin(amber, 150), amber, 0.4}},
    Case{"re-roofed", "Re-roofed", {thin({217, 98, 156}, 150), {217, 98, 156}, 0.4}},
    Case{"unchanged", "Unchanged", {thin(pale, 60), pale, 0.2}},
    Case{nullptr, "Not compared", {none, ink, 0.3, true}},
};

/// Of two with one name, the first whose field the layer has. "segment_…" is what layers of a segmentation are called
/// beside a city's.
constexpr std::array styles{
    LayerStyle{"gis_footprints", "ms_quality", "Buildings by how likely they are right", quality},
    LayerStyle{"gis_footprints", "ms_outcome", "Buildings by outcome", outcome},
    LayerStyle{"gis_footprints", nullptr, "Outlines of the footprints", gis},
    LayerStyle{"changes", "ms_change", "Buildings by what has changed", changes},
    LayerStyle{"footprints", "part_id", "Outlines of the parts", plans},
    LayerStyle{"footprints", "faces", "Parts of the segmentation", pieces},
    LayerStyle{"segment_footprints", "faces", "Parts of the segmentation", pieces},
    LayerStyle{"edges", "party", "Edges by what stands against them", party},
    LayerStyle{"edges", "chosen", "Edges by whether they were chosen", chosen},
    LayerStyle{"segment_edges", "chosen", "Edges by whether they were chosen", chosen},
    LayerStyle{"roof_planes", "class", "Roofs by class", roofs},
    LayerStyle{"walls", "class", "Walls by class", walls},
    LayerStyle{"solids_lod12", nullptr, "Solids of LoD 1.2", solids},
    LayerStyle{"solids_lod13", nullptr, "Solids of LoD 1.3", solids},
    LayerStyle{"solids_lod20", nullptr, "Solids of LoD 2.0", solids},
    LayerStyle{"solids_lod22", nullptr, "Solids of LoD 2.2", solids},
    LayerStyle{"ground_lod12", nullptr, "Ground of the solids of LoD 1.2", grounds},
    LayerStyle{"ground_lod13", nullptr, "Ground of the solids of LoD 1.3", grounds},
    LayerStyle{"ground_lod20", nullptr, "Ground of the solids of LoD 2.0", grounds},
    LayerStyle{"ground_lod22", nullptr, "Ground of the solids of LoD 2.2", grounds},
    LayerStyle{"sweep_edges", nullptr, "Walls in the scan", sweep_edges},
    LayerStyle{"faces", "inside", "Faces by whether they are inside", inside},
    LayerStyle{"conflicts", "paid", "Bad pairs by whether both were cut", paid},
    LayerStyle{"diagnostics", "severity", "Diagnostics by severity", severity},
};

// ---- XML

using Members = std::vector<std::pair<std::string_view, std::string>>;

auto tag(std::string_view name, const Members& attributes) -> std::string {
  std::string out = "<" + std::string(name);
  for (const auto& [key, value] : attributes)
    out += " " + std::string(key) + "=\"" + base::markup_escaped(value) + "\"";
  return out;
}
auto empty(std::string_view name, const Members& attributes) -> std::string { return tag(name, attributes) + "/>"; }
auto element(std::string_view name, const Members& attributes, const std::string& inner) -> std::string {
  return tag(name, attributes) + ">" + inner + "</" + std::string(name) + ">";
}
auto text_element(std::string_view name, std::string_view text, const Members& attributes = {}) -> std::string {
  return element(name, attributes, base::markup_escaped(text));
}

/// What of a layer its style depends on.
struct Subject {
  bool area = false;  ///< polygons, else lines
  bool flag = false;  ///< the field is one
};

// ---- QML, as QGIS 3.22 and later write it; read there from "Symbology" alone, so that all else stays as it is set

auto option(std::string_view name, const std::string& value) -> std::string {
  return empty("Option", {{"name", std::string(name)}, {"type", "QString"}, {"value", value}});
}

auto qml_colour(const Colour& c) -> std::string {
  return std::to_string(c.red) + "," + std::to_string(c.green) + "," + std::to_string(c.blue) + "," +
         std::to_string(c.opacity);
}

auto qml_symbol(const Look& look, bool area, std::size_t number) -> std::string {
  const std::string style = look.dashed ? "dash" : "solid", width = base::to_text(look.width, 2);
  const std::string options =
      area ? option("color", qml_colour(look.fill)) + option("style", look.fill.opacity > 0 ? "solid" : "no") +
                 option("outline_color", qml_colour(look.line)) + option("outline_style", style) +
                 option("outline_width", width) + option("outline_width_unit", "MM") + option("joinstyle", "round")
           : option("line_color", qml_colour(look.line)) + option("line_style", style) + option("line_width", width) +
                 option("line_width_unit", "MM") + option("capstyle", "round") + option("joinstyle", "round");
  return element(
      "symbol",
      {{"type", area ? "fill" : "line"},
       {"name", std::to_string(number)},
       {"alpha", "1"},
       {"clip_to_extent", "1"},
       {"force_rhr", "0"}},
      element("layer",
              {{"class", area ? "SimpleFill" : "SimpleLine"}, {"enabled", "1"}, {"locked", "0"}, {"pass", "0"}},
              element("Option", {{"type", "Map"}}, options)));
}

auto qml(const LayerStyle& style, const Subject& subject) -> std::string {
  std::string symbols, categories;
  for (std::size_t i = 0; i < style.cases.size(); ++i) {
    const Case& one = style.cases[i];
    symbols += qml_symbol(one.look, subject.area, i);
    // An empty text is every value that no other category has, and none.
    categories += empty("category", {{"symbol", std::to_string(i)},
                                     {"value", one.value == nullptr ? "" : one.value},
                                     {"type", subject.flag && one.value != nullptr ? "bool" : "string"},
                                     {"label", one.label},
                                     {"render", "true"}});
  }
  Members renderer{{"type", style.field == nullptr ? "singleSymbol" : "categorizedSymbol"}};
  if (style.field != nullptr) renderer.emplace_back("attr", style.field);
  for (const auto* off : {"symbollevels", "enableorderby", "forceraster"}) renderer.emplace_back(off, "0");
  std::string inner;
  if (style.field != nullptr) inner += element("categories", {}, categories);
  inner += element("symbols", {}, symbols);
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n" +
         element("qgis", {{"version", "3.22.0"}, {"styleCategories", "Symbology"}},
                 element("renderer-v2", renderer, inner) + text_element("blendMode", "0") +
                     text_element("featureBlendMode", "0") + text_element("layerOpacity", "1") +
                     text_element("layerGeometryType", subject.area ? "2" : "1")) +
         "\n";
}

// ---- SLD 1.1 (OGC 05-078r4) with Symbology Encoding (OGC 05-077r4)

auto parameter(const char* name, const std::string& value) -> std::string {
  return text_element("se:SvgParameter", value, {{"name", name}});
}

auto hexadecimal(const Colour& c) -> std::string {
  std::string out = "#";
  for (const int channel : {c.red, c.green, c.blue})
    for (const int digit : {channel / 16, channel % 16}) out += "0123456789abcdef"[digit];
  return out;
}

auto opacity_of(const Colour& c) -> std::string { return base::to_text(c.opacity / 255.0, 2); }

auto stroke(const Look& look) -> std::string {
  constexpr double pixel = 0.28;  // mm, as the standard has it
  std::string inner = parameter("stroke", hexadecimal(look.line)) + parameter("stroke-opacity", opacity_of(look.line)) +
                      parameter("stroke-width", base::to_text(look.width / pixel, 2)) +
                      parameter("stroke-linejoin", "round");
  if (look.dashed) inner += parameter("stroke-dasharray", "4 2");
  return element("se:Stroke", {}, inner);
}

auto symboliser(const Look& look, bool area) -> std::string {
  if (!area) return element("se:LineSymbolizer", {}, stroke(look));
  const std::string fill =
      look.fill.opacity == 0
          ? std::string()
          : element("se:Fill", {},
                    parameter("fill", hexadecimal(look.fill)) + parameter("fill-opacity", opacity_of(look.fill)));
  return element("se:PolygonSymbolizer", {}, fill + stroke(look));
}

/// Flags are 1 and 0 in the file, and a filter may be put to it as it is; programs with flags of their own take these.
auto literal(const char* value, bool flag) -> std::string {
  return !flag ? value : value == std::string_view("true") ? "1" : "0";
}

auto sld(const LayerStyle& style, const Subject& subject) -> std::string {
  std::string rules;
  for (const Case& one : style.cases) {
    std::string when;
    if (style.field != nullptr && one.value != nullptr) {
      const std::string both =
          text_element("ogc:PropertyName", style.field) + text_element("ogc:Literal", literal(one.value, subject.flag));
      when = element("ogc:Filter", {}, element("ogc:PropertyIsEqualTo", {}, both));
    } else if (style.field != nullptr) {
      when = "<se:ElseFilter/>";
    }
    rules += element("se:Rule", {}, text_element("se:Name", one.label) + when + symboliser(one.look, subject.area));
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
         element(
             "StyledLayerDescriptor",
             {{"version", "1.1.0"},
              {"xmlns", "http://www.opengis.net/sld"},
              {"xmlns:se", "http://www.opengis.net/se"},
              {"xmlns:ogc", "http://www.opengis.net/ogc"}},
             element("NamedLayer", {},
                     text_element("se:Name", style.layer) +
                         element("UserStyle", {},
                                 text_element("se:Name", style.layer) + element("se:FeatureTypeStyle", {}, rules)))) +
         "\n";
}

// ---- the table, with the columns and widths that QGIS makes it with

auto make_table(GDALDataset& file) -> OGRLayer* {
  CPLStringList options;
  options.SetNameValue("FID", "id");
  OGRLayer* table = file.CreateLayer(styles_name, nullptr, wkbNone, options.List());
  if (table == nullptr) return nullptr;
  struct Column {
    const char* name;
    OGRFieldType type;
    int width;
  };
  static constexpr std::array columns{
      Column{"f_table_catalog", OFTString, 256},
      Column{"f_table_schema", OFTString, 256},
      Column{"f_table_name", OFTString, 256},
      Column{"f_geometry_column", OFTString, 256},
      Column{"styleName", OFTString, 30},
      Column{"styleQML", OFTString, 0},
      Column{"styleSLD", OFTString, 0},
      Column{"useAsDefault", OFTInteger, 0},
      Column{"description", OFTString, 0},
      Column{"owner", OFTString, 30},
      Column{"ui", OFTString, 30},
      Column{"update_time", OFTDateTime, 0},
  };
  for (const Column& column : columns) {
    OGRFieldDefn definition(column.name, column.type);
    if (column.width > 0) definition.SetWidth(column.width);
    if (column.type == OFTInteger) definition.SetSubType(OFSTBoolean);
    if (column.type == OFTDateTime) definition.SetDefault("CURRENT_TIMESTAMP");
    if (table->CreateField(&definition) != OGRERR_NONE) return nullptr;
  }
  return table;
}

auto add_row(OGRLayer& layer, const QgisStyle& style, OGRLayer& table) -> bool {
  OGRFeature row(table.GetLayerDefn());
  row.SetField("f_table_catalog", "");
  row.SetField("f_table_schema", "");
  row.SetField("f_table_name", layer.GetName());
  row.SetField("f_geometry_column", layer.GetGeometryColumn());
  row.SetField("styleName", style.name.c_str());
  row.SetField("styleQML", style.qml.c_str());
  row.SetField("styleSLD", style.sld.c_str());
  row.SetField("useAsDefault", 1);
  row.SetField("description", style.description.c_str());
  row.SetField("owner", "");
  // The day that every file of ours is of, in UTC (100): the same city gives the same bytes at any time.
  row.SetField(row.GetFieldIndex("update_time"), 1970, 1, 1, 0, 0, 0.0F, 100);
  return table.CreateFeature(&row) == OGRERR_NONE;
}

}  // namespace

auto style_of(OGRLayer& layer) -> std::optional<QgisStyle> {
  const auto type = wkbFlatten(layer.GetGeomType());
  // QGIS reads polyhedral surfaces as polygons.
  const bool area = type == wkbPolygon || type == wkbMultiPolygon || type == wkbPolyhedralSurface;
  if (!area && type != wkbLineString && type != wkbMultiLineString) return std::nullopt;
  for (const LayerStyle& style : styles) {
    if (std::string_view(layer.GetName()) != style.layer) continue;
    const int field = style.field == nullptr ? -1 : layer.GetLayerDefn()->GetFieldIndex(style.field);
    if (style.field != nullptr && field < 0) continue;
    LayerStyle drawn = style;
    if (style.cases.size() == 1) drawn.field = nullptr;  // a field that only tells which layer it is
    const Subject subject{area, field >= 0 && layer.GetLayerDefn()->GetFieldDefn(field)->GetSubType() == OFSTBoolean};
    return QgisStyle{"mansard", style.description, qml(drawn, subject), sld(drawn, subject)};
  }
  return std::nullopt;
}

auto add_styles(GDALDataset& file) -> base::Result<void> {
  if (file.GetLayerByName(styles_name) != nullptr) return {};
  OGRLayer* table = nullptr;
  for (int i = 0, count = file.GetLayerCount(); i < count; ++i) {
    OGRLayer& layer = *file.GetLayer(i);
    const auto style = style_of(layer);
    if (!style) continue;
    if (table == nullptr) table = make_table(file);
    if (table == nullptr) return geopackage_failure("make the table " + std::string(styles_name));
    if (!add_row(layer, *style, *table)) return geopackage_failure("write a style of " + std::string(layer.GetName()));
  }
  return {};
}

}  // namespace mansard::formats::detail
