#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "profile/houses.hpp"

namespace {

using namespace houses;  // NOLINT: the fixture of this folder
using mansard::profile::Options;
using mansard::profile::Quality;

constexpr double degree = 3.14159265358979323846 / 180;
constexpr std::size_t south = 0, east = 1, north = 2, west = 3;

class Noise : public testing::TestWithParam<std::tuple<double, bool>> {
 protected:
  [[nodiscard]] auto house(Roof roof) const -> House {
    House h;
    h.roof = std::move(roof);
    h.noise = std::get<0>(GetParam());
    h.walls = std::get<1>(GetParam());
    return h;
  }
};

INSTANTIATE_TEST_SUITE_P(With, Noise, testing::Combine(testing::Values(0.0, 0.05, 0.1), testing::Bool()),
                         [](const auto& tested) {
                           return std::to_string(static_cast<int>(100 * std::get<0>(tested.param))) + "cm" +
                                  (std::get<1>(tested.param) ? "" : "_without_walls");
                         });

void expect_pitch(const mansard::model::Profile& profile, double gutter, double pitch) {
  ASSERT_EQ(profile.size(), 3U) << testing::PrintToString(profile.size());
  EXPECT_NEAR(profile[1].height, gutter, 0.25);
  EXPECT_NEAR(pitch_of(profile, 1), pitch, 3);
}

TEST_P(Noise, a_gable_has_two_pitches_and_two_vertical_ends) {
  const auto footprint = fit(house(gable(9, 40 * degree)));
  expect_pitch(profile_of(footprint, south), 6, 40);
  expect_pitch(profile_of(footprint, north), 6, 40);
  EXPECT_TRUE(is_vertical(profile_of(footprint, east)));
  EXPECT_TRUE(is_vertical(profile_of(footprint, west)));
}

TEST_P(Noise, a_hip_has_four_pitches) {
  const auto footprint = fit(house(hip(14, 9, 35 * degree)));
  for (const auto edge : {south, east, north, west}) {
    SCOPED_TRACE(edge);
    expect_pitch(profile_of(footprint, edge), 6, 35);
  }
}

TEST_P(Noise, a_mansard_has_a_steep_and_a_shallow_pitch) {
  const auto footprint = fit(house(mansard_roof(14, 9)));
  const auto& profile = profile_of(footprint, south);
  ASSERT_EQ(profile.size(), 4U);
  EXPECT_NEAR(profile[1].height, 6, 0.5);
  EXPECT_NEAR(pitch_of(profile, 1), 70, 4);
  EXPECT_NEAR(pitch_of(profile, 2), 25, 4);
}

TEST_P(Noise, a_flat_roof_is_vertical_whatever_its_parapet) {
  const auto footprint = fit(house(flat_with_parapet(14, 9)));
  for (const auto& profile : footprint.plan.profiles) EXPECT_TRUE(is_vertical(profile));
  EXPECT_NEAR(footprint.caps.front(), 9, 0.2);
}

TEST_P(Noise, a_shed_roof_rises_from_its_low_side_only) {
  const auto footprint = fit(house(shed(15 * degree)));
  expect_pitch(profile_of(footprint, south), 4, 15);
  for (const auto edge : {east, north, west}) EXPECT_TRUE(is_vertical(profile_of(footprint, edge))) << edge;
}

TEST_P(Noise, a_box_is_vertical_and_capped_at_its_roof) {
  const auto footprint = fit(house([](double, double) { return 7.0; }));
  for (const auto& profile : footprint.plan.profiles) EXPECT_TRUE(is_vertical(profile));
  EXPECT_NEAR(footprint.plan.cap, 7, 0.15);
}

TEST(Fit, makes_party_walls_between_terraced_houses_vertical) {
  House whole;
  whole.roof = gable(9, 40 * degree);
  whole.length = 18;
  House left = whole, right = whole;
  left.length = 9;
  right.length = 9;
  right.at = placed(whole, 9, 0);
  const auto footprints = fit(scan(whole), {outline(left), outline(right)}, whole.ground);
  ASSERT_EQ(footprints.size(), 2U);
  EXPECT_TRUE(is_vertical(profile_of(footprints[0], east)));
  EXPECT_TRUE(is_vertical(profile_of(footprints[1], west)));
  expect_pitch(profile_of(footprints[0], south), 6, 40);
  expect_pitch(profile_of(footprints[1], north), 6, 40);
}

TEST(Fit, steps_back_over_an_annex_before_the_wall) {
  House house;
  house.width = 12;
  house.roof = [](double, double y) { return y < 3 ? 2.8 : 6 + std::tan(40 * degree) * std::min(y - 3, 12 - y); };
  const auto footprint = fit(house);
  const auto& profile = profile_of(footprint, south);
  ASSERT_EQ(profile.size(), 5U);
  EXPECT_NEAR(profile[1].height, 2.8, 0.2);
  EXPECT_EQ(profile[2].height, profile[1].height);
  EXPECT_NEAR(profile[2].inward, 3, 0.3);
  EXPECT_NEAR(profile[3].height, 6, 0.4);
  EXPECT_NEAR(pitch_of(profile, 3), 40, 3);
  // Fewer pitches are asked for: none of them is a terrace.
  Options options;
  options.quality = Quality::moderate;
  const auto moderate = fit(house, options);
  EXPECT_LE(profile_of(moderate, south).size(), 3U);
}

TEST(Fit, lets_a_bevelled_corner_follow_the_roof_beside_it) {
  House house;
  house.roof = gable(9, 40 * degree);
  auto polygon = outline(house);
  // The south side's last half metre turns in by 0.3 rad.
  polygon.outer = {placed(house, 0, 0), placed(house, 13.5, 0), placed(house, 14, 0.15), placed(house, 14, 9),
                   placed(house, 0, 9)};
  const auto footprint = fit(scan(house), {polygon}, house.ground).front();
  EXPECT_NE(footprint.plan.outer.profile_of_edge[0], footprint.plan.outer.profile_of_edge[1]);
  EXPECT_EQ(profile_of(footprint, 1), profile_of(footprint, 0));
}

TEST(Fit, simple_gives_walls_only) {
  House house;
  house.roof = hip(14, 9, 35 * degree);
  Options options;
  options.quality = Quality::simple;
  const auto footprint = fit(house, options);
  for (const auto& profile : footprint.plan.profiles) {
    EXPECT_EQ(profile.size(), 2U);
    EXPECT_TRUE(is_vertical(profile));
  }
}

TEST(Fit, moderate_gives_at_most_one_pitch) {
  House house;
  house.roof = mansard_roof(14, 11);
  house.width = 11;
  Options options;
  options.quality = Quality::moderate;
  for (const auto& profile : fit(house, options).plan.profiles) EXPECT_EQ(profile.size(), 3U);
}

TEST(Fit, keeps_the_rings_of_the_part_as_they_are) {
  House house;
  house.roof = gable(9, 40 * degree);
  auto polygon = outline(house);
  polygon.holes.push_back({placed(house, 4, 4), placed(house, 4, 6), placed(house, 7, 6), placed(house, 7, 4)});
  const auto footprint = fit(scan(house), {polygon}, house.ground).front();
  EXPECT_EQ(mansard::model::polygon_of(footprint.plan), polygon);
  EXPECT_EQ(footprint.plan.base, house.ground);
  ASSERT_EQ(footprint.plan.holes.size(), 1U);
  EXPECT_EQ(footprint.plan.holes[0].profile_of_edge.size(), 4U);
  EXPECT_EQ(footprint.evidence.size(), footprint.plan.profiles.size());
}

TEST(Fit, gives_the_edges_of_a_straight_run_one_profile) {
  House house;
  house.roof = gable(9, 40 * degree);
  auto polygon = outline(house);
  polygon.outer.insert(polygon.outer.begin() + 1, placed(house, 7, -0.1));
  const auto footprint = fit(scan(house), {polygon}, house.ground).front();
  EXPECT_EQ(footprint.plan.outer.profile_of_edge[0], footprint.plan.outer.profile_of_edge[1]);
  EXPECT_EQ(footprint.plan.profiles.size(), 4U);
}

TEST(Fit, remembers_how_far_outward_the_wall_stands) {
  House house;
  house.roof = [](double, double) { return 7.0; };
  House drawn = house;  // its south edge half a metre inside the wall, its north edge as much outside
  drawn.at = placed(house, 0, 0.5);
  const auto footprint = fit(scan(house), {outline(drawn)}, house.ground).front();
  EXPECT_NEAR(footprint.evidence[footprint.plan.outer.profile_of_edge[south]].offset, 0.5, 0.1);
  EXPECT_NEAR(footprint.evidence[footprint.plan.outer.profile_of_edge[north]].offset, -0.5, 0.1);
}

TEST(Fit, finds_the_gutter_where_the_footprint_is_drawn_a_little_off) {
  House house;
  house.roof = gable(9, 40 * degree);
  for (const double off : {-0.5, 0.5}) {
    SCOPED_TRACE(off);
    House drawn = house;
    drawn.at = placed(house, 0, off);
    const auto footprint = fit(scan(house), {outline(drawn)}, house.ground).front();
    // The roof stays where it was scanned, so the drawn edge meets it higher or lower.
    expect_pitch(profile_of(footprint, south), 6 + off * std::tan(40 * degree), 40);
    expect_pitch(profile_of(footprint, north), 6 - off * std::tan(40 * degree), 40);
  }
}

TEST(Fit, looks_past_cars_hedges_and_dormers) {
  House house;
  house.roof = [](double x, double y) {
    const double roof = 6 + std::tan(40 * degree) * std::min(y, 9 - y);
    const bool dormer = y > 0.8 && y < 3 && (std::abs(x - 4) < 1 || std::abs(x - 10) < 1);
    return dormer ? std::max(roof, 8.6) : roof;
  };
  auto mesh = scan(house);
  House hedge = house;
  hedge.length = 6;
  hedge.width = 0.8;
  hedge.at = placed(house, 3, -1.2);
  hedge.roof = [](double, double) { return 1.6; };
  const auto more = scan(hedge);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const auto footprint = fit(mesh, {outline(house)}, house.ground).front();
  expect_pitch(profile_of(footprint, south), 6, 40);
}

TEST(Fit, without_any_mesh_assumes_walls) {
  House house;
  house.roof = gable(9, 40 * degree);
  const auto footprint = fit({}, {outline(house)}, house.ground).front();
  for (const auto& profile : footprint.plan.profiles) EXPECT_TRUE(is_vertical(profile));
  for (const auto& evidence : footprint.evidence) {
    EXPECT_EQ(evidence.slices, 0U);
    EXPECT_GT(evidence.attempted, 0U);
  }
  ASSERT_FALSE(footprint.caps.empty());
  EXPECT_GT(footprint.caps.front(), 0);
}

TEST(Fit, gives_a_part_below_a_crown_the_height_from_which_that_rises) {
  House house;
  house.roof = [](double x, double) { return 7 + 0.02 * x; };
  const auto crown = scan(house);
  const auto block = block_of({}, {outline(house)}, house.ground);
  mansard::segment::Segmentation segmentation;
  segmentation.parts.push_back(part_of(outline(house)));
  const mansard::rays::Scene nothing({}), above(crown);
  const auto hidden = mansard::profile::fit(segmentation, block, nothing, {}, {}, &above);
  EXPECT_NEAR(hidden[0].plan.cap, 7, 0.3);
  EXPECT_LT(mansard::profile::fit(segmentation, block, nothing, {})[0].plan.cap, 4) << "assumed";
}

TEST(Fit, takes_the_ground_of_the_parts_feature) {
  House house;
  house.roof = gable(9, 40 * degree);
  const auto mesh = scan(house);
  auto block = block_of(mesh, {outline(house)}, house.ground);
  block.members.push_back({5, {outline(house)}, house.ground - 1});
  mansard::segment::Segmentation segmentation;
  for (const std::optional<std::size_t> feature : {std::optional<std::size_t>(5), std::optional<std::size_t>()}) {
    segmentation.parts.push_back(part_of(outline(house)));
    segmentation.parts.back().feature = feature;
  }
  block.ground = house.ground + 0.5;
  const auto footprints = mansard::profile::fit(segmentation, block, mansard::rays::Scene(mesh), {});
  EXPECT_EQ(footprints[0].plan.base, house.ground - 1);
  EXPECT_EQ(footprints[1].plan.base, house.ground + 0.5);
  EXPECT_NEAR(profile_of(footprints[0], south)[1].height, 7, 0.25);
}

TEST(Fit, is_the_same_at_one_and_two_threads) {
  House house;
  house.roof = mansard_roof(14, 9);
  House second = house;
  second.at = placed(house, 20, 3);
  const auto run = [&](std::size_t threads) {
    mansard::base::limit_threads(threads);
    auto footprints = fit(scan(house), {outline(house), outline(second)}, house.ground);
    mansard::base::limit_threads(0);
    return footprints;
  };
  const auto one = run(1), two = run(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].plan, two[i].plan);
    EXPECT_EQ(one[i].caps, two[i].caps);
  }
}

