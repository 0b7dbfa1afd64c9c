// Sources of footprints beyond plain vector files: archives, OpenStreetMap, city models, and what a box leaves out.
#include <gdal/cpl_vsi.h>
#include <gdal/ogrsf_frmts.h>
#include <gmock/gmock.h>

#include "ingest/workshop.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/formats/vector/features.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class MoreSources : public Workshop {
 protected:
  static void SetUpTestSuite() { crs::register_gdal(); }

  static void pack(const std::string& name, std::string_view bytes) {
    VSILFILE* file = VSIFOpenL(name.c_str(), "wb");
    ASSERT_NE(file, nullptr) << name;
    VSIFWriteL(bytes.data(), 1, bytes.size(), file);
    VSIFCloseL(file);
  }
  static auto ids(const model::Scene& scene) -> std::vector<std::string> {
    std::vector<std::string> out;
    for (const auto& footprint : scene.footprints) out.push_back(footprint.id);
    return out;
  }
  static auto attribute(const model::Footprint& footprint, std::string_view name) -> model::Value {
    for (const auto& [key, value] : footprint.attributes)
      if (key == name) return value;
    return std::string("no such attribute");
  }
  /// Squares of 10 m in EPSG:28992, one every 100 m to the east, in a file with a spatial index.
  auto row_of_houses(int count) const -> fs::path {
    const auto path = at("row.gpkg");
    GDALDriver* maker = GetGDALDriverManager()->GetDriverByName("GPKG");
    const GDALDatasetUniquePtr made(maker->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference crs;
    crs.importFromEPSG(28992);
    OGRLayer* layer = made->CreateLayer("houses", &crs, wkbPolygon, nullptr);
    OGRFieldDefn name("name", OFTString);
    layer->CreateField(&name);
    for (int i = 0; i < count; ++i) {
      const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
      feature->SetField("name", ("house " + std::to_string(i)).c_str());
      OGRLinearRing ring;
      const double x = 84000 + 100.0 * i, y = 447000;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}) ring.addPoint(x + dx, y + dy);
      OGRPolygon polygon;
      polygon.addRing(&ring);
      feature->SetGeometry(&polygon);
      EXPECT_EQ(layer->CreateFeature(feature.get()), OGRERR_NONE);
    }
    return path;
  }
};

TEST_F(MoreSources, may_be_packed) {
  const auto plain = polygons({square(), square(50, 50)}, "urn:ogc:def:crs:EPSG::28992");
  const auto bytes = base::read_file(plain).value();
  pack("/vsigzip/" + at("f.geojson.gz").string(), bytes);
  pack("/vsizip/" + at("f.zip").string() + "/deep/f.geojson", bytes);
  const auto expected = read_footprints(plain, {});
  ASSERT_TRUE(expected) << base::to_string(expected.error());
  for (const auto& name :
       {at("f.geojson.gz").string(), at("f.zip").string(), "/vsizip/" + at("f.zip").string() + "/deep/f.geojson"}) {
    const auto scene = read_footprints(name, {});
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_EQ(ids(*scene), ids(*expected));
    EXPECT_EQ(scene->frame.crs, "EPSG:28992");
    ASSERT_EQ(scene->inputs.size(), 1U) << name;
    EXPECT_EQ(scene->inputs[0].sha256, expected->inputs[0].sha256);
  }
  EXPECT_FALSE(fs::exists(at("f.geojson.gz.properties")));
  EXPECT_EQ(code(read_footprints("/vsizip/" + at("f.zip").string() + "/deep/g.geojson", {})), "file-missing");
}

