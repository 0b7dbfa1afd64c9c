// Outlines that are sketched again under other roofs.
#include "mansard/extrude/detail/outlines.hpp"

#include <gmock/gmock.h>

#include "mansard/base/run.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/extrude.hpp"

namespace {

using namespace mansard;
using model::Plan;
using model::Profile;

const Profile walls[]{{{0, 0}, {0, 5}}, {{0, 0}, {0, 7}}};
const Profile roofs[]{{{0, 0}, {0, 5}, {1, 5.8}}, {{0, 0}, {0, 5}, {2, 6.6}}, {{0, 0}, {0, 4}, {1, 5}, {4, 6}}};

/// An L with a corner on a straight side and a shallow turn on another: how they are joined depends on which profiles
/// climb alike. Or without both: then they decide nothing.
auto outline(int shape, bool plain) -> geometry::Ring {
  geometry::Ring ring{{0, 0}, {6, 0.001}, {12, 0}, {12, 5}, {7, 5}, {7, 11}, {3, 11}, {0, 11.002}};
  if (plain) ring = {{0, 0}, {12, 0}, {12, 5}, {7, 5}, {7, 11}, {0, 11}};
  for (auto& p : ring) p = {p.x + 0.3 * shape * p.y + 1000, p.y + 2000 - 0.3 * shape * p.x};
  return ring;
}

void expect_same(const extrude::detail::Footprint& a, const extrude::detail::Footprint& b) {
  EXPECT_TRUE(a.corners == b.corners);
  EXPECT_TRUE(a.tracks == b.tracks);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.moved, b.moved);
  ASSERT_EQ(a.rings.size(), b.rings.size());
  for (std::size_t r = 0; r < a.rings.size(); ++r) {
    ASSERT_EQ(a.rings[r].size(), b.rings[r].size());
    for (std::size_t i = 0; i < a.rings[r].size(); ++i) {
      const auto &p = a.rings[r][i], &q = b.rings[r][i];
      EXPECT_TRUE(p.direction == q.direction && p.offset == q.offset && p.track == q.track && p.joint == q.joint);
      EXPECT_TRUE(p.provenance == q.provenance);
    }
  }
}

TEST(Outlines, are_the_canonical_ones_whatever_was_asked_before) {
  base::Random random(3);
  const auto below = [&random](int most) { return static_cast<std::uint32_t>(random.uniform(0, most)); };
  for (int round = 0; round < 400; ++round) {
    Plan plan;
    plan.outer.points = outline(static_cast<int>(below(3)), below(2) == 0);
    for (std::uint32_t i = 0; i < plan.outer.points.size(); ++i) {
      plan.outer.profile_of_edge.push_back(i);
      plan.profiles.push_back(below(2) == 0 ? walls[below(2)] : roofs[below(3)]);
    }
    plan.cap = 9;
    extrude::Options options;
    if (below(2) == 0) options.merge_angle = 0.001;
    const auto source = extrude::detail::prepared(plan);
    ASSERT_TRUE(source);
    std::string why, reason;
    const auto expected = extrude::detail::canonical(*source, options, reason);
    const auto* made = extrude::detail::canonical_outline(*source, options, why);
    ASSERT_EQ(made != nullptr, expected.has_value()) << round;
    EXPECT_EQ(why, reason);
    if (made) expect_same(*made, *expected);
  }
}

TEST(Outlines, that_cannot_be_made_say_why_again) {
  std::size_t refused = 0;
  for (const double width : {1e-5, 1e-6, 1e-7, 1e-8}) {
    Plan plan;
    plan.outer.points = {{0, 0}, {10, 3}, {10 - width, 3 + 3 * width}, {-width, 3 * width}};
    plan.outer.profile_of_edge = {0, 0, 0, 0};
    plan.profiles = {walls[0]};
    plan.cap = 5;
    const auto source = extrude::detail::prepared(plan);
    if (!source) continue;
    std::string expected;
    if (extrude::detail::canonical(*source, {}, expected)) continue;
    EXPECT_FALSE(expected.empty());
    ++refused;
    for (int round = 0; round < 2; ++round) {
      std::string why;
      EXPECT_EQ(extrude::detail::canonical_outline(*source, {}, why), nullptr);
      EXPECT_EQ(why, expected);
    }
  }
  EXPECT_GT(refused, 0U);
}

}  // namespace
