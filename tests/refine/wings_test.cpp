#include "mansard/refine/detail/wings.hpp"

#include <gmock/gmock.h>

#include "scans.hpp"

namespace {

namespace geometry = mansard::geometry;

using namespace scans;
using refine::detail::wing_lines_of;

struct Wing {
  geometry::Polygon polygon;
  double length = 0;  // m; of the line
};
auto wings_of(const geometry::Polygon& part, const refine::Options& options) -> std::vector<Wing> {
  std::vector<Wing> out;
  for (const auto& line : wing_lines_of(part, options))
    for (auto& wing : refine::detail::wings_along(part, line, options)) out.push_back({std::move(wing), line.length()});
  return out;
}

// An L: a bar of 20 × 8 m, and a wing of 8 × 10 m on its eastern end.
auto l_shape() -> geometry::Ring { return {{0, 0}, {20, 0}, {20, 18}, {12, 18}, {12, 8}, {0, 8}}; }

TEST(Wings, a_rectangle_has_none) { EXPECT_TRUE(wings_of({rectangle(0, 0, 12, 8), {}}, {}).empty()); }

TEST(Wings, an_L_is_cut_along_both_lines_of_its_inner_corner) {
  const geometry::Polygon part{l_shape(), {}};
  const auto wings = wings_of(part, {});
  EXPECT_EQ(wings.size(), 6U);  // two lines: one side, and both sides with a wedge
  for (const auto& wing : wings) {
    EXPECT_NEAR(wing.length, 8, 1e-9);
    const auto beyond = geometry::subtract(wing.polygon, part);
    ASSERT_TRUE(beyond);
    for (const auto& piece : *beyond) EXPECT_LT(geometry::area(piece), 1e-6);
  }
  std::vector<double> areas;
  for (const auto& wing : wings) areas.push_back(geometry::area(wing.polygon));
  const auto is = [](double area) { return testing::DoubleNear(area, 1e-6); };
  // Wing or bar, with a wedge or without.
  EXPECT_THAT(areas, testing::AllOf(testing::Contains(testing::AnyOf(is(80), is(160))), testing::Contains(is(96)),
                                    testing::Contains(is(176)), testing::Contains(testing::AnyOf(is(96), is(144))),
                                    testing::Contains(is(112)), testing::Contains(is(160))));
}

TEST(Wings, a_line_from_a_court_goes_on_at_both_ends) {
  const geometry::Polygon ring{rectangle(0, 0, 30, 30), {{{8, 8}, {8, 22}, {22, 22}, {22, 8}}}};
  for (const auto& wing : wings_of(ring, {})) EXPECT_TRUE(geometry::is_simple(wing.polygon));
  EXPECT_THAT(wings_of(ring, {}), testing::Contains(testing::Truly(
                                      [](const auto& w) { return std::abs(geometry::area(w.polygon) - 240) < 1e-6; })));
}

// One wing runs through and ends in a gable, the other runs into it: no profiles around the L can raise that.
TEST(Wings, a_gable_at_the_corner_of_an_L_is_found) {
  const auto bar = plan(rectangle(0, 0, 20, 8), {roof(5, 0.9), wall(5), roof(5, 0.9), wall(5)}, 12);
  // The wing with its wedge, up to the bar's ridge.
  const auto wing = plan({{12, 8}, {16, 4}, {20, 8}, {20, 18}, {12, 18}},
                         {wall(5), wall(5), roof(5, 0.9), wall(5), roof(5, 0.9)}, 12);
  const auto mesh = scan({bar, wing});
  const std::vector<refine::Draft> drafts{flat_draft(l_shape(), 6)};
  const auto out = refine::refine(drafts, mesh, {}, {});
  EXPECT_GE(out.parts.size(), 2U);
  EXPECT_LT(difference(out.parts, {bar, wing}), 0.15);
}

}  // namespace
