// Pictures of the ground from tiles, in folders. Those of a server are in tests/server.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "base/scratch.hpp"
#include "mansard/formats/ground_tiles.hpp"
#include "mansard/formats/image.hpp"

namespace mansard::formats {
namespace {

using geometry::Box2;
using testing::HasSubstr;

/// A square of one colour.
auto square(int side, std::array<std::uint8_t, 3> colour) -> std::string {
  model::Pixels pixels;
  pixels.width = pixels.height = static_cast<std::uint32_t>(side);
  for (int i = 0; i < side * side; ++i) pixels.rgb.insert(pixels.rgb.end(), colour.begin(), colour.end());
  return encode_image(pixels, ImageCodec::png, 90).value();
}

auto text(const std::filesystem::path& path) -> std::string { return path.string(); }

struct MapTile {
  int zoom = 0, column = 0, row = 0;
};
/// The tile of a place, by the formula of https://wiki.openstreetmap.org/wiki/Slippy_map_tilenames.
auto tile_of(double longitude, double latitude, int zoom) -> MapTile {
  const double n = std::exp2(zoom), phi = latitude * std::numbers::pi / 180;
  return {zoom, static_cast<int>((longitude + 180) / 360 * n),
          static_cast<int>((1 - std::asinh(std::tan(phi)) / std::numbers::pi) / 2 * n)};
}
auto colour_of(const MapTile& t) -> std::array<std::uint8_t, 3> {
  return {static_cast<std::uint8_t>(t.column % 2 ? 200 : 40), static_cast<std::uint8_t>(t.row % 2 ? 200 : 40), 100};
}
void put(const std::filesystem::path& folder, const MapTile& t, const std::string& bytes, const std::string& row) {
  const auto column = folder / std::to_string(t.zoom) / std::to_string(t.column);
  std::filesystem::create_directories(column);
  std::ofstream(column / (row + ".png"), std::ios::binary) << bytes;
}

// In Delft, in EPSG:28992, and where that is by gdaltransform.
constexpr Box2 delft{{84'300, 447'300}, {84'700, 447'700}};
constexpr double longitude = 4.36029931, latitude = 52.01137928;
struct KnownPlace {
  double x, y, longitude, latitude;
};
constexpr std::array places{
    KnownPlace{84'500, 447'500, longitude, latitude}, KnownPlace{84'320, 447'320, 4.35771499, 52.00973873},
    KnownPlace{84'680, 447'680, 4.36288382, 52.01301978}, KnownPlace{84'320, 447'680, 4.35764068, 52.01297404}};

/// Tiles around Delft at one zoom level, each of one colour.
void put_all(const std::filesystem::path& folder, int zoom, int reach, int side, bool south = false) {
  const auto middle = tile_of(longitude, latitude, zoom);
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy) {
      const MapTile t{zoom, middle.column + dx, middle.row + dy};
      put(folder, t, square(side, colour_of(t)), std::to_string(south ? (1 << zoom) - 1 - t.row : t.row));
    }
}

auto pixel(const GroundPicture& picture, double x, double y) -> std::array<int, 3> {
  const auto pixels = decode_image(picture.png, "picture").value();
  const auto& [least, most] = picture.place;
  const auto column = static_cast<std::size_t>((x - least.x) / (most.x - least.x) * pixels.width);
  const auto row = static_cast<std::size_t>((most.y - y) / (most.y - least.y) * pixels.height);
  const auto* p = pixels.rgb.data() + 3 * (row * pixels.width + column);
  return {p[0], p[1], p[2]};
}

TEST(GroundTiles, of_a_folder_are_placed_in_the_crs_of_the_models) {
  for (const bool south : {false, true})
    for (const int side : {256, 512}) {
      SCOPED_TRACE(side);
      const test::Scratch folder;
      put_all(folder / "map", 16, 2, side, south);
      // As gdal2tiles writes them: only those from the south have that file.
      if (south) std::ofstream(folder / "map/tilemapresource.xml") << "<TileMap/>";
      const auto name = text(folder / "map");
      ASSERT_TRUE(is_ground_tiles(name));
      const auto pattern = ground_tiles_pattern(name);
      ASSERT_TRUE(pattern);
      EXPECT_EQ(*pattern, text(folder / (south ? "map/{z}/{x}/{-y}.png" : "map/{z}/{x}/{y}.png")));
      const auto picture = read_ground_tiles(*pattern, "EPSG:28992", delft, 4096);
      ASSERT_TRUE(picture) << picture.errors().front().message;
      EXPECT_EQ(picture->place.least, delft.least);
      EXPECT_EQ(picture->place.most, delft.most);
      for (const auto& at : places) {
        const auto wanted = colour_of(tile_of(at.longitude, at.latitude, 16));
        EXPECT_EQ(pixel(*picture, at.x, at.y), (std::array<int, 3>{wanted[0], wanted[1], wanted[2]})) << at.x;
      }
    }
}

TEST(GroundTiles, are_taken_from_the_finest_level_that_is_there_and_fits) {
  const test::Scratch folder;
  put_all(folder, 14, 1, 256);
  put_all(folder, 17, 3, 256);
  const auto pattern = ground_tiles_pattern(text(folder)).value();
  const auto width = [&](int most) {
    return decode_image(read_ground_tiles(pattern, "EPSG:28992", delft, most).value().png, "").value().width;
  };
  EXPECT_NEAR(width(4096), 400 / 0.735, 25) << "zoom 17: 1.19 m times the cosine of the latitude";
  EXPECT_NEAR(width(200), 400 / 5.88, 5) << "zoom 14";
}

TEST(GroundTiles, that_are_missing_leave_holes) {
  const test::Scratch folder;
  const auto t = tile_of(longitude, latitude, 16);
  put(folder, t, square(256, {250, 10, 20}), std::to_string(t.row));
  const auto picture = read_ground_tiles(ground_tiles_pattern(text(folder)).value(), "EPSG:28992", delft, 4096);
  ASSERT_TRUE(picture);
  int holes = 0;
  for (const auto& at : places) {
    const auto its = tile_of(at.longitude, at.latitude, 16);
    const bool there = its.column == t.column && its.row == t.row;
    holes += there ? 0 : 1;
    EXPECT_EQ(pixel(*picture, at.x, at.y), there ? (std::array<int, 3>{250, 10, 20}) : (std::array<int, 3>{}));
  }
  EXPECT_GT(holes, 0);
  EXPECT_LT(holes, 4);
}

TEST(GroundTiles, that_cannot_be_used_are_refused_with_what_is_wrong) {
  const test::Scratch folder;
  const auto refusal = [](const auto& result) {
    EXPECT_FALSE(result);
    EXPECT_EQ(result ? "" : result.errors().front().code, "ingest-ground-tiles");
    return result ? std::string() : result.errors().front().message;
  };
  EXPECT_THAT(refusal(ground_tiles_pattern("https://example.org/map.png")), HasSubstr("{z}"));
  EXPECT_THAT(refusal(ground_tiles_pattern("https://{s}.example.org/{z}/{x}/{y}.png")), HasSubstr("'{s}'"));
  EXPECT_THAT(refusal(ground_tiles_pattern("https://example.org/{z}/{x}/{y}/{-y}.png")), HasSubstr("{-y}"));
  std::filesystem::create_directories(folder / "17");
  EXPECT_THAT(refusal(ground_tiles_pattern(text(folder))), HasSubstr("no tiles"));
  EXPECT_FALSE(is_ground_tiles((folder / "map.tif").string()));
  EXPECT_FALSE(is_ground_tiles(""));

  const auto t = tile_of(longitude, latitude, 16);
  const auto pattern = (folder / "{z}/{x}/{y}.png").string();
  EXPECT_THAT(refusal(read_ground_tiles(pattern, "EPSG:28992", delft, 4096)), HasSubstr("there are no tiles"));
  EXPECT_THAT(refusal(read_ground_tiles(pattern, "", delft, 4096)), HasSubstr("no CRS"));
  put(folder, t, "<html>Sign in</html>", std::to_string(t.row));
  EXPECT_THAT(refusal(read_ground_tiles(pattern, "EPSG:28992", delft, 4096)), HasSubstr("not a picture"));
  put(folder, t, square(256, {1, 2, 3}), std::to_string(t.row));
  put(folder, {16, t.column + 1, t.row}, square(512, {1, 2, 3}), std::to_string(t.row));
  EXPECT_THAT(refusal(read_ground_tiles(pattern, "EPSG:28992", {{84'300, 447'300}, {85'200, 447'700}}, 4096)),
              HasSubstr("different sizes"));
}

}  // namespace
}  // namespace mansard::formats
