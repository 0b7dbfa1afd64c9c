// The terms of the objective, the readings of O2 and O7, GIS edges as candidates; and that the program says the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "case.hpp"

namespace mansard::segment {
namespace {

using testing::AsciiMap, testing::Case, testing::expect_guarantees, testing::plain, testing::sweep_edges;

/// Two houses of one height, a GIS edge between them, and one feature each.
auto equal_houses() -> Case {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}, {'B', 10}}, {"A", "B"});
  c.map.wall({10, 0}, {10, 10}, gis_source);
  c.options.gis_edges = GisEdges::candidate;
  return c;
}

TEST(GisCandidate, finds_the_party_wall_between_equal_houses) {
  Case c = equal_houses();
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  EXPECT_EQ(s.parts.size(), 2U);
  EXPECT_FALSE(s.candidates[0].forced);
  EXPECT_NEAR(s.candidates[0].amounts[Term::gis_unused], 10, 1e-9);
  EXPECT_NEAR(s.candidates[0].costs[Term::gis_unused], c.options.gis_alpha * 10, 1e-9);
  EXPECT_NEAR(s.objective, 0, 1e-9) << "a GIS edge pays no β";
}

TEST(GisCandidate, is_left_alone_where_nothing_pays_for_it) {
  Case c = equal_houses();
  c.options.gis_alpha = 0;
  EXPECT_EQ(c.run().parts.size(), 1U);
  c.options.gis_edges = GisEdges::hard;
  EXPECT_EQ(c.run().parts.size(), 2U) << "no choice then";
}

TEST(GisCandidate, gives_way_to_a_sweep_edge_beside_it) {
  // The wall was seen 1 m east of where the GIS has it: only one of the two can be used.
  Case c{AsciiMap(std::vector<std::string>(6, "AAAAABCCCCC"), 1), {{'A', 10}, {'B', 10}, {'C', 12}}, {"A", "BC"}, {}};
  c.map.wall({5, 0}, {5, 6}, gis_source);
  c.map.wall({6, 0}, {6, 6}, 0);
  c.options.gis_edges = GisEdges::candidate;
  c.options.narrow = 0;
  c.options.phi = 100;
  const Segmentation s = c.run();
  expect_guarantees(c.map.arrangement, s);
  ASSERT_EQ(s.parts.size(), 2U);
  EXPECT_EQ(c.part(s, 'A'), c.part(s, 'B'));
  EXPECT_NEAR(s.terms[Term::gis_unused], 6 * c.options.gis_alpha, 1e-6);
  EXPECT_EQ(s.terms[Term::sweep_unused], 0);
}

TEST(GisCandidate, pays_by_the_sweep_edge_where_both_run) {
  Case c = equal_houses();
  c.map.wall({10, 0}, {10, 10}, 0);
  const Segmentation s = c.run();
  EXPECT_EQ(s.candidates[0].amounts[Term::gis_unused], 0);
  EXPECT_NEAR(s.candidates[0].costs.sum(Paid::uncut), c.options.alpha * 10, 1e-6);
}

TEST(HeightMeasure, sees_the_step_at_the_edge_which_medians_do_not) {
  // A: 12 12 10 10 8 8, B: 14 14 12 12 10 10 – a step of 6 m at the edge, medians 10 and 12.
  const AsciiMap map(std::vector<std::string>(4, "AAAAAABBBBBB"), 1);
  const AsciiMap roofs(std::vector<std::string>(4, "aabbccddaabb"), 1);
  const rays::Scene mesh(roofs.roofs({{'a', 12}, {'b', 10}, {'c', 8}, {'d', 14}}));
  Options options;
  const auto step = [&](HeightMeasure measure) {
    options.height_measure = measure;
    const auto s = choose(map.arrangement, sweep_edges(0), map.block({"AB"}), mesh, options);
    EXPECT_TRUE(s);
    EXPECT_EQ(s->candidates.size(), 1U);
    return s->candidates[0].amounts[Term::height];
  };
  EXPECT_NEAR(step(HeightMeasure::median), 2, 0.01);
  EXPECT_NEAR(step(HeightMeasure::along), 6, 0.01);
}

