// Plans that failed once, and plans that hold a tie of a kind each: every file of fixtures/ is extruded and judged. And
// the minimiser that makes such files.
#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>

#include "exact.hpp"
#include "families.hpp"
#include "mansard/extrude/extrude.hpp"
#include "minimise.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace extrude = mansard::extrude;

namespace model = mansard::model;

using namespace plans;

auto fixtures() -> std::vector<std::string> {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(MANSARD_TEST_DATA "/fixtures"))
    if (file.path().extension() == ".json") names.push_back(file.path().stem().string());
  std::ranges::sort(names);
  return names;
}

auto read(const std::string& name) -> Plan {
  std::ifstream in(MANSARD_TEST_DATA "/fixtures/" + name + ".json");
  std::ostringstream text;
  text << in.rdbuf();
  return plan_from_json(text.str());
}

class Fixture : public testing::TestWithParam<std::string> {};

TEST_P(Fixture, is_raised_in_full_and_as_the_oracle_says) {
  const Plan plan = read(GetParam());
  const auto raised = extrude::raise(plan);
  ASSERT_TRUE(raised) << base::to_string(raised.error());
  EXPECT_EQ(raised->outcome, extrude::Outcome::full)
      << (raised->warnings.empty() ? "" : raised->warnings.front().message);
  EXPECT_EQ(faults(raised->solid), "");
  if (plan.outer.points.size() > 60) return;
  const Footprint footprint = footprint_of(plan);
  const auto surface = surface_of(footprint, cap_of(plan));
  const auto judged = oracle::raise(footprint, cap_of(plan));
  EXPECT_EQ(oracle::difference(surface, judged), "");
  EXPECT_EQ(oracle::misnamed(footprint, oracle::faces(surface), judged.faces), "");
}

INSTANTIATE_TEST_SUITE_P(All, Fixture, testing::ValuesIn(fixtures()), [](const auto& instance) {
  std::string name = instance.param;
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

TEST(PlanJson, comes_back_to_the_bit) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Plan plan = family_plan(seed, 16);
    EXPECT_EQ(plan_from_json(to_json(plan)), plan);
  }
}

TEST(Minimiser, finds_the_least_plan_of_a_planted_failure) {
  // "Fails" whenever a corner is reflex and some edge has a setback.
  const auto fails = [](const Plan& p) {
    bool reflex = false, setback = false;
    const auto& points = p.outer.points;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
      reflex = reflex || cross(points[i] - points[(i + n - 1) % n], points[(i + 1) % n] - points[i]) < -1e-9;
      const Profile& profile = p.profiles.at(p.outer.profile_of_edge.at(i));
      for (std::size_t k = 1; k < profile.size(); ++k) setback = setback || profile[k].height == profile[k - 1].height;
    }
    return reflex && setback && geometry::signed_area(points) > 0 && geometry::is_simple(model::polygon_of(p));
  };
  std::size_t tried = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Plan plan = family_plan(seed, 24);
    if (!fails(plan)) continue;
    ++tried;
    const Plan small = minimised(plan, fails);
    EXPECT_TRUE(fails(small)) << to_json(small);
    EXPECT_EQ(small.outer.points.size(), 4U) << to_json(small);
    EXPECT_TRUE(small.holes.empty()) << to_json(small);
    EXPECT_EQ(small.profiles.size(), 1U) << to_json(small);
    EXPECT_EQ(small.profiles[0].size(), 3U) << to_json(small);
    EXPECT_EQ(small, minimised(plan, fails));
    double sum = 0;
    for (const Point2 p : small.outer.points) sum += std::abs(p.x - std::round(p.x)) + std::abs(p.y - std::round(p.y));
    EXPECT_LE(sum, 2) << to_json(small);
  }
  EXPECT_GT(tried, 5U);
}

TEST(Minimiser, stops_after_the_tries_it_is_given) {
  std::size_t tries = 0;
  Minimiser minimiser(
      [&](const Plan&) {
        ++tries;
        return true;
      },
      17);
  static_cast<void>(minimiser.run(family_plan(3, 24)));
  EXPECT_LE(tries, 17U);
  EXPECT_EQ(minimiser.tries(), tries);
}

}  // namespace
