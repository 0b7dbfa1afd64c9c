// Random plans: whatever is chosen, parts are simple, disjoint and cover what is inside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ascii_map.hpp"
#include "mansard/segment/detail/parts.hpp"
#include "mansard/segment/detail/rings.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment {
namespace {

using testing::AsciiMap, testing::sweep_edges;

/// Every cell a face of its own: rows of letters of a large alphabet.
auto cells(int columns, int rows) -> std::vector<std::string> {
  std::vector<std::string> map;
  char letter = 33;
  for (int y = 0; y < rows; ++y) {
    std::string line;
    for (int x = 0; x < columns; ++x, ++letter) {
      if (letter == '.') ++letter;
      line += letter;
    }
    map.push_back(line);
  }
  return map;
}

auto corners_are_unique(const geometry::Polygon& polygon) -> bool {
  std::vector<geometry::Point2> points = polygon.outer;
  for (const auto& hole : polygon.holes) points.insert(points.end(), hole.begin(), hole.end());
  std::ranges::sort(points);
  return std::ranges::adjacent_find(points) == points.end();
}

TEST(Parts, of_random_labels_are_simple_disjoint_and_cover_the_inside) {
  base::Random random(17);
  int holes = 0, pinches = 0;
  for (int round = 0; round < 150; ++round) {
    const int columns = 3 + static_cast<int>(random.index(5)), rows = 3 + static_cast<int>(random.index(5));
    const AsciiMap map(cells(columns, rows), 4);
    const std::size_t count = map.arrangement.faces.size();
    detail::Evidence evidence{std::vector<FaceEvidence>(count), std::vector<detail::FaceSamples>(count),
                              std::vector<double>(count, 0.0)};
    // Blobs: labels 0 or 1 or outside, then split into connected pieces.
    std::vector<int> colour(count);
    double inside = 0;
    for (std::size_t f = 0; f < count; ++f) {
      const double chance = random.uniform();
      colour[f] = chance < 0.12 ? 0 : chance < 0.95 ? 1 : 2;
      evidence.faces[f].inside = colour[f] > 0;
      if (colour[f] > 0) inside += map.arrangement.faces[f].area;
    }
    std::vector<std::optional<std::uint32_t>> label(count);
    for (std::uint32_t f = 0; f < count; ++f) {
      if (colour[f] == 0 || label[f]) continue;
      std::vector<std::uint32_t> open{f};
      label[f] = f;
      while (!open.empty()) {
        const std::uint32_t g = open.back();
        open.pop_back();
        std::uint32_t h = map.arrangement.faces[g].edge;
        do {
          const auto other = map.arrangement.half_edges[map.arrangement.half_edges[h].twin].face;
          if (other && colour[*other] == colour[g] && !label[*other]) label[*other] = f, open.push_back(*other);
          h = map.arrangement.half_edges[h].next;
        } while (h != map.arrangement.faces[g].edge);
      }
    }
    Segmentation s;
    Options options;
    options.narrow = 0;
    detail::make_parts(map.arrangement, evidence, label, options, s);
    EXPECT_TRUE(s.warnings.empty());
    double sum = 0;
    for (const Part& part : s.parts) {
      ASSERT_TRUE(geometry::is_simple(part.polygon)) << round;
      EXPECT_TRUE(corners_are_unique(part.polygon));
      sum += geometry::area(part.polygon);
      holes += static_cast<int>(part.polygon.holes.size());
      for (const auto p : part.polygon.outer)
        if (std::abs(std::remainder(p.x, 4)) > 1e-9) ++pinches;
    }
    // A pinched corner costs a triangle of 1 cm by a few metres at most.
    EXPECT_NEAR(sum, inside, 0.05 * static_cast<double>(count));
    EXPECT_LE(sum, inside + 1e-6) << "parts only ever draw back";
    for (std::size_t a = 0; a < s.parts.size(); ++a)
      for (std::size_t b = a + 1; b < s.parts.size(); ++b) {
        const auto common = geometry::intersect(s.parts[a].polygon, s.parts[b].polygon);
        ASSERT_TRUE(common);
        for (const auto& piece : *common) EXPECT_LT(geometry::area(piece), 1e-6) << round;
      }
  }
  EXPECT_GT(holes, 5) << "the rounds exercise holes";
  EXPECT_GT(pinches, 20) << "and pinches";
}

TEST(Parts, chosen_on_random_blocks_keep_every_guarantee_and_come_out_the_same_twice) {
  base::Random random(23);
  for (int round = 0; round < 12; ++round) {
    AsciiMap map(cells(6, 5), 3.5);
    std::map<char, double> heights;
    std::string first, second;
    for (const auto& [letter, face] : map.face) {
      const double height = random.uniform() < 0.12 ? 1 : 6 + 4 * static_cast<double>(random.index(4));
      if (random.uniform() < 0.85) heights[letter] = height;
      (map.at(static_cast<int>(face) % 6, 0) != ' ' && random.uniform() < 0.5 ? first : second) += letter;
    }
    for (std::uint32_t source = 0; source < 8; ++source) {
      const auto grid = [&](std::size_t n) { return 3.5 * static_cast<double>(random.index(n)); };
      if (source % 2 == 0) {
        const double x = grid(7), y = grid(4);
        map.wall({x, y}, {x, y + 7}, source);
      } else {
        const double x = grid(5), y = grid(6);
        map.wall({x + 7, y}, {x, y}, source);
      }
    }
    const block::Block block = round % 2 == 0 ? map.block({first, second}) : map.block({first + second});
    const rays::Scene mesh(map.roofs(heights));
    const auto one = choose(map.arrangement, sweep_edges(8), block, mesh, {});
    base::limit_threads(1);
    const auto two = choose(map.arrangement, sweep_edges(8), block, mesh, {});
    base::limit_threads(0);
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->status, "optimal");
    EXPECT_EQ(one->part_of_face, two->part_of_face);
    ASSERT_EQ(one->parts.size(), two->parts.size());
    for (std::size_t p = 0; p < one->parts.size(); ++p) {
      EXPECT_EQ(one->parts[p].polygon, two->parts[p].polygon);
      EXPECT_TRUE(geometry::is_simple(one->parts[p].polygon));
      EXPECT_EQ(one->parts[p].height, two->parts[p].height);
    }
    for (const Candidate& c : one->candidates) {
      EXPECT_EQ(c.chosen, one->part_of_face[c.left] != one->part_of_face[c.right]);
      EXPECT_EQ(c.forced, one->faces[c.left].feature != one->faces[c.right].feature);
      if (c.forced) {
        EXPECT_TRUE(c.chosen);
      }
    }
    for (std::size_t p = 1; p < one->parts.size(); ++p) {
      const auto key = [](const Part& part) {
        return std::tuple(!part.feature, part.feature.value_or(0), part.faces.front());
      };
      EXPECT_LT(key(one->parts[p - 1]), key(one->parts[p]));
    }
  }
}

