#include "mansard/formats/drivers.hpp"

#include <gmock/gmock.h>

#include <set>

#include "mansard/formats/stream.hpp"

namespace mansard::formats {
namespace {

using testing::HasSubstr;

TEST(Drivers, have_names_of_their_own) {
  std::set<std::string_view> names;
  for (const auto& driver : drivers()) EXPECT_TRUE(names.insert(driver.name).second) << driver.name;
}

TEST(Drivers, write_every_format_once_in_the_order_of_the_enumeration) {
  std::vector<Format> written;
  for (const auto& driver : drivers())
    if (driver.writes) written.push_back(*driver.writes);
  ASSERT_EQ(written.size(), static_cast<std::size_t>(Format::flatgeobuf) + 1);
  for (std::size_t i = 0; i < written.size(); ++i) EXPECT_EQ(written[i], static_cast<Format>(i));
  EXPECT_EQ(formats().size(), written.size());
}

TEST(Drivers, have_lower_case_extensions_with_a_dot) {
  for (const auto& driver : drivers()) {
    EXPECT_FALSE(driver.extensions.empty()) << driver.name;
    for (const auto extension : driver.extensions)
      EXPECT_THAT(std::string(extension), testing::MatchesRegex("[.][a-z0-9.]+"));
  }
}

TEST(Drivers, say_what_they_are_for) {
  for (const auto& driver : drivers()) {
    const auto& r = driver.reads;
    EXPECT_TRUE(r.mesh || r.raster || r.footprints || r.models || r.results || driver.writes) << driver.name;
    EXPECT_TRUE(driver.mesh.parse == nullptr || r.mesh) << driver.name;
    EXPECT_THAT(std::string(driver.description), testing::EndsWith(".")) << driver.name;
  }
}

TEST(Drivers, are_listed_in_words) {
  EXPECT_EQ(titles(&Reads::mesh), "OBJ, GLB, 3D Tiles, STL, PLY, OFF, glTF, OSGB, FBX, COLLADA, LAS, LAZ, XYZ");
  EXPECT_EQ(extensions_in_words(&Reads::raster), ".tif, .tiff, .vrt, .asc or .img");
  EXPECT_THAT(extensions(&Reads::footprints), testing::Contains(".gpkg"));
}

TEST(Drivers, extensions_are_found_in_any_case_and_in_archives) {
  EXPECT_TRUE(has_extension("a/DSM.TIF", &Reads::raster));
  EXPECT_TRUE(has_extension("a/city.CITY.json", &Reads::models));
  EXPECT_FALSE(has_extension("a/city.obj", &Reads::raster));
  EXPECT_EQ(extension_of("mesh.OBJ.gz"), ".obj");
}

}  // namespace
}  // namespace mansard::formats
