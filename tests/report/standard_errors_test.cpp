// What is said of the errors of numbers, compared with the errors of planted ones.
#include "mansard/report/standard_errors.hpp"

#include <gmock/gmock.h>

#include "formats/cities.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/solid/solid.hpp"

namespace {

using namespace cities;
using namespace mansard;

auto number(const model::Attributes& attributes, std::string_view name) -> std::optional<double> {
  for (const auto& [key, one] : attributes)
    if (key == name)
      if (const auto* found = std::get_if<double>(&one)) return *found;
  return std::nullopt;
}

/// About normal, with a variance of 1 (the sum of twelve uniform numbers).
auto draw(base::Random& random) -> double {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// 10 by 8 m, ground at 1.25, eaves at 7.25, ridge at 11.25: with other eaves and ridge, which is along x.
auto house_of(double eave, double ridge) -> Building {
  auto house = street().buildings[0];
  auto& solid = house.parts[0].model.solid;
  solid.faces[5].kind = solid.faces[6].kind = FaceKind::side;
  for (auto& v : solid.vertices) v.z = v.z == 7.25 ? eave : v.z == 11.25 ? ridge : v.z;
  for (const std::size_t f : {5U, 6U}) {
    const auto& loop = solid.faces[f].loops[0];
    solid.faces[f].normal = geometry::normalised(
        cross(solid.vertices[loop[1]] - solid.vertices[loop[0]], solid.vertices[loop[2]] - solid.vertices[loop[1]]));
  }
  return house;
}
auto box_of(const Building& house) -> geometry::Box2 { return geometry::Box2::of(house.parts[0].model.solid.vertices); }

/// A scan of the roof with the planted heights, one vertex every half metre, and the roof that fits it best.
struct Scanned {
  geometry::Mesh mesh;
  double eave = 0, ridge = 0;
};
auto scanned(double noise, double common, base::Random& random) -> Scanned {
  constexpr double step = 0.5, eave = 7.25, pitch = 1;
  const auto box = box_of(house_of(7.25, 11.25));
  const double middle = (box.least.y + box.most.y) / 2, half = (box.most.y - box.least.y) / 2;
  const auto columns = static_cast<std::uint32_t>((box.most.x - box.least.x) / step) + 1,
             rows = static_cast<std::uint32_t>((box.most.y - box.least.y) / step) + 1;
  Scanned out;
  geometry::LineSums sums;
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const geometry::Point2 p = box.least + geometry::Point2{step * c, step * r};
      const double up = half - std::abs(p.y - middle);
      out.mesh.vertices.push_back({p.x, p.y, eave + common + pitch * up + noise * draw(random)});
      sums.add(up, out.mesh.vertices.back().z);
      if (r + 1 == rows || c + 1 == columns) continue;
      const std::uint32_t v = r * columns + c;
      out.mesh.triangles.push_back({v, v + 1, v + columns + 1});
      out.mesh.triangles.push_back({v, v + columns + 1, v + columns});
    }
  const auto line = sums.line(sums.joint() / sums.spread());
  out.eave = line.at_zero, out.ridge = line.at_zero + half * line.slope;
  return out;
}

TEST(StandardErrors, of_planted_roofs_are_right) {
  constexpr std::size_t houses = 400;
  constexpr double noise = 0.05;
  model::Accuracy accuracy;
  accuracy.noise = noise / std::sqrt(2), accuracy.correlated_area = 0.25;  // along the normal of a pitch of 45°
  accuracy.blur = accuracy.edge_noise = 0;
  struct Counted {
    const char* name;
    std::size_t one = 0, two = 0;
    void add(double error, std::optional<double> of) {
      ASSERT_TRUE(of) << name;
      one += std::abs(error) <= *of, two += std::abs(error) <= 2 * *of;
    }
  };
  Counted eave{"ms_h_eave_se"}, ridge{"ms_h_ridge_se"}, half{"ms_h_roof_50p_se"}, volume{"ms_volume_lod22_se"};
  for (std::size_t seed = 0; seed < houses; ++seed) {
    base::Random random(seed);
    const double common = 0.5 * accuracy.noise * draw(random), ground = 0.02 * draw(random);
    const auto scan = scanned(noise, common, random);
    const auto house = house_of(scan.eave, scan.ridge);
    const auto all = report::standard_errors(house, {rays::Scene(scan.mesh), accuracy, 0.02});
    eave.add(scan.eave - 7.25, number(all, eave.name));
    ridge.add(scan.ridge - 11.25, number(all, ridge.name));
    half.add((scan.eave + scan.ridge) / 2 - 9.25, number(all, half.name));
    // Ground and roof have the same common error.
    volume.add(80 * ((scan.eave + scan.ridge) / 2 - 9.25 - common + ground), number(all, volume.name));
  }
  for (const auto& counted : {ridge, half, volume}) {
    EXPECT_NEAR(static_cast<double>(counted.one) / houses, 0.68, 0.08) << counted.name;
    EXPECT_NEAR(static_cast<double>(counted.two) / houses, 0.95, 0.04) << counted.name;
  }
  // The planes here cannot tilt along the eaves, which is allowed for: √(7/4) times as much error as there is.
  for (const auto& counted : {eave}) {
    EXPECT_NEAR(static_cast<double>(counted.one) / houses, 0.81, 0.08) << counted.name;
    EXPECT_NEAR(static_cast<double>(counted.two) / houses, 0.98, 0.03) << counted.name;
  }
}

TEST(StandardErrors, say_that_a_roof_is_not_where_the_scan_is) {
  base::Random random(1);
  model::Accuracy accuracy;
  accuracy.noise = 0.01, accuracy.correlated_area = 0.25;
  const auto scan = scanned(0.01, 0, random);
  const auto right = report::standard_errors(house_of(7.25, 11.25), {rays::Scene(scan.mesh), accuracy, 0.02});
  const auto wrong = report::standard_errors(house_of(7.25, 11.75), {rays::Scene(scan.mesh), accuracy, 0.02});
  EXPECT_LT(*number(right, "ms_h_ridge_se"), 0.02);
  EXPECT_GT(*number(wrong, "ms_h_ridge_se"), 0.2);
}

TEST(StandardErrors, are_missing_where_nothing_is_seen) {
  base::Random random(1);
  auto scan = scanned(0.01, 0, random);
  const auto half = [&](const geometry::Triangle& t) { return scan.mesh.vertices[t[0]].y > 4; };
  std::erase_if(scan.mesh.triangles, half);
  const model::Accuracy accuracy;
  const auto house = house_of(7.25, 11.25);
  const auto all = report::standard_errors(house, {rays::Scene(scan.mesh), accuracy, {}});
  EXPECT_FALSE(number(all, "ms_h_ground_se"));
  EXPECT_FALSE(number(all, "ms_volume_lod22_se")) << "one of the two roofs, and no ground";
  EXPECT_FALSE(number(all, "ms_h_ridge_se"));
  EXPECT_TRUE(number(all, "ms_area_ground_se"));
  EXPECT_TRUE(report::standard_errors({}, {rays::Scene(scan.mesh), accuracy, {}}).empty());
}

}  // namespace