TEST(HeightMeasure, sees_none_across_a_ridge_that_is_off_the_middle) {
  // Medians 9 and 6, but 10 on both sides of the edge.
  const AsciiMap map(std::vector<std::string>(4, "AAAAAABBBBBB"), 1);
  const AsciiMap roofs(std::vector<std::string>(4, "ababaaaccccc"), 1);
  const rays::Scene mesh(roofs.roofs({{'a', 10}, {'b', 8}, {'c', 6}}));
  Options options;
  options.height_measure = HeightMeasure::along;
  const auto s = choose(map.arrangement, sweep_edges(0), map.block({"AB"}), mesh, options).value();
  EXPECT_NEAR(s.candidates[0].amounts[Term::height], 0, 0.01);
}

TEST(HeightMeasure, falls_back_to_medians_without_mesh_coverage) {
  Case c = plain({"AABB", "AABB"}, {{'A', 10}}, {"AB"});
  c.options.height_measure = HeightMeasure::along;
  EXPECT_EQ(c.run().candidates[0].amounts[Term::height], 0) << "B borrows its height from A";
}

TEST(ThinReach, looks_across_several_faces_when_told_to) {
  // Two strips of 0.8 m side by side: their outer walls are 1.6 m apart, and in no common face.
  Case c{AsciiMap(std::vector<std::string>(6, "AAAAAABCDDDDDD"), 0.8), {}, {"ABCD"}, {}};
  for (const char l : std::string("ABCD")) c.heights[l] = 10;
  const auto pairs = [&](ThinReach reach) {
    c.options.thin_reach = reach;
    const Segmentation s = c.run();
    expect_guarantees(c.map.arrangement, s);
    return s.conflicts.size();
  };
  EXPECT_EQ(pairs(ThinReach::face), 2U) << "AB with BC, BC with CD";
  EXPECT_EQ(pairs(ThinReach::block), 3U) << "AB with CD too";
  c.options.thin_distance = 1.2;
  EXPECT_EQ(pairs(ThinReach::block), 2U) << "too far from each other";
}

TEST(ThinReach, does_not_look_across_what_is_outside) {
  Case c{AsciiMap(std::vector<std::string>(6, "AAAAAAB.CDDDDDD"), 0.5), {}, {"ABCD"}, {}};
  for (const char l : std::string("ABCD")) c.heights[l] = 10;
  c.options.thin_reach = ThinReach::block;
  for (const Conflict& conflict : c.run().conflicts) EXPECT_FALSE(conflict.second) << "each only with its own outline";
}

TEST(ThinRule, any_holds_edges_at_right_angles_against_each_other) {
  // A corner of C reaches into the walls' corner: AB runs down, AD and BC across; AB's upper and lower wall are one
  // line.
  Case c{AsciiMap({"AAAABBBB", "AAAABBBB", "AAAABBBB", "AAAACCBB", "AAAACCBB", "AAAABBBB"}, 0.5), {}, {"ABC"}, {}};
  for (const char l : std::string("ABC")) c.heights[l] = 10;
  const auto pairs = [&](ThinRule rule, double distance) {
    c.options.thin_rule = rule;
    c.options.thin_distance = distance;
    c.options.thin_reach = ThinReach::block;
    const Segmentation s = c.run();
    expect_guarantees(c.map.arrangement, s);
    return s.conflicts.size();
  };
  EXPECT_LT(pairs(ThinRule::all, 1.8), pairs(ThinRule::any, 1.8))
      << "those that face each other are some of all near ones";
  EXPECT_LT(pairs(ThinRule::any, 0.4), pairs(ThinRule::any, 1.8)) << "nothing that does not meet is so near";
}

TEST(ThinRule, any_does_not_hold_a_straight_wall_against_itself) {
  // One line of walls, in three pieces with different neighbours; nothing else is near.
  Case c{AsciiMap({"AAAAAAAA", "AAAAAAAA", "AAAAAAAA", "BBBCCDDD", "BBBCCDDD", "BBBCCDDD"}, 1), {}, {"ABCD"}, {}};
  for (const char l : std::string("ABCD")) c.heights[l] = 10;
  c.options.thin_rule = ThinRule::any;
  c.options.thin_reach = ThinReach::block;
  c.options.thin_distance = 2.5;
  std::size_t pairs = 0;
  for (const Conflict& conflict : c.run().conflicts) pairs += conflict.second ? 1 : 0;
  EXPECT_EQ(pairs, 3U) << "BC with CD, AB with CD, AD with BC; not AB with AD, which is 2 m further along";
}

