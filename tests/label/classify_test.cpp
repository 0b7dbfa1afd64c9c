#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "label/solids.hpp"
#include "mansard/base/run.hpp"
#include "mansard/label/label.hpp"

namespace {

using mansard::label::classify;
using mansard::label::Options;
using mansard::model::FaceClass;
using solids::box;
using solids::FaceKind;
using solids::gable;
using solids::Solid;
using testing::ElementsAre;

constexpr FaceClass wall = FaceClass::wall, party = FaceClass::party_wall, roof = FaceClass::roof,
                    ground = FaceClass::ground;
constexpr std::size_t east = 1, west = 3;

TEST(Classify, tells_walls_roofs_and_ground_of_a_gable_apart) {
  const auto labelled = classify({gable({0, 0}, {10, 8}, 0, 6, 9)}, {});
  ASSERT_EQ(labelled.size(), 1U);
  EXPECT_THAT(labelled[0].classes, ElementsAre(wall, wall, wall, wall, roof, roof, ground));
}

TEST(Classify, gives_one_class_to_every_face_whatever_its_kind) {
  auto solid = box({0, 0}, {10, 8}, 0, 6);
  solid.faces[0].kind = FaceKind::connector;
  solid.faces[5].kind = FaceKind::terrace;
  EXPECT_THAT(classify({solid}, {})[0].classes, ElementsAre(wall, wall, wall, wall, ground, roof));
}

TEST(Classify, calls_a_side_roof_from_the_wall_angle_on) {
  // The south side leans inward by 0.15 rad and by 0.25 rad.
  for (const double lean : {0.15, 0.25}) {
    auto solid = box({0, 0}, {10, 8}, 0, 6);
    for (const std::size_t v : {4, 5}) solid.vertices[v].y += 6 * std::tan(lean);
    solid.faces[0].normal = {0, -std::cos(lean), std::sin(lean)};
    EXPECT_EQ(classify({solid}, {})[0].classes[0], lean < 0.2 ? wall : roof) << lean;
  }
}

TEST(Classify, finds_the_wall_two_boxes_share) {
  const auto labelled = classify({box({0, 0}, {10, 8}, 0, 6), box({10, 0}, {20, 8}, 0, 6)}, {});
  EXPECT_THAT(labelled[0].classes, ElementsAre(wall, party, wall, wall, ground, roof));
  EXPECT_THAT(labelled[1].classes, ElementsAre(wall, wall, wall, party, ground, roof));
}

TEST(Classify, finds_shared_walls_in_any_position) {
  for (const double angle : {0.3, 1.2, 2.0, 3.9}) {
    const auto put = [&](Solid s) { return solids::moved(std::move(s), angle, {85000, 447000, 3}); };
    const auto labelled = classify({put(box({0, 0}, {10, 8}, 0, 6)), put(box({10, 0}, {20, 8}, 0, 6))}, {});
    EXPECT_EQ(labelled[0].classes[east], party) << angle;
    EXPECT_EQ(labelled[1].classes[west], party) << angle;
    EXPECT_EQ(std::ranges::count(labelled[0].classes, party), 1) << angle;
  }
}

TEST(Classify, wants_more_than_half_of_the_wall_covered) {
  // The neighbour covers 40 % of the tall box's east wall; all of its own west wall is covered.
  const auto labelled = classify({box({0, 0}, {10, 8}, 0, 10), box({10, 0}, {20, 8}, 0, 4)}, {});
  EXPECT_EQ(labelled[0].classes[east], wall);
  EXPECT_EQ(labelled[1].classes[west], party);
}

TEST(Classify, adds_up_the_neighbours_along_one_wall) {
  const auto labelled =
      classify({box({0, 0}, {10, 10}, 0, 6), box({10, 0}, {20, 3}, 0, 6), box({10, 3}, {20, 6}, 0, 6)}, {});
  EXPECT_EQ(labelled[0].classes[east], party);
  // The same three metres twice are not six.
  const auto twice =
      classify({box({0, 0}, {10, 10}, 0, 6), box({10, 0}, {20, 3}, 0, 6), box({10, 0}, {18, 3}, 0, 6)}, {});
  EXPECT_EQ(twice[0].classes[east], wall);
}

TEST(Classify, looks_no_farther_than_the_party_distance) {
  for (const double gap : {0.05, 0.15}) {
    const auto labelled = classify({box({0, 0}, {10, 8}, 0, 6), box({10 + gap, 0}, {20, 8}, 0, 6)}, {});
    EXPECT_EQ(labelled[0].classes[east], gap < 0.1 ? party : wall) << gap;
    EXPECT_EQ(labelled[1].classes[west], gap < 0.1 ? party : wall) << gap;
  }
}

TEST(Classify, does_not_mistake_walls_facing_the_same_way) {
  // Two boxes overlap: their south walls lie in one plane but look the same way.
  const auto labelled = classify({box({0, 0}, {10, 8}, 0, 6), box({0, 0}, {10, 4}, 0, 6)}, {});
  EXPECT_EQ(labelled[0].classes[0], wall);
  EXPECT_EQ(labelled[1].classes[0], wall);
}

TEST(Classify, finds_the_gable_a_neighbour_covers) {
  const auto labelled = classify({gable({0, 0}, {10, 8}, 0, 6, 9), gable({10, 0}, {20, 8}, 0, 6, 9)}, {});
  EXPECT_THAT(labelled[0].classes, ElementsAre(wall, party, wall, wall, roof, roof, ground));
  EXPECT_THAT(labelled[1].classes, ElementsAre(wall, wall, wall, party, roof, roof, ground));
}

TEST(Classify, minds_the_hole_in_a_neighbours_wall) {
  auto neighbour = box({10, 0}, {20, 8}, 0, 6);
  // A passage 6 m wide and 5 m high leaves less than half of the wall.
  const auto first = static_cast<std::uint32_t>(neighbour.vertices.size());
  for (const auto& [y, z] : {std::pair{1.0, 0.5}, {1.0, 5.5}, {7.0, 5.5}, {7.0, 0.5}})
    neighbour.vertices.push_back({10, y, z});
  neighbour.faces[west].loops.push_back({first, first + 1, first + 2, first + 3});
  const auto labelled = classify({box({0, 0}, {10, 8}, 0, 6), neighbour}, {});
  EXPECT_EQ(labelled[0].classes[east], wall);
  EXPECT_EQ(labelled[1].classes[west], party);
}

TEST(Classify, does_not_depend_on_the_order_of_solids) {
  mansard::base::Random random(3);
  std::vector<Solid> solids;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (random.index(4) > 0) {
        const double x = 10.0 * i, y = 8.0 * j;
        solids.push_back(box({x, y}, {x + 10, y + 8}, 0, random.uniform(2, 9)));
      }
  const auto forward = classify(solids, {});
  auto reversed = solids;
  std::ranges::reverse(reversed);
  const auto backward = classify(reversed, {});
  std::size_t parties = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    EXPECT_EQ(forward[i].classes, backward[solids.size() - 1 - i].classes) << i;
    EXPECT_EQ(forward[i].classes.size(), solids[i].faces.size());
    parties += static_cast<std::size_t>(std::ranges::count(forward[i].classes, party));
  }
  EXPECT_GT(parties, 10U);
}

