// GeoPackages, read back by GDAL as users' programs do.
#include <gmock/gmock.h>
#include <ogrsf_frmts.h>
#include <chrono>
#include <limits>
#include <thread>

#include "mansard/base/run.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/formats/layers.hpp"

namespace mansard::formats {
namespace {

using model::Value;

auto square(double x, double y, double side) -> geometry::Polygon {
  return {{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}}, {}};
}
auto with_hole(double x, double y) -> geometry::Polygon {
  auto polygon = square(x, y, 10);
  polygon.holes.push_back({{x + 2, y + 2}, {x + 2, y + 4}, {x + 4, y + 4}, {x + 4, y + 2}});
  return polygon;
}

const std::string odd_text = "O'Brien \"Straße\" – 橋; DROP TABLE x";

/// A layer of every shape, with every type of field.
auto every_shape() -> std::vector<Layer> {
  Layer parts{
      "parts",
      "Parts & their numbers",
      Shape::polygon,
      {{"name"}, {"number", FieldType::integer}, {"area", FieldType::real}, {"seen", FieldType::boolean}, {"note"}},
      {}};
  for (int i = 0; i < 50; ++i)
    parts.features.push_back(
        {{}, {with_hole(20 * i, 0.1 * i)}, {odd_text, std::int64_t{1} << 40, 0.1 * i, i % 2 == 0, Value()}});
  const Layer blocks{
      "blocks",
      "",
      Shape::polygons,
      {{"name"}},
      {{{}, {square(0, 0, 1), with_hole(5, 5)}, {std::string("two")}}, {{}, {}, {std::string("nowhere")}}}};
  const Layer walls{"walls", "", Shape::line, {{"length", FieldType::real}}, {{{{{0, 0}, {3, 4}}}, {}, {5.0}}}};
  const Layer edges{"edges", "", Shape::lines, {}, {{{{{0, 0}, {1, 0}}, {{2, 0}, {2, 1}, {3, 1}}}, {}, {}}}};
  const Layer notes{"notes", "", Shape::none, {{"key"}}, {{{}, {}, {std::string("value")}}}};
  return {parts, blocks, walls, edges, notes};
}

const model::Frame delft{{84800, 447400, -3}, "EPSG:28992"};

/// A GeoPackage opened from its bytes, in memory.
class Opened {
 public:
  explicit Opened(const base::Result<std::string>& made) {
    EXPECT_TRUE(made) << base::to_string(made.error());
    bytes_ = made ? *made : std::string();
    crs::register_gdal();
    VSIFCloseL(VSIFileFromMemBuffer(name_, reinterpret_cast<GByte*>(bytes_.data()), bytes_.size(), FALSE));
    file_.reset(GDALDataset::Open(name_, GDAL_OF_VECTOR));
    EXPECT_NE(file_, nullptr);
  }
  Opened(const Opened&) = delete;
  auto operator=(const Opened&) -> Opened& = delete;
  ~Opened() {
    file_.reset();
    VSIUnlink(name_);
  }

  [[nodiscard]] auto layer(const char* name) const -> OGRLayer& { return *file_->GetLayerByName(name); }
  [[nodiscard]] auto rows(const char* name) const -> std::vector<OGRFeatureUniquePtr> {
    std::vector<OGRFeatureUniquePtr> all;
    layer(name).ResetReading();
    while (OGRFeature* row = layer(name).GetNextFeature()) all.emplace_back(row);
    return all;
  }
  /// The first column of the first row.
  [[nodiscard]] auto sql(const char* query) const -> std::string {
    OGRLayer* answer = file_->ExecuteSQL(query, nullptr, nullptr);
    if (answer == nullptr) return "";
    const OGRFeatureUniquePtr row(answer->GetNextFeature());
    std::string text = row ? row->GetFieldAsString(0) : "";
    file_->ReleaseResultSet(answer);
    return text;
  }
  [[nodiscard]] auto names() const -> std::vector<std::string> {
    std::vector<std::string> all;
    for (auto* one : file_->GetLayers()) all.emplace_back(one->GetName());
    return all;
  }

