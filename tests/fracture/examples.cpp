#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "fracture/drawing.hpp"
#include "fracture/judge.hpp"

namespace mansard::fracture {
namespace {

using geometry::Point2;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;
using testing::SizeIs;

/// The region as drawn is the rectangle.
auto flush(double continuation = 2) -> Options { return {.continuation = continuation, .snap = 0.05, .margin = 0}; }

auto areas(const Arrangement& a) -> std::vector<double> { return shape_of(a).areas; }

auto arranged(const std::vector<Cut>& cuts, const geometry::Box2& region, const Options& options) -> Arrangement {
  auto result = arrange(cuts, region, options);
  EXPECT_TRUE(result);
  EXPECT_EQ(complaint(*result, cuts, options.snap), std::nullopt);
  return *std::move(result);
}

TEST(Arrange, makes_one_face_of_a_region_without_cuts) {
  const auto a = arranged({}, box(12, 8), flush());
  EXPECT_THAT(areas(a), ElementsAre(96.0));
  EXPECT_THAT(a.half_edges, SizeIs(8));
}

TEST(Arrange, makes_nothing_of_nothing) {
  const auto a = arrange({}, {}, {});
  ASSERT_TRUE(a);
  EXPECT_TRUE(a->faces.empty());
  EXPECT_TRUE(a->vertices.empty());
}

TEST(Arrange, bounds_both_ends_of_all_cuts_and_the_region_with_the_margin) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 4}}, 0}, {{{5, 9}, {6, -3}}, 1}};
  geometry::Box2 region;
  region.add({-1, 0}), region.add({2, 2});
  const auto a = arranged(cuts, region, {.continuation = 2, .snap = 0.05, .margin = 10});
  geometry::Box2 all;
  for (const Point2 p : a.vertices) all.add(p);
  EXPECT_EQ(all.least, (Point2{-11, -13}));
  EXPECT_EQ(all.most, (Point2{30, 19}));
}

TEST(Arrange, lets_one_cut_split_the_rectangle) {
  const auto cuts = cuts_in(R"(
...........
..a----b...
...........
...........)",
                            "ab");
  const auto a = arranged(cuts, box(10, 3), flush());
  EXPECT_THAT(areas(a), ElementsAre(10.0, 20.0));
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 0), 5);
  EXPECT_DOUBLE_EQ(length_of(a, Kind::continuation, 0), 5);
}

TEST(Arrange, remembers_direction_and_source) {
  const auto cuts = cuts_in(R"(
b....
.....
a....)",
                            "ab");
  const auto a = arranged({{cuts[0].segment, 77}}, box(4, 2), {.continuation = 2, .snap = 0.05, .margin = 1});
  int found = 0;
  for (std::uint32_t h = 0; h < a.half_edges.size(); ++h) {
    for (const Origin& o : a.half_edges[h].origins) {
      if (o.kind == Kind::border) continue;
      ++found;
      EXPECT_EQ(o.source, 77U);
      EXPECT_EQ(o.along, a.segment(h).end.y > a.segment(h).start.y);
    }
  }
  EXPECT_EQ(found, 6);  // continuation, hard, continuation; both sides
}

TEST(Arrange, gives_the_border_the_border_as_origin) {
  const auto a = arranged({}, box(3, 3), flush());
  for (const HalfEdge& edge : a.half_edges)
    EXPECT_THAT(edge.origins, ElementsAre(Origin{Kind::border, 0, edge.face.has_value()}));
}

// Longest first: `cd` ends at `ab`, whose continuation ends at the border.
TEST(Arrange, ends_a_cut_at_the_next_edge) {
  const auto cuts = cuts_in(R"(
.........
.a-----b.
.........
....c....
....|....
....d....
.........)",
                            "ab cd");
  const auto a = arranged(cuts, box(8, 6), flush(2));
  EXPECT_THAT(areas(a), ElementsAre(8.0, 20.0, 20.0));
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 1), 2);
  EXPECT_DOUBLE_EQ(length_of(a, Kind::continuation, 1), 3);
}

TEST(Arrange, makes_a_cross_of_two_cuts_that_cross) {
  const auto cuts = cuts_in(R"(
....c....
....|....
a---+---b
....|....
....d....)",
                            "ab cd");
  const auto a = arranged(cuts, box(8, 4), flush());
  EXPECT_THAT(areas(a), ElementsAre(8.0, 8.0, 8.0, 8.0));
  EXPECT_THAT(a.vertices, SizeIs(9));
}