TEST_F(MoreSources, of_a_zipped_shapefile_name_all_its_members) {
  GDALDriver* maker = GetGDALDriverManager()->GetDriverByName("ESRI Shapefile");
  {
    const GDALDatasetUniquePtr from(GDALDataset::Open(row_of_houses(3).c_str(), GDAL_OF_VECTOR));
    const GDALDatasetUniquePtr made(maker->CreateCopy(at("s.shp").c_str(), from.get(), 0, nullptr, nullptr, nullptr));
  }
  for (const char* ending : {"shp", "shx", "dbf", "prj"})
    pack("/vsizip/" + at("s.zip").string() + "/s." + ending, base::read_file(at(std::string("s.") + ending)).value());
  const auto scene = read_footprints(at("s.zip"), {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->footprints.size(), 3U);
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  EXPECT_EQ(scene->inputs.size(), 4U);
  for (const auto& input : scene->inputs) EXPECT_THAT(input.path, HasSubstr("s.zip/s."));
}

TEST_F(MoreSources, are_found_in_an_archive_of_a_folder) {
  const auto scene_of = [](const fs::path& path) {
    const auto scene = read_footprints(path, {});
    EXPECT_TRUE(scene) << base::to_string(scene.error());
    return scene ? scene->footprints.size() : 0;
  };
  const auto houses = row_of_houses(3);
  const auto gpkg = base::read_file(houses).value();
  const std::string name = houses.filename().string();
  // As macOS packs one file, and as everybody packs a folder.
  pack("/vsizip/" + at("mac.zip").string() + "/" + name, gpkg);
  pack("/vsizip/" + at("mac.zip").string() + "/__MACOSX/._" + name, "not for others");
  EXPECT_EQ(scene_of(at("mac.zip")), 3U);
  pack("/vsizip/" + at("folder.zip").string() + "/city/houses/" + name, gpkg);
  pack("/vsizip/" + at("folder.zip").string() + "/.DS_Store", "not for others");
  EXPECT_EQ(scene_of(at("folder.zip")), 3U);
  EXPECT_TRUE(formats::vector_source(at("folder.zip")));
}

TEST_F(MoreSources, of_geojson_without_crs_are_no_degrees_beyond_the_earth) {
  EXPECT_EQ(formats::vector_source(polygons({square(500, 300)})).value().layers.at(0).crs, "");
  EXPECT_EQ(formats::vector_source(polygons({square(4, 52, 0.001)})).value().layers.at(0).crs, "EPSG:4326");
  EXPECT_EQ(
      formats::vector_source(polygons({square(500, 300)}, "urn:ogc:def:crs:EPSG::28992")).value().layers.at(0).crs,
      "EPSG:28992");
}

TEST_F(MoreSources, with_a_box_are_the_same_whether_the_driver_knows_boxes_or_not) {
  const auto path = row_of_houses(400);  // 40 km: most are beyond what the driver is asked for
  Options options;
  options.bbox = {84995, 446990, 85305, 447020};
  const auto scene = read_footprints(path, options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->footprints.size(), 4U);
  EXPECT_EQ(attribute(scene->footprints[0], "name"), model::Value(std::string("house 10")));
  EXPECT_EQ(scene->footprints[0].id, "11");
  const auto raw =
      formats::read_features(path, {.layer = {}, .where = {}, .others = false, .crs = {}, .bbox = options.bbox}, {});
  ASSERT_TRUE(raw);
  EXPECT_GT(raw->features.size(), 100U);
  EXPECT_LT(raw->features.size(), 130U);
  // The same place in another CRS: house 10 alone.
  OGRSpatialReference rd, utm;
  rd.importFromEPSG(28992);
  utm.importFromEPSG(25831);
  const std::unique_ptr<OGRCoordinateTransformation> way(OGRCreateCoordinateTransformation(&rd, &utm));
  double x = 85005, y = 447005;
  ASSERT_TRUE(way->Transform(1, &x, &y));
  options.crs = "EPSG:25831";
  options.bbox = {x - 20, y - 20, x + 20, y + 20};
  const auto other = read_footprints(path, options);
  ASSERT_TRUE(other) << base::to_string(other.error());
  ASSERT_EQ(other->footprints.size(), 1U);
  EXPECT_EQ(other->footprints[0].id, "11");
  options = {};
  options.bbox = {1, 1, 2, 2};
  const auto nowhere = read_footprints(path, options);
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(nowhere.error().message, HasSubstr("they lie in x 84000.0 to 123910.0"));
}

TEST_F(MoreSources, of_openstreetmap_are_its_buildings_with_all_their_tags) {
  for (const char* name : {"houses.osm", "houses.osm.pbf"}) {
    const auto scene = read_footprints(fs::path(MANSARD_TEST_DATA) / "fixtures" / name, {});
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_THAT(ids(*scene), UnorderedElementsAre("way/101", "relation/201")) << name;
    EXPECT_EQ(scene->frame.crs, "EPSG:32631");
    for (const auto& footprint : scene->footprints) {
      ASSERT_FALSE(footprint.defect);
      if (footprint.id == "relation/201") {
        EXPECT_EQ(footprint.polygons[0].holes.size(), 1U);
        EXPECT_EQ(attribute(footprint, "height"), model::Value(std::string("12")));
        continue;
      }
      EXPECT_EQ(attribute(footprint, "building:levels"), model::Value(std::string("3")));
      EXPECT_EQ(attribute(footprint, "roof:shape"), model::Value(std::string("gabled")));
      EXPECT_EQ(attribute(footprint, "name"), model::Value(std::string("The \"Crown\"")));
      EXPECT_EQ(attribute(footprint, "description"), model::Value(std::string("a \\ b => c")));
      EXPECT_EQ(attribute(footprint, "other_tags"), model::Value(std::string("no such attribute")));
    }
    for (const auto& warning : scene->warnings) EXPECT_NE(warning.code, "ingest-layers");
  }
  Options options;
  options.where = "building = 'house'";
  const auto one = read_footprints(fs::path(MANSARD_TEST_DATA) / "fixtures/houses.osm.pbf", options);
  ASSERT_TRUE(one) << base::to_string(one.error());
  EXPECT_THAT(ids(*one), ElementsAre("way/101"));
  options.where = "landuse = 'grass'";
  const auto none = read_footprints(fs::path(MANSARD_TEST_DATA) / "fixtures/houses.osm", options);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("none of the 1 areas is tagged as a building"));
}