 private:
  static constexpr const char* name_ = "/vsimem/read-back.gpkg";
  std::string bytes_;
  GDALDatasetUniquePtr file_;
};

TEST(GeoPackage, has_every_layer_with_its_shape_its_crs_and_a_spatial_index) {
  const Opened file(geopackage(every_shape(), delft));
  EXPECT_THAT(file.names(), testing::ElementsAre("parts", "blocks", "walls", "edges", "notes"));
  const std::vector<std::pair<const char*, OGRwkbGeometryType>> shapes{
      {"parts", wkbPolygon}, {"blocks", wkbMultiPolygon}, {"walls", wkbLineString}, {"edges", wkbMultiLineString}};
  for (const auto& [name, type] : shapes) {
    OGRLayer& layer = file.layer(name);
    EXPECT_EQ(layer.GetGeomType(), type) << name;
    ASSERT_NE(layer.GetSpatialRef(), nullptr) << name;
    EXPECT_STREQ(layer.GetSpatialRef()->GetAuthorityCode(nullptr), "28992") << name;
    EXPECT_EQ(file.sql((std::string("SELECT HasSpatialIndex('") + name + "', 'geom')").c_str()), "1") << name;
  }
  EXPECT_EQ(file.layer("notes").GetGeomType(), wkbNone);
  EXPECT_EQ(file.sql("SELECT description FROM gpkg_contents WHERE table_name = 'parts'"), "Parts & their numbers");
}

TEST(GeoPackage, keeps_every_value_with_its_type) {
  const Opened file(geopackage(every_shape(), delft));
  const auto rows = file.rows("parts");
  ASSERT_EQ(rows.size(), 50U);
  for (int i = 0; i < 50; ++i) {
    const OGRFeature& row = *rows[static_cast<std::size_t>(i)];
    EXPECT_EQ(row.GetFieldAsString("name"), odd_text);
    EXPECT_EQ(row.GetFieldAsInteger64("number"), std::int64_t{1} << 40);
    EXPECT_EQ(row.GetFieldAsDouble("area"), 0.1 * i);
    EXPECT_EQ(row.GetFieldAsInteger("seen"), i % 2 == 0 ? 1 : 0);
    EXPECT_TRUE(row.IsFieldNull(row.GetFieldIndex("note")));
  }
  const auto* definition = file.layer("parts").GetLayerDefn();
  EXPECT_EQ(definition->GetFieldDefn(2)->GetType(), OFTReal);
  EXPECT_EQ(definition->GetFieldDefn(3)->GetType(), OFTInteger);
  EXPECT_EQ(definition->GetFieldDefn(3)->GetSubType(), OFSTBoolean);
  EXPECT_STREQ(file.rows("notes").at(0)->GetFieldAsString("key"), "value");
}

TEST(GeoPackage, puts_the_origin_back_and_keeps_holes_in_valid_polygons) {
  const Opened file(geopackage(every_shape(), delft));
  for (const auto& row : file.rows("parts")) {
    const OGRGeometry& geometry = *row->GetGeometryRef();
    EXPECT_TRUE(geometry.IsValid());
    EXPECT_EQ(geometry.toPolygon()->getNumInteriorRings(), 1);
    EXPECT_NEAR(geometry.toPolygon()->get_Area(), 96, 1e-6);
  }
  const auto blocks = file.rows("blocks");
  EXPECT_TRUE(blocks.at(0)->GetGeometryRef()->IsValid());
  EXPECT_EQ(blocks.at(0)->GetGeometryRef()->toMultiPolygon()->getNumGeometries(), 2);
  EXPECT_EQ(blocks.at(1)->GetGeometryRef(), nullptr);
  const auto walls = file.rows("walls");
  const auto* wall = walls.at(0)->GetGeometryRef()->toLineString();
  EXPECT_EQ(wall->getX(1), 84803);
  EXPECT_EQ(wall->getY(1), 447404);
  EXPECT_EQ(wall->getCoordinateDimension(), 2);
  const auto edges = file.rows("edges");
  EXPECT_EQ(edges.at(0)->GetGeometryRef()->toMultiLineString()->getGeometryRef(1)->getNumPoints(), 3);
}

TEST(GeoPackage, says_undefined_cartesian_where_there_is_no_crs) {
  const Opened file(geopackage(every_shape(), {}));
  EXPECT_EQ(file.sql("SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = 'parts'"), "-1");
  EXPECT_EQ(file.sql("SELECT srs_id FROM gpkg_contents WHERE table_name = 'walls'"), "-1");
  EXPECT_EQ(file.sql("SELECT organization FROM gpkg_spatial_ref_sys WHERE srs_id = -1"), "NONE");
}

TEST(GeoPackage, takes_a_crs_as_wkt_too) {
  OGRSpatialReference utm;
  utm.importFromEPSG(32631);
  char* wkt = nullptr;
  utm.exportToWkt(&wkt);
  const Opened file(geopackage(every_shape(), {{0, 0, 0}, wkt}));
  CPLFree(wkt);
  EXPECT_TRUE(file.layer("walls").GetSpatialRef()->IsSame(&utm));
}

TEST(GeoPackage, is_the_same_to_the_byte_a_second_later_and_from_several_threads) {
  const auto layers = every_shape();
  const auto first = geopackage(layers, delft);
  ASSERT_TRUE(first);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  std::vector<std::string> others(8);
  base::parallel_for(others.size(), [&](std::size_t i) { others[i] = *geopackage(layers, delft); });
  for (const auto& other : others) EXPECT_TRUE(other == *first);
  EXPECT_EQ(first->substr(0, 15), "SQLite format 3");
}

TEST(GeoPackage, leaves_the_date_that_gdal_takes_elsewhere_alone) {
  ASSERT_TRUE(geopackage(every_shape(), delft));
  EXPECT_EQ(CPLGetConfigOption("OGR_CURRENT_DATE", nullptr), nullptr);
}

TEST(GeoPackage, gives_fields_whose_name_is_taken_the_next_number) {
  const Layer layer{"a",
                    "",
                    Shape::line,
                    {{"fid"}, {"Name"}, {"name"}, {"GEOM"}, {"name_2"}},
                    {{{{{0, 0}, {1, 1}}},
                      {},
                      {std::string("1"), std::string("2"), std::string("3"), std::string("4"), std::string("5")}}}};
  const Opened file(geopackage({layer}, {}));
  std::vector<std::string> names;
  const auto* definition = file.layer("a").GetLayerDefn();
  for (int i = 0; i < definition->GetFieldCount(); ++i) names.emplace_back(definition->GetFieldDefn(i)->GetNameRef());
  EXPECT_THAT(names, testing::ElementsAre("fid_2", "Name", "name_2", "GEOM_2", "name_2_2"));
  const auto rows = file.rows("a");
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rows.at(0)->GetFieldAsInteger(i), i + 1);
}

