#include <gmock/gmock.h>

#include "mansard/base/run.hpp"
#include "mansard/ingest/detail/rings.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Point2;
using geometry::Ring;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Ring square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
auto box(double x0, double y0, double x1, double y1) -> Ring { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

auto mend(const std::vector<formats::RawPolygon>& parts) -> Repaired {
  auto out = repair(parts, {1000, 2000});
  EXPECT_EQ(out.polygons.empty(), out.defect.has_value());
  for (const auto& polygon : out.polygons) {
    EXPECT_TRUE(geometry::is_simple(polygon));
    EXPECT_GT(geometry::signed_area(polygon.outer), 0);
    for (const auto& hole : polygon.holes) EXPECT_LT(geometry::signed_area(hole), 0);
  }
  return out;
}
auto code(const Repaired& repaired) -> std::string { return repaired.defect ? repaired.defect->code : ""; }

TEST(Rings, of_any_orientation_and_closed_or_not_come_out_oriented) {
  Ring closed = square, backwards(square.rbegin(), square.rend());
  closed.push_back(closed.front());
  for (const Ring& outer : {square, closed, backwards})
    for (const Ring& hole : {box(2, 2, 4, 4), Ring{{2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}}) {
      const auto out = mend({{outer, hole}});
      ASSERT_EQ(out.polygons.size(), 1U);
      EXPECT_EQ(geometry::area(out.polygons[0]), 96);
      EXPECT_THAT(out.repairs, IsEmpty());
    }
}

TEST(Rings, lose_repeated_points_silently) {
  const auto out = mend({{{{0, 0}, {0, 0}, {10, 0}, {10, 0.0004}, {10, 10}, {0, 10}, {0, 10}, {0, 0.0002}}}});
  ASSERT_EQ(out.polygons.size(), 1U);
  EXPECT_EQ(out.polygons[0].outer.size(), 4U);
  EXPECT_THAT(out.repairs, IsEmpty());
}

TEST(Rings, lose_spikes_with_a_word_and_keep_points_on_straight_edges) {
  for (const Ring& ring :
       {Ring{{0, 0}, {10, 0}, {15, 0}, {10, 0}, {10, 10}, {0, 10}}, Ring{{0, 0}, {10, 0}, {10, 20}, {10, 10}, {0, 10}},
        Ring{{0, 0}, {5, 0}, {5, -7}, {5, -9}, {5, -3}, {5, 0}, {10, 0}, {10, 10}, {0, 10}}}) {
    const auto out = mend({{ring}});
    ASSERT_EQ(out.polygons.size(), 1U);
    EXPECT_EQ(geometry::area(out.polygons[0]), 100);
    EXPECT_THAT(out.repairs, ::testing::ElementsAre(HasSubstr("spike")));
  }
  const auto straight = mend({{{{0, 0}, {5, 0}, {10, 0}, {10, 10}, {0, 10}}}});
  EXPECT_EQ(straight.polygons.at(0).outer.size(), 5U);
}

TEST(Rings, that_cross_like_a_bow_tie_are_a_defect_that_says_where) {
  const auto even = mend({{{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}});
  EXPECT_EQ(code(even), "ingest-footprint-crossing");
  EXPECT_THAT(even.defect->message, HasSubstr("(1005.00, 2005.00)"));
  EXPECT_EQ(code(mend({{{{0, 0}, {10, 10}, {10, 0}, {0, 4}}}})), "ingest-footprint-crossing");
}

TEST(Rings, with_a_tiny_loop_are_repaired_with_a_word) {
  const auto out = mend({{{{0, 0}, {10, 0}, {10, 10}, {5, 10}, {5.2, 10.2}, {5, 10.2}, {5.2, 10}, {0, 10}}}});
  EXPECT_EQ(code(out), "");
  EXPECT_NEAR(geometry::area(out.polygons.at(0)), 100, 0.5);
  EXPECT_EQ(out.repairs.size(), 1U);
}

TEST(Rings, without_area_are_a_defect) {
  EXPECT_EQ(code(mend({{{{0, 0}, {10, 0}}}})), "ingest-footprint-area");
  EXPECT_EQ(code(mend({{{{0, 0}, {10, 0}, {5, 0}}}})), "ingest-footprint-area");
  EXPECT_EQ(code(mend({{{{3, 3}, {3, 3}, {3, 3}, {3, 3}}}})), "ingest-footprint-area");
  EXPECT_EQ(code(mend({{{}}})), "ingest-footprint-area");
  EXPECT_EQ(code(mend({{{{0, 0}, {10, 0}, {10, 0.0009}, {0, 0.0009}}}})), "ingest-footprint-area");
  const auto one = mend({{square}, {{{20, 0}, {30, 0}, {25, 0}}}});
  EXPECT_EQ(one.polygons.size(), 1U);
  EXPECT_EQ(one.repairs.size(), 2U);  // the spike, and the part
}

TEST(Rings, with_coordinates_that_are_no_numbers_are_a_defect) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(mend({{{{0, 0}, {10, nan}, {10, 10}}}})), "ingest-footprint-coordinates");
  EXPECT_EQ(code(mend({{{{0, 0}, {1e300, 0}, {10, 10}}}})), "ingest-footprint-coordinates");
}

TEST(Rings, with_holes_outside_or_overlapping_are_a_defect) {
  EXPECT_EQ(code(mend({{square, box(20, 20, 24, 24)}})), "ingest-footprint-holes");
  EXPECT_EQ(code(mend({{square, box(8, 2, 12, 8)}})), "ingest-footprint-holes");
  EXPECT_EQ(code(mend({{square, box(2, 2, 6, 6), box(4, 4, 8, 8)}})), "ingest-footprint-holes");
  EXPECT_EQ(code(mend({{square, box(2, 2, 8, 8), box(4, 4, 6, 6)}})), "ingest-footprint-holes");
}

TEST(Rings, that_touch_are_held_apart_by_a_small_bridge) {
  // A courtyard whose corner lies on the outer wall, on a corner of the outer wall, and on another courtyard.
  for (const formats::RawPolygon& raw :
       {formats::RawPolygon{square, {{5, 0}, {7, 4}, {3, 4}}}, formats::RawPolygon{square, {{0, 0}, {6, 2}, {2, 6}}},
        formats::RawPolygon{square, box(2, 2, 4, 4), box(4, 4, 6, 6)}}) {
    const auto out = mend({raw});
    ASSERT_EQ(out.polygons.size(), 1U);
    EXPECT_EQ(out.polygons[0].holes.size(), raw.size() - 1);
    EXPECT_EQ(out.repairs.size(), 1U);
  }
}

TEST(Rings, that_come_within_a_millimetre_of_each_other_are_separated_as_those_that_touch) {
  for (const double near : {1e-7, 1e-5, 1e-4, 9e-4}) {
    SCOPED_TRACE(near);
    const auto neck = mend({{{{0, 0},
                              {6, 0},
                              {6, 6 - near / 2},
                              {12, 6 - near / 2},
                              {12, 12},
                              {6 - near / 2, 12},
                              {6 - near / 2, 6},
                              {0, 6}}}});
    ASSERT_EQ(neck.polygons.size(), 2U);
    for (const auto& half : neck.polygons) EXPECT_NEAR(geometry::area(half), 36, 0.02);
    EXPECT_EQ(neck.repairs.size(), 1U);
    // A corner near an edge, a slit, a courtyard near the outer wall and near another one.
    const auto corner = mend({{{{0, 0}, {8, 0}, {8, 8}, {4, near}, {0, 8}}}});
    EXPECT_EQ(corner.polygons.size(), 2U);
    const auto slit = mend({{{{0, 0}, {8, 0}, {8, 8}, {4 + near, 8}, {4 + near, 2}, {4, 2}, {4, 8}, {0, 8}}}});
    ASSERT_EQ(slit.polygons.size(), 1U);
    EXPECT_NEAR(geometry::area(slit.polygons[0]), 64, 0.01);
    const auto yards = mend({{square, {{5, near}, {7, 4}, {3, 4}}, {{5, 4 + near}, {6, 6}, {4, 6}}}});
    ASSERT_EQ(yards.polygons.size(), 1U);
    EXPECT_EQ(yards.polygons[0].holes.size(), 2U);
    for (const auto& polygon : yards.polygons) EXPECT_TRUE(geometry::is_simple(polygon));
  }
  const auto wide = mend({{{{0, 0}, {6, 0}, {6, 5.998}, {12, 5.998}, {12, 12}, {5.998, 12}, {5.998, 6}, {0, 6}}}});
  EXPECT_EQ(wide.polygons.size(), 1U);
  EXPECT_THAT(wide.repairs, IsEmpty());
}

TEST(Rings, that_are_near_each_other_everywhere_stay_as_they_are) {
  const double thin = 5e-4;  // m: a wall around a yard, which is all of it
  const auto out = mend({{square, box(thin, thin, 10 - thin, 10 - thin)}});
  ASSERT_EQ(out.polygons.size(), 1U);
  EXPECT_NEAR(geometry::area(out.polygons[0]), 4 * 10 * thin, 1e-5);
}

TEST(Rings, of_a_wall_around_a_yard_drawn_in_one_stroke_enclose_the_yard) {
  // The outline goes in along a cut, round the yard and out the same way.
  const auto out =
      mend({{{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 5}, {2, 5}, {2, 8}, {8, 8}, {8, 2}, {2, 2}, {2, 5}, {0, 5}}}});
  EXPECT_EQ(code(out), "");
  ASSERT_EQ(out.polygons.size(), 1U);
  EXPECT_NEAR(geometry::area(out.polygons[0]), 64, 0.01);
}