TEST(Arrange, carries_a_cut_on_beyond_the_first_edge_while_its_continuation_lasts) {
  const auto plan = R"(
a---------b
...........
c---------d
...........
.....e.....
.....|.....
.....f.....)";
  // From e it is 2 m to cd, 4 m to ab.
  EXPECT_THAT(areas(arranged(cuts_in(plan, "ab cd ef"), box(10, 6), flush(1))), SizeIs(3));
  EXPECT_THAT(areas(arranged(cuts_in(plan, "ab cd ef"), box(10, 6), flush(2))), SizeIs(3));
  EXPECT_THAT(areas(arranged(cuts_in(plan, "ab cd ef"), box(10, 6), flush(2.5))), SizeIs(4));
  EXPECT_DOUBLE_EQ(length_of(arranged(cuts_in(plan, "ab cd ef"), box(10, 6), flush(1)), Kind::continuation, 2), 2);
  EXPECT_DOUBLE_EQ(length_of(arranged(cuts_in(plan, "ab cd ef"), box(10, 6), flush(2.5)), Kind::continuation, 2), 4);
}

TEST(Arrange, carries_a_cut_on_across_even_if_it_ends_on_an_edge) {
  const auto plan = R"(
...........
...........
a----e----b
.....|.....
.....f.....
...........)";
  const auto on = arranged(cuts_in(plan, "ab ef"), box(10, 5), flush(2));
  EXPECT_THAT(areas(on), ElementsAre(10.0, 10.0, 15.0, 15.0));
  EXPECT_DOUBLE_EQ(length_of(on, Kind::continuation, 1), 3);
  const auto none = arranged(cuts_in(plan, "ab ef"), box(10, 5), flush(0));
  EXPECT_THAT(areas(none), ElementsAre(15.0, 15.0, 20.0));
}

TEST(Arrange, carries_a_cut_on_from_a_vertex) {
  const auto cuts = cuts_in(R"(
.....c.....
.....|.....
a----e----b
.....|\....
.....d.\...
........f..)",
                            "ab cd ef");
  const auto a = arranged(cuts, box(10, 5), flush(2));
  EXPECT_THAT(areas(a), SizeIs(6));
  EXPECT_GT(length_of(a, Kind::continuation, 2), 2);
  for (const Point2 p : a.vertices)
    EXPECT_TRUE(geometry::length(p - Point2{5, 3}) == 0 || geometry::length(p - Point2{5, 3}) > 1);
}

TEST(Arrange, stops_continuations_at_the_border) {
  const auto cuts = cuts_in("..a--b..", "ab");
  const auto a = arranged(cuts, box(7, 0), {.continuation = 50, .snap = 0.05, .margin = 3});
  EXPECT_THAT(areas(a), ElementsAre(39.0, 39.0));
  EXPECT_DOUBLE_EQ(length_of(a, Kind::continuation, 0), 10);
}

TEST(Arrange, lists_all_cuts_on_an_edge) {
  const auto cuts = cuts_in("a..c--b..d", "ab cd");
  const auto a = arranged(cuts, box(9, 0), {.continuation = 2, .snap = 0.05, .margin = 4});
  EXPECT_THAT(a.faces, SizeIs(2));
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 0), 6);
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 1), 6);
  double both = 0;
  for (std::uint32_t h = 0; h < a.half_edges.size(); h += 2) {
    const auto& origins = a.half_edges[h].origins;
    const auto hard = std::ranges::count(origins, Kind::hard, &Origin::kind);
    if (hard == 2) both += geometry::length(a.segment(h).end - a.segment(h).start);
    if (origins.size() == 2 && hard == 1) {
      EXPECT_EQ(origins[0].kind, Kind::hard) << "the better reason comes first";
    }
  }
  EXPECT_DOUBLE_EQ(both, 3);
}

TEST(Arrange, merges_a_cut_drawn_twice_in_opposite_directions) {
  const auto cuts = cuts_in("a------b", "ab ba");
  const auto a = arranged(cuts, box(7, 0), {.continuation = 2, .snap = 0.05, .margin = 4});
  EXPECT_THAT(a.faces, SizeIs(2));
  for (std::uint32_t h = 0; h < a.half_edges.size(); h += 2) {
    if (a.half_edges[h].origins[0].kind != Kind::hard) continue;
    ASSERT_THAT(a.half_edges[h].origins, SizeIs(2));
    EXPECT_NE(a.half_edges[h].origins[0].along, a.half_edges[h].origins[1].along);
  }
}

TEST(Arrange, merges_lines_nearer_than_the_snapping_distance) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 0}}, 0}, {{{3, 0.03}, {14, -0.02}}, 1}, {{{21, 0.045}, {5, 0.045}}, 2}};
  const auto a = arranged(cuts, {}, {});
  EXPECT_THAT(a.faces, SizeIs(2));
  EXPECT_NEAR(length_of(a, Kind::hard, 1), 11, 0.1);
  EXPECT_NEAR(length_of(a, Kind::hard, 2), 16, 0.1);
}

