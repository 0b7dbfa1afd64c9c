// Vector sources are written through OGR itself, in each format, and read back.
#include <gdal/ogrsf_frmts.h>
#include <gmock/gmock.h>

#include "ingest/workshop.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/formats/vector/features.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Shape {
  const char* wkt;
  const char* name;
  int floors;
};

class Sources : public Workshop {
 protected:
  static void SetUpTestSuite() { crs::register_gdal(); }

  /// A layer "roofs" with the fields name, floors, height, built; epsg 0 for none.
  void write(const std::string& driver, const fs::path& path, int epsg, const std::vector<Shape>& shapes,
             const char* layer_name = "roofs", OGRwkbGeometryType type = wkbUnknown) const {
    GDALDriver* maker = GetGDALDriverManager()->GetDriverByName(driver.c_str());
    ASSERT_NE(maker, nullptr) << driver;
    const GDALDatasetUniquePtr made(maker->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    ASSERT_TRUE(made);
    add_layer(*made, epsg, shapes, layer_name, type);
  }
  static void add_layer(GDALDataset& dataset, int epsg, const std::vector<Shape>& shapes, const char* layer_name,
                        OGRwkbGeometryType type) {
    OGRSpatialReference crs;
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (epsg != 0) crs.importFromEPSG(epsg);
    OGRLayer* layer = dataset.CreateLayer(layer_name, epsg != 0 ? &crs : nullptr, type, nullptr);
    ASSERT_NE(layer, nullptr);
    OGRFieldDefn name("name", OFTString), floors("floors", OFTInteger), height("height", OFTReal),
        built("built", OFTDate);
    for (OGRFieldDefn* field : {&name, &floors, &height, &built}) layer->CreateField(field);
    for (const auto& shape : shapes) {
      const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
      feature->SetField("name", shape.name);
      feature->SetField("floors", shape.floors);
      if (shape.floors > 0) feature->SetField("height", shape.floors * 3.25);
      feature->SetField("built", 1911, 4, 3);
      if (*shape.wkt != '\0') {
        OGRGeometry* geometry = nullptr;
        ASSERT_EQ(OGRGeometryFactory::createFromWkt(shape.wkt, nullptr, &geometry), OGRERR_NONE) << shape.wkt;
        if (std::string_view(shape.name) == "nan")  // which text cannot say
          geometry->toPolygon()->getExteriorRing()->setPoint(1, std::numeric_limits<double>::quiet_NaN(), 10);
        feature->SetGeometryDirectly(geometry);
      }
      ASSERT_EQ(layer->CreateFeature(feature.get()), OGRERR_NONE);
    }
  }
  static auto attribute(const model::Footprint& footprint, std::string_view name) -> model::Value {
    for (const auto& [key, value] : footprint.attributes)
      if (key == name) return value;
    return std::string("no such attribute");
  }
};

struct Format {
  const char* driver;
  const char* ending;
};
class SourcesOfAnyFormat : public Sources, public ::testing::WithParamInterface<Format> {};

TEST_P(SourcesOfAnyFormat, keep_polygons_holes_attributes_and_crs) {
  const auto [driver, ending] = GetParam();
  const fs::path path = at(std::string("f.") + ending);
  write(driver, path, 28992,
        {{"POLYGON ((84910.125 447510.5,84910.125 447530.5,84930.125 447530.5,84930.125 447510.5,84910.125 447510.5),"
          "(84915 447515,84920 447515,84920 447520,84915 447520,84915 447515))",
          "Ærø \"3\"", 3},
         {"MULTIPOLYGON (((84940 447540,84950 447540,84950 447550,84940 447550,84940 447540)),"
          "((84960 447540,84970 447540,84970 447550,84960 447550,84960 447540)))",
          "two", 0}});
  const auto scene = read({ground(84900, 447500, 85000, 447600)}, path);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  ASSERT_EQ(scene->footprints.size(), 2U);
  // FlatGeobuf puts features into the order of its spatial index.
  const std::size_t at_first = attribute(scene->footprints[0], "name") == model::Value(std::string("two")) ? 1 : 0;
  const model::Footprint& first = scene->footprints[at_first];
  const model::Footprint& second = scene->footprints[1 - at_first];
  ASSERT_FALSE(first.defect) << first.defect->message;
  ASSERT_EQ(first.polygons.size(), 1U);
  EXPECT_GT(geometry::signed_area(first.polygons[0].outer), 0);
  ASSERT_EQ(first.polygons[0].holes.size(), 1U);
  EXPECT_LT(geometry::signed_area(first.polygons[0].holes[0]), 0);
  EXPECT_DOUBLE_EQ(geometry::area(first.polygons[0]), 375);
  EXPECT_EQ(attribute(first, "name"), model::Value(std::string("Ærø \"3\"")));
  EXPECT_EQ(attribute(first, "floors"), model::Value(std::int64_t{3}));
  EXPECT_EQ(attribute(first, "height"), model::Value(9.75));
  // FlatGeobuf has no dates without a time.
  EXPECT_THAT(std::get<std::string>(attribute(first, "built")), ::testing::StartsWith("1911-04-03"));
  EXPECT_EQ(second.polygons.size(), 2U);
  EXPECT_EQ(attribute(second, "height"), model::Value());
  EXPECT_NE(first.id, second.id);
  EXPECT_FALSE(fs::exists(at("f.gfs")));
  // The coordinates come back as they were.
  bool found = false;
  for (const auto p : first.polygons[0].outer)
    found = found || (p.x + static_cast<double>(scene->frame.origin[0]) == 84910.125 &&
                      p.y + static_cast<double>(scene->frame.origin[1]) == 447510.5);
  EXPECT_TRUE(found);
}
INSTANTIATE_TEST_SUITE_P(, SourcesOfAnyFormat,
                         ::testing::Values(Format{"GeoJSON", "geojson"}, Format{"GPKG", "gpkg"},
                                           Format{"ESRI Shapefile", "shp"}, Format{"GML", "gml"},
                                           Format{"FlatGeobuf", "fgb"}),
                         [](const auto& given) { return std::string(given.param.ending); });

TEST_P(SourcesOfAnyFormat, are_read_without_a_mesh_just_the_same) {
  const auto [driver, ending] = GetParam();
  const fs::path path = at(std::string("alone.") + ending);
  write(driver, path, 28992,
        {{"POLYGON ((84910.125 447510.5,84910.125 447530.5,84930.125 447530.5,84930.125 447510.5,84910.125 447510.5))",
          "one", 3},
         {"POLYGON ((94960 457540,94970 457540,94970 457550,94960 457550,94960 457540))", "far", 2}});
  const auto alone = read_footprints(path, {});
  ASSERT_TRUE(alone) << base::to_string(alone.error());
  EXPECT_EQ(alone->frame.crs, "EPSG:28992");
  EXPECT_EQ(alone->frame.origin[2], 0);
  EXPECT_TRUE(alone->mesh.triangles.empty());
  ASSERT_EQ(alone->footprints.size(), 2U);
  for (const auto& footprint : alone->footprints) EXPECT_FALSE(footprint.defect);  // nothing lies outside
  Options some;
  some.bbox = {84900, 447500, 85000, 447600};
  const auto near = read_footprints(path, some);
  ASSERT_TRUE(near) << base::to_string(near.error());
  ASSERT_EQ(near->footprints.size(), 1U);
  EXPECT_DOUBLE_EQ(geometry::area(near->footprints[0].polygons.at(0)), 400);
}

TEST_F(Sources, a_shapefile_names_all_its_files_as_inputs) {
  write("ESRI Shapefile", at("f.shp"), 28992, {{"POLYGON ((0 0,9 0,9 9,0 0))", "a", 1}});
  const auto scene = read({ground()}, at("f.shp"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  std::vector<std::string> endings;
  for (const auto& input : scene->inputs) endings.push_back(fs::path(input.path).extension());
  EXPECT_THAT(endings, ::testing::IsSupersetOf({".obj", ".dbf", ".prj", ".shp", ".shx"}));
}

TEST_F(Sources, curves_become_segments_and_heights_go) {
  write("GPKG", at("f.gpkg"), 28992,
        {{"CURVEPOLYGON (CIRCULARSTRING (60 50,50 60,40 50,50 40,60 50))", "circle", 1},
         {"POLYGON Z ((10 10 5,20 10 6,20 20 7,10 20 8,10 10 5))", "high", 1}});
  const auto scene = read({ground()}, at("f.gpkg"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_NEAR(geometry::area(scene->footprints[0].polygons.at(0)), 314.16, 1.5);
  EXPECT_EQ(geometry::area(scene->footprints[1].polygons.at(0)), 100);
}

TEST_F(Sources, the_kinds_of_fields_keep_their_kind) {
  const auto path = file("f.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature","id":7,"properties":
    {"yes":true,"big":9007199254740993,"real":0.1,"none":null,"when":"2020-02-03T04:05:06Z","list":[1,2],"words":["a","b\"c"],
     "object":{"k":1}},"geometry":{"type":"Polygon","coordinates":)" +
                                          square() + "}}]}");
  const auto scene = read({ground()}, path);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  const auto& f = scene->footprints[0];
  EXPECT_EQ(f.id, "7");
  EXPECT_EQ(f.attributes[0], (std::pair<std::string, model::Value>{"yes", true}));
  EXPECT_EQ(attribute(f, "big"), model::Value(std::int64_t{9007199254740993}));
  EXPECT_EQ(attribute(f, "real"), model::Value(0.1));
  EXPECT_EQ(attribute(f, "none"), model::Value());
  EXPECT_EQ(attribute(f, "when"), model::Value(std::string("2020-02-03T04:05:06Z")));
  EXPECT_EQ(attribute(f, "list"), model::Value(std::string("[1,2]")));
  EXPECT_EQ(attribute(f, "words"), model::Value(std::string(R"(["a","b\"c"])")));
}

TEST_F(Sources, ids_come_from_the_attribute_asked_for_and_are_made_different) {
  const char* box = "POLYGON ((10 10,20 10,20 20,10 10))";
  write("GPKG", at("f.gpkg"), 28992, {{box, "a", 1}, {box, "b", 2}, {box, "a", 3}, {box, "a~2", 4}, {box, "a", 5}});
  Options options;
  options.id_attribute = "NAME";
  const auto scene = read({ground()}, at("f.gpkg"), options);
  ASSERT_TRUE(scene);
  std::vector<std::string> ids;
  for (const auto& f : scene->footprints) ids.push_back(f.id);
  EXPECT_THAT(ids, ElementsAre("a", "b", "a~3", "a~2", "a~4"));
  EXPECT_TRUE(has_warning(*scene, "ingest-id-duplicate"));
  // Of a selection, ids are those of the whole.
  options.where = "floors = 5";
  const auto one = read({ground()}, at("f.gpkg"), options);
  ASSERT_TRUE(one) << base::to_string(one.error());
  ASSERT_EQ(one->footprints.size(), 1U);
  EXPECT_EQ(one->footprints[0].id, "a~4");
  options.where.clear();
  // GeoPackage's own column, which its driver keeps apart.
  options.id_attribute = "FID";
  const auto numbered = read({ground()}, at("f.gpkg"), options);
  ASSERT_TRUE(numbered) << base::to_string(numbered.error());
  ids.clear();
  for (const auto& f : numbered->footprints) ids.push_back(f.id);
  EXPECT_THAT(ids, ElementsAre("1", "2", "3", "4", "5"));
  options.id_attribute = "nmae";
  const auto misspelt = read({ground()}, at("f.gpkg"), options);
  ASSERT_EQ(code(misspelt), "ingest-id-attribute");
  EXPECT_THAT(misspelt.error().message, HasSubstr("floors"));
}

TEST_F(Sources, a_well_known_id_that_features_share_stays_and_is_made_different) {
  const auto features = [&](const std::vector<std::string>& values) {
    std::string all;
    for (const auto& value : values)
      all += (all.empty() ? "" : ",") +
             (R"({"type":"Feature","properties":{"bag_id":)" + value +
              R"(,"id":"house"},"geometry":{"type":"Polygon","coordinates":)" + square() + "}}");
    return file("f.geojson", R"({"type":"FeatureCollection","features":[)" + all + "]}");
  };
  const auto ids = [](const model::Scene& scene) {
    std::vector<std::string> out;
    for (const auto& f : scene.footprints) out.push_back(f.id);
    return out;
  };
  const auto twice = read({ground()}, features({"12", "13", "12", "14", "12"}));
  ASSERT_TRUE(twice) << base::to_string(twice.error());
  EXPECT_THAT(ids(*twice), ElementsAre("12", "13", "12~2", "14", "12~3"));
  const auto warning = std::ranges::find(twice->warnings, "ingest-id-duplicate", &base::Diagnostic::code);
  ASSERT_NE(warning, twice->warnings.end());
  EXPECT_THAT(warning->message, HasSubstr("2 of 5 features"));
  EXPECT_THAT(warning->message, HasSubstr("12~2, 12~3"));
  // What all share names no feature; nor does what most lack.
  const auto none = read({ground()}, features({"null", "null", "null", "13", "14"}));
  ASSERT_TRUE(none);
  EXPECT_THAT(ids(*none), ElementsAre("0", "1", "2", "3", "4"));
  EXPECT_FALSE(has_warning(*none, "ingest-id-duplicate"));
}

TEST_F(Sources, a_well_known_id_is_taken_only_when_it_is_there_for_all) {
  const auto features = [&](const std::string& first, const std::string& second) {
    const auto feature = [&](const std::string& properties) {
      return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":{"type":"Polygon","coordinates":)" +
             square() + "}}";
    };
    return file("f.geojson",
                R"({"type":"FeatureCollection","features":[)" + feature(first) + "," + feature(second) + "]}");
  };
  const auto id = [&](const fs::path& path) { return read({ground()}, path).value().footprints[1].id; };
  EXPECT_EQ(id(features(R"({"osm_id":"5","gml_id":"g1"})", R"({"osm_id":"6","gml_id":"g2"})")), "g2");
  EXPECT_EQ(id(features(R"({"osm_id":"5","gml_id":"g"})", R"({"osm_id":"6","gml_id":"g"})")), "6");
  EXPECT_EQ(id(features(R"({"OSM_ID":5,"gml_id":"g"})", R"({"OSM_ID":6,"gml_id":null})")), "6");
  EXPECT_EQ(id(features(R"({"colour":"red"})", R"({"colour":"blue"})")), "1");
}

TEST_F(Sources, layers_and_filters_choose) {
  GDALDriver* maker = GetGDALDriverManager()->GetDriverByName("GPKG");
  {
    const GDALDatasetUniquePtr made(maker->Create(at("f.gpkg").c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    add_layer(*made, 28992, {{"POINT (1 1)", "p", 1}}, "trees", wkbPoint);
    add_layer(*made, 28992,
              {{"POLYGON ((10 10,20 10,20 20,10 10))", "a", 1}, {"POLYGON ((50 50,60 50,60 60,50 50))", "b", 2}},
              "roofs", wkbPolygon);
  }
  const auto scene = read({ground()}, at("f.gpkg"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->footprints.size(), 2U);
  EXPECT_TRUE(has_warning(*scene, "ingest-layers"));
  Options options;
  options.layer = "rofs";
  const auto misspelt = read({ground()}, at("f.gpkg"), options);
  ASSERT_EQ(code(misspelt), "ingest-layer");
  EXPECT_THAT(misspelt.error().message, HasSubstr("did you mean 'roofs'"));
  options.layer = "trees";
  EXPECT_EQ(code(read({ground()}, at("f.gpkg"), options)), "ingest-footprints-geometry");
  options.layer = "roofs";
  options.where = "floors > 1";
  EXPECT_EQ(read({ground()}, at("f.gpkg"), options).value().footprints.size(), 1U);
  const auto both = formats::read_features(at("f.gpkg"), {"roofs", "floors > 1", true, "", {}}, {});
  ASSERT_TRUE(both) << base::to_string(both.error());
  ASSERT_EQ(both->features.size(), 2U);
  EXPECT_NE(both->features[0].passes, both->features[1].passes);
  options.where = "floors > 9";
  EXPECT_EQ(code(read({ground()}, at("f.gpkg"), options)), "ingest-footprints-none");
  options.where = "floors >>> 9";
  const auto unknown = read({ground()}, at("f.gpkg"), options);
  ASSERT_EQ(code(unknown), "ingest-where");
  EXPECT_THAT(unknown.error().message, HasSubstr("the layer has: name, floors"));
}

TEST_F(Sources, a_box_keeps_what_meets_it_and_the_mesh_around) {
  Options options;
  options.bbox = {0, 0, 15, 15};
  const auto path = polygons({square(10, 10, 10), square(70, 70, 10)});
  // A second piece of mesh, far away.
  const auto mesh = file("m.obj", "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\nv 300 0 0\nv 330 0 0\nv 300 30 0\nf 4 5 6\n");
  const auto scene = read({mesh}, path, options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->footprints.size(), 1U);
  EXPECT_EQ(scene->mesh.triangles.size(), 1U);
  options.bbox = {40, 40, 50, 50};
  EXPECT_EQ(code(read({mesh}, path, options)), "ingest-footprints-none");
  options.bbox = {5, 5, 1, 1};
  EXPECT_EQ(code(read({mesh}, path, options)), "ingest-bbox");
}

TEST_F(Sources, files_that_are_no_footprints_are_refused_in_one_line) {
  EXPECT_EQ(code(read({ground()}, at("nowhere.gpkg"))), "file-missing");
  EXPECT_EQ(code(read({ground()}, file("empty.geojson", ""))), "ingest-footprints-format");
  EXPECT_EQ(code(read({ground()}, file("text.geojson", "hello"))), "ingest-footprints-format");
  EXPECT_EQ(code(read({ground()}, file("half.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feat)"))),
            "ingest-footprints-format");
  EXPECT_EQ(code(read({ground()}, file("none.geojson", R"({"type":"FeatureCollection","features":[]})"))),
            "ingest-footprints-none");
  EXPECT_EQ(code(read({ground()}, file("points.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature",
      "properties":{},"geometry":{"type":"Point","coordinates":[1,2]}}]})"))),
            "ingest-footprints-geometry");
  write("GPKG", at("f.gpkg"), 28992, {{"POLYGON ((10 10,20 10,20 20,10 10))", "a", 1}});
  const auto bytes = base::read_file(at("f.gpkg")).value();
  EXPECT_EQ(code(read({ground()}, file("half.gpkg", bytes.substr(0, bytes.size() / 2)))), "ingest-footprints-format");
  write("ESRI Shapefile", at("s.shp"), 28992, {{"POLYGON ((10 10,20 10,20 20,10 10))", "a", 1}});
  const auto shp = base::read_file(at("s.shp")).value();
  file("s.shp", shp.substr(0, shp.size() - 40));
  EXPECT_EQ(code(read({ground()}, at("s.shp"))), "ingest-footprints-format");
  for (const auto& [driver, ending] : {std::pair{"FlatGeobuf", "fgb"}, std::pair{"GML", "gml"}}) {
    const std::string name = std::string("whole.") + ending;
    write(driver, at(name), 28992,
          {{"POLYGON ((10 10,20 10,20 20,10 10))", "a", 1}, {"POLYGON ((30 10,40 10,40 20,30 10))", "b", 1}});
    const auto whole = base::read_file(at(name)).value();
    for (const std::size_t percent : {30U, 75U, 90U, 97U})
      EXPECT_EQ(
          code(read({ground()}, file(std::string("half.") + ending, whole.substr(0, whole.size() * percent / 100)))),
          "ingest-footprints-format")
          << ending << " " << percent;
  }
}

TEST_F(Sources, a_feature_that_is_damaged_in_its_file_leaves_the_others_alone) {
  const auto path = file("f.geojson", R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"id":"x"},"geometry":{"type":"Polygon","coordinates":[[["a",2],[3,"b"],[1,1],["a",2]]]}},
    {"type":"Feature","properties":{"id":"y"},"geometry":{"type":"Nonsense"}},
    {"type":"Feature","properties":{"id":"z"},"geometry":{"type":"Polygon","coordinates":)" +
                                          square() + "}}]}");
  const auto scene = read({ground()}, path);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  ASSERT_EQ(scene->footprints.size(), 3U);
  EXPECT_TRUE(scene->footprints[0].defect.has_value());
  EXPECT_TRUE(scene->footprints[1].defect.has_value());
  EXPECT_FALSE(scene->footprints[2].defect.has_value());
  // A Shapefile of three whose last shape is cut off.
  write("ESRI Shapefile", at("s.shp"), 28992,
        {{"POLYGON ((10 10,20 10,20 20,10 10))", "a", 1}, {"POLYGON ((30 10,40 10,40 20,30 10))", "b", 1}});
  const auto bytes = base::read_file(at("s.shp")).value();
  file("s.shp", bytes.substr(0, bytes.size() - 40));
  const auto cut = read({ground()}, at("s.shp"));
  ASSERT_TRUE(cut) << base::to_string(cut.error());
  EXPECT_FALSE(cut->footprints[0].defect.has_value());
  ASSERT_TRUE(cut->footprints[1].defect.has_value());
  EXPECT_EQ(cut->footprints[1].defect->code, "ingest-footprint-unreadable");
}

TEST_F(Sources, have_the_lowest_height_of_an_outline_where_it_is_drawn_in_three_dimensions) {
  const auto scene = read({ground()}, file("f.geojson", R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"id":"flat"},"geometry":{"type":"Polygon","coordinates":[[[10,10],[20,10],[20,20],[10,10]]]}},
    {"type":"Feature","properties":{"id":"zero"},"geometry":{"type":"Polygon","coordinates":[[[10,10,0],[20,10,0],[20,20,0],[10,10,0]]]}},
    {"type":"Feature","properties":{"id":"high"},"geometry":{"type":"Polygon","coordinates":[[[10,10,42.5],[20,10,41],[20,20,43],[10,10,42.5]]]}}]})"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  ASSERT_EQ(scene->footprints.size(), 3U);
  EXPECT_FALSE(scene->footprints[0].outline_z);
  EXPECT_FALSE(scene->footprints[1].outline_z) << "a z that nobody measured";
  EXPECT_EQ(scene->footprints[2].outline_z, 41);
}

TEST_F(Sources, a_feature_that_cannot_be_used_affects_no_other) {
  write("GPKG", at("f.gpkg"), 28992,
        {{"POLYGON ((10 10,20 10,20 20,10 10))", "good", 1},
         {"", "none", 1},
         {"POLYGON EMPTY", "empty", 1},
         {"LINESTRING (10 10,20 10,20 20)", "line", 1},
         {"GEOMETRYCOLLECTION (POINT (1 1),POLYGON ((30 10,40 10,40 20,30 10)))", "mixed", 1},
         {"POLYGON ((10 10,20 10,20 20,10 10))", "nan", 1},
         {"POLYGON ((900 900,910 900,910 910,900 900))", "outside", 1}});
  Options options;
  options.id_attribute = "name";
  const auto scene = read({ground()}, at("f.gpkg"), options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  std::vector<std::string> defects;
  for (const auto& f : scene->footprints) {
    defects.push_back(f.defect ? f.defect->code : "");
    const bool is_sound = !f.defect || f.defect->code == "ingest-footprint-outside";
    EXPECT_EQ(f.polygons.empty(), !is_sound) << f.id;
    EXPECT_EQ(f.defect.value_or(base::error("", "", f.id)).subject, f.id);
  }
  EXPECT_THAT(defects, ElementsAre("", "ingest-footprint-empty", "ingest-footprint-empty", "ingest-footprint-type", "",
                                   "ingest-footprint-coordinates", "ingest-footprint-outside"));
  EXPECT_TRUE(has_warning(*scene, "ingest-footprint-repaired"));
}

}  // namespace
}  // namespace mansard::ingest::test
