#include <gmock/gmock.h>

#include <algorithm>

#include "fracture/families.hpp"
#include "fracture/judge.hpp"

namespace mansard::fracture {
namespace {

using geometry::Point2;

constexpr std::size_t many = 60;
constexpr std::uint64_t seed_count = 8;

auto arranged(const std::vector<Cut>& cuts, const Options& options = {}, const geometry::Box2& region = {})
    -> Arrangement {
  auto result = arrange(cuts, region, options);
  EXPECT_TRUE(result);
  return *std::move(result);
}

/// Calls look(cuts) for every family and seed, and says which when it fails.
template <class Look>
void everywhere(Look look, std::size_t count = many, std::uint64_t runs = seed_count) {
  for (const Family& family : families()) {
    for (const std::uint64_t seed : seeds(runs)) {
      SCOPED_TRACE(family.name + ", MANSARD_SEED=" + std::to_string(seed));
      look(cuts_of(family, count, seed));
      if (testing::Test::HasFailure()) return;
    }
  }
}

template <class Move>
auto moved(std::vector<Cut> cuts, Move move) -> std::vector<Cut> {
  for (Cut& cut : cuts) cut.segment = {move(cut.segment.start), move(cut.segment.end)};
  return cuts;
}

template <class Move>
auto moved(Arrangement arrangement, Move move) -> Shape {
  for (Point2& p : arrangement.vertices) p = move(p);
  return shape_of(arrangement);
}

/// The same vertices and edges to the last bit; areas up to the order of their sums.
void expect_same(const Shape& a, const Shape& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_THAT(a.areas, testing::Pointwise(testing::DoubleNear(1e-9), b.areas));
}

TEST(Guarantees, one_to_three_hold_for_cuts_of_all_families) {
  everywhere([](const auto& cuts) { EXPECT_EQ(complaint(arranged(cuts), cuts, Options{}.snap), std::nullopt); });
}

TEST(Guarantees, one_to_three_hold_for_other_snapping_distances_and_continuations) {
  for (const Options& options : {Options{0, 0.05, 10}, Options{2, 0.01, 1}, Options{5, 0.2, 10}, Options{100, 0.1, 2}})
    everywhere(
        [&](const auto& cuts) { EXPECT_EQ(complaint(arranged(cuts, options), cuts, options.snap), std::nullopt); }, 30,
        4);
}

// What follows from 2: no edge comes nearer than snap to another it shares no vertex with, and the two beside it end at
// least that far off, so that over every edge of a face stands a triangle of height snap that belongs to the face.
TEST(Guarantees, two_leaves_no_slivers) {
  for (const double snap : {0.01, 0.05, 0.2})
    everywhere(
        [&](const auto& cuts) {
          const auto arrangement = arranged(cuts, {2, snap, 10});
          for (std::uint32_t f = 0; f < arrangement.faces.size(); ++f) {
            const geometry::Ring ring = arrangement.ring(f);
            double longest = 0;
            for (std::size_t i = 0; i < ring.size(); ++i)
              longest = std::max(longest, geometry::length(ring[(i + 1) % ring.size()] - ring[i]));
            EXPECT_GE(arrangement.faces[f].area, 0.5 * snap * longest) << "face " << f;
          }
        },
        40, 4);
}

TEST(Guarantees, two_leaves_no_cut_out_but_in_hostile_bundles) {
  for (const Family& family : families()) {
    std::size_t left_out = 0, all = 0;
    for (const std::uint64_t seed : seeds(seed_count)) {
      const auto arrangement = arranged(cuts_of(family, many, seed));
      left_out += static_cast<std::size_t>(
          std::ranges::count(arrangement.warnings, "fracture-cut-left-out", &base::Diagnostic::code));
      all += many;
    }
    EXPECT_LE(static_cast<double>(left_out), family.left_out * static_cast<double>(all)) << family.name;
  }
}

TEST(Guarantees, four_the_same_cuts_give_the_same_arrangement) {
  everywhere(
      [](const auto& cuts) {
        const auto a = arranged(cuts), b = arranged(cuts);
        EXPECT_EQ(a.vertices, b.vertices);
        ASSERT_EQ(a.half_edges.size(), b.half_edges.size());
        for (std::size_t h = 0; h < a.half_edges.size(); ++h) {
          EXPECT_EQ(a.half_edges[h].from, b.half_edges[h].from);
          EXPECT_EQ(a.half_edges[h].next, b.half_edges[h].next);
          EXPECT_EQ(a.half_edges[h].face, b.half_edges[h].face);
          EXPECT_EQ(a.half_edges[h].origins, b.half_edges[h].origins);
        }
        EXPECT_EQ(a.warnings, b.warnings);
      },
      many, 4);
}

TEST(Guarantees, four_shifted_by_whole_metres_everything_is_shifted) {
  everywhere([](const auto& cuts) {
    const auto shift = [](Point2 p) { return p + Point2{84'321, -447'005}; };
    const auto a = arranged(cuts), b = arranged(moved(cuts, shift));
    EXPECT_EQ(moved(a, shift).vertices, shape_of(b).vertices);
    expect_same(moved(a, shift), shape_of(b));
    ASSERT_EQ(a.faces.size(), b.faces.size());
    for (std::size_t f = 0; f < a.faces.size(); ++f) EXPECT_EQ(a.faces[f].area, b.faces[f].area);
  });
}

TEST(Arrange, turned_by_a_right_angle_gives_everything_turned) {
  everywhere([](const auto& cuts) {
    const auto turn = [](Point2 p) { return Point2{-p.y, p.x}; };
    expect_same(moved(arranged(cuts), turn), shape_of(arranged(moved(cuts, turn))));
  });
}

TEST(Arrange, mirrored_gives_everything_mirrored) {
  everywhere([](const auto& cuts) {
    const auto mirror = [](Point2 p) { return Point2{-p.x, p.y}; };
    expect_same(moved(arranged(cuts), mirror), shape_of(arranged(moved(cuts, mirror))));
  });
}

TEST(Arrange, changes_nothing_when_its_own_edges_are_inserted_again) {
  everywhere(
      [](auto cuts) {
        const Options options{.continuation = 0, .snap = 0.05, .margin = 0};
        const geometry::Box2 region{{-70, -70}, {130, 130}};
        const auto once = arranged(cuts, options, region);
        const auto source = static_cast<std::uint32_t>(cuts.size());
        for (std::uint32_t h = 0; h < once.half_edges.size(); h += 2)
          if (once.half_edges[h].origins[0].kind != Kind::border) cuts.push_back({once.segment(h), source});
        const auto twice = arranged(cuts, options, region);
        expect_same(shape_of(once), shape_of(twice));
        for (const HalfEdge& edge : twice.half_edges)
          EXPECT_TRUE(std::ranges::any_of(edge.origins, [&](const Origin& o) {
            return o.kind == Kind::border || (o.kind == Kind::hard && o.source == source);
          }));
      },
      many, 6);
}

// Lines in general position that run from border to border make one face more each, and one more at each crossing.
TEST(Arrange, makes_as_many_faces_as_lines_and_crossings_ask_for) {
  std::size_t judged = 0;
  for (const std::uint64_t seed : seeds(60)) {
    const Options options{.continuation = 1000, .snap = 0.02, .margin = 5};
    const auto cuts = cuts_of(families()[0], 14, seed);
    const auto arrangement = arranged(cuts, options);
    geometry::Box2 all;
    for (const Point2 p : arrangement.vertices) all.add(p);
    std::vector<Point2> points;
    std::size_t crossings = 0;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto [a, b] = cuts[i].segment;
        const auto [c, d] = cuts[j].segment;
        const Point2 p = a + (cross(c - a, d - c) / cross(b - a, d - c)) * (b - a);
        if (!all.grown(1).contains(p)) continue;
        points.push_back(p);
        crossings += all.contains(p) ? 1 : 0;
      }
    }
    bool general = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point2 p = points[i];
      for (const double rim : {p.x - all.least.x, all.most.x - p.x, p.y - all.least.y, all.most.y - p.y})
        general = general && std::abs(rim) > 0.5;
      for (std::size_t j = 0; j < i; ++j) general = general && geometry::length(p - points[j]) > 0.1;
    }
    // A line that passes near a crossing of two others, or a corner, is drawn to it: not judged.
    for (const Cut& cut : cuts) {
      const Point2 along = normalised(cut.segment.end - cut.segment.start);
      for (const Point2 corner :
           {all.least, all.most, Point2{all.least.x, all.most.y}, Point2{all.most.x, all.least.y}})
        general = general && std::abs(cross(along, corner - cut.segment.start)) > 0.2;
      std::size_t on = 0;
      for (const Point2 p : points) on += std::abs(cross(along, p - cut.segment.start)) < 0.1 ? 1 : 0;
      std::size_t own = 0;
      for (const Point2 p : points) own += std::abs(cross(along, p - cut.segment.start)) < 1e-9 ? 1 : 0;
      general = general && on == own;
    }
    if (!general) continue;
    ++judged;
    EXPECT_EQ(arrangement.faces.size(), 1 + cuts.size() + crossings) << "MANSARD_SEED=" << seed;
  }
  EXPECT_GE(judged, std::getenv("MANSARD_SEED") ? 0U : 3U);
}

TEST(Arrange, survives_a_block_of_many_cuts) {
  const auto cuts = cuts_of(families()[2], 300, 7);
  const auto arrangement = arranged(cuts);
  EXPECT_EQ(complaint(arrangement, cuts, Options{}.snap), std::nullopt);
  EXPECT_GT(arrangement.faces.size(), 1500U);
}

}  // namespace
}  // namespace mansard::fracture
