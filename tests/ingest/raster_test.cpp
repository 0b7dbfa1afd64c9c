// Height rasters of known heights, made by GDAL or written as text.
#include "mansard/formats/raster/raster.hpp"

#include <gdal/gdal_priv.h>
#include <gdal/ogr_spatialref.h>
#include <gmock/gmock.h>

#include "ingest/workshop.hpp"
#include "mansard/crs/gdal.hpp"

namespace mansard::ingest::test {
namespace {

using formats::read_raster;
using formats::read_terrain;
using geometry::Box2;
using geometry::Point2;
using geometry::Point3;
using ::testing::HasSubstr;

struct Made {
  int columns = 4, rows = 3, bands = 1;
  const char* crs = "EPSG:28992";
  std::array<double, 6> geotransform{84000, 0.5, 0, 447500, 0, -0.5};
  GDALDataType type = GDT_Float32;
  const char* unit = "";
  double scale = 1, offset = 0;
  std::optional<double> nodata{};
};

class Rasters : public Workshop {
 protected:
  static void SetUpTestSuite() { crs::register_gdal(); }

  template <class Height>
  auto tiff(const std::string& name, const Made& as, Height height) const -> fs::path {
    GDALDriver* maker = GetGDALDriverManager()->GetDriverByName("GTiff");
    const GDALDatasetUniquePtr made(maker->Create(at(name).c_str(), as.columns, as.rows, as.bands, as.type, nullptr));
    made->SetGeoTransform(const_cast<double*>(as.geotransform.data()));
    OGRSpatialReference crs;
    EXPECT_EQ(crs.SetFromUserInput(as.crs), OGRERR_NONE);
    made->SetSpatialRef(&crs);
    GDALRasterBand* band = made->GetRasterBand(1);
    if (as.nodata) band->SetNoDataValue(*as.nodata);
    if (as.scale != 1) band->SetScale(as.scale);
    if (as.offset != 0) band->SetOffset(as.offset);
    if (*as.unit != '\0') band->SetUnitType(as.unit);
    for (int r = 0; r < as.rows; ++r)
      for (int c = 0; c < as.columns; ++c) {
        double z = height(c, r);
        EXPECT_EQ(band->RasterIO(GF_Write, c, r, 1, 1, &z, 1, 1, GDT_Float64, 0, 0, nullptr), CE_None);
      }
    return at(name);
  }
};

/// Twice the area in plan; negative for a triangle that is clockwise seen from above.
auto turn(const formats::RawMesh& mesh, const geometry::Triangle& t) -> double {
  const auto p = [&](std::size_t k) { return xy(mesh.vertices[t[k]]); };
  return cross(p(1) - p(0), p(2) - p(0));
}

TEST_F(Rasters, are_a_vertex_per_cell_centre_and_two_triangles_between_four) {
  const auto raster = formats::read_raster(tiff("a.tif", {}, [](int c, int r) { return c + 10 * r; }), {});
  ASSERT_TRUE(raster) << base::to_string(raster.error());
  ASSERT_EQ(raster->mesh.vertices.size(), 12U);
  EXPECT_EQ(raster->mesh.vertices[0], (Point3{84000.25, 447499.75, 0}));
  EXPECT_EQ(raster->mesh.vertices[11], (Point3{84001.75, 447498.75, 23}));
  ASSERT_EQ(raster->mesh.triangles.size(), 12U);
  for (const auto& t : raster->mesh.triangles) EXPECT_EQ(turn(raster->mesh, t), 0.25);
  EXPECT_THAT(raster->crs, HasSubstr("28992"));
  EXPECT_TRUE(raster->warnings.empty());
}

TEST_F(Rasters, are_cut_along_the_flatter_diagonal) {
  // A roof of 9 over the upper left corner, the street at 0: no triangle may join roof and both far corners.
  const Made two{.columns = 2, .rows = 2};
  const auto raster = formats::read_raster(tiff("a.tif", two, [](int c, int r) { return c + r == 0 ? 9 : 0; }), {});
  ASSERT_TRUE(raster);
  ASSERT_EQ(raster->mesh.triangles.size(), 2U);
  for (const auto& t : raster->mesh.triangles) {
    EXPECT_FALSE(std::ranges::find(t, 0U) != t.end() && std::ranges::find(t, 3U) != t.end());
    EXPECT_GT(turn(raster->mesh, t), 0);
  }
}

TEST_F(Rasters, have_holes_where_there_is_no_height) {
  const Made given{.nodata = -32768};
  const auto hole = [](int c, int r) {
    if (c == 0 && r == 0) return -32768.0;
    if (c == 3 && r == 2) return std::nan("");
    return c == 3 && r == 0 ? -9999.0 : 1.0;  // a mark that the raster does not declare
  };
  const auto raster = formats::read_raster(tiff("a.tif", given, hole), {});
  ASSERT_TRUE(raster);
  EXPECT_EQ(raster->mesh.vertices.size(), 9U);
  EXPECT_EQ(raster->mesh.triangles.size(), 6U);
  const auto nothing = formats::read_raster(tiff("b.tif", given, [](int, int) { return -32768.0; }), {});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, "ingest-raster");
}

TEST_F(Rasters, may_be_turned_mirrored_and_of_oblong_cells) {
  const double s = std::sin(0.3), k = std::cos(0.3);
  const Made turned{.geotransform = {100, 2 * k, 0.5 * s, 200, 2 * s, -0.5 * k}};
  const auto raster = formats::read_raster(tiff("a.tif", turned, [](int c, int r) { return c * r; }), {});
  ASSERT_TRUE(raster);
  const Point3 last = raster->mesh.vertices[11];
  EXPECT_NEAR(last.x, 100 + 3.5 * 2 * k + 2.5 * 0.5 * s, 1e-9);
  EXPECT_NEAR(last.y, 200 + 3.5 * 2 * s - 2.5 * 0.5 * k, 1e-9);
  for (const auto& t : raster->mesh.triangles) EXPECT_NEAR(turn(raster->mesh, t), 1, 1e-9);
  const Made upward{.geotransform = {100, 1, 0, 200, 0, 1}};
  const auto mirrored = formats::read_raster(tiff("b.tif", upward, [](int c, int r) { return c * r; }), {});
  ASSERT_TRUE(mirrored);
  EXPECT_EQ(mirrored->mesh.vertices[11], (Point3{103.5, 202.5, 6}));
  for (const auto& t : mirrored->mesh.triangles) EXPECT_EQ(turn(mirrored->mesh, t), 1);
}

TEST_F(Rasters, in_feet_or_stored_by_scale_and_offset_come_in_metres) {
  const Made stored{.type = GDT_Int16, .unit = "ft", .scale = 0.1, .offset = 100};
  const auto raster = formats::read_raster(tiff("a.tif", stored, [](int c, int) { return 10 * c; }), {});
  ASSERT_TRUE(raster) << base::to_string(raster.error());
  EXPECT_NEAR(raster->mesh.vertices[3].z, 103 * 0.3048, 1e-9);
  const auto odd = formats::read_raster(tiff("b.tif", {.unit = "furlong"}, [](int, int) { return 1; }), {});
  ASSERT_FALSE(odd);
  EXPECT_THAT(odd.error().message, HasSubstr("furlong"));
  // New York in feet, with heights in feet: the CRS says what the band does not.
  const auto by_crs = formats::read_raster(tiff("c.tif", {.crs = "EPSG:2263+6360"}, [](int, int) { return 1; }), {});
  ASSERT_TRUE(by_crs);
  EXPECT_NEAR(by_crs->mesh.vertices[0].z, 1200.0 / 3937, 1e-9);
}

TEST_F(Rasters, are_read_in_part_within_a_box) {
  const auto path = tiff("a.tif", {.columns = 100, .rows = 700}, [](int c, int r) { return c + r / 10.0; });
  const auto whole = formats::read_raster(path, {});
  const auto part = formats::read_raster(path, Box2{{84010, 447300}, {84012, 447302}});
  ASSERT_TRUE(whole && part);
  EXPECT_EQ(whole->mesh.vertices.size(), 70000U);
  EXPECT_GE(part->mesh.vertices.size(), 25U);
  EXPECT_LE(part->mesh.vertices.size(), 64U);
  for (const auto v : part->mesh.vertices)
    EXPECT_NE(std::ranges::find(whole->mesh.vertices, v), whole->mesh.vertices.end());
  Box2 box;
  for (const auto v : part->mesh.vertices) box.add(xy(v));
  EXPECT_TRUE(box.contains({84010, 447300}) && box.contains({84012, 447302}));
  const auto beside = formats::read_raster(path, Box2{{0, 0}, {10, 10}});
  ASSERT_TRUE(beside);
  EXPECT_TRUE(beside->mesh.vertices.empty());
}

TEST_F(Rasters, of_text_are_read_and_those_that_are_none_refused) {
  const auto grid =
      file("a.asc", "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 1\nNODATA_value -9999\n1 2\n3 4\n");
  const auto raster = formats::read_raster(grid, {});
  ASSERT_TRUE(raster) << base::to_string(raster.error());
  EXPECT_EQ(raster->mesh.vertices[0], (Point3{10.5, 21.5, 1}));
  EXPECT_TRUE(raster->crs.empty());
  const auto why = [](const fs::path& path) {
    const auto read = formats::read_raster(path, {});
    return read ? std::string() : read.error().code + ": " + read.error().message;
  };
  EXPECT_THAT(why(at("none.tif")), HasSubstr("file-missing: "));
  EXPECT_THAT(why(file("text.tif", "hello")), HasSubstr("ingest-raster: not a raster that GDAL reads"));
  EXPECT_THAT(why(tiff("rgb.tif", {.bands = 3, .type = GDT_Byte}, [](int, int) { return 1; })),
              HasSubstr("a picture of 3"));
  const auto two = formats::read_raster(tiff("two.tif", {.bands = 2}, [](int, int) { return 1; }), {});
  ASSERT_TRUE(two);
  ASSERT_EQ(two->warnings.size(), 1U);
  EXPECT_EQ(two->warnings[0].code, "ingest-raster-bands");
  const auto bytes =
      base::read_file(tiff("whole.tif", {.columns = 300, .rows = 300}, [](int, int) { return 1; })).value();
  EXPECT_THAT(why(file("half.tif", bytes.substr(0, bytes.size() / 2))), HasSubstr("ingest-raster: "));
  EXPECT_TRUE(formats::is_raster("a/b.TIFF") && formats::is_raster("/vsizip/a.zip/b.asc") &&
              !formats::is_raster("a.obj"));
}

const model::Frame delft{{84000, 447000, -5}, "EPSG:28992"};

TEST_F(Rasters, of_the_ground_keep_their_cells_where_they_can) {
  const auto path = tiff("a.tif", {.columns = 40, .rows = 30}, [](int c, int r) { return c + 100 * r; });
  const auto grid = formats::read_terrain(path, delft, {{5.1, 490.1}, {10.1, 495.1}});
  ASSERT_TRUE(grid) << base::to_string(grid.error());
  EXPECT_EQ(grid->cell, 0.5);
  EXPECT_EQ(grid->centre, (Point2{4.75, 489.75}));
  // The cell of column 10 and row 20 has its centre at x 5.25, y 489.75; half a cell farther lies half a step higher.
  EXPECT_EQ(grid->at({5.25, 489.75}), 10 + 100 * 20 + 5);
  EXPECT_NEAR(grid->at({5.5, 489.75}).value(), 10.5 + 100 * 20 + 5, 1e-3);
  EXPECT_TRUE(grid->at({10.1, 495.1}).has_value());
  EXPECT_FALSE(grid->at({30, 495}).has_value());
}

TEST_F(Rasters, of_the_ground_in_another_crs_are_taken_over) {
  // Degrees around Delft; heights rise by a metre for 0.001 degrees to the north.
  const Made degrees{.columns = 200, .rows = 200, .crs = "EPSG:4326", .geotransform = {4.34, 1e-4, 0, 52.02, 0, -1e-4}};
  const auto path = tiff("a.tif", degrees, [](int, int r) { return 52020 - 0.1 * (r + 0.5) - 52000; });
  const auto grid = formats::read_terrain(path, delft, {{100, 500}, {300, 800}});
  ASSERT_TRUE(grid) << base::to_string(grid.error());
  EXPECT_GT(grid->cell, 7);
  EXPECT_LT(grid->cell, 11);
  // PROJ's own answer for one place, by another way than the grid's.
  OGRSpatialReference rd, wgs;
  for (auto* crs : {&rd, &wgs}) crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  rd.importFromEPSG(28992);
  wgs.importFromEPSG(4326);
  const std::unique_ptr<OGRCoordinateTransformation> way(OGRCreateCoordinateTransformation(&rd, &wgs));
  double x = 84200, y = 447650;
  ASSERT_TRUE(way->Transform(1, &x, &y));
  EXPECT_NEAR(grid->at({200, 650}).value(), y * 1000 - 52000 + 5, 0.01);
}

TEST_F(Rasters, of_the_ground_have_none_where_there_is_none) {
  const auto hole = [](int c, int r) { return c == 10 && r == 10 ? -9999.0 : 1.0; };
  const auto path = tiff("a.tif", {.columns = 40, .rows = 30, .nodata = -9999}, hole);
  const auto grid = formats::read_terrain(path, delft, {{-1e9, -1e9}, {1e9, 1e9}});
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->columns, 40U);
  EXPECT_EQ(grid->rows, 30U);
  EXPECT_FALSE(grid->at({5.2, 494.7}).has_value());
  EXPECT_EQ(grid->at({5.75, 494.75}), 6);
  const auto beside = formats::read_terrain(path, delft, {{5000, 5000}, {5001, 5001}});
  ASSERT_FALSE(beside);
  EXPECT_EQ(beside.error().code, "ingest-raster");
  EXPECT_THAT(beside.error().message, HasSubstr("x 84000.2 to 84019.8"));
}

}  // namespace
}  // namespace mansard::ingest::test
