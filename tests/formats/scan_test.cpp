// Fields and labelled meshes, read back by the libraries and modules that users read them with.
#include "mansard/formats/scan.hpp"
#include "base/scratch.hpp"
#include "mansard/ingest/model.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "mansard/base/files.hpp"
#include "mansard/crs/gdal.hpp"

namespace mansard::formats {
namespace {

using model::SurfaceClass;

class Scans : public testing::Test {
 protected:
  auto file(const std::string& name, const std::string& bytes) const -> std::filesystem::path {
    EXPECT_TRUE(base::write_file(folder_ / name, bytes));
    return folder_ / name;
  }

  test::Scratch folder_;
  model::Frame frame_{{85000, 447000, 2}, "EPSG:28992"};
  /// Two squares of two triangles each.
  geometry::Mesh mesh_{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0.25}, {2, 1, 0.25}},
                       {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}};
  std::vector<SurfaceClass> classes_{SurfaceClass::roof, SurfaceClass::ground, SurfaceClass::other, SurfaceClass::roof};
};

TEST_F(Scans, write_fields_where_they_lie_north_up) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{1, 2, 3, 4, none, -6};  // the southern row first
  const Raster raster{{10.125, 20.125}, 0.25, 3, 2, values};
  const auto bytes = geotiff(raster, frame_);
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(*bytes, *geotiff(raster, frame_));

  crs::register_gdal();
  const auto path = file("field.tif", *bytes);
  GDALDatasetUniquePtr read(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->GetRasterXSize(), 3);
  EXPECT_EQ(read->GetRasterYSize(), 2);
  std::array<double, 6> transform{};
  ASSERT_EQ(read->GetGeoTransform(transform.data()), CE_None);
  EXPECT_EQ(transform, (std::array<double, 6>{85010, 0.25, 0, 447020.5, 0, -0.25}));
  EXPECT_STREQ(read->GetSpatialRef()->GetAuthorityCode(nullptr), "28992");
  std::array<float, 6> back{};
  ASSERT_EQ(read->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 3, 2, back.data(), 3, 2, GDT_Float32, 0, 0), CE_None);
  EXPECT_EQ(back[0], 4);
  EXPECT_TRUE(std::isnan(back[1]));
  EXPECT_EQ(back[2], -6);
  EXPECT_EQ(back[3], 1);
  EXPECT_TRUE(std::isnan(read->GetRasterBand(1)->GetNoDataValue()));
}

TEST_F(Scans, write_fields_without_a_crs_and_refuse_what_is_no_field) {
  const std::vector<float> values{1};
  EXPECT_TRUE(geotiff({{0, 0}, 1, 1, 1, values}, {}));
  const auto empty = geotiff({{0, 0}, 1, 0, 0, {}}, {});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, "write-geotiff");
  const auto unknown = geotiff({{0, 0}, 1, 1, 1, values}, {{0, 0, 0}, "EPSG:1"});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, testing::HasSubstr("EPSG:1"));
}

TEST_F(Scans, write_a_class_per_face_that_is_read_back) {
  const auto path = file("scan.ply", labelled_ply(mesh_, classes_, frame_));
  const auto back = ingest::read_mesh({path}, frame_, {});
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->classes, classes_);
  EXPECT_EQ(back->mesh.vertices, mesh_.vertices);
  EXPECT_EQ(back->mesh.triangles, mesh_.triangles);
}

TEST_F(Scans, write_a_material_per_class) {
  const auto bytes = labelled_glb(mesh_, classes_, frame_);
  ASSERT_TRUE(bytes);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes->data() + 12, 4);
  const auto json = nlohmann::json::parse(bytes->substr(20, length));
  std::vector<std::string> materials;
  for (const auto& material : json["materials"]) materials.push_back(material["name"]);
  EXPECT_EQ(materials, (std::vector<std::string>{"roof", "ground", "other"}));
  const auto& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 3U);
  EXPECT_EQ(json["accessors"][primitives[0]["indices"].get<std::size_t>()]["count"], 6);
  EXPECT_EQ(json["accessors"][primitives[1]["indices"].get<std::size_t>()]["count"], 3);
  EXPECT_EQ(json["asset"]["extras"]["origin"], (nlohmann::json{85000, 447000, 2}));

  const auto back = ingest::read_mesh({file("scan.glb", *bytes)}, {}, {});
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->mesh.vertices.size(), 6U);
  EXPECT_EQ(back->mesh.triangles.size(), 4U);
  EXPECT_EQ(back->mesh.vertices[4], mesh_.vertices[4]);
}

}  // namespace
}  // namespace mansard::formats
