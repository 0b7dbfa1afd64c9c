// Planted blocks of the size of the paper's smaller ones, compared with a four-colour program of their faces.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mansard/segment/segment.hpp"
#include "planar.hpp"
#include "planted.hpp"

namespace mansard::segment {
namespace {

/// Faces as nodes, candidates as edges, costs as in the program that was solved.
auto problem_of(const Segmentation& segmentation, const solver::Program& program) -> detail::Multicut {
  detail::Multicut problem;
  std::map<std::uint32_t, std::uint32_t> node_of_face;
  for (std::uint32_t f = 0; f < segmentation.faces.size(); ++f)
    if (segmentation.faces[f].inside) node_of_face.emplace(f, problem.nodes++);
  for (std::size_t i = 0; i < segmentation.candidates.size(); ++i) {
    const Candidate& c = segmentation.candidates[i];
    problem.edges.push_back(
        {node_of_face.at(c.left), node_of_face.at(c.right), std::llround(program.variables[i].cost), c.forced});
  }
  for (const Conflict& conflict : segmentation.conflicts)
    if (conflict.second)
      problem.pairs.push_back({conflict.first, *conflict.second, std::llround(1000 * segmentation.phi)});
  return problem;
}

TEST(FourColours, find_the_same_optimum_on_planted_blocks_of_up_to_60_faces) {
  std::size_t most = 0;
  for (const char* name : {"glasgow_small", "copenhagen"})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto planted = planted::make(planted::preset(name, seed));
      Options options;
      options.thin_reach = seed == 2 ? ThinReach::block : ThinReach::face;
      options.gis_shortest = 0.2;  // jogs of 5 cm would make more faces than four colours can be tried on
      options.height_weight = seed == 3 ? 1 : 16;
      const auto arrangement = planted::fractured(planted, options);
      const auto s =
          choose(arrangement, planted.edges, planted.block, rays::Scene(planted.block.mesh), options).value();
      const auto inside = static_cast<std::size_t>(std::ranges::count_if(s.faces, &FaceEvidence::inside));
      if (inside > 60) continue;
      most = std::max(most, inside);
      ASSERT_EQ(s.status, "optimal");
      const solver::Program program = program_of(s);
      const auto least = testing::least_by_four_colours(problem_of(s, program));
      const auto rounding = static_cast<double>(s.candidates.size() + 1);
      EXPECT_NEAR(static_cast<double>(least) + program.constant, 1000 * s.objective, rounding)
          << name << " " << seed << ", " << inside << " faces";
    }
  EXPECT_GE(most, 45U);
}

}  // namespace
}  // namespace mansard::segment