TEST(Fit, stops_when_asked_and_still_gives_every_part_a_plan) {
  House house;
  house.roof = gable(9, 40 * degree);
  const auto mesh = scan(house);
  const auto block = block_of(mesh, {outline(house)}, house.ground);
  mansard::segment::Segmentation segmentation;
  segmentation.parts.push_back(part_of(outline(house)));
  mansard::base::Cancel cancel;
  cancel.request();
  mansard::base::Run run;
  run.cancel = &cancel;
  const auto footprints = mansard::profile::fit(segmentation, block, mansard::rays::Scene(mesh), {}, run);
  ASSERT_EQ(footprints.size(), 1U);
  for (const auto& evidence : footprints[0].evidence) EXPECT_EQ(evidence.attempted, 0U);
}

TEST(Vertical_plan, has_one_profile_for_every_edge) {
  House house;
  auto polygon = outline(house);
  polygon.holes.push_back({placed(house, 4, 4), placed(house, 4, 6), placed(house, 7, 6)});
  const auto plan = mansard::profile::vertical_plan(polygon, 3, 8);
  EXPECT_EQ(mansard::model::polygon_of(plan), polygon);
  ASSERT_EQ(plan.profiles.size(), 1U);
  EXPECT_TRUE(is_vertical(plan.profiles[0]));
  EXPECT_THAT(plan.outer.profile_of_edge, testing::Each(0U));
  EXPECT_EQ(plan.base, 3);
  EXPECT_EQ(plan.cap, 8);
}