/// A box of 10 by 10 by 5 m at x, with a roof hanging over by 1 m where it has LoD 2.2; corners by number.
constexpr std::string_view model = R"({"type":"CityJSON","version":"2.0",
 "transform":{"scale":[0.5,0.5,0.5],"translate":[84000,447000,0]},
 "metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"},
 "CityObjects":{
  "flat":{"type":"Building","attributes":{"name":"A","floors":3,"old":true,"tags":["x",1],"ms_h_roof":9.5,"empty":null},
   "geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]},
               {"type":"MultiSurface","lod":"1.2","boundaries":[[[4,5,6,7]]],
                "semantics":{"surfaces":[{"type":"GroundSurface"}],"values":[0]}}]},
  "ground":{"type":"Building","attributes":{"name":"B","floors":2},"children":["part"]},
  "part":{"type":"BuildingPart","parents":["ground"],
   "geometry":[{"type":"Solid","lod":"2.2","boundaries":[[[[4,5,6,7]],[[8,9,10,11]]]],
                "semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"}],"values":[[0,1]]}}]},
  "bare":{"type":"Building","geometry":[{"type":"Solid","lod":1,"boundaries":[[[[0,3,2,1]],[[8,9,10,11]],[[0,1,9,8]]]]}]},
  "tree":{"type":"SolitaryVegetationObject","geometry":[{"type":"MultiSurface","lod":"1","boundaries":[[[0,1,2]]]}]},
  "gone":{"type":"Building","attributes":{"name":"C"}}},
 "vertices":[[0,0,0],[20,0,0],[20,20,0],[0,20,0],[40,0,0],[60,0,0],[60,20,0],[40,20,0],
             [-2,-2,10],[22,-2,10],[22,22,10],[-2,22,10]]})";