TEST(Rings, of_overlapping_parts_become_one) {
  const auto out = mend({{square}, {box(5, 5, 15, 15)}});
  ASSERT_EQ(out.polygons.size(), 1U);
  EXPECT_NEAR(geometry::area(out.polygons[0]), 175, 1e-9);
  const auto apart = mend({{square}, {box(10, 0, 20, 10)}});
  EXPECT_EQ(apart.polygons.size(), 2U);
  EXPECT_THAT(apart.repairs, IsEmpty());
}

TEST(Rings, of_random_scribbles_end_simple_or_with_a_reason) {
  base::Random random(3);
  std::size_t good = 0, bad = 0;
  for (int round = 0; round < 2000; ++round) {
    // Small whole coordinates, so that touching, repeating and overlapping are the rule.
    std::vector<formats::RawPolygon> parts(1 + random.index(2));
    for (auto& part : parts) {
      part.resize(1 + random.index(3));
      for (auto& ring : part)
        for (std::size_t i = 0, n = 3 + random.index(5); i < n; ++i)
          ring.push_back({static_cast<double>(random.index(7)), static_cast<double>(random.index(7))});
    }
    const auto out = mend(parts);
    (out.defect ? bad : good) += 1;
  }
  EXPECT_GT(good, 100U);
  EXPECT_GT(bad, 100U);
}

}  // namespace
}  // namespace mansard::ingest::detail
