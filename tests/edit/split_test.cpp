#include <gmock/gmock.h>

#include "edit/plans.hpp"

namespace mansard::edit {
namespace {

using geometry::Point2;
using geometry::Polygon;
using model::Plan;
using testing::HasSubstr;

auto split_at(const Plan& plan, const std::vector<Point2>& line) -> std::vector<Plan> {
  auto pieces = split(plan, line);
  EXPECT_TRUE(pieces) << base::to_string(pieces.error());
  return pieces ? std::move(*pieces) : std::vector<Plan>();
}

auto refusal_of(const Plan& plan, const std::vector<Point2>& line) -> std::string {
  const auto pieces = split(plan, line);
  EXPECT_FALSE(pieces);
  if (pieces) return {};
  EXPECT_EQ(pieces.error().code, "edit-split");
  return pieces.error().message;
}

TEST(Split, cuts_a_house_into_two_that_keep_its_profiles_and_share_a_wall) {
  const auto pieces = split_at(test::house(), {{6, -1}, {6, 9}});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(test::area_of(pieces[0]), 48, 1e-12);
  EXPECT_NEAR(test::area_of(pieces[1]), 32, 1e-12);
  for (const auto& piece : pieces) {
    const double x = &piece == &pieces[0] ? 3 : 8;
    EXPECT_EQ(*test::profile_at(piece, {x, 0}), test::pitch);
    EXPECT_EQ(*test::profile_at(piece, {x, 8}), test::pitch);
    EXPECT_EQ(*test::profile_at(piece, {6, 4}), test::wall);
    EXPECT_EQ(piece.outer.points.size(), 4U);
    EXPECT_EQ(piece.base, 0);
    EXPECT_EQ(piece.cap, 9);
  }
}

TEST(Split, leaves_eaves_with_the_edges_that_have_them_and_merge_brings_them_together) {
  auto house = test::house();
  house.outer.overhang_of_edge.assign(house.outer.points.size(), 0);
  const auto overhang_at = [](const Plan& plan, Point2 at) {
    for (std::size_t i = 0; i < plan.outer.overhang_of_edge.size(); ++i)
      if (const auto& a = plan.outer.points[i], &b = plan.outer.points[(i + 1) % plan.outer.points.size()];
          geometry::distance({a, b}, at) < 0.01)
        return plan.outer.overhang_of_edge[i];
    return -1.0;
  };
  for (std::size_t i = 0; i < house.outer.points.size(); ++i)
    if (house.outer.points[i].y == 0 && house.outer.points[(i + 1) % house.outer.points.size()].y == 0)
      house.outer.overhang_of_edge[i] = 0.4;
  const auto pieces = split_at(house, {{6, -1}, {6, 9}});
  ASSERT_EQ(pieces.size(), 2U);
  for (const auto& piece : pieces) {
    ASSERT_EQ(piece.outer.overhang_of_edge.size(), piece.outer.points.size());
    EXPECT_EQ(overhang_at(piece, {&piece == &pieces[0] ? 3.0 : 8.0, 0}), 0.4);
    EXPECT_EQ(overhang_at(piece, {&piece == &pieces[0] ? 3.0 : 8.0, 8}), 0);
    EXPECT_EQ(overhang_at(piece, {6, 4}), 0);
  }
  const auto whole = merge(pieces[0], pieces[1]);
  ASSERT_TRUE(whole) << base::to_string(whole.error());
  EXPECT_EQ(overhang_at(*whole, {3, 0}), 0.4);
  EXPECT_EQ(overhang_at(*whole, {3, 8}), 0);
  EXPECT_TRUE(split_at(test::house(), {{6, -1}, {6, 9}})[0].outer.overhang_of_edge.empty());
}

TEST(Split, follows_a_line_with_corners) {
  const auto pieces = split_at(test::house(), {{4, -1}, {4, 4}, {7, 4}, {7, 9}});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(test::area_of(pieces[0]), 4 * 4 + 7 * 4, 1e-12);
  EXPECT_NEAR(test::area_of(pieces[1]), 6 * 4 + 3 * 4, 1e-12);
}

TEST(Split, makes_as_many_plans_as_the_line_divides_off_largest_first) {
  const auto comb = test::plan_of(
      {{{0, 0}, {12, 0}, {12, 6}, {9, 6}, {9, 2}, {6, 2}, {6, 5}, {3, 5}, {3, 2}, {0, 2}}, {}}, {test::pitch});
  const auto pieces = split_at(comb, {{-1, 4}, {13, 4}});
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(test::area_of(pieces[0]), 24 + 3 * 2 + 3 * 2, 1e-12);
  EXPECT_NEAR(test::area_of(pieces[1]), 3 * 2, 1e-12);
  EXPECT_NEAR(test::area_of(pieces[2]), 3 * 1, 1e-12);
}

TEST(Split, goes_through_a_courtyard_but_not_into_one) {
  const auto around =
      test::plan_of({test::rectangle(0, 0, 12, 12).outer, {{{4, 4}, {4, 8}, {8, 8}, {8, 4}}}}, {test::pitch});
  const auto pieces = split_at(around, {{-1, 6}, {13, 6}});
  ASSERT_EQ(pieces.size(), 2U);
  for (const auto& piece : pieces) {
    EXPECT_NEAR(test::area_of(piece), 64, 1e-12);
    EXPECT_TRUE(piece.holes.empty());
    EXPECT_EQ(piece.outer.points.size(), 8U);
  }
  EXPECT_THAT(refusal_of(around, {{-1, 6}, {6, 6}}), HasSubstr("does not divide"));
}

TEST(Split, leaves_courtyards_that_it_does_not_touch_where_they_are) {
  const auto around =
      test::plan_of({test::rectangle(0, 0, 20, 12).outer, {{{4, 4}, {4, 8}, {8, 8}, {8, 4}}}}, {test::pitch});
  const auto pieces = split_at(around, {{12, -1}, {12, 13}});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].holes.size(), 1U);
  EXPECT_NEAR(test::area_of(pieces[0]), 12 * 12 - 16, 1e-12);
  EXPECT_TRUE(pieces[1].holes.empty());
}

