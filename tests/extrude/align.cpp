// The contract of align.hpp, on streets of houses whose corners were shaken. Random cases print their seed.
#include "mansard/extrude/align.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "mansard/extrude/canonical.hpp"
#include "plans.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace extrude = mansard::extrude;

namespace model = mansard::model;

using namespace plans;

/// m; lines of neighbours are that far apart at most: a quantum of 2^-16 m, and its rounding on either side.
constexpr double apart = 3.1e-5;

auto aligned(const std::vector<Plan>& plans) -> std::vector<Plan> {
  std::vector<Plan> out = plans;
  const auto made = extrude::align(plans);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (made[i]) out[i] = *made[i];
  return out;
}

/// What the plan is extruded over.
auto ground(const Plan& p) -> geometry::Polygon {
  const auto raised = extrude::raise(p);
  EXPECT_TRUE(raised && raised->outcome == extrude::Outcome::full) << text(p);
  if (!raised) return {};
  EXPECT_EQ(faults(raised->solid), "") << text(p);
  for (const auto& face : raised->solid.faces) {
    if (face.kind != model::FaceKind::base) continue;
    geometry::Polygon out;
    for (const auto v : face.loops.front()) out.outer.push_back(xy(raised->solid.vertices[v]));
    return geometry::oriented(out);
  }
  return {};
}

/// m²
auto overlap(const geometry::Polygon& a, const geometry::Polygon& b) -> double {
  double sum = 0;
  if (const auto shared = geometry::intersect(a, b))
    for (const auto& polygon : *shared) sum += geometry::area(polygon);
  return sum;
}

auto most_overlap(const std::vector<Plan>& plans) -> double {
  std::vector<geometry::Polygon> grounds;
  for (const auto& p : plans) grounds.push_back(ground(p));
  double most = 0;
  for (std::size_t i = 0; i < grounds.size(); ++i)
    for (std::size_t k = i + 1; k < grounds.size(); ++k) most = std::max(most, overlap(grounds[i], grounds[k]));
  return most;
}

/// Two rows of houses back to back, cut where they like. All have the corners of the wall between them, each shaken,
/// and some leave out those of others that hardly stand off.
auto street(std::uint64_t seed, double by) -> std::vector<Plan> {
  base::Random random(seed);
  const double angle = random.uniform(0, 3);
  const auto shaken = [&](Point2 p) { return p + Point2{random.uniform(-by, by), random.uniform(-by, by)}; };
  struct Cut {
    double at;
    bool front;
    Point2 back, street;
  };
  std::vector<Cut> cuts;
  constexpr double width = 40, depth = 9;
  for (const bool front : {true, false})
    for (double x = 0; x <= width; x += front ? 8 : 10) {
      const double at = x == 0 || x == width ? x : x + random.uniform(-2, 2);
      cuts.push_back({at, front, {}, shaken({at, front ? -depth : depth})});
    }
  std::ranges::sort(cuts, {}, &Cut::at);
  for (auto& cut : cuts) cut.back = shaken({cut.at, 0});
  for (std::size_t i = 1; i < cuts.size(); ++i)  // both rows end at one corner
    if (cuts[i].at == cuts[i - 1].at) cuts[i].back = cuts[i - 1].back;

  std::vector<Plan> plans;
  for (const bool front : {true, false}) {
    const Cut* before = nullptr;
    for (const auto& cut : cuts) {
      if (cut.front != front) continue;
      if (before != nullptr) {
        Ring ring{before->street, cut.street, cut.back};
        std::vector<Point2> between;
        for (const auto& other : cuts)
          if (other.front != front && other.at > before->at && other.at < cut.at && random.index(2) == 0)
            between.push_back(other.back);
        ring.insert(ring.end(), between.rbegin(), between.rend());
        ring.push_back(before->back);
        if (!front) ring = turned_in(ring);
        std::vector<std::uint32_t> of_edge(ring.size());
        for (std::size_t i = 0; i < ring.size(); ++i) of_edge[i] = i % 2 == 0 ? 0 : 1;
        plans.push_back(turned(plan(std::move(ring), {hip, wall}, std::move(of_edge)), angle));
      }
      before = &cut;
    }
  }
  return plans;
}

