// Pictures of the ground.
#include <gmock/gmock.h>

#include <fstream>

#include "base/scratch.hpp"
#include "mansard/formats/ground_picture.hpp"
#include "mansard/formats/image.hpp"

namespace mansard::formats {
namespace {

using testing::HasSubstr;

/// 4 by 2 pixels: the northern row red, green, blue, white, the southern one black.
void write_picture(const std::filesystem::path& path) {
  std::ofstream file(path, std::ios::binary);
  file << "P6\n4 2\n255\n" << std::string("\xff\0\0\0\xff\0\0\0\xff\xff\xff\xff", 12) << std::string(12, '\0');
}
void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(GroundPicture, with_a_world_file_lies_where_that_says) {
  const test::Scratch folder;
  write_picture(folder / "map.ppm");
  EXPECT_EQ(read_ground_picture(folder / "map.ppm", "EPSG:28992", 100).errors().front().code, "ingest-raster")
      << "it does not say where it is";
  write_text(folder / "map.wld", "10\n0\n0\n-10\n84005\n447015\n");  // the centre of the first pixel
  const auto picture = read_ground_picture(folder / "map.ppm", "EPSG:28992", 100);
  ASSERT_TRUE(picture) << picture.errors().front().message;
  EXPECT_EQ(picture->place.least, (geometry::Point2{84000, 447000}));
  EXPECT_EQ(picture->place.most, (geometry::Point2{84040, 447020}));
  const auto pixels = decode_image(picture->png, "map");
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->width, 4U);
  EXPECT_EQ(pixels->height, 2U);
  EXPECT_EQ(std::vector<int>(pixels->rgb.begin(), pixels->rgb.begin() + 6), (std::vector<int>{255, 0, 0, 0, 255, 0}));
}

TEST(GroundPicture, is_transformed_to_the_crs_of_the_models) {
  const test::Scratch folder;
  write_picture(folder / "map.ppm");
  // About 66 by 33 m in Delft, in degrees.
  write_text(
      folder / "map.vrt",
      R"(<VRTDataset rasterXSize="4" rasterYSize="2"><SRS>EPSG:4326</SRS>
    <GeoTransform>4.35, 0.00024, 0, 52.01, 0, -0.00015</GeoTransform>)" +
          [] {
            std::string bands;
            for (const char* band : {"1", "2", "3"})
              bands += std::string("<VRTRasterBand dataType=\"Byte\" band=\"") + band +
                       "\"><SimpleSource><SourceFilename relativeToVRT=\"1\">map.ppm</SourceFilename><SourceBand>" +
                       band + "</SourceBand></SimpleSource></VRTRasterBand>";
            return bands;
          }() +
          "</VRTDataset>");
  const auto picture = read_ground_picture(folder / "map.vrt", "EPSG:28992", 100);
  ASSERT_TRUE(picture) << picture.errors().front().message;
  // By gdaltransform.
  EXPECT_NEAR(picture->place.least.x, 83'790, 2);
  EXPECT_NEAR(picture->place.most.y, 447'357, 2);
  EXPECT_NEAR(picture->place.most.x - picture->place.least.x, 66, 5);
  EXPECT_NEAR(picture->place.most.y - picture->place.least.y, 33, 5);
}

TEST(GroundPicture, is_made_smaller_where_it_is_large) {
  const test::Scratch folder;
  {
    std::ofstream file(folder / "map.ppm", std::ios::binary);
    file << "P6\n300 100\n255\n" << std::string(90'000, '\x40');
  }
  write_text(folder / "map.wld", "1\n0\n0\n-1\n0.5\n99.5\n");
  const auto picture = read_ground_picture(folder / "map.ppm", "", 60);
  ASSERT_TRUE(picture);
  const auto pixels = decode_image(picture->png, "map");
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->width, 60U);
  EXPECT_EQ(pixels->height, 20U);
  EXPECT_EQ(pixels->rgb.at(0), 0x40);
  EXPECT_EQ(picture->place.most, (geometry::Point2{300, 100}));
}

TEST(GroundPicture, that_is_none_is_refused_with_what_is_wrong) {
  const test::Scratch folder;
  write_text(folder / "map.png", "no picture");
  const auto none = read_ground_picture(folder / "map.png", "", 100);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.errors().front().code, "ingest-raster");
  EXPECT_EQ(read_ground_picture(folder / "none.png", "", 100).errors().front().code, "file-missing");
  write_picture(folder / "map.ppm");
  write_text(folder / "map.wld", "7\n7\n7\n-7\n0\n0\n");
  const auto turned = read_ground_picture(folder / "map.ppm", "", 100);
  ASSERT_FALSE(turned);
  EXPECT_THAT(turned.errors().front().message, HasSubstr("north up"));
  // What it names outside of its folder is not read.
  write_text(folder / "out.vrt",
             R"(<VRTDataset rasterXSize="4" rasterYSize="2"><GeoTransform>0, 1, 0, 2, 0, -1</GeoTransform>
    <VRTRasterBand dataType="Byte" band="1"><SimpleSource><SourceFilename>/etc/passwd</SourceFilename>
    <SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>)");
  EXPECT_FALSE(read_ground_picture(folder / "out.vrt", "", 100));
}

}  // namespace
}  // namespace mansard::formats