TEST(Split, takes_ends_within_a_centimetre_to_be_on_the_outline_and_in_its_corners) {
  const auto diagonal = split_at(test::house(), {{0.005, 0.004}, {9.996, 8.003}});
  ASSERT_EQ(diagonal.size(), 2U);
  EXPECT_EQ(diagonal[0].outer.points.size(), 3U);
  EXPECT_EQ(diagonal[1].outer.points.size(), 3U);
  EXPECT_NEAR(test::area_of(diagonal[0]), 40, 1e-12);
  EXPECT_EQ(split_at(test::house(), {{6, 0.008}, {6, 7.995}}).size(), 2U);
  EXPECT_THAT(refusal_of(test::house(), {{6, 0.05}, {6, 9}}), HasSubstr("does not divide"));
}

TEST(Split, leaves_out_of_the_line_what_divides_nothing) {
  // In from the south and out again, then across; and a tail that ends inside.
  const auto pieces = split_at(test::house(), {{5, -1}, {5, 9}, {8, 9}, {8, 6}});
  ASSERT_EQ(pieces.size(), 2U);
  for (const auto& piece : pieces) EXPECT_EQ(piece.outer.points.size(), 4U);
}

TEST(Split, refuses_lines_that_divide_nothing_and_says_what_to_do) {
  const auto house = test::house();
  EXPECT_THAT(refusal_of(house, {}), HasSubstr("does not divide"));
  EXPECT_THAT(refusal_of(house, {{5, 5}}), HasSubstr("does not divide"));
  EXPECT_THAT(refusal_of(house, {{20, 0}, {20, 9}}), HasSubstr("does not divide"));
  EXPECT_THAT(refusal_of(house, {{0, 0}, {10, 0}}), HasSubstr("does not divide"));
  EXPECT_THAT(refusal_of(house, {{2, -1}, {2, 5}, {5, 5}, {5, 2}, {-1, 2}}), HasSubstr("crosses itself"));
  EXPECT_THAT(refusal_of(house, {{-1, 4}, {6, 4}, {-1, 4}}), HasSubstr("crosses itself"));
  EXPECT_THAT(refusal_of(house, {{0.05, -1}, {0.05, 0.05}, {-1, 0.05}}), HasSubstr("cuts off 0.0025 m²"));
  EXPECT_THAT(refusal_of(house, {{5, -1}, {5, std::nan("")}}), HasSubstr("not finite"));
}