/// A random plan of rooms with random walls.
auto random_rooms(base::Random& random) -> Case {
  AsciiMap map({"AABBCCDD", "AABBCCDD", "EEFFGGHH", "EEFFGGHH", "IIJJKKLL", "IIJJKKLL"}, 1);
  Case c{map, {}, {"ABCDEFGHIJKL"}, {}};
  for (const char l : std::string("ABCDEFGHIJKL")) c.heights[l] = 8 + std::floor(12 * random.uniform()) / 2;
  for (std::uint32_t source = 0; source < 6; ++source) {
    const double at = 2 * static_cast<double>(1 + random.index(2)), from = 2 * static_cast<double>(random.index(2));
    if (source % 2 == 0) c.map.wall({at, from}, {at, from + 4}, source);
    else c.map.wall({from, at}, {from + 4, at}, source);
  }
  c.options.thin_distance = 2.5;
  c.options.narrow = 0;
  return c;
}

TEST(Program, has_the_objective_as_its_optimum_whatever_the_options) {
  base::Random random(17);
  for (int round = 0; round < 24; ++round) {
    Case c = random_rooms(random);
    c.options.phi = round % 3 == 0 ? 0.5 : 5;
    c.options.thin_reach = round % 2 == 0 ? ThinReach::block : ThinReach::face;
    c.options.cliques = round % 4 < 2;
    c.options.height_weight = 1 + round % 5;
    const Segmentation s = c.run();
    EXPECT_EQ(s.status, "optimal");
    const solver::Program program = program_of(s);
    const auto solution = solver::minimise(program, {});
    ASSERT_TRUE(solution);
    const double rounding = static_cast<double>(s.candidates.size() + 1);
    EXPECT_NEAR(solution->objective, 1000 * s.objective, rounding) << "round " << round;
    double costs = program.constant;
    for (std::size_t i = 0; i < s.candidates.size(); ++i)
      costs += s.candidates[i].solved ? program.variables[i].cost : 0;
    for (const Conflict& conflict : s.conflicts)
      if (conflict.second && s.candidates[conflict.first].solved && s.candidates[*conflict.second].solved)
        costs += 1000 * s.phi;
    EXPECT_NEAR(costs, solution->objective, 1e-6) << "in whole thousandths nothing is rounded";
  }
}

TEST(Program, costs_the_same_with_and_without_clique_rows) {
  base::Random random(23);
  for (int round = 0; round < 12; ++round) {
    Case c = random_rooms(random);
    c.options.thin_reach = ThinReach::block;
    const double without = c.run().objective;
    c.options.cliques = true;
    EXPECT_NEAR(c.run().objective, without, 1e-6);
  }
}

TEST(Limits, no_thin_cost_with_phi_0_and_no_paid_conflict_with_a_huge_one) {
  base::Random random(29);
  for (int round = 0; round < 8; ++round) {
    Case c = random_rooms(random);
    c.options.phi = 0;
    const Segmentation free = c.run();
    EXPECT_EQ(free.terms[Term::thin], 0);
    c.options.phi = 1e4;
    const Segmentation dear = c.run();
    EXPECT_EQ(dear.terms[Term::thin], 0) << "cutting nothing has no conflict, so the optimum has none";
    EXPECT_GE(dear.objective, free.objective - 1e-6);
    for (const Conflict& conflict : dear.conflicts)
      EXPECT_FALSE(dear.candidates[conflict.first].solved &&
                   (!conflict.second || dear.candidates[*conflict.second].solved));
  }
}

TEST(Limits, no_more_metres_without_support_with_a_greater_beta) {
  base::Random random(31);
  for (int round = 0; round < 8; ++round) {
    Case c = random_rooms(random);
    c.options.height_weight = 20;
    double before = 1e300;
    for (const double beta : {1.0, 5.0, 20.0, 60.0, 200.0, 1000.0}) {
      c.options.beta = beta;
      const Segmentation s = c.run();
      EXPECT_EQ(s.status, "optimal");
      EXPECT_LE(s.terms[Term::unsupported] / beta, before + 1e-6) << "beta " << beta;
      before = s.terms[Term::unsupported] / beta;
    }
  }
}

