// A city as a GeoPackage: every layer as GDAL reads it, and the way back.
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>

#include <filesystem>

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

auto folder() -> const std::filesystem::path& {
  static const mansard::test::Scratch scratch;
  return scratch;
}
auto place(const std::string& name) -> std::filesystem::path { return folder() / name; }

void write(const model::City& city, const std::filesystem::path& path, const std::vector<Layer>& more = {}) {
  base::Outputs outputs;
  auto writer = open_writer(Format::geopackage, path, {city.frame, city.made_by}, {}, outputs, more);
  ASSERT_TRUE(writer) << base::to_string(writer.error());
  const auto done = write_city(city, **writer);
  ASSERT_TRUE(done) << base::to_string(done.error());
  const auto kept = outputs.commit();
  ASSERT_TRUE(kept) << base::to_string(kept.error());
}

auto open(const std::filesystem::path& path) -> GDALDatasetUniquePtr {
  mansard::crs::register_gdal();
  return GDALDatasetUniquePtr(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
}

auto rows(GDALDataset& file, const char* name) -> std::vector<OGRFeatureUniquePtr> {
  std::vector<OGRFeatureUniquePtr> all;
  OGRLayer* layer = file.GetLayerByName(name);
  if (layer == nullptr) return all;
  layer->ResetReading();
  while (OGRFeature* row = layer->GetNextFeature()) all.emplace_back(row);
  return all;
}

TEST(GeoPackageCity, has_its_layers_with_a_row_for_every_thing) {
  write(street(), place("city.gpkg"));
  const auto file = open(place("city.gpkg"));
  ASSERT_NE(file, nullptr);
  std::map<std::string, GIntBig> counts;
  for (auto* layer : file->GetLayers()) counts[layer->GetName()] = layer->GetFeatureCount();
  // A gabled house (4 edges, 2 roofs, 4 walls), a court (8 edges and walls, one roof) and an annex (4 and 1).
  EXPECT_EQ(counts, (std::map<std::string, GIntBig>{{"gis_footprints", 2},
                                                    {"footprints", 3},
                                                    {"edges", 16},
                                                    {"roof_planes", 4},
                                                    {"walls", 16},
                                                    {"profiles", 6},
                                                    {"made_by", 4},
                                                    {"mansard_records", 3},
                                                    {"solids_lod12", 2},
                                                    {"ground_lod12", 2},
                                                    {"solids_lod13", 2},
                                                    {"ground_lod13", 2},
                                                    {"solids_lod22", 2},
                                                    {"ground_lod22", 2},
                                                    {"layer_styles", 11}}));
}

TEST(GeoPackageCity, begins_with_the_footprints_which_programs_open_first) {
  write(street(), place("city.gpkg"));
  const auto file = open(place("city.gpkg"));
  std::vector<std::string> names;
  for (auto* layer : file->GetLayers()) names.emplace_back(layer->GetName());
  EXPECT_THAT(names, ElementsAre("gis_footprints", "footprints", "edges", "roof_planes", "walls", "solids_lod12",
                                 "ground_lod12", "solids_lod13", "ground_lod13", "solids_lod22", "ground_lod22",
                                 "profiles", "made_by", "mansard_records", "layer_styles"));
}

TEST(GeoPackageCity, has_valid_geometry_in_the_frame_of_the_file_with_an_index) {
  write(street(), place("city.gpkg"));
  const auto file = open(place("city.gpkg"));
  for (const char* name : {"gis_footprints", "footprints", "edges", "roof_planes", "walls", "ground_lod12",
                           "ground_lod22", "solids_lod22"}) {
    OGRLayer& layer = *file->GetLayerByName(name);
    EXPECT_STREQ(layer.GetSpatialRef()->GetAuthorityCode(nullptr), "28992") << name;
    OGREnvelope extent;
    ASSERT_EQ(layer.GetExtent(&extent), OGRERR_NONE) << name;
    EXPECT_NEAR(extent.MinX, 84801.0625, 1e-9) << name;
    EXPECT_NEAR(extent.MaxX, 84845, 1e-9) << name;
    EXPECT_NEAR(extent.MinY, 447400, 1e-9) << name;
    EXPECT_NEAR(extent.MaxY, 447420, 1e-9) << name;
    OGRLayer* answer =
        file->ExecuteSQL((std::string("SELECT HasSpatialIndex('") + name + "', 'geom')").c_str(), nullptr, nullptr);
    EXPECT_EQ(OGRFeatureUniquePtr(answer->GetNextFeature())->GetFieldAsInteger(0), 1) << name;
    file->ReleaseResultSet(answer);
    for (const auto& row : rows(*file, name)) {
      EXPECT_FALSE(row->GetGeometryRef()->IsEmpty()) << name;
      if (name != std::string_view("solids_lod22")) {  // GEOS has no polyhedral surfaces
        EXPECT_TRUE(row->GetGeometryRef()->IsValid()) << name;
      }
    }
  }
}

TEST(GeoPackageCity, unites_ground_that_is_cut_into_triangles_as_other_producers_do) {
  auto city = street();
  auto& model = city.buildings[0].parts[0].model;
  const auto ground = std::ranges::find(model.classes, FaceClass::ground) - model.classes.begin();
  auto& face = model.solid.faces[static_cast<std::size_t>(ground)];
  const auto corners = face.loops[0];
  ASSERT_EQ(corners.size(), 4U);
  face.loops = {{corners[0], corners[1], corners[2]}};
  add_face(model, {{corners[0], corners[2], corners[3]}}, FaceClass::ground);
  auto open_below = city.buildings[1].parts[0].model;
  for (auto& kind : open_below.classes)
    if (kind == FaceClass::ground) kind = FaceClass::wall;
  city.buildings[1].solids.push_back({{0}, open_below});
  write(city, place("cut.gpkg"));
  const auto file = open(place("cut.gpkg"));
  const auto all = rows(*file, "ground_lod22");
  ASSERT_EQ(all.size(), 1U);
  const auto* geometry = all[0]->GetGeometryRef()->toMultiPolygon();
  EXPECT_TRUE(geometry->IsValid());
  EXPECT_NEAR(geometry->get_Area(), all[0]->GetFieldAsDouble("area"), 1e-6);
  OGREnvelope3D box;
  geometry->getEnvelope(&box);
  EXPECT_NEAR(box.MinZ, all[0]->GetFieldAsDouble("bottom"), 1e-9);
  EXPECT_NEAR(box.MaxZ, box.MinZ, 1e-9);
  EXPECT_EQ(rows(*file, "solids_lod22").size(), 2U);
}

TEST(GeoPackageCity, says_of_roofs_and_walls_where_they_look) {
  write(street(), place("city.gpkg"));
  const auto file = open(place("city.gpkg"));
  const auto roofs = rows(*file, "roof_planes");
  // The gable's south side: 4 m up on 4 m, 10 m long.
  EXPECT_STREQ(roofs[0]->GetFieldAsString("class"), "sloped");
  EXPECT_NEAR(roofs[0]->GetFieldAsDouble("slope"), 45, 1e-9);
  EXPECT_NEAR(roofs[0]->GetFieldAsDouble("azimuth"), 180, 1e-9);
  EXPECT_NEAR(roofs[0]->GetFieldAsDouble("area"), 10 * std::sqrt(32), 1e-9);
  EXPECT_NEAR(roofs[0]->GetGeometryRef()->toMultiPolygon()->getGeometryRef(0)->getExteriorRing()->getZ(2), 11.25, 1e-9);
  EXPECT_STREQ(roofs[2]->GetFieldAsString("class"), "flat");
  EXPECT_TRUE(roofs[2]->IsFieldNull(roofs[2]->GetFieldIndex("azimuth")));
  EXPECT_EQ(roofs[2]->GetGeometryRef()->toMultiPolygon()->getGeometryRef(0)->getNumInteriorRings(), 1);
  std::size_t party = 0;
  for (const auto& wall : rows(*file, "walls"))
    party += wall->GetFieldAsString("class") == std::string_view("party_wall");
  EXPECT_EQ(party, 1U);
}

TEST(GeoPackageCity, has_solids_with_all_their_faces_at_every_level) {
  write(street(), place("city.gpkg"));
  const auto file = open(place("city.gpkg"));
  const auto fine = rows(*file, "solids_lod22"), flat = rows(*file, "solids_lod12");
  ASSERT_EQ(fine.size(), 2U);
  EXPECT_STREQ(fine[0]->GetFieldAsString("building_id"), "house");
  EXPECT_NEAR(fine[0]->GetFieldAsDouble("volume"), 10 * 8 * 6 + 10 * 8 * 4 / 2., 1e-6);
  EXPECT_NEAR(flat[0]->GetFieldAsDouble("volume"), 10 * 8 * 8, 1e-6);
  EXPECT_NEAR(fine[0]->GetFieldAsDouble("top"), 11.25, 1e-9);
  const OGRGeometry* shape = fine[0]->GetGeometryRef();
  ASSERT_EQ(wkbFlatten(shape->getGeometryType()), wkbPolyhedralSurface);
  EXPECT_EQ(shape->toPolyhedralSurface()->getNumGeometries(), 7);
  EXPECT_NEAR(rows(*file, "ground_lod22")[1]->GetFieldAsDouble("area"), 400, 1e-6);
}

TEST(GeoPackageCity, has_walls_where_they_stand_in_plan) {
  write(street(), place("city.gpkg"));
  const auto file = open(place("city.gpkg"));
  const auto walls = rows(*file, "walls");
  // The south wall of the house, seen from the south: from west to east.
  const auto& line = *walls[0]->GetGeometryRef()->toLineString();
  EXPECT_EQ(line.getNumPoints(), 2);
  EXPECT_NEAR(line.getX(0), 84801.0625, 1e-9);
  EXPECT_NEAR(line.getX(1), 84811.0625, 1e-9);
  EXPECT_NEAR(walls[0]->GetFieldAsDouble("bottom"), 1.25, 1e-9);
  EXPECT_NEAR(walls[0]->GetFieldAsDouble("top"), 7.25, 1e-9);
  EXPECT_NEAR(walls[1]->GetFieldAsDouble("top"), 11.25, 1e-9);
}

TEST(GeoPackageCity, gives_each_attribute_the_type_that_holds_all_its_values) {
  model::City city = street();
  city.buildings[0].attributes = {{"mixed", std::int64_t{1}}, {"odd", true}, {"NAME", std::string("a")}, {"fid", 7.5}};
  city.buildings[1].attributes = {
      {"mixed", 2.5}, {"odd", 3.25}, {"name", std::string("b")}, {"none", std::monostate{}}};
  write(city, place("mixed.gpkg"));
  const auto file = open(place("mixed.gpkg"));
  const auto all = rows(*file, "gis_footprints");
  const OGRFeatureDefn& definition = *file->GetLayerByName("gis_footprints")->GetLayerDefn();
  std::vector<std::string> names;
  for (int i = 0; i < definition.GetFieldCount(); ++i) names.emplace_back(definition.GetFieldDefn(i)->GetNameRef());
  EXPECT_THAT(names, ElementsAre("building_id", "parts", "ground", "mixed", "odd", "NAME", "fid_2", "name_2", "none"));
  EXPECT_EQ(definition.GetFieldDefn(3)->GetType(), OFTReal);
  EXPECT_EQ(all[0]->GetFieldAsDouble("mixed"), 1);
  EXPECT_STREQ(all[0]->GetFieldAsString("odd"), "true");
  EXPECT_STREQ(all[1]->GetFieldAsString("odd"), "3.25");
  EXPECT_NEAR(all[1]->GetFieldAsDouble("ground"), 0.5, 1e-12);
}

TEST(GeoPackageCity, takes_further_layers_beside_its_own) {
  const auto layer = [](const char* name) {
    return Layer{name, "", Shape::none, {{"key"}}, {{{}, {}, {std::string("value")}}}};
  };
  write(street(), place("more.gpkg"),
        {layer("gis_footprints"), layer("sweep_edges"), layer("edges"), layer("made_by")});
  const auto file = open(place("more.gpkg"));
  EXPECT_EQ(rows(*file, "sweep_edges").size(), 1U);
  EXPECT_EQ(rows(*file, "segment_edges").size(), 1U);
  EXPECT_EQ(rows(*file, "edges").size(), 16U);
  EXPECT_EQ(rows(*file, "gis_footprints").size(), 2U);
  EXPECT_EQ(file->GetLayerCount(), 17);
}

/// Every shape, type and emptiness that a layer may have.
auto others() -> std::vector<Layer> {
  using enum FieldType;
  const std::vector<mansard::model::Value> values{std::int64_t{1} << 40, 0.1, std::string("\xC3\xA9"), true};
  const std::vector<mansard::model::Value> nothing(4);
  const std::vector<Field> fields{{"count", integer}, {"share", real}, {"why"}, {"chosen", boolean}};
  Polygon holed = rectangle(1. / 3, 0, 10, 10);
  holed.holes = {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}};
  return {{"sweep_edges", "lines & more", Shape::line, fields, {{{{{0.1, 0.2}, {3.3, 4.4}}}, {}, values}}},
          {"edges",
           "",
           Shape::lines,
           fields,
           {{{{{0, 0}, {1, 1}}, {{5, 5}, {6, 6}, {7, 5}}}, {}, values}, {{}, {}, nothing}}},
          {"faces", "", Shape::polygon, fields, {{{}, {holed}, values}, {{}, {}, values}}},
          {"conflicts", "none", Shape::lines, fields, {}},
          {"diagnostics", "why", Shape::polygons, fields, {{{}, {holed, rectangle(20, 0, 1, 1)}, nothing}}},
          {"notes", "", Shape::none, fields, {{{}, {}, values}}}};
}