TEST(Rings, keep_corners_that_are_farther_than_the_tolerance_from_the_edge_without_them) {
  detail::CornerRing ring;
  std::uint32_t vertex = 0;
  for (const geometry::Point2 p : {geometry::Point2{0, 0}, {5, 0.009}, {10, 0}, {10, 5}, {9.97, 10}, {10, 15}, {0, 15}})
    ring.push_back({p, vertex}), ++vertex;
  const auto straight = detail::straightened({ring}, 0.01);
  ASSERT_EQ(straight.size(), 1U);
  ASSERT_EQ(straight[0].size(), 6U) << "only (5, 0.009) goes";
  EXPECT_EQ(straight[0][1].at, (geometry::Point2{10, 0}));
}

TEST(Rings, do_not_drift_by_dropping_one_corner_after_another) {
  detail::CornerRing ring;
  std::uint32_t vertex = 0;
  for (int i = 0; i <= 40; ++i) {  // an arc of 20 m radius: every corner is millimetres off its neighbours' chord
    const double a = 0.01 * i;
    ring.push_back({{20 * std::cos(a), 20 * std::sin(a)}, vertex});
    ++vertex;
  }
  ring.push_back({{0, 0}, vertex});
  const auto straight = detail::straightened({ring}, 0.01)[0];
  EXPECT_LT(straight.size(), ring.size());
  for (const auto& corner : ring) {
    double nearest = 1e300;
    for (std::size_t i = 0; i < straight.size(); ++i)
      nearest =
          std::min(nearest, geometry::distance({straight[i].at, straight[(i + 1) % straight.size()].at}, corner.at));
    EXPECT_LE(nearest, 0.01 + 1e-12);
  }
}

}  // namespace
}  // namespace mansard::segment
