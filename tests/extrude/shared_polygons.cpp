// Real building outlines, and cases that broke other skeletons: read from the shared data, whose licences keep them out
// of the project.
#include <gmock/gmock.h>

#include <fstream>

#include "mansard/base/text.hpp"
#include "mansard/extrude/extrude.hpp"
#include "plans.hpp"

namespace {

using namespace plans;

struct Entry {
  std::string name;
  bool metres = false;
  Ring outer;
  std::vector<Ring> holes;
};

/// The rings after a key of one line of the file: `[[x,y],…]`, or a list of such lists.
auto rings_after(const std::string& line, const std::string& key, int depth_of_ring) -> std::vector<Ring> {
  std::vector<Ring> rings;
  std::size_t at = line.find("\"" + key + "\":");
  if (at == std::string::npos) return rings;
  at += key.size() + 3;
  int depth = 0;
  std::vector<double> pair;
  do {
    const char c = line[at];
    if (c == '[') {
      if (++depth == depth_of_ring) rings.emplace_back();
      pair.clear();
      ++at;
    } else if (c == ']') {
      if (depth == depth_of_ring + 1 && pair.size() == 2) rings.back().push_back({pair[0], pair[1]});
      pair.clear();
      --depth;
      ++at;
    } else if (c == ',' || c == ' ') {
      ++at;
    } else {
      const std::size_t end = line.find_first_of(",] ", at);
      pair.push_back(base::to_number(line.substr(at, end - at)).value());
      at = end;
    }
  } while (depth > 0 && at < line.size());
  return rings;
}

/// Every polygon of at most that many corners.
auto corpus(std::size_t most) -> std::vector<Entry> {
  std::vector<Entry> entries;
  std::ifstream in(MANSARD_SHARED_DATA "/polygons/polygons.jsonl");
  for (std::string line; std::getline(in, line);) {
    Entry e;
    const std::size_t name = line.find("\"name\":\"") + 8;
    e.name = line.substr(name, line.find('"', name) - name);
    e.metres = line.find("\"units\":\"m\"") != std::string::npos;
    e.outer = rings_after(line, "outer", 1).at(0);
    e.holes = rings_after(line, "hole_rings", 2);
    std::size_t n = e.outer.size();
    for (const Ring& hole : e.holes) n += hole.size();
    if (n > most) continue;
    const auto area = geometry::bounds(e.outer);
    const double scale = e.metres ? 1 : 20 / std::max(area.most.x - area.least.x, area.most.y - area.least.y);
    const auto place = [&](Ring& ring) {
      for (Point2& p : ring) p = scale * (p - area.least);
    };
    place(e.outer);
    for (Ring& hole : e.holes) place(hole);
    entries.push_back(std::move(e));
  }
  return entries;
}

TEST(SharedPolygons, are_all_raised_in_full_under_a_hip) {
  const auto entries = corpus(24);
  ASSERT_GT(entries.size(), 150U);
  for (const Entry& e : entries) {
    const auto raised = extrude::raise(plan(e.outer, {hip}, {}, 1000, e.holes));
    ASSERT_TRUE(raised) << e.name << " " << base::to_string(raised.error());
    EXPECT_EQ(raised->outcome, extrude::Outcome::full) << e.name;
    EXPECT_EQ(faults(raised->solid), "") << e.name;
  }
}

TEST(SharedPolygons, are_all_raised_in_full_under_mixed_profiles) {
  const auto entries = corpus(18);
  ASSERT_GT(entries.size(), 80U);
  base::Random random(3);
  for (const Entry& e : entries) {
    Plan p = plan(e.outer, {hip, wall, two_pitch, setback, {{0, 0}, {0, 4}, {2, 5}}}, {}, 8, e.holes);
    for (auto& k : p.outer.profile_of_edge) k = static_cast<std::uint32_t>(random.index(5));
    for (auto& hole : p.holes)
      for (auto& k : hole.profile_of_edge) k = static_cast<std::uint32_t>(random.index(5));
    const auto raised = extrude::raise(p);
    ASSERT_TRUE(raised) << e.name << " " << base::to_string(raised.error());
    EXPECT_EQ(raised->outcome, extrude::Outcome::full)
        << e.name << " " << (raised->warnings.empty() ? "" : raised->warnings[0].message);
    EXPECT_EQ(faults(raised->solid), "") << e.name;
  }
}

}  // namespace
