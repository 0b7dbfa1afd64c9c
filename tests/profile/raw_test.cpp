#include "mansard/profile/raw.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "profile/houses.hpp"

namespace {

using namespace mansard;

/// 14 by 9 m, walls of 6 m, a roof of 45° along x; no noise.
auto gabled() -> houses::House {
  houses::House house;
  house.roof = houses::gable(house.width, std::atan(1.0));
  house.noise = 0;
  return house;
}

TEST(RawProfiles, go_up_the_wall_and_the_roof_behind_an_edge) {
  const auto house = gabled();
  const auto mesh = houses::scan(house);
  const profile::RawProfiles raw(mesh);
  const auto outline = houses::outline(house);
  for (const std::size_t edge : {0U, 2U}) {
    const auto slices = raw.behind(outline, 0, edge, house.ground, {});
    ASSERT_EQ(slices.size(), 67U);  // every 0.2 m of 14 m without 0.3 m at both ends
    for (const auto& slice : slices) {
      EXPECT_NEAR(length(slice.foot - outline.outer[edge]), slice.along, 1e-9);
      double before = -1e9, eaves = 1e9;
      for (const auto& p : slice.points) {
        EXPECT_GE(p.height, before);
        before = p.height;
        if (p.inward > 0.5) {
          EXPECT_NEAR(p.height, 6 + p.inward, 0.6) << p.inward;
        }
        eaves = std::min(eaves, std::hypot(p.inward, p.height - 6));
      }
      EXPECT_LT(eaves, 0.6);
      EXPECT_NEAR(before, 6 + house.width / 2, 0.6);
    }
  }
}

TEST(RawProfiles, measure_heights_from_the_base) {
  const auto house = gabled();
  const auto mesh = houses::scan(house);
  const profile::RawProfiles raw(mesh);
  const auto low = raw.behind(houses::outline(house), 0, 0, house.ground, {});
  const auto high = raw.behind(houses::outline(house), 0, 0, house.ground + 1, {});
  ASSERT_EQ(low.size(), high.size());
  for (std::size_t i = 0; i < low.size(); ++i)
    EXPECT_NEAR(low[i].points.back().height, high[i].points.back().height + 1, 1e-9);
}

TEST(RawProfiles, are_none_where_nothing_stands) {
  const auto house = gabled();
  const auto mesh = houses::scan(house);
  const profile::RawProfiles raw(mesh);
  EXPECT_TRUE(raw.behind({{{900, 900}, {910, 900}, {910, 910}, {900, 910}}, {}}, 0, 0, 0, {}).empty());
}

}  // namespace