TEST(GeoPackage, refuses_layers_that_are_not_consistent) {
  const auto code_for = [](std::vector<Layer> layers) {
    const auto made = geopackage(layers, delft);
    return made ? "none" : made.error().code;
  };
  const auto with = [](Shape shape, Feature feature) {
    return std::vector<Layer>{{"a", "", shape, {{"x", FieldType::integer}}, {std::move(feature)}}};
  };
  const Value one = std::int64_t{1};
  const std::vector<std::vector<geometry::Point2>> line{{{0, 0}, {1, 0}}};
  EXPECT_EQ(code_for(with(Shape::line, {line, {}, {one}})), "none");
  EXPECT_EQ(code_for(with(Shape::line, {line, {}, {}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::line, {line, {}, {one, one}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::line, {line, {}, {std::string("1")}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::line, {line, {}, {1.5}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::polygon, {line, {}, {one}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::none, {line, {}, {one}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::line, {{line[0], line[0]}, {}, {one}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::lines, {{{{0, 0}}}, {}, {one}})), "write-layer");
  EXPECT_EQ(code_for(with(Shape::polygon, {{}, {square(std::numeric_limits<double>::quiet_NaN(), 0, 1)}, {one}})),
            "write-layer");
  auto twice = with(Shape::line, {line, {}, {one}});
  twice.push_back(twice.front());
  EXPECT_EQ(code_for(twice), "write-layer");
}

TEST(GeoPackage, gives_up_on_a_crs_that_nobody_knows_in_gdals_words) {
  const auto made = geopackage(every_shape(), {{0, 0, 0}, "EPSG:999999"});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, "write-geopackage");
  EXPECT_THAT(made.error().message, testing::HasSubstr("999999"));
}

}  // namespace
}  // namespace mansard::formats