TEST(Limits, no_time_at_all_still_gives_parts_and_a_true_bound) {
  base::Random random(37);
  int with_gap = 0;
  for (int round = 0; round < 12; ++round) {
    Case c = random_rooms(random);
    const double best = c.run().objective;
    c.options.seconds = 0;
    const Segmentation s = c.run();
    expect_guarantees(c.map.arrangement, s);
    EXPECT_GE(s.parts.size(), 1U);
    EXPECT_LE(s.bound, best + 1e-6);
    EXPECT_GE(s.objective, best - 1e-6);
    EXPECT_EQ(s.status, s.bound < s.objective ? "stopped" : "optimal");
    with_gap += s.bound < s.objective ? 1 : 0;
  }
  EXPECT_GT(with_gap, 0) << "some of them are not proven without the solver";
}

auto turned(geometry::Point2 p, double angle) -> geometry::Point2 {
  return {std::cos(angle) * p.x - std::sin(angle) * p.y + 300, std::sin(angle) * p.x + std::cos(angle) * p.y - 100};
}

TEST(Invariance, of_the_objective_when_the_plane_is_turned_and_faces_are_numbered_again) {
  base::Random random(41);
  for (int round = 0; round < 10; ++round) {
    Case c = random_rooms(random);
    const Segmentation before = c.run();
    const double angle = random.uniform(0, 6);
    geometry::Mesh roofs = c.map.roofs(c.heights);
    for (auto& v : roofs.vertices) {
      const auto p = turned({v.x, v.y}, angle);
      v.x = p.x, v.y = p.y;
    }
    block::Block block = c.map.block(c.features);
    for (auto& member : block.members)
      for (auto& polygon : member.polygons)
        for (auto& p : polygon.outer) p = turned(p, angle);
    fracture::Arrangement arrangement = c.map.arrangement;
    for (auto& p : arrangement.vertices) p = turned(p, angle);
    // Faces in reverse, half-edges with their twins swapped.
    const auto last = static_cast<std::uint32_t>(arrangement.faces.size() - 1);
    std::ranges::reverse(arrangement.faces);
    auto& half_edges = arrangement.half_edges;
    for (std::size_t h = 0; h < half_edges.size(); h += 2) std::swap(half_edges[h], half_edges[h + 1]);
    for (auto& h : half_edges) {
      h.twin ^= 1U, h.next ^= 1U, h.previous ^= 1U;
      if (h.face) h.face = last - *h.face;
    }
    for (auto& f : arrangement.faces) f.edge ^= 1U;
    const auto after = choose(arrangement, sweep_edges(8), block, rays::Scene(roofs), c.options);
    ASSERT_TRUE(after);
    EXPECT_EQ(after->candidates.size(), before.candidates.size());
    EXPECT_EQ(after->conflicts.size(), before.conflicts.size());
    EXPECT_NEAR(after->objective, before.objective, 1e-4 * before.objective + 0.05);
    EXPECT_EQ(after->parts.size(), before.parts.size());
  }
}

TEST(Terms, have_names_weights_and_reasons_and_add_up) {
  std::set<std::string_view> names, costs;
  Terms all;
  for (const TermInfo& info : terms()) {
    EXPECT_FALSE(info.symbol.empty() || info.words.empty() || info.caption.empty()) << info.name;
    EXPECT_FALSE(info.reason(12).empty()) << info.name;
    names.insert(info.name);
    costs.insert(info.cost);
    all[info.term] = 1;
  }
  EXPECT_EQ(names.size(), term_count);
  EXPECT_EQ(costs.size(), term_count);
  EXPECT_EQ(all.sum(), term_count);
  EXPECT_EQ(all.sum(Paid::cut) + all.sum(Paid::uncut), all.sum());
  all += all;
  EXPECT_EQ(all[Term::gis_unused], 2);
}

}  // namespace
}  // namespace mansard::segment
