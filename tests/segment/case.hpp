// A drawn plan with all that choose() wants, and what every answer must hold.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ascii_map.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment::testing {

/// O2 weighs 1, as published, so that what is drawn can be added up in the head.
struct DrawnOptions : Options {
  DrawnOptions() { height_weight = 1; }
};

struct Case {
  AsciiMap map;
  std::map<char, double> heights;
  std::vector<std::string> features;
  DrawnOptions options;

  [[nodiscard]] auto run(std::size_t edges = 8) const -> Segmentation {
    const rays::Scene mesh(map.roofs(heights));
    auto segmentation = choose(map.arrangement, sweep_edges(edges), map.block(features), mesh, options);
    EXPECT_TRUE(segmentation) << (segmentation ? "" : base::to_string(segmentation.error()));
    return segmentation ? std::move(*segmentation) : Segmentation{};
  }
  [[nodiscard]] auto part(const Segmentation& s, char letter) const -> std::optional<std::uint32_t> {
    return s.part_of_face[map.face.at(letter)];
  }
};

/// Guarantees 1 to 3, whatever the input.
inline void expect_guarantees(const fracture::Arrangement& arrangement, const Segmentation& s) {
  for (const Candidate& c : s.candidates) {
    ASSERT_TRUE(s.faces[c.left].inside && s.faces[c.right].inside);
    EXPECT_EQ(c.chosen, s.part_of_face[c.left] != s.part_of_face[c.right]);
    if (c.forced) {
      EXPECT_TRUE(c.chosen);
    }
  }
  EXPECT_LE(s.bound, s.objective);
  if (s.status == "optimal") {
    EXPECT_EQ(s.bound, s.objective);
  }
  EXPECT_DOUBLE_EQ(s.objective, s.terms.sum());
  for (std::uint32_t p = 0; p < s.parts.size(); ++p) {
    const Part& part = s.parts[p];
    EXPECT_TRUE(geometry::is_simple(part.polygon));
    EXPECT_GT(geometry::signed_area(part.polygon.outer), 0);
    for (const auto& hole : part.polygon.holes) EXPECT_LT(geometry::signed_area(hole), 0);
    double area = 0;
    for (const std::uint32_t f : part.faces) {
      EXPECT_EQ(s.part_of_face[f], p);
      area += arrangement.faces[f].area;
    }
    // Straightening and opening move the outline by a centimetre at most.
    double rim = geometry::perimeter(part.polygon.outer);
    for (const auto& hole : part.polygon.holes) rim += geometry::perimeter(hole);
    EXPECT_NEAR(geometry::area(part.polygon), area, 0.02 * rim);
  }
}

inline auto plain(std::vector<std::string> rows, std::map<char, double> heights, std::vector<std::string> features)
    -> Case {
  Case c{AsciiMap(std::move(rows)), std::move(heights), std::move(features), {}};
  return c;
}

}  // namespace mansard::segment::testing
