// The shared data, which may not all be shipped: read from where it lies.
#include <gmock/gmock.h>

#include "ingest/workshop.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::ingest::test {
namespace {

const fs::path shared = MANSARD_SHARED_DATA;

struct Known {
  const char* name;
  const char* mesh;
  const char* footprints;
  std::array<double, 3> offset;
  std::uint64_t vertices, triangles;
  std::size_t features;
  const char* crs;
};

class SharedData : public Workshop {
 protected:
  void SetUp() override {
    if (!fs::exists(shared)) GTEST_SKIP() << "no shared data";
  }
};

class RealData : public SharedData, public ::testing::WithParamInterface<Known> {};

TEST_P(RealData, is_read_as_the_catalogue_has_it) {
  const Known& known = GetParam();
  Options options;
  options.mesh_offset = known.offset;
  const auto scene = read_scene({shared / known.mesh}, shared / known.footprints, options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->mesh_counts.vertices_read, known.vertices);
  EXPECT_EQ(scene->mesh_counts.triangles_read, known.triangles);
  EXPECT_GE(static_cast<double>(scene->mesh_counts.triangles), 0.999 * static_cast<double>(known.triangles));
  EXPECT_EQ(scene->mesh.triangles.size(), scene->mesh_counts.triangles);
  EXPECT_EQ(scene->frame.crs, known.crs);
  ASSERT_EQ(scene->footprints.size(), known.features);
  for (const auto& footprint : scene->footprints) {
    EXPECT_FALSE(footprint.defect) << base::to_string(*footprint.defect);
    EXPECT_FALSE(footprint.attributes.empty());
    for (const auto& polygon : footprint.polygons) EXPECT_TRUE(geometry::is_simple(polygon));
  }
}

INSTANTIATE_TEST_SUITE_P(
    , RealData,
    ::testing::Values(
        Known{"delft",
              "delft/delft_west_mesh.ply",
              "delft/delft_west_footprints.geojson",
              {84800, 447400, 0},
              144235,
              286928,
              87,
              "EPSG:28992"},
        Known{"hall",
              "mvs_buildings/cgal_building.off",
              "mvs_buildings/cgal_footprints.geojson",
              {0, 0, 0},
              16344,
              32245,
              2,
              ""},
        Known{"b9", "mvs_buildings/b9_mesh.off", "mvs_buildings/b9_footprints.geojson", {0, 0, 0}, 5951, 10174, 3, ""},
        Known{"zhongshan_18",
              "zhongshan/zhongshan_A_L18.ply",
              "zhongshan/zhongshan_A_footprints.geojson",
              {0, 0, 0},
              18774,
              36776,
              8,
              ""},
        Known{"zhongshan_19",
              "zhongshan/zhongshan_A_L19.ply",
              "zhongshan/zhongshan_A_footprints.geojson",
              {0, 0, 0},
              39521,
              70782,
              8,
              ""},
        Known{"rotterdam",
              "sim_rotterdam/block_A_sim_mesh.ply",
              "sim_rotterdam/block_A_footprints.geojson",
              {0, 0, 0},
              269144,
              535644,
              29,
              ""},
        Known{"rotterdam_truth",
              "sim_rotterdam/block_A_truth.obj",
              "sim_rotterdam/block_A_footprints.geojson",
              {0, 0, 0},
              981,
              1630,
              29,
              ""}),
    [](const auto& given) { return std::string(given.param.name); });

class OtherRealData : public SharedData {};

TEST_F(OtherRealData, campus_is_read_over_a_drawn_footprint) {
  const auto scene = read({shared / "campus/campus_2tiles.ply"}, polygons({square(10, 10)}));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->mesh_counts.vertices_read, 191636U);
  EXPECT_EQ(scene->mesh_counts.triangles_read, 353917U);
}

TEST_F(OtherRealData, footprints_without_a_mesh_are_read_over_level_ground) {
  for (const auto& [path, count] : {std::pair{"regent_street/regent_st_200m_local.geojson", 99U},
                                    std::pair{"regent_street/regent_st_600m_local.geojson", 494U},
                                    std::pair{"denhaag/denhaag_subs_footprints.geojson", 4U},
                                    std::pair{"zurich/zurich_subset_footprints.geojson", 49U}}) {
    const auto scene = read({ground(-20000, -20000, 20000, 20000)}, shared / path);
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    ASSERT_EQ(scene->footprints.size(), count) << path;
    for (const auto& footprint : scene->footprints)
      EXPECT_FALSE(footprint.defect) << path << " " << base::to_string(*footprint.defect);
  }
}

class Delft : public SharedData {};

TEST_F(Delft, coordinates_are_those_of_the_file_bit_for_bit) {
  Options options;
  options.mesh_offset = {84800, 447400, 0};
  const auto scene =
      read_scene({shared / "delft/delft_west_mesh.ply"}, shared / "delft/delft_west_footprints.geojson", options);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->footprints[0].id, "b31bc26a8-00ba-11e6-b420-2bdcc4ab5d7f");
  bool found = false;  // the first corner of the first footprint
  for (const auto p : scene->footprints[0].polygons[0].outer)
    found = found || (p.x + static_cast<double>(scene->frame.origin[0]) == 84929.574 &&
                      p.y + static_cast<double>(scene->frame.origin[1]) == 447500.49);
  EXPECT_TRUE(found);
}

TEST_F(Delft, is_the_same_at_one_and_two_threads) {
  Options options;
  options.mesh_offset = {84800, 447400, 0};
  const auto once = [&](std::size_t threads) {
    base::limit_threads(threads);
    auto scene =
        read_scene({shared / "delft/delft_west_mesh.ply"}, shared / "delft/delft_west_footprints.geojson", options);
    base::limit_threads(0);
    return std::move(scene).value();
  };
  const auto one = once(1), two = once(2);
  EXPECT_TRUE(one.mesh.vertices == two.mesh.vertices && one.mesh.triangles == two.mesh.triangles);
  ASSERT_EQ(one.footprints.size(), two.footprints.size());
  for (std::size_t i = 0; i < one.footprints.size(); ++i)
    EXPECT_EQ(one.footprints[i].polygons, two.footprints[i].polygons);
}

}  // namespace
}  // namespace mansard::ingest::test