// The guarantees of the public function, over random houses.
TEST(Fit, keeps_its_guarantees_on_random_houses) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(seed);
    mansard::base::Random random(seed);
    House house;
    house.length = random.uniform(2, 16);
    house.width = random.uniform(2, 12);
    house.noise = random.uniform(0, 0.3);
    house.walls = random.index(2) == 0;
    house.turned = random.uniform(0, 6.28);
    house.seed = seed;
    const double pitch = random.uniform(0, 1.4), skew = random.uniform(-0.5, 0.5);
    house.roof = [=](double x, double y) { return 3 + std::abs(std::sin(x + 2 * y)) + pitch * y + skew * x; };
    const auto mesh = scan(house);
    Options options;
    options.quality = static_cast<Quality>(random.index(3));
    const auto footprint = fit(mesh, {outline(house)}, house.ground, options).front();
    double low = 1e9, high = -1e9;
    for (const auto& v : mesh.vertices) {
      low = std::min(low, v.z - house.ground);
      high = std::max(high, v.z - house.ground);
    }
    for (const auto& profile : footprint.plan.profiles) {
      ASSERT_GE(profile.size(), 2U);
      EXPECT_EQ(profile.front(), (mansard::model::ProfilePoint{0, 0}));
      for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        EXPECT_GE(profile[i + 1].inward, profile[i].inward);
        EXPECT_GE(profile[i + 1].height, profile[i].height);
        EXPECT_FALSE(profile[i + 1] == profile[i]);
      }
      if (options.quality == Quality::simple) {
        EXPECT_EQ(profile.size(), 2U);
      }
      if (options.quality == Quality::moderate) {
        EXPECT_LE(profile.size(), 3U);
      }
    }
    ASSERT_FALSE(footprint.caps.empty());
    EXPECT_EQ(footprint.caps.front(), footprint.plan.cap);
    for (const double cap : footprint.caps) {
      EXPECT_GT(cap, 0);
      EXPECT_GE(cap, low);
      EXPECT_LE(cap, high + 0.5);
    }
  }
}

TEST(Options, are_all_listed_with_their_defaults) {
  Options options;
  const auto list = mansard::profile::option_list(options);
  EXPECT_EQ(list.module(), "profile");
  EXPECT_EQ(std::ranges::count(list.options(), false, &mansard::base::Option::advanced), 10);
  ASSERT_NE(list.find("quality"), nullptr);
  EXPECT_EQ(list.find("quality")->get(), "high");
  EXPECT_TRUE(list.find("quality")->set("moderate").has_value());
  EXPECT_EQ(options.quality, Quality::moderate);
  EXPECT_FALSE(list.find("support")->set("1.5").has_value());
}

}  // namespace