TEST_F(MoreSources, of_city_models_are_their_outlines_on_the_ground) {
  const auto path = file("model.city.json", model);
  const auto scene = read_footprints(path, {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  EXPECT_THAT(ids(*scene), ElementsAre("flat", "ground", "bare", "gone"));
  const auto& flat = scene->footprints[0];
  ASSERT_EQ(flat.polygons.size(), 1U);
  EXPECT_DOUBLE_EQ(geometry::area(flat.polygons[0]), 100);
  const double x = flat.polygons[0].outer[0].x + static_cast<double>(scene->frame.origin[0]);
  EXPECT_TRUE(x == 84000 || x == 84010) << x;
  EXPECT_EQ(attribute(flat, "floors"), model::Value(std::int64_t{3}));
  EXPECT_EQ(attribute(flat, "old"), model::Value(true));
  EXPECT_EQ(attribute(flat, "tags"), model::Value(std::string(R"(["x",1])")));
  EXPECT_EQ(attribute(flat, "empty"), model::Value());
  EXPECT_EQ(attribute(flat, "ms_h_roof"), model::Value(std::string("no such attribute")));
  EXPECT_DOUBLE_EQ(geometry::area(scene->footprints[1].polygons.at(0)), 100);
  EXPECT_DOUBLE_EQ(geometry::area(scene->footprints[2].polygons.at(0)), 100);
  ASSERT_TRUE(scene->footprints[3].defect);
  EXPECT_EQ(scene->footprints[3].defect->code, "ingest-footprint-empty");

  Options options;
  options.where = "floors > 2 AND name = 'A'";
  const auto one = read_footprints(path, options);
  ASSERT_TRUE(one) << base::to_string(one.error());
  EXPECT_THAT(ids(*one), ElementsAre("flat"));
  options.where = "floors >";
  EXPECT_EQ(code(read_footprints(path, options)), "ingest-where");
  options.where = "floors > 7";
  EXPECT_EQ(code(read_footprints(path, options)), "ingest-footprints-none");
  options = {};
  options.layer = "roofs";
  EXPECT_EQ(code(read_footprints(path, options)), "ingest-layer");
  options = {};
  options.id_attribute = "name";
  const auto named = read_footprints(path, options);
  ASSERT_TRUE(named);
  EXPECT_THAT(ids(*named), ElementsAre("A", "B", "feature-2", "C"));
}

TEST_F(MoreSources, of_city_models_may_be_a_line_per_feature) {
  const auto path = file(
      "model.city.jsonl",
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},"CityObjects":{},"vertices":[]})"
      "\n"
      R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2]]]}]}},"vertices":[[0,0,0],[10,0,0],[0,10,0]]})"
      "\n\n"
      R"({"type":"CityJSONFeature","id":"b","CityObjects":{"b":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2]]]}]}},"vertices":[[50,0,0],[60,0,0],[50,10,0]]})");
  const auto scene = read_footprints(path, {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(ids(*scene), ElementsAre("a", "b"));
  EXPECT_EQ(code(read_footprints(file("half.city.json", model.substr(0, 500)), {})), "ingest-footprints-format");
  EXPECT_EQ(code(read_footprints(file("old.city.json", R"({"type":"CityJSON","version":"0.9","CityObjects":{}})"), {})),
            "ingest-footprints-format");
}

TEST_F(MoreSources, that_are_databases_never_show_their_password) {
  using formats::shown_name;
  EXPECT_EQ(formats::shown_name("PG:dbname=a password=secret host=b"), "PG:dbname=a password=*** host=b");
  EXPECT_EQ(formats::shown_name("PG:password='se cr\\'et' dbname=a"), "PG:password=*** dbname=a");
  EXPECT_EQ(formats::shown_name("postgresql://me:secret@host/a"), "postgresql://me:***@host/a");
  EXPECT_EQ(formats::shown_name("postgresql://me@host:5432/a?password=secret&x=1"),
            "postgresql://me@host:5432/a?password=***&x=1");
  EXPECT_EQ(formats::shown_name("postgresql://host:5432/a"), "postgresql://host:5432/a");
  EXPECT_EQ(formats::shown_name("a/password=b.gpkg"), "a/password=b.gpkg");
  const auto none = formats::read_features("PG:host=127.0.0.1 port=9 dbname=a password=secret", {}, {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, "file-read");
  EXPECT_EQ(base::to_string(none.error()).find("secret"), std::string::npos);
}

}  // namespace
}  // namespace mansard::ingest::test