TEST(Areas, add_up_by_class) {
  const auto labelled = classify({gable({0, 0}, {10, 8}, 0, 6, 9), box({10, 0}, {20, 8}, 0, 6)}, {});
  const auto first = mansard::label::areas(labelled[0]), second = mansard::label::areas(labelled[1]);
  EXPECT_NEAR(first.ground, 80, 1e-9);
  EXPECT_NEAR(first.roof_sloped, 100, 1e-9);  // two slopes of 5 m × 10 m
  EXPECT_NEAR(first.roof_flat, 0, 1e-9);
  EXPECT_NEAR(first.wall, 2 * 60 + 60, 1e-9);
  EXPECT_NEAR(first.party_wall, 60, 1e-9);  // 48 of these 60 m² are covered
  EXPECT_NEAR(second.roof_flat, 80, 1e-9);
  EXPECT_NEAR(second.party_wall, 48, 1e-9);
}

TEST(Classify, of_nothing_is_nothing) { EXPECT_TRUE(classify({}, {}).empty()); }

TEST(Options, are_all_listed) {
  Options options;
  const auto list = mansard::label::option_list(options);
  EXPECT_EQ(std::ranges::count(list.options(), false, &mansard::base::Option::advanced), 2);
  EXPECT_TRUE(list.find("wall_angle")->set("0.3").has_value());
  EXPECT_EQ(options.wall_angle, 0.3);
}

}  // namespace
