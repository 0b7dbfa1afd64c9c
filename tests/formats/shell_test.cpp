// Models that stand wall to wall, joined: drawn examples, each with what is left of the walls between them.
#include <gmock/gmock.h>

#include "cities.hpp"
#include "mansard/solid/shell.hpp"

namespace {

using namespace cities;
using mansard::solid::join;
using mansard::solid::Joined;
using testing::ElementsAre;
using testing::IsEmpty;

auto box(double x, double y, double width, double depth, double base, double top) -> Solid {
  return prism(rectangle(x, y, width, depth), base, top).solid;
}

auto joined(const std::vector<Solid>& solids) -> Joined {
  std::vector<const Solid*> all;
  for (const auto& solid : solids) all.push_back(&solid);
  return join(all);
}

/// m² of the faces that look along an axis.
auto area_towards(const Solid& solid, Point3 axis) -> double {
  double sum = 0;
  for (const auto& face : solid.faces)
    if (dot(face.normal, axis) > 0.999) sum += mansard::solid::area(solid, face);
  return sum;
}
const Point3 east{1, 0, 0}, west{-1, 0, 0}, south{0, -1, 0}, up{0, 0, 1}, down{0, 0, -1};

/// One sound shell with the volume of all.
auto one_shell(const std::vector<Solid>& solids, double within = 1e-6) -> Solid {
  const auto all = joined(solids);
  EXPECT_EQ(all.groups.size(), 1U);
  const auto& group = all.groups.front();
  EXPECT_EQ(group.why, "");
  EXPECT_EQ(group.shells.size(), 1U);
  const Solid& shell = group.shells.front();
  for (const auto& fault : mansard::solid::check(shell, 0.12)) ADD_FAILURE() << fault.message;
  double volume = 0;
  for (const auto& solid : solids) volume += mansard::solid::volume(solid);
  EXPECT_NEAR(mansard::solid::volume(shell), volume, within);
  return shell;
}

TEST(Shell, of_two_boxes_keeps_only_what_stands_higher_of_the_wall_between) {
  const Solid shell = one_shell({box(0, 0, 10, 8, 0, 6), box(10, 0, 5, 8, 0, 4)});
  EXPECT_NEAR(area_towards(shell, east), 5 * 0 + 8 * 2 + 8 * 4, 1e-9) << "the step, and the end";
  EXPECT_NEAR(area_towards(shell, west), 8 * 6, 1e-9);
  EXPECT_NEAR(area_towards(shell, up), 15 * 8, 1e-9);
}

TEST(Shell, of_boxes_of_one_height_has_nothing_between) {
  const Solid shell = one_shell({box(0, 0, 10, 8, 0, 6), box(10, 0, 5, 8, 0, 6)});
  EXPECT_NEAR(area_towards(shell, east), 8 * 6, 1e-9);
  EXPECT_NEAR(area_towards(shell, west), 8 * 6, 1e-9);
}

TEST(Shell, of_an_l_has_the_corners_of_both_on_the_longer_wall) {
  const Solid shell = one_shell({box(0, 0, 10, 20, 0, 6), box(10, 5, 5, 8, -1, 4)});
  EXPECT_NEAR(area_towards(shell, east), 20 * 6 - 8 * 4 + 8 * 5, 1e-9);
  EXPECT_NEAR(area_towards(shell, west), 20 * 6 + 8 * 1, 1e-9) << "the annex reaches a metre deeper";
}

TEST(Shell, of_three_around_a_corner) {
  const Solid shell = one_shell({box(0, 0, 10, 10, 0, 9), box(10, 0, 10, 10, 0, 6), box(0, 10, 10, 10, 0, 3)});
  EXPECT_NEAR(area_towards(shell, east), 10 * 9 + 10 * 3, 1e-9) << "of the first its step, of the others their ends";
  EXPECT_NEAR(area_towards(shell, down), 300, 1e-9);
}

TEST(Shell, around_a_courtyard_is_one_with_a_hole) {
  const Solid shell = one_shell(
      {box(0, 0, 30, 10, 0, 9), box(0, 20, 30, 10, 0, 9), box(0, 10, 10, 10, 0, 6), box(20, 10, 10, 10, 0, 12)});
  EXPECT_NEAR(area_towards(shell, down), 800, 1e-9);
  EXPECT_NEAR(area_towards(shell, east), 10 * 9 * 2 + 10 * 12 + 10 * 6, 1e-9) << "the east end, and into the court";
}

TEST(Shell, breaks_roofs_where_a_gable_rises_above_a_flat_roof) {
  // The gable's end is a pentagon of eaves 3 and ridge 7; the flat roof at 5 hides what is lower.
  const Solid shell = one_shell({gable(0, 0, 10, 8, 0, 3, 7).solid, box(10, 0, 6, 8, 0, 5)});
  EXPECT_NEAR(area_towards(shell, west), 8 * 3 + 8 * 4 / 2.0 + 2 * (2 * 2 / 2.0), 1e-9)
      << "of the box two corners show";
  EXPECT_NEAR(area_towards(shell, east), 8 * 5 + 4 * 2 / 2.0, 1e-9) << "of the gable its tip";
}

TEST(Shell, breaks_both_roofs_where_two_gables_cross) {
  const Solid shell = one_shell({gable(0, 0, 10, 8, 0, 3, 7).solid, gable(10, 0, 10, 8, 0, 4, 6).solid});
  EXPECT_EQ(shell.vertices.size(), 4U + 4 + 2 + 4 + 4 + 2 - 2 + 2)
      << "two corners fall together, two crossings are new";
}

TEST(Shell, stands_on_one_corner_of_two_as_two) {
  const auto all = joined({box(0, 0, 10, 10, 0, 9), box(10, 10, 10, 10, 0, 6)});
  EXPECT_EQ(all.groups.size(), 2U);
}

TEST(Shell, of_towers_across_a_corner_is_more_than_one_and_says_why) {
  // Above the low ones four walls meet in one line: no shell can have that.
  const std::vector<Solid> solids{box(0, 0, 10, 10, 0, 9), box(10, 0, 10, 10, 0, 3), box(10, 10, 10, 10, 0, 9),
                                  box(0, 10, 10, 10, 0, 3)};
  const auto all = joined(solids);
  ASSERT_EQ(all.groups.size(), 1U);
  EXPECT_THAT(all.groups[0].of, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(all.groups[0].why, testing::HasSubstr("more than two faces"));
  EXPECT_EQ(all.groups[0].shells.size(), 2U);
  double volume = 0;
  for (const auto& shell : all.groups[0].shells) {
    EXPECT_THAT(mansard::solid::check(shell), IsEmpty());
    volume += mansard::solid::volume(shell);
  }
  EXPECT_NEAR(volume, 2400, 1e-6);
}

TEST(Shell, joins_walls_that_straightening_has_parted) {
  // The north-east corner of the first is 3 cm off the second's wall.
  const Solid bent = prism({{{0, 0}, {10, 0}, {9.97, 8}, {0, 8}}, {}}, 0, 6).solid;
  const Solid shell = one_shell({bent, box(10, 0, 5, 8, 0, 4)}, 0.06 * 8 * 6);
  EXPECT_NEAR(area_towards(shell, up), 15 * 8, 0.2);
}

TEST(Shell, keeps_solids_that_overlap) {
  const auto all = joined({box(0, 0, 10, 8, 0, 6), box(9, 0, 5, 8, 0, 4)});
  EXPECT_EQ(all.groups.size(), 2U) << "no wall of one faces a wall of the other";
}

TEST(Shell, has_a_gap_where_walls_stand_apart) {
  EXPECT_EQ(joined({box(0, 0, 10, 8, 0, 6), box(10.1, 0, 5, 8, 0, 4)}).groups.size(), 2U);
}

TEST(Shell, joins_walls_turned_any_way_and_of_uneven_coordinates) {
  for (int i = 0; i < 40; ++i) {
    const double c = std::cos(0.37 * i), s = std::sin(0.37 * i);
    const auto turn = [&](Solid solid) {
      for (auto& v : solid.vertices)
        v = {std::round((c * v.x - s * v.y) * 1e4) / 1e4, std::round((s * v.x + c * v.y) * 1e4) / 1e4, v.z};
      for (auto& face : solid.faces)
        face.normal = {c * face.normal.x - s * face.normal.y, s * face.normal.x + c * face.normal.y, face.normal.z};
      return solid;
    };
    SCOPED_TRACE(i);
    one_shell({turn(gable(0, 0, 10, 8, 0, 3, 7).solid), turn(gable(10, 1, 10, 5, 0.5, 4.2, 6.3).solid),
               turn(box(3, 8, 12, 4, 0, 2.5))},
              0.3);
  }
}

}  // namespace