TEST(Align, puts_a_shared_wall_on_one_line) {
  // The long wall of one lies against two, whose common corner stands off by 8 mm.
  const std::vector<Plan> plans{plan({{0, -9}, {20, -9}, {20, 0}, {0, 0}}, {hip}),
                                plan({{0, 0}, {11, -0.008}, {11, 9}, {0, 9}}, {hip}),
                                plan({{11, -0.008}, {20, 0}, {20, 9}, {11, 9}}, {hip})};
  EXPECT_GT(most_overlap(plans), 0.03);
  const auto made = extrude::align(plans);
  EXPECT_FALSE(made[0]);  // it gives the line
  ASSERT_TRUE(made[1] && made[2]);
  EXPECT_NEAR(made[1]->outer.points[1].y, 0, apart);
  EXPECT_NEAR(made[2]->outer.points[0].y, 0, apart);
  EXPECT_LT(most_overlap(aligned(plans)), 20 * apart);
}

TEST(Align, leaves_alone_what_touches_nothing) {
  const auto made = extrude::align(std::vector{plan({{0, 0}, {10, 0.004}, {20, 0}, {20, 9}, {0, 9}}, {hip}),
                                               shifted(plan(box(9, 9), {hip}), {0, 9.1}),
                                               plan({{40, 0}, {50, 10}, {50, 0}, {40, 10}}, {hip})});  // crosses itself
  EXPECT_THAT(made, testing::Each(testing::Eq(std::nullopt)));
}

TEST(Align, keeps_profiles_with_their_walls) {
  // The walls of two that bend are one line in the neighbour; their profiles still change at the corner.
  const auto made = aligned({plan({{0, -9}, {20, -9}, {20, 0}, {0, 0}}, {hip}),
                             plan({{0, 0}, {10, 0.2}, {20, 0}, {20, 9}, {0, 9}}, {hip, wall, setback}, {1, 2, 0, 0, 0}),
                             plan({{20, -9}, {30, -9}, {30, 0}, {20, 0.012}}, {hip, wall}, {0, 0, 1, 0})});
  EXPECT_THAT(made[1].outer.profile_of_edge, testing::ElementsAre(1, 2, 0, 0, 0));
  EXPECT_THAT(made[2].outer.profile_of_edge, testing::ElementsAre(0, 0, 1, 0));
  EXPECT_EQ(made[1].profiles, (std::vector{hip, wall, setback}));
}

TEST(Align, leaves_no_overlap_in_streets) {
  // Where corners stand off by much, walls can share a stretch and then part by more than may be moved.
  constexpr std::size_t streets = 30;
  for (const auto& [by, most_left] : {std::pair(1e-3, 0U), std::pair(8e-3, 10U)}) {
    std::size_t overlapped = 0, left = 0;
    for (std::uint64_t seed = 0; seed < streets; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const auto before = street(seed, by);
      overlapped += most_overlap(before) > 20 * apart ? 1 : 0;
      left += most_overlap(aligned(before)) > 20 * apart ? 1 : 0;
    }
    EXPECT_GT(overlapped, 2 * streets / 3) << by;
    EXPECT_LE(left, most_left) << by;
  }
}

TEST(Align, gives_outlines_that_are_raised_as_they_are_and_near_those_given) {
  const extrude::Options options;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto before = street(seed, seed % 2 == 0 ? 1e-3 : 8e-3), after = aligned(before);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const auto was = extrude::canonical(before[i]), is = extrude::canonical(after[i]);
      ASSERT_TRUE(was && is);
      EXPECT_LT(is->moved, 5e-5);
      for (const Point2 p : after[i].outer.points)
        EXPECT_LE(geometry::boundary_distance(model::polygon_of(was->plan), p), options.tolerance / 2 + 1e-9);
    }
  }
}

TEST(Align, does_not_go_by_the_order_of_the_plans) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    auto plans = street(seed, 8e-3);
    auto forth = aligned(plans);
    std::ranges::reverse(plans);
    auto back = aligned(plans);
    std::ranges::reverse(back);
    EXPECT_EQ(forth, back) << "seed " << seed;
  }
}

}  // namespace
