// Real building outlines, and cases that broke other skeletons: read from the shared data, whose licences keep them out
// of the project. Every polygon is extruded in five dresses; a test for every dress and range of sizes.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "families.hpp"
#include "mansard/extrude/extrude.hpp"
#include "minimise.hpp"

namespace {

namespace geometry = mansard::geometry;
namespace extrude = mansard::extrude;

using namespace plans;

struct Entry {
  std::string name;
  Outline rings;
};

/// Polygons that the public function may refuse, and the reasons.
const std::map<std::string, std::string> refused{};

/// Every polygon of at least so many corners and fewer than so many.
auto corpus(std::size_t least, std::size_t below) -> std::vector<Entry> {
  std::vector<Entry> entries;
  std::ifstream in(MANSARD_SHARED_DATA "/polygons/polygons.jsonl");
  for (std::string line; std::getline(in, line);) {
    const auto json = nlohmann::json::parse(line);
    Entry e{json.at("name").get<std::string>(), {}};
    const auto add = [&](const nlohmann::json& points) {
      e.rings.emplace_back();
      for (const auto& p : points) e.rings.back().push_back({p.at(0).get<double>(), p.at(1).get<double>()});
    };
    add(json.at("outer"));
    for (const auto& hole : json.at("hole_rings")) add(hole);
    std::size_t corners = 0;
    for (const Ring& ring : e.rings) corners += ring.size();
    if (corners < least || corners >= below) continue;
    const auto box = geometry::bounds(e.rings[0]);
    // Those without a unit become buildings, the larger ones palaces: so wide that their details are some metres.
    const double width = std::max(20.0, 3 * std::sqrt(static_cast<double>(corners)));
    const double scale =
        json.at("units") == "m" ? 1 : width / std::max(box.most.x - box.least.x, box.most.y - box.least.y);
    for (Ring& ring : e.rings)
      for (Point2& p : ring) p = scale * (p - box.least);
    entries.push_back(std::move(e));
  }
  return entries;
}

struct Case {
  Dress dress;
  std::size_t least, below;
};

class SharedPolygons : public testing::TestWithParam<Case> {};

auto fault_of(const Plan& plan) -> std::string {
  const auto raised = extrude::raise(plan);
  if (!raised) return base::to_string(raised.error());
  if (raised->outcome != extrude::Outcome::full)
    return raised->warnings.empty() ? "not in full" : base::to_string(raised->warnings[0]);
  return faults(raised->solid);
}

TEST_P(SharedPolygons, are_all_raised_in_full) {
  const Case& with = GetParam();
  for (const Entry& e : corpus(with.least, with.below)) {
    base::Random random(e.rings[0].size(), static_cast<std::uint64_t>(with.dress));
    Plan plan = dressed(e.rings, with.dress, random);
    plan.cap = with.dress == Dress::hipped ? 1000 : 12;
    const std::string fault = fault_of(plan);
    EXPECT_EQ(fault.empty(), !refused.contains(e.name)) << e.name << ": " << fault;
    if (!fault.empty()) keep_failure(plan, MANSARD_TEST_DATA "/fixtures/kept", e.name);
  }
}

const std::vector<std::size_t> sizes{3, 10, 14, 18, 24, 32, 60, 200, 800, 2000, 10000};

auto cases() -> std::vector<Case> {
  std::vector<Case> out;
  for (const Dress dress : {Dress::hipped, Dress::gabled, Dress::mansard, Dress::eaves, Dress::setbacks})
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i) out.push_back({dress, sizes[i], sizes[i + 1]});
  return out;
}

INSTANTIATE_TEST_SUITE_P(All, SharedPolygons, testing::ValuesIn(cases()), [](const auto& instance) {
  const Case& c = instance.param;
  return std::string(dress_names[static_cast<std::size_t>(c.dress)]) + "_from_" + std::to_string(c.least) + "_corners";
});

TEST(SharedPolygons, are_582) {
  if (!std::filesystem::exists(MANSARD_SHARED_DATA)) GTEST_SKIP() << "no shared data";
  EXPECT_EQ(corpus(sizes.front(), sizes.back()).size(), 582U);
}

}  // namespace
