#include <gmock/gmock.h>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "lab/simulate/detail/noise.hpp"
#include "mansard/ingest/ingest.hpp"
#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  auto put(const std::string& name, const std::string& bytes) const -> fs::path {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  mansard::test::Scratch folder_;
};

TEST_F(Files, are_read_back_as_they_were) {
  auto truth = test::pair_of_houses();
  truth.city.frame.origin = {84000, 447000, 3};
  truth.city.frame.crs = "EPSG:28992";
  const auto scan = test::scanned(truth, test::clean());
  const auto footprints = *survey(truth, {}, 1);
  const auto scene = ingest::read_scene({put("mesh.ply", ply(scan, truth.city.frame))},
                                        put("footprints.geojson", geojson(footprints, truth.city.frame)), {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  EXPECT_EQ(scene->mesh_counts.triangles_read, scan.mesh.triangles.size());
  EXPECT_EQ(scene->mesh_counts.vertices_read, scan.mesh.vertices.size());
  EXPECT_EQ(scene->mesh_counts.flipped_edges, 0U);
  ASSERT_EQ(scene->footprints.size(), footprints.size());
  for (std::size_t i = 0; i < footprints.size(); ++i) {
    EXPECT_FALSE(scene->footprints[i].defect);
    EXPECT_EQ(scene->footprints[i].id, footprints[i].id);
    const auto at = [](const auto& frame, geometry::Point2 p) {
      return p + geometry::Point2{static_cast<double>(frame.origin[0]), static_cast<double>(frame.origin[1])};
    };
    const auto here = at(truth.city.frame, footprints[i].polygons[0].outer[0]);
    double nearest = 1e9;
    for (const auto p : scene->footprints[i].polygons[0].outer)
      nearest = std::min(nearest, length(at(scene->frame, p) - here));
    EXPECT_LT(nearest, 0.002);
  }
}

TEST_F(Files, name_party_walls_buildings_and_options) {
  const auto truth = test::pair_of_houses();
  Options options;
  options.seed = 5;
  options.scan.noise = 0.125;
  const auto json = nlohmann::json::parse(truth_json(truth, *survey(truth, {}, 5), options, "test"));
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["source"], "test");
  EXPECT_EQ(json["options"]["simulate.noise"], "0.125");
  ASSERT_EQ(json["buildings"].size(), 2U);
  EXPECT_NEAR(json["buildings"][1]["parts"][0]["top"].get<double>(), 9, 1e-6);
  EXPECT_NEAR(json["buildings"][1]["parts"][0]["volume"].get<double>(), 1080, 1e-3);
  ASSERT_EQ(json["party_walls"].size(), 1U);
  EXPECT_EQ(json["party_walls"][0]["second"], "high");
}

TEST(Presets, set_only_options_that_exist_to_values_in_range) {
  for (const auto& preset : presets()) {
    Options options;
    const auto list = option_list(options);
    for (const auto& [key, value] : preset.values) {
      ASSERT_TRUE(key.starts_with("simulate."));
      const auto* option = list.find(key.substr(9));
      ASSERT_NE(option, nullptr) << key;
      EXPECT_TRUE(option->set(value)) << key << " " << value;
    }
  }
}

TEST(Codes, of_simulate_have_cause_and_remedy) {
  for (const auto& code : codes()) {
    EXPECT_TRUE(code.code.starts_with("simulate-"));
    EXPECT_FALSE(code.cause.empty() || code.remedy.empty()) << code.code;
  }
}

TEST(Kind, is_found_by_its_name) {
  for (const auto kind : {Kind::terrace, Kind::perimeter, Kind::courtyard, Kind::towers, Kind::detached})
    EXPECT_EQ(kind_of(to_string(kind)), kind);
  EXPECT_FALSE(kind_of("castle"));
}

TEST(Noise, has_mean_0_and_root_mean_square_1) {
  const detail::Noise noise(3, 2.0);
  base::Random random(1);
  double sum = 0, squares = 0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-500, 500), y = random.uniform(-500, 500), z = random.uniform(-500, 500);
    const double value = noise.at({x, y, z});
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / count, 0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.02);
}

TEST(Noise, is_correlated_over_less_than_its_wavelength_only) {
  const detail::Noise noise(4, 2.0);
  base::Random random(2);
  const auto correlation = [&](double apart) {
    double sum = 0;
    constexpr int count = 50000;
    for (int i = 0; i < count; ++i) {
      const geometry::Point3 p{random.uniform(-500, 500), random.uniform(-500, 500), random.uniform(-500, 500)};
      sum += noise.at(p) * noise.at(p + geometry::Point3{apart, 0, 0});
    }
    return sum / count;
  };
  EXPECT_GT(correlation(0.1), 0.9);
  EXPECT_LT(std::abs(correlation(2.5)), 0.05);
}

}  // namespace
}  // namespace mansard::simulate
