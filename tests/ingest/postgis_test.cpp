#include <gmock/gmock.h>

#include "ingest/database.hpp"
#include "mansard/formats/vector/features.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(Database, is_a_source_of_footprints) {
  sql("CREATE EXTENSION postgis; CREATE SCHEMA city;"
      "CREATE TABLE city.houses (gid serial PRIMARY KEY, name text, floors int, geom geometry(Polygon, 28992));"
      "CREATE INDEX ON city.houses USING gist (geom);"
      "INSERT INTO city.houses (name, floors, geom) SELECT 'house ' || i, i % 4, ST_MakeEnvelope(84000 + 100 * i, "
      "447000,"
      " 84010 + 100 * i, 447010, 28992) FROM generate_series(1, 300) AS i;"
      "UPDATE city.houses SET floors = 9 WHERE gid = 2;"  // now the last one in the table
      "CREATE TABLE city.trees (gid serial PRIMARY KEY, geom geometry(Point, 28992));");
  Options options;
  options.layer = "city.houses";
  options.bbox = {84095, 446990, 84405, 447020};
  const auto scene = read_footprints(address(" password=secret"), options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  std::vector<std::string> names;
  for (const auto& footprint : scene->footprints) {
    EXPECT_FALSE(footprint.defect);
    for (const auto& [name, value] : footprint.attributes)
      if (name == "name") names.push_back(std::get<std::string>(value));
  }
  EXPECT_THAT(names, ElementsAre("house 1", "house 2", "house 3", "house 4"));
  ASSERT_EQ(scene->inputs.size(), 1U);
  EXPECT_THAT(scene->inputs[0].path, HasSubstr("password=***"));
  EXPECT_EQ(scene->inputs[0].sha256.size(), 64U);
  for (const auto& warning : scene->warnings) EXPECT_EQ(base::to_string(warning).find("secret"), std::string::npos);

  const auto again = read_footprints(address(" password=secret"), options);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->inputs[0].sha256, scene->inputs[0].sha256);
  sql("UPDATE city.houses SET floors = 5 WHERE gid = 3;");
  const auto changed = read_footprints(address(" password=secret"), options);
  ASSERT_TRUE(changed);
  EXPECT_NE(changed->inputs[0].sha256, scene->inputs[0].sha256);

  options.where = "floors = 5";
  options.id_attribute = "name";
  const auto one = read_footprints(address(), options);
  ASSERT_TRUE(one) << base::to_string(one.error());
  ASSERT_EQ(one->footprints.size(), 1U);
  EXPECT_EQ(one->footprints[0].id, "house 3");
  options.where = "storeys = 5";
  EXPECT_EQ(code(read_footprints(address(), options)), "ingest-where");
  options = {};
  options.layer = "city.hauses";
  const auto misspelt = read_footprints(address(), options);
  EXPECT_EQ(code(misspelt), "ingest-layer");
  EXPECT_THAT(misspelt.error().message, HasSubstr("city.houses"));
  EXPECT_EQ(code(read_footprints(address(" port=1"), {})), "file-read");
}

}  // namespace
}  // namespace mansard::ingest::test