TEST(GeoPackageCity, gives_the_layers_beside_it_back_to_be_written_as_the_same_bytes) {
  for (const char* crs : {"EPSG:28992", ""}) {
    model::City city = street();
    city.frame.crs = crs;
    write(city, place("beside.gpkg"), others());
    auto reader = read_city(place("beside.gpkg"));
    ASSERT_TRUE(reader) << base::to_string(reader.error());
    const auto beside = (*reader)->beside();
    ASSERT_TRUE(beside) << base::to_string(beside.error());
    EXPECT_TRUE(beside->warnings.empty());
    ASSERT_EQ(beside->layers.size(), others().size());
    EXPECT_EQ(beside->layers[1].name, "segment_edges");
    EXPECT_EQ(beside->layers[0].meaning, "lines & more");
    EXPECT_EQ(read_whole(**reader)->buildings.size(), 2U) << "buildings are read as well";
    write(city, place("beside-again.gpkg"), beside->layers);
    EXPECT_TRUE(*base::read_file(place("beside.gpkg")) == *base::read_file(place("beside-again.gpkg"))) << crs;
  }
}

TEST(GeoPackageCity, says_which_layers_of_others_it_cannot_take_along) {
  write(street(), place("foreign.gpkg"), others());
  {
    mansard::crs::register_gdal();
    const GDALDatasetUniquePtr file(GDALDataset::Open(place("foreign.gpkg").c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
    OGRSpatialReference same, other;
    same.importFromEPSG(28992);
    other.importFromEPSG(4326);
    file->CreateLayer("trees", &same, wkbPoint);
    file->CreateLayer("cables", &same, wkbLineString25D);
    file->CreateLayer("abroad", &other, wkbPolygon);
    OGRFieldDefn day("day", OFTDate);
    ASSERT_EQ(file->CreateLayer("visits", nullptr, wkbNone)->CreateField(&day), OGRERR_NONE);
    OGRLayer* plots = file->CreateLayer("plots", &same, wkbPolygon);
    OGRFeature row(plots->GetLayerDefn());
    ASSERT_EQ(plots->CreateFeature(&row), OGRERR_NONE);
  }
  auto reader = read_city(place("foreign.gpkg"));
  ASSERT_TRUE(reader) << base::to_string(reader.error());
  const auto beside = (*reader)->beside();
  ASSERT_TRUE(beside) << base::to_string(beside.error());
  EXPECT_EQ(beside->layers.size(), others().size() + 1) << "with the plots";
  std::vector<std::string> left;
  for (const auto& warning : beside->warnings) {
    EXPECT_EQ(warning.code, "write-layer-left");
    left.push_back(warning.subject);
  }
  EXPECT_THAT(left, ElementsAre("trees", "cables", "abroad", "visits"));
}

TEST(GeoPackageCity, comes_back_and_is_the_same_to_the_byte_when_written_again) {
  for (const char* crs : {"EPSG:28992", ""}) {
    model::City city = street();
    city.frame.crs = crs;
    write(city, place("there.gpkg"));
    auto reader = read_city(place("there.gpkg"));
    ASSERT_TRUE(reader) << base::to_string(reader.error());
    EXPECT_FALSE((*reader)->has_models());
    auto back = read_whole(**reader);
    ASSERT_TRUE(back) << base::to_string(back.error());
    EXPECT_EQ(plans(*back), plans(city));
    for (std::size_t b = 0; b < city.buildings.size(); ++b)  // raised again
      for (std::size_t p = 0; p < city.buildings[b].parts.size(); ++p)
        back->buildings[b].parts[p].model = city.buildings[b].parts[p].model;
    write(*back, place("again.gpkg"));
    EXPECT_TRUE(*base::read_file(place("there.gpkg")) == *base::read_file(place("again.gpkg"))) << crs;
  }
}

TEST(GeoPackageCity, is_refused_without_its_plans) {
  const auto bytes = geopackage({{"notes", "", Shape::none, {{"key"}}, {}}}, {});
  ASSERT_TRUE(base::write_files({{place("foreign.gpkg"), *bytes}}));
  EXPECT_EQ(read_city(place("foreign.gpkg")).error().code, "write-read-plans");
  ASSERT_TRUE(base::write_files({{place("text.gpkg"), "no GeoPackage"}}));
  EXPECT_EQ(read_city(place("text.gpkg")).error().code, "write-read-format");
  EXPECT_EQ(read_city(place("missing.gpkg")).error().code, "file-missing");
}

TEST(GeoPackageCity, leaves_nothing_where_it_was_not_finished) {
  const auto path = place("broken.gpkg");
  std::filesystem::remove(path);
  {
    base::Outputs outputs;
    auto writer = open_writer(Format::geopackage, path, {street().frame, {}}, {}, outputs);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->add(street().buildings[0]));
    EXPECT_EQ((*writer)->add(street().buildings[0]).error().code, "write-duplicate-id");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  for (const auto& entry : std::filesystem::directory_iterator(folder()))
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("broken.gpkg")));
}

}  // namespace