TEST(Split, gives_the_new_parts_of_a_building_the_next_free_ids) {
  const std::vector<NamedPlan> parts{{"b-1", test::house()}, {"b-3", test::house(20)}};
  const std::vector<Point2> line{{3, -1}, {3, 9}, {5, 9}, {5, -1}};
  const auto after = split("b", parts, "b-1", line);
  ASSERT_TRUE(after);
  ASSERT_EQ(after->size(), 4U);
  EXPECT_EQ((*after)[0].id, "b-1");
  EXPECT_NEAR(test::area_of((*after)[0].plan), 40, 1e-12);
  EXPECT_EQ((*after)[1].id, "b-4");
  EXPECT_EQ((*after)[2].id, "b-5");
  EXPECT_EQ((*after)[3], parts[1]);
  EXPECT_EQ(split("b", parts, "b-2", line).error().code, "edit-part");
  const std::vector<Point2> outside{{30, 0}, {31, 0}};
  EXPECT_EQ(split("b", parts, "b-3", outside).error().subject, "b-3");
}

/// A line from outside to outside with a few corners within.
auto random_line(base::Random& random) -> std::vector<Point2> {
  const double angle = random.uniform(0, 6.28), away = angle + random.uniform(1.5, 4.7);
  std::vector<Point2> line{{15 * std::cos(angle), 15 * std::sin(angle)}};
  for (std::size_t i = random.index(4); i > 0; --i) line.push_back({random.uniform(-8, 8), random.uniform(-8, 8)});
  line.push_back({15 * std::cos(away), 15 * std::sin(away)});
  return line;
}

/// No corner within 3 cm of another, or of an edge that is not its own: merge takes what is within a centimetre for
/// one.
auto well_apart(const std::vector<Plan>& pieces) -> bool {
  std::vector<geometry::Segment2> edges;
  for (const auto& piece : pieces)
    for (std::size_t i = 0; i < piece.outer.points.size(); ++i)
      edges.push_back({piece.outer.points[i], piece.outer.points[(i + 1) % piece.outer.points.size()]});
  for (const auto& [p, unused] : edges)
    for (const auto& edge : edges)
      if (p != edge.start && p != edge.end && geometry::distance(edge, p) < 0.03) return false;
  return true;
}

auto merged(std::vector<Plan> pieces) -> std::optional<Plan> {
  while (pieces.size() > 1) {
    bool any = false;
    for (std::size_t i = 0; i < pieces.size() && !any; ++i)
      for (std::size_t j = i + 1; j < pieces.size() && !any; ++j)
        if (auto one = merge(pieces[i], pieces[j])) {
          pieces[i] = std::move(*one);
          pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
          any = true;
        }
    if (!any) return std::nullopt;
  }
  return pieces.front();
}

TEST(Split, is_undone_by_merge_over_random_outlines_and_lines) {
  std::size_t cut = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Random random(seed);
    Polygon polygon = test::star(random, 5 + random.index(12));
    if (random.index(2) == 0) polygon.holes.push_back({{-0.8, -0.7}, {-0.6, 0.9}, {0.8, 0.7}, {0.5, -0.9}});
    const auto whole = test::plan_of(polygon, {test::pitch, test::wall, {{0, 0}, {0, 4}, {1, 4}, {3, 7}}}, 1.5);
    auto line = random_line(random);
    if (random.index(4) == 0) line.front() = polygon.outer[random.index(polygon.outer.size())];
    const auto pieces = split(whole, line);
    if (!pieces || !well_apart(*pieces)) continue;
    ++cut;
    double sum = 0;
    for (const auto& piece : *pieces) {
      sum += test::area_of(piece);
      ASSERT_TRUE(geometry::is_simple(model::polygon_of(piece)));
      for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
        const Point2 middle = 0.5 * (polygon.outer[i] + polygon.outer[(i + 1) % polygon.outer.size()]);
        if (const auto* profile = test::profile_at(piece, middle)) {
          EXPECT_EQ(*profile, *test::profile_at(whole, middle));
        }
      }
    }
    ASSERT_NEAR(sum, geometry::area(polygon), 1e-9);
    const auto again = merged(*pieces);
    ASSERT_TRUE(again);
    ASSERT_LT(test::difference(model::polygon_of(*again), polygon), 1e-9);
    ASSERT_EQ(again->outer.points.size(), whole.outer.points.size());
    for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
      const Point2 middle = 0.5 * (polygon.outer[i] + polygon.outer[(i + 1) % polygon.outer.size()]);
      ASSERT_NE(test::profile_at(*again, middle), nullptr);
      EXPECT_EQ(*test::profile_at(*again, middle), *test::profile_at(whole, middle));
    }
    EXPECT_EQ(again->base, whole.base);
    EXPECT_EQ(again->cap, whole.cap);
  }
  EXPECT_GT(cut, 1200U);  // the rest cross themselves or miss
}

}  // namespace
}  // namespace mansard::edit
