// What is planted: noise, its correlation, spacing, blur, offset of the survey, errors of points.
#include <gmock/gmock.h>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/simulate/detail/noise.hpp"
#include "lab/simulate/points.hpp"
#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point2;
using geometry::Point3;
using test::clean;
using test::scanned;

auto large_roof() -> Truth { return test::truth_of({test::house("a", 0, 0, 60, 60, 6)}); }

/// Heights over the middle of that roof, less 6 m.
auto errors_of(const Scan& scan) -> std::vector<double> {
  std::vector<double> errors;
  for (const auto v : scan.mesh.vertices)
    if (v.x > 2 && v.x < 58 && v.y > 2 && v.y < 58) errors.push_back(v.z - 6);
  return errors;
}

auto root_mean_square(const std::vector<double>& values) -> double {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(Correlation, is_that_of_the_noise) {
  const detail::Noise noise(4, 2.0);
  base::Random random(2);
  for (const Point3 apart : {Point3{0.2, 0, 0}, {0, 0.5, 0}, {0.3, -0.4, 0.3}, {0.9, 0.2, 0}, {2.5, 0, 0}}) {
    double sum = 0;
    constexpr int count = 100000;
    for (int i = 0; i < count; ++i) {
      const Point3 p{random.uniform(-500, 500), random.uniform(-500, 500), random.uniform(-500, 500)};
      sum += noise.at(p) * noise.at(p + apart);
    }
    EXPECT_NEAR(detail::correlation(2.0, apart), sum / count, 0.015) << apart.x << " " << apart.y;
  }
  EXPECT_NEAR(detail::correlation(2.0, {}), 1, 1e-4);
}

TEST(CorrelatedArea, is_the_integral_of_the_autocorrelation) {
  for (const double length : {0.5, 1.5, 6.0}) EXPECT_NEAR(correlated_area(length) / (length * length), 0.3559, 1e-4);
}

TEST(CorrelatedArea, is_what_the_mean_over_a_large_area_varies_by) {
  constexpr double length = 1, side = 30, step = 0.2;
  constexpr int seeds = 300;
  double squares = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const detail::Noise noise(static_cast<std::uint64_t>(seed) * 7919 + 13, length);
    double sum = 0;
    int count = 0;
    for (double x = 0; x < side; x += step)
      for (double y = 0; y < side; y += step, ++count) sum += noise.at({x, y, 0});
    squares += sum / count * (sum / count);
  }
  // The variance of 300 means is known to 8 %.
  EXPECT_NEAR(squares / seeds * side * side, correlated_area(length), 0.2 * correlated_area(length));
}

TEST(CorrelatedArea, is_that_of_a_sample_for_noise_that_samples_do_not_share) {
  EXPECT_EQ(correlated_area(0, 0.5), 0.25);
  EXPECT_EQ(correlated_area(0), 0);
  EXPECT_NEAR(correlated_area(0.3, 0.5), 0.25, 0.01);
  EXPECT_NEAR(correlated_area(2, 0.5), correlated_area(2), 0.02 * correlated_area(2));
}

TEST(Planted, noise_is_what_roofs_have) {
  auto options = clean();
  options.resolution = 0.5;
  options.noise = 0.05;
  for (const double length : {0.0, 2.0}) {
    options.noise_length = length;
    const auto scan = scanned(large_roof(), options, 3);
    const double found = root_mean_square(errors_of(scan));
    EXPECT_NEAR(scan.planted.noise, found, 0.03 * found);
    EXPECT_NEAR(found, 0.05, length > 0 ? 0.005 : 0.001);
    EXPECT_NEAR(scan.planted.correlated_area, correlated_area(length, 0.5), 1e-9);
    EXPECT_EQ(scan.planted.spacing, 0.5);
  }
}

TEST(Planted, noise_of_length_0_is_not_shared_by_neighbours) {
  auto options = clean();
  options.resolution = 0.5;
  options.noise = 0.1;
  options.noise_length = 0;
  const auto scan = scanned(large_roof(), options);
  double edges = 0, numbers = 0, count = 0;
  for (const auto& t : scan.mesh.triangles) {
    const auto at = [&](std::uint32_t v) { return scan.mesh.vertices[v]; };
    if (at(t[0]).x < 3 || at(t[0]).x > 57 || at(t[0]).y < 3 || at(t[0]).y > 57) continue;
    edges += (at(t[0]).z - 6) * (at(t[1]).z - 6);
    if (const auto next = at(t[0] + 1); next.z > 5) numbers += (at(t[0]).z - 6) * (next.z - 6);
    ++count;
  }
  EXPECT_NEAR(edges / count / 0.01, 0, 0.03);
  EXPECT_NEAR(numbers / count / 0.01, 0, 0.03);
}

TEST(Planted, noise_is_stronger_where_few_cameras_see_unless_told_otherwise) {
  auto options = clean();
  options.resolution = 0.5;
  options.noise = 0.05;
  options.noise_length = 0;
  const auto truth = test::truth_of({test::house("low", 0, 0, 20, 20, 4), test::house("high", 20, 0, 40, 20, 40)});
  EXPECT_GT(scanned(truth, options).planted.noise, 0.052);
  options.noise_hidden = 0;
  EXPECT_NEAR(scanned(truth, options).planted.noise, 0.05, 0.001);
}

