// What QGIS finds in the table layer_styles of a GeoPackage.
#include <cpl_minixml.h>
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <set>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/formats/layers.hpp"
#include "mansard/formats/stream.hpp"

namespace {

namespace model = mansard::model;

using namespace cities;
using namespace mansard::formats;
namespace base = mansard::base;
using testing::ElementsAre;
using testing::HasSubstr;
using Shape = mansard::formats::Shape;

class QgisStyles : public testing::Test {
 protected:
  QgisStyles() : path_(folder_ / "styles.gpkg") { mansard::crs::register_gdal(); }

  void open() {
    file_.reset(GDALDataset::Open(path_.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
    ASSERT_NE(file_, nullptr);
  }
  void write(const model::City& city, const std::vector<Layer>& more = {}) {
    base::Outputs outputs;
    auto writer = open_writer(Format::geopackage, path_, {city.frame, city.made_by}, {}, outputs, more);
    ASSERT_TRUE(writer) << base::to_string(writer.error());
    ASSERT_TRUE(write_city(city, **writer));
    ASSERT_TRUE(outputs.commit());
    open();
  }
  void write(const std::vector<Layer>& layers) {
    const auto bytes = geopackage(layers, {{84800, 447400, 0}, "EPSG:28992"});
    ASSERT_TRUE(bytes) << base::to_string(bytes.error());
    ASSERT_TRUE(base::write_file(path_, *bytes));
    open();
  }

  /// The one row of a layer.
  auto style(const std::string& layer) -> OGRFeatureUniquePtr {
    OGRLayer* table = file_->GetLayerByName("layer_styles");
    if (table == nullptr) return nullptr;
    table->SetAttributeFilter(("f_table_name = '" + layer + "'").c_str());
    table->ResetReading();
    OGRFeatureUniquePtr row(table->GetNextFeature());
    EXPECT_EQ(OGRFeatureUniquePtr(table->GetNextFeature()), nullptr) << layer << " has a second style";
    table->SetAttributeFilter(nullptr);
    return row;
  }
  auto styled() -> std::vector<std::string> {
    std::vector<std::string> names;
    OGRLayer* table = file_->GetLayerByName("layer_styles");
    if (table == nullptr) return names;
    table->ResetReading();
    while (const OGRFeatureUniquePtr row{table->GetNextFeature()})
      names.emplace_back(row->GetFieldAsString("f_table_name"));
    return names;
  }
  auto sql(const char* query) -> std::string {
    OGRLayer* answer = file_->ExecuteSQL(query, nullptr, nullptr);
    std::string value = OGRFeatureUniquePtr(answer->GetNextFeature())->GetFieldAsString(0);
    file_->ReleaseResultSet(answer);
    return value;
  }

  mansard::test::Scratch folder_;
  std::filesystem::path path_;
  GDALDatasetUniquePtr file_;
};

using Xml = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;
auto xml(const char* text) -> Xml {
  CPLErrorReset();
  Xml parsed(CPLParseXMLString(text), &CPLDestroyXMLNode);
  EXPECT_STREQ(CPLGetLastErrorMsg(), "") << text;
  return parsed;
}

/// Every element of that name, wherever it stands.
void find_all(const CPLXMLNode* node, const std::string& name, std::vector<const CPLXMLNode*>& found) {
  for (; node != nullptr; node = node->psNext) {
    if (node->eType == CXT_Element && name == node->pszValue) found.push_back(node);
    find_all(node->psChild, name, found);
  }
}
auto all(const Xml& document, const std::string& name) -> std::vector<const CPLXMLNode*> {
  std::vector<const CPLXMLNode*> found;
  find_all(document.get(), name, found);
  return found;
}
auto get(const CPLXMLNode* node, const char* path) -> std::string { return CPLGetXMLValue(node, path, "none"); }

/// Layers of a segmentation as the pipeline calls them, with what their styles go by.
auto segment_layers() -> std::vector<Layer> {
  const std::vector<std::vector<Point2>> line{{{0, 0}, {1, 0}}};
  const auto square = rectangle(0, 0, 1, 1);
  return {
      {"sweep_edges", "", Shape::line, {{"block"}}, {{line, {}, {std::string("block")}}}},
      {"faces", "", Shape::polygon, {{"inside", FieldType::boolean}}, {{{}, {square}, {true}}}},
      {"edges", "", Shape::lines, {{"chosen", FieldType::boolean}}, {{line, {}, {false}}}},
      {"conflicts", "", Shape::lines, {{"paid", FieldType::boolean}}, {{line, {}, {true}}}},
      {"footprints", "", Shape::polygon, {{"faces", FieldType::integer}}, {{{}, {square}, {std::int64_t{3}}}}},
      {"diagnostics", "", Shape::polygons, {{"severity"}}, {{{}, {square}, {std::string("error")}}}},
  };
}

TEST_F(QgisStyles, are_one_default_for_every_layer_that_can_be_drawn) {
  write(street(), segment_layers());
  EXPECT_THAT(styled(),
              ElementsAre("gis_footprints", "footprints", "edges", "roof_planes", "walls", "solids_lod12",
                          "ground_lod12", "solids_lod13", "ground_lod13", "solids_lod22", "ground_lod22", "sweep_edges",
                          "faces", "segment_edges", "conflicts", "segment_footprints", "diagnostics"));
  for (auto* layer : file_->GetLayers()) {
    const auto row = style(layer->GetName());
    EXPECT_EQ(row != nullptr, layer->GetGeomType() != wkbNone) << layer->GetName();
    if (!row) continue;
    EXPECT_STREQ(row->GetFieldAsString("f_geometry_column"), layer->GetGeometryColumn());
    EXPECT_STREQ(row->GetFieldAsString("styleName"), "mansard");
    EXPECT_EQ(row->GetFieldAsInteger("useAsDefault"), 1);
    // QGIS looks for the empty text; a null would not be found.
    for (const char* empty : {"f_table_catalog", "f_table_schema", "owner"}) {
      EXPECT_TRUE(row->IsFieldSetAndNotNull(row->GetFieldIndex(empty))) << empty;
      EXPECT_STREQ(row->GetFieldAsString(empty), "") << empty;
    }
    EXPECT_STREQ(row->GetFieldAsString("update_time"), "1970/01/01 00:00:00+00");
  }
}

TEST_F(QgisStyles, stand_in_the_table_that_qgis_makes) {
  write(street());
  std::vector<std::string> names;
  const auto* definition = file_->GetLayerByName("layer_styles")->GetLayerDefn();
  for (int i = 0; i < definition->GetFieldCount(); ++i) names.emplace_back(definition->GetFieldDefn(i)->GetNameRef());
  EXPECT_THAT(names, ElementsAre("f_table_catalog", "f_table_schema", "f_table_name", "f_geometry_column", "styleName",
                                 "styleQML", "styleSLD", "useAsDefault", "description", "owner", "ui", "update_time"));
  EXPECT_STREQ(file_->GetLayerByName("layer_styles")->GetFIDColumn(), "id");
  EXPECT_EQ(sql("SELECT data_type FROM gpkg_contents WHERE table_name = 'layer_styles'"), "attributes");
  // As texts: GDAL makes dates of them, and of other spellings too, with a warning.
  EXPECT_EQ(sql("SELECT last_change || '' FROM gpkg_contents WHERE table_name = 'layer_styles'"),
            "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(sql("SELECT update_time || '' FROM layer_styles"), "1970-01-01T00:00:00.000Z");
}

TEST_F(QgisStyles, are_xml_that_names_fields_of_the_layer_and_a_symbol_for_every_case) {
  write(street(), segment_layers());
  for (const auto& name : styled()) {
    const auto row = style(name);
    const auto qml = xml(row->GetFieldAsString("styleQML")), sld = xml(row->GetFieldAsString("styleSLD"));
    ASSERT_NE(qml, nullptr) << name;
    ASSERT_NE(sld, nullptr) << name;
    const auto renderers = all(qml, "renderer-v2"), symbols = all(qml, "symbol"), categories = all(qml, "category");
    ASSERT_EQ(renderers.size(), 1U) << name;
    const std::string field = get(renderers[0], "attr");
    const auto* definition = file_->GetLayerByName(name.c_str())->GetLayerDefn();
    if (field == "none") {
      EXPECT_EQ(get(renderers[0], "type"), "singleSymbol") << name;
      EXPECT_EQ(symbols.size(), 1U) << name;
      EXPECT_TRUE(categories.empty()) << name;
    } else {
      EXPECT_EQ(get(renderers[0], "type"), "categorizedSymbol") << name;
      EXPECT_GE(definition->GetFieldIndex(field.c_str()), 0) << name << " " << field;
      ASSERT_EQ(symbols.size(), categories.size()) << name;
      for (std::size_t i = 0; i < symbols.size(); ++i) EXPECT_EQ(get(symbols[i], "name"), get(categories[i], "symbol"));
    }
    const bool area = wkbFlatten(definition->GetGeomType()) % 3 == 0;  // Polygon 3, MultiPolygon 6
    for (const auto* symbol : symbols) EXPECT_EQ(get(symbol, "type"), area ? "fill" : "line") << name;
    EXPECT_EQ(all(sld, "se:Rule").size(), symbols.size()) << name;
    EXPECT_EQ(all(sld, area ? "se:PolygonSymbolizer" : "se:LineSymbolizer").size(), symbols.size()) << name;
    for (const auto* asked : all(sld, "ogc:PropertyName")) EXPECT_EQ(get(asked, ""), field) << name;
  }
}

TEST_F(QgisStyles, know_every_class_and_every_outcome_that_is_written) {
  model::City city = street();
  city.buildings[0].attributes.emplace_back("ms_outcome", std::string("full"));
  city.buildings[1].attributes.emplace_back("ms_outcome", std::string("fallback"));
  write(city, segment_layers());
  for (const auto& [name, field] : std::map<std::string, std::string>{{"gis_footprints", "ms_outcome"},
                                                                      {"roof_planes", "class"},
                                                                      {"walls", "class"},
                                                                      {"edges", "party"},
                                                                      {"faces", "inside"},
                                                                      {"segment_edges", "chosen"},
                                                                      {"conflicts", "paid"},
                                                                      {"diagnostics", "severity"}}) {
    const auto qml = xml(style(name)->GetFieldAsString("styleQML"));
    EXPECT_EQ(get(all(qml, "renderer-v2").at(0), "attr"), field);
    std::set<std::string> known;
    for (const auto* category : all(qml, "category")) known.insert(get(category, "value"));
    OGRLayer* layer = file_->GetLayerByName(name.c_str());
    layer->ResetReading();
    while (const OGRFeatureUniquePtr row{layer->GetNextFeature()}) {
      const int at = row->GetFieldIndex(field.c_str());
      std::string value = row->GetFieldAsString(at);
      const bool flag = row->GetFieldDefnRef(at)->GetSubType() == OFSTBoolean;
      if (flag && !value.empty()) value = value == "1" ? "true" : "false";
      EXPECT_TRUE(known.contains(value)) << name << " '" << value << "'";
    }
  }
}

TEST_F(QgisStyles, show_how_likely_buildings_are_right_where_that_is_known) {
  model::City city = street();
  for (auto& building : city.buildings) building.attributes.emplace_back("ms_outcome", std::string("full"));
  city.buildings[0].attributes.emplace_back("ms_quality", std::string("high"));
  city.buildings[1].attributes.emplace_back("ms_quality", std::string("low"));
  write(city);
  const auto qml = xml(style("gis_footprints")->GetFieldAsString("styleQML"));
  EXPECT_EQ(get(all(qml, "renderer-v2").at(0), "attr"), "ms_quality");
  std::set<std::string> known;
  for (const auto* category : all(qml, "category")) known.insert(get(category, "value"));
  EXPECT_THAT(known, testing::IsSupersetOf({"high", "medium", "low", "none"}));
}

TEST_F(QgisStyles, have_the_colours_of_the_materials) {
  write(street());
  const auto colours = obj(street(), "street.mtl")->mtl;
  const auto expect_as = [&](const char* layer, const char* material, const char* qml, const char* sld) {
    // "Kd 0.6902 0.3843 0.3137" for "176,98,80,255" and "#b06250"
    const auto at = colours.find(std::string("newmtl ") + material + "\n");
    std::istringstream words(colours.substr(colours.find("Kd ", at) + 3));
    std::string as_qml, as_sld = "#";
    for (double channel = 0; as_sld.size() < 7 && words >> channel;) {
      const int level = static_cast<int>(std::lround(channel * 255));
      as_qml += std::to_string(level) + ",";
      for (const int digit : {level / 16, level % 16}) as_sld += "0123456789abcdef"[digit];
    }
    EXPECT_THAT(style(layer)->GetFieldAsString("styleQML"),
                HasSubstr(std::string(qml) + "\" type=\"QString\" value=\"" + as_qml));
    EXPECT_THAT(style(layer)->GetFieldAsString("styleSLD"), HasSubstr(std::string(sld) + "\">" + as_sld));
  };
  expect_as("roof_planes", "roof", "\"color", "fill");
  expect_as("walls", "wall", "line_color", "stroke");  // lines in plan
  expect_as("walls", "party_wall", "line_color", "stroke");
}

TEST_F(QgisStyles, are_those_of_a_segmentation_alone_too) {
  write(segment_layers());
  EXPECT_THAT(styled(), ElementsAre("sweep_edges", "faces", "edges", "conflicts", "footprints", "diagnostics"));
  EXPECT_EQ(get(all(xml(style("edges")->GetFieldAsString("styleQML")), "renderer-v2").at(0), "attr"), "chosen");
}

TEST_F(QgisStyles, are_not_made_for_layers_of_others) {
  write(std::vector<Layer>{{"trees", "", Shape::polygon, {{"class"}}, {}},
                           {"walls", "no field to go by", Shape::polygon, {{"kind"}}, {}},
                           {"roof_planes", "no geometry", Shape::none, {{"class"}}, {}}});
  EXPECT_EQ(file_->GetLayerByName("layer_styles"), nullptr);
}

}  // namespace