TEST(Arrange, keeps_lines_farther_apart_than_the_snapping_distance) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 0}}, 0}, {{{3, 0.06}, {14, 0.06}}, 1}};
  const auto a = arranged(cuts, {}, {});
  EXPECT_THAT(a.faces, SizeIs(3));
  EXPECT_NEAR(areas(a).front(), 0.06 * 40, 1e-6);
}

TEST(Arrange, leads_a_line_that_passes_near_a_vertex_through_it) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 0}}, 0}, {{{10, -5}, {10, 5}}, 1}, {{{5, -5.03}, {15, 4.97}}, 2}};
  const auto a = arranged(cuts, {}, {});
  EXPECT_THAT(a.faces, SizeIs(6));
  EXPECT_EQ(std::ranges::count(a.vertices, Point2{10, 0}), 1);
}

TEST(Arrange, snaps_an_end_to_the_edge_it_nearly_touches) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 0}}, 0}, {{{10, 0.04}, {10, 5}}, 1}};
  const auto a = arranged(cuts, {}, {.continuation = 0, .snap = 0.05, .margin = 10});
  EXPECT_THAT(a.faces, SizeIs(3));
  EXPECT_EQ(std::ranges::count(a.vertices, Point2{10, 0}), 1);
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 1), 5);
}

TEST(Arrange, ignores_cuts_shorter_than_the_snapping_distance_with_a_warning) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 0}}, 0}, {{{4, 4}, {4, 4}}, 5}, {{{4, 4}, {4.02, 4.02}}, 6}};
  const auto a = arranged(cuts, {}, {});
  EXPECT_THAT(a.faces, SizeIs(2));
  ASSERT_THAT(a.warnings, SizeIs(2));
  EXPECT_EQ(a.warnings[0].code, "fracture-cut-short");
  EXPECT_EQ(a.warnings[0].subject, "cut 5");
  EXPECT_EQ(a.warnings[1].subject, "cut 6");
}

TEST(Arrange, takes_cuts_on_the_border_itself) {
  const std::vector<Cut> cuts{{{{0, 0}, {20, 0}}, 0}, {{{20, 0}, {20, 10}}, 1}, {{{20, 9.98}, {0, 9.97}}, 2}};
  const auto a = arranged(cuts, box(20, 10), flush());
  EXPECT_THAT(areas(a), ElementsAre(200.0));
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 0), 20);
  EXPECT_DOUBLE_EQ(length_of(a, Kind::hard, 2), 20);
}

TEST(Arrange, refuses_what_is_not_finite_or_beyond_the_earth) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300, 2e7}) {
    for (const auto& cut : {Cut{{{bad, 0}, {1, 1}}, 3}, Cut{{{0, bad}, {1, 1}}, 3}, Cut{{{0, 0}, {bad, 1}}, 3},
                            Cut{{{0, 0}, {1, bad}}, 3}}) {
      const auto a = arrange({cut}, box(1, 1), {});
      ASSERT_FALSE(a);
      EXPECT_EQ(a.error().code, "fracture-not-finite");
      EXPECT_EQ(a.error().subject, "cut 3");
    }
    if (bad == inf) continue;
    geometry::Box2 region = box(1, 1);
    region.most.y = bad;
    if (bad == -inf) region.least.y = bad;
    const auto a = arrange({}, region, {});
    ASSERT_FALSE(a) << bad;
    EXPECT_EQ(a.error().code, "fracture-not-finite");
  }
}

TEST(Arrange, stops_early_when_cancelled_with_what_is_valid_so_far) {
  base::Cancel cancel;
  cancel.request();
  const auto a = arrange(cuts_in("a---b", "ab"), box(4, 4), flush(), {.cancel = &cancel, .progress = {}, .seed = 1});
  ASSERT_TRUE(a);
  EXPECT_THAT(a->faces, SizeIs(1));
}

TEST(Arrange, explains_every_code_and_bounds_every_option) {
  for (const auto& code : codes()) {
    EXPECT_TRUE(code.code.starts_with("fracture-"));
    EXPECT_FALSE(code.cause.empty() || code.remedy.empty());
  }
  Options options;
  const auto list = option_list(options);
  EXPECT_EQ(std::ranges::count(list.options(), false, &base::Option::advanced), 3);
  EXPECT_FALSE(list.find("snap")->set("0"));
  EXPECT_TRUE(list.find("snap")->set("0.1"));
  EXPECT_EQ(options.snap, 0.1);
}

}  // namespace
}  // namespace mansard::fracture