TEST(Planted, noise_has_the_part_of_the_bulge_that_slopes_have) {
  auto options = clean();
  options.resolution = 0.5;
  options.bulge = 0.2;
  options.bulge_length = 3;
  const auto truth = test::truth_of({test::house("a", 0, 0, 40, 20, 6, 10)});  // 45°
  const auto scan = scanned(truth, options);
  EXPECT_NEAR(scan.planted.noise, 0.2 * (1 - std::sqrt(0.5)), 0.015);
  EXPECT_NEAR(scan.planted.correlated_area, correlated_area(3, 0.5), 1e-9);
}

TEST(Planted, blur_leaves_flat_surfaces_where_they_are) {
  auto options = clean();
  options.resolution = 0.5;
  options.melt = 0.6;
  const auto scan = scanned(large_roof(), options);
  EXPECT_EQ(scan.planted.blur, 0.6);
  for (const auto v : scan.mesh.vertices)
    if (v.x > 3 && v.x < 57 && v.y > 3 && v.y < 57) {
      ASSERT_NEAR(v.z, 6, 0.002);
    }
}

TEST(Planted, offset_is_that_of_the_scan_against_the_survey) {
  const auto truth = test::pair_of_houses();
  SurveyOptions options{0.7, 0, 0, 0, 0};
  for (const std::optional<double> direction : {std::optional<double>(), std::optional(0.0), std::optional(2.5)}) {
    options.direction = direction;
    const auto footprints = *survey(truth, options, 5);
    const auto offset = offset_of(options, 5);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        const auto back = truth.city.buildings[i].footprint[0].outer[k] - footprints[i].polygons[0].outer[k];
        EXPECT_NEAR(length(back - offset), 0, 1e-9);
      }
    if (direction) {
      EXPECT_NEAR(length(offset + 0.7 * Point2{std::cos(*direction), std::sin(*direction)}), 0, 1e-9);
    }
  }
}

TEST(Planted, offset_spread_is_the_root_mean_square_of_the_jitter) {
  std::vector<model::Building> houses;
  for (int i = 0; i < 200; ++i) houses.push_back(test::house("h" + std::to_string(i), 20 * i, 0, 20 * i + 10, 10, 6));
  const auto truth = test::truth_of(std::move(houses));
  const SurveyOptions options{0, 0.3, 0, 0, 0};
  const auto footprints = *survey(truth, options, 1);
  std::vector<double> moved;
  for (std::size_t i = 0; i < footprints.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      moved.push_back(length(footprints[i].polygons[0].outer[k] - truth.city.buildings[i].footprint[0].outer[k]));
  EXPECT_NEAR(root_mean_square(moved), offset_spread(options), 0.01);
}

TEST(AirbornePoints, have_the_independent_noise_that_is_asked_for) {
  Options exact;
  exact.scan = clean();
  exact.scan.exact = true;
  const auto scan = scanned(large_roof(), exact.scan);
  const auto without = airborne_points(scan, {4, 0, 0}, 7), with = airborne_points(scan, {4, 0.03, 0.08}, 7);
  ASSERT_EQ(with.points.size(), without.points.size());
  std::vector<double> high, east, roof;
  double neighbours = 0;
  for (std::size_t i = 0; i < with.points.size(); ++i) {
    const auto by = with.points[i].position - without.points[i].position;
    EXPECT_EQ(with.points[i].classification, without.points[i].classification);
    high.push_back(by.z);
    east.push_back(by.x);
    if (with.points[i].classification == 6) roof.push_back(with.points[i].position.z - 6);
    if (i > 0) neighbours += high[i - 1] * high[i];
  }
  EXPECT_NEAR(root_mean_square(high), 0.03, 0.0005);
  EXPECT_NEAR(root_mean_square(east), 0.08, 0.0015);
  EXPECT_NEAR(neighbours / static_cast<double>(high.size()) / 0.0009, 0, 0.03);
  EXPECT_NEAR(with.planted.noise, root_mean_square(roof), 1e-6);
  EXPECT_NEAR(with.planted.correlated_area, 0.25, 1e-9);
  EXPECT_EQ(with.planted.spacing, 0.5);
  EXPECT_EQ(with.planted.blur, 0);
  EXPECT_EQ(without.planted.noise, 0);
}

TEST(TruthJson, says_what_was_planted) {
  const auto truth = test::pair_of_houses();
  Options options;
  options.seed = 5;
  options.survey.direction = 0;
  const Planted planted{{0.05, 1.5, 0.3, 0.25}, Accuracy{0.06, 0.7, 0.5, 0.2}};
  const auto json = nlohmann::json::parse(truth_json(truth, {}, options, "test", {}, planted))["planted"];
  EXPECT_EQ(json["noise_m"], 0.05);
  EXPECT_EQ(json["correlated_area_m2"], 1.5);
  EXPECT_EQ(json["spacing_m"], 0.3);
  EXPECT_EQ(json["blur_m"], 0.25);
  EXPECT_EQ(json["offset_m"], (nlohmann::json{-0.2, 0.0}));
  EXPECT_NEAR(json["offset_spread_m"].get<double>(), 0.05 / std::sqrt(3), 1e-12);
  EXPECT_EQ(json["points"]["noise_m"], 0.06);
  EXPECT_FALSE(nlohmann::json::parse(truth_json(truth, {}, options, "test")).contains("planted"));
}

}  // namespace
}  // namespace mansard::simulate
