// The sentences that say why an edge was cut or not.
#include "mansard/report/detail/why.hpp"

#include <gmock/gmock.h>
#include <array>

namespace mansard::report {
namespace {

using testing::HasSubstr;

/// In the order: unsupported, conflicts with the outline, unused sweep-edge, height, unused GIS edge.
auto candidate(bool solved, std::array<double, 5> costs) -> segment::Candidate {
  using enum segment::Term;
  segment::Candidate c;
  c.length = 12;
  c.amounts.values.fill(12);
  c.amounts[height] = 8;
  c.solved = c.chosen = solved;
  c.costs[unsupported] = costs[0], c.costs[thin] = costs[1], c.costs[sweep_unused] = costs[2];
  c.costs[height] = costs[3], c.costs[gis_unused] = costs[4];
  return c;
}

TEST(Why, weighs_what_was_done_against_what_was_not) {
  EXPECT_EQ(detail::why(candidate(true, {0, 0, 480, 0, 0}), 0, 100),
            "cut: 480 for leaving 12.0 m of sweep-edge unused against 0");
  EXPECT_EQ(detail::why(candidate(false, {720, 0, 0, 96, 0}), 0, 100),
            "not cut: 720 for 12.0 m without a sweep-edge against 96 for the height step of 8.0 m");
  EXPECT_EQ(detail::why(candidate(true, {0, 0, 0, 4.26, 120}), 0, 100),
            "cut: 4.3 for the height step of 8.0 m and 120 for leaving 12.0 m of GIS edge unused against 0");
  EXPECT_EQ(detail::why(candidate(false, {0, 0, 0, 0, 0}), 0, 100), "not cut: 0 against 0");
  EXPECT_EQ(detail::why(candidate(true, {0, 0, 0, 0.01, 0}), 0, 100),
            "cut: under 0.1 for the height step of 8.0 m against 0");
}

TEST(Why, says_when_other_edges_decided) {
  EXPECT_EQ(
      detail::why(candidate(true, {720, 0, 0, 96, 0}), 0, 100),
      "cut though dearer by itself (720 for 12.0 m without a sweep-edge against 96 for the height step of 8.0 m): "
      "its ends need a wall");
  EXPECT_EQ(detail::why(candidate(false, {0, 0, 480, 0, 0}), 0, 100),
            "not cut though cheaper by itself (0 against 480 for leaving 12.0 m of sweep-edge unused): the walls that "
            "its ends need cost more");
}

TEST(Why, counts_conflicts_with_the_outline_and_with_other_walls) {
  EXPECT_EQ(detail::why(candidate(false, {0, 500, 480, 0, 0}), 0, 100),
            "not cut: 500 for its conflict with the outline against 480 for leaving 12.0 m of sweep-edge unused");
  EXPECT_EQ(detail::why(candidate(false, {0, 0, 480, 0, 0}), 1, 500),
            "not cut: 500 for its conflict with another wall against 480 for leaving 12.0 m of sweep-edge unused");
  EXPECT_THAT(detail::why(candidate(true, {0, 0, 480, 0, 0}), 3, 500),
              HasSubstr("dearer by itself (1500 for its conflicts with 3 other walls against 480"));
  segment::Segmentation s;
  s.candidates = {candidate(true, {}), candidate(false, {}), candidate(true, {})};
  s.conflicts = {{0, std::nullopt}, {0, 1}, {1, 2}};
  EXPECT_THAT(detail::walls_in_conflict(s), testing::ElementsAre(0, 2, 0));
}

TEST(Why, says_when_features_or_small_parts_decided) {
  auto c = candidate(true, {720, 0, 0, 0, 0});
  c.forced = true;
  EXPECT_EQ(detail::why(c, 0, 100), "cut: between two features");
  c.chosen = false;
  EXPECT_EQ(detail::why(c, 0, 100),
            "cut by the program, but one side is too small or narrow for a part: joined or left out");
}

}  // namespace
}  // namespace mansard::report
