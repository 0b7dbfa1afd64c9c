#include "mansard/solid/half_edges.hpp"

#include <gmock/gmock.h>

#include <map>

#include "extrude/plans.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace solid = mansard::solid;

namespace model = mansard::model;

using namespace plans;
using model::Solid;
using solid::HalfEdges;
using solid::Line;
using solid::LineKind;
using testing::ElementsAre;
using testing::Pair;

using Counts = std::map<std::string, int>;

auto solid_of(const Plan& p) -> Solid {
  auto raised = extrude::raise(p);
  if (!raised) {
    ADD_FAILURE() << base::to_string(raised.error()) << " " << text(p);
    return {};
  }
  EXPECT_EQ(raised->outcome, extrude::Outcome::full) << text(p);
  return std::move(raised->solid);
}

auto lines_of(const Solid& solid) -> std::vector<Line> {
  auto found = solid::lines(solid);
  if (found) return *found;
  ADD_FAILURE() << base::to_string(found.error());
  return {};
}

/// How many lines of each kind, but for the foot and the corners of the walls, which the roof does not change.
auto roof_lines(const Plan& p) -> Counts {
  Counts counts;
  for (const Line& line : lines_of(solid_of(p)))
    if (line.kind != LineKind::foot && line.kind != LineKind::corner && line.kind != LineKind::inner_corner)
      ++counts[std::string(solid::name(line.kind))];
  return counts;
}

/// The same however the plan is turned.
auto turned_or_not(const Plan& p) -> Counts {
  auto counts = roof_lines(p);
  for (const double angle : {0.3, 2.0}) EXPECT_EQ(roof_lines(turned(p, angle)), counts) << angle;
  return counts;
}

TEST(HalfEdges, go_round_every_face_and_have_opposites) {
  const auto solid = solid_of(plan(box(20, 20), {setback}, {}, 6, {turned_in({{8, 8}, {12, 8}, {12, 12}, {8, 12}})}));
  const auto edges = solid::half_edges(solid);
  ASSERT_TRUE(edges);
  std::size_t corners = 0;
  ASSERT_EQ(edges->first_loop_of_face.size(), solid.faces.size() + 1);
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const auto& loops = solid.faces[f].loops;
    ASSERT_EQ(edges->first_loop_of_face[f + 1] - edges->first_loop_of_face[f], loops.size());
    for (std::uint32_t l = 0; l < loops.size(); ++l) {
      const std::uint32_t first = edges->first_of_loop[edges->first_loop_of_face[f] + l];
      std::uint32_t h = first;
      for (std::size_t i = 0; i < loops[l].size(); ++i, h = edges->next[h]) {
        EXPECT_EQ(edges->origin[h], loops[l][i]);
        EXPECT_EQ(edges->face[h], f);
        EXPECT_EQ(h, first + i);
      }
      EXPECT_EQ(h, first);
      corners += loops[l].size();
    }
  }
  EXPECT_EQ(edges->size(), corners);
  for (std::uint32_t h = 0; h < edges->size(); ++h) {
    EXPECT_EQ(edges->twin[edges->twin[h]], h);
    EXPECT_EQ(edges->origin[edges->twin[h]], edges->target(h));
    EXPECT_EQ(edges->target(edges->twin[h]), edges->origin[h]);
    EXPECT_NE(edges->face[edges->twin[h]], edges->face[h]);
  }
  for (std::uint32_t v = 0; v < solid.vertices.size(); ++v) EXPECT_EQ(edges->origin[edges->leaving[v]], v);
}

TEST(HalfEdges, say_what_is_wrong_with_a_solid) {
  const Solid cube = *extrude::prism(plan(box(2, 2), {wall}, {}, 2));
  const auto code = [](const Solid& solid) {
    const auto edges = solid::half_edges(solid);
    const auto found = solid::lines(solid);
    EXPECT_EQ(edges.has_value(), found.has_value());
    return edges ? std::string() : edges.error().code;
  };
  EXPECT_EQ(code(cube), "");
  Solid open = cube;
  open.faces.pop_back();
  EXPECT_EQ(code(open), "solid-open");
  Solid small = cube;
  small.faces[0].loops[0].resize(2);
  EXPECT_EQ(code(small), "solid-degenerate");
  Solid beyond = cube;
  beyond.faces[0].loops[0][0] = 8;
  EXPECT_EQ(code(beyond), "solid-degenerate");
  Solid twice = cube;
  for (const auto& face : cube.faces) twice.faces.push_back(face);
  EXPECT_EQ(code(twice), "solid-non-manifold");
  Solid tips = cube;  // a second cube that shares vertex 0
  for (std::size_t v = 1; v < 8; ++v) tips.vertices.push_back(-1.0 * cube.vertices[v]);
  for (auto face : cube.faces) {
    for (auto& loop : face.loops) {
      for (auto& v : loop) v = v == 0 ? 0 : v + 7;
      std::ranges::reverse(loop);
    }
    tips.faces.push_back(std::move(face));
  }
  EXPECT_EQ(code(tips), "solid-non-manifold");
}

TEST(Lines, name_a_hipped_roof) {
  //  +-----------+
  //  | \       / |
  //  |  >-----<  |
  //  | /       \ |
  //  +-----------+
  EXPECT_THAT(turned_or_not(plan(box(10, 6), {hip})), ElementsAre(Pair("eave", 4), Pair("hip", 4), Pair("ridge", 1)));
  EXPECT_THAT(turned_or_not(plan(box(10, 10), {hip})), ElementsAre(Pair("eave", 4), Pair("hip", 4)));
}

TEST(Lines, name_a_gabled_roof) {
  //  +-----------+
  //  |           |
  //  |-----------|
  //  |           |
  //  +-----------+
  const Plan p = plan(box(10, 6), {hip, wall}, {0, 1, 0, 1});
  EXPECT_THAT(turned_or_not(p), ElementsAre(Pair("eave", 2), Pair("ridge", 1), Pair("verge", 4)));
  // The ridge is where and as long as it should be.
  const Solid solid = solid_of(p);
  for (const Line& line : lines_of(solid)) {
    const Point3 a = solid.vertices[line.from], b = solid.vertices[line.to];
    if (line.kind == LineKind::ridge) {
      EXPECT_NEAR(a.z, 6, 1e-9);
      EXPECT_NEAR(b.z, 6, 1e-9);
      EXPECT_NEAR(a.y, 3, 1e-9);
      EXPECT_NEAR(length(b - a), 10, 1e-9);
    }
    if (line.kind == LineKind::eave) {
      EXPECT_NEAR(a.z + b.z, 6, 1e-9);
    }
    if (line.kind == LineKind::verge) {
      EXPECT_NEAR(a.x, b.x, 1e-9);
    }
    if (line.kind == LineKind::foot) {
      EXPECT_NEAR(a.z + b.z, 0, 1e-9);
    }
  }
}

TEST(Lines, name_a_single_pitch) {
  // Only one long side slopes: the roof ends high at the wall across.
  EXPECT_THAT(turned_or_not(plan(box(10, 6), {hip, wall}, {0, 1, 1, 1})),
              ElementsAre(Pair("eave", 1), Pair("mono ridge", 1), Pair("verge", 2)));
}

TEST(Lines, name_the_valley_of_an_L) {
  //  +----+
  //  |\  /|
  //  | \/ |          two ridges that meet above the inner corner's diagonal
  //  |  \ +-----+
  //  | / `v----/|    v the valley
  //  |/_________\|
  const Ring ell{{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 12}, {0, 12}};
  EXPECT_THAT(turned_or_not(plan(ell, {hip})),
              ElementsAre(Pair("eave", 6), Pair("hip", 5), Pair("ridge", 2), Pair("valley", 1)));
  const Solid solid = solid_of(plan(ell, {hip}));
  for (const Line& line : lines_of(solid))
    if (line.kind == LineKind::valley) {
      const Point3 a = solid.vertices[line.from], b = solid.vertices[line.to];
      EXPECT_NEAR(std::min(length(a - Point3{5, 5, 3}), length(b - Point3{5, 5, 3})), 0, 1e-9);
      EXPECT_NEAR(std::abs(b.x - a.x), std::abs(b.y - a.y), 1e-9);
    }
}

TEST(Lines, name_the_breaks_of_a_mansard) {
  // Steep, then shallow: on each side an eave and a break, at each corner two hips.
  EXPECT_THAT(turned_or_not(plan(box(12, 12), {two_pitch})),
              ElementsAre(Pair("eave", 4), Pair("hip", 8), Pair("pitch break", 4)));
  // Shallow below and steep above: as many breaks, reflex.
  const Profile bell{{0, 0}, {0, 3}, {2, 4}, {3, 7}};
  const Plan p = plan(box(12, 12), {bell});
  EXPECT_THAT(turned_or_not(p), ElementsAre(Pair("eave", 4), Pair("hip", 8), Pair("pitch break", 4)));
}

TEST(Lines, name_an_M_roof_by_its_level_valley) {
  //    /\  /\        Two slopes that start from one line: no plan says that, but a solid may.
  //   /  \/  \.
  //   |      |
  Solid solid;
  solid.vertices = {{0, 0, 0}, {8, 0, 0}, {8, 9, 0}, {0, 9, 0}, {0, 0, 3}, {2, 0, 5}, {4, 0, 3},
                    {6, 0, 5}, {8, 0, 3}, {0, 9, 3}, {2, 9, 5}, {4, 9, 3}, {6, 9, 5}, {8, 9, 3}};
  const auto add = [&](std::vector<std::uint32_t> loop, model::FaceKind kind) {
    const Point3 a = solid.vertices[loop[0]], b = solid.vertices[loop[1]], c = solid.vertices[loop[2]];
    model::Face face;
    face.normal = normalised(cross(b - a, c - a));
    face.loops = {std::move(loop)};
    face.kind = kind;
    solid.faces.push_back(std::move(face));
  };
  using model::FaceKind;
  add({0, 3, 2, 1}, FaceKind::base);
  add({8, 7, 6, 5, 4, 0, 1}, FaceKind::side);
  solid.faces.back().normal = {0, -1, 0};
  add({2, 3, 9, 10, 11, 12, 13}, FaceKind::side);
  solid.faces.back().normal = {0, 1, 0};
  add({3, 0, 4, 9}, FaceKind::side);
  add({1, 2, 13, 8}, FaceKind::side);
  add({4, 5, 10, 9}, FaceKind::side);
  add({5, 6, 11, 10}, FaceKind::side);
  add({6, 7, 12, 11}, FaceKind::side);
  add({7, 8, 13, 12}, FaceKind::side);
  ASSERT_EQ(faults(solid), "");
  Counts counts;
  for (const Line& line : lines_of(solid)) ++counts[std::string(solid::name(line.kind))];
  EXPECT_THAT(counts, ElementsAre(Pair("corner", 4), Pair("eave", 2), Pair("foot", 4), Pair("ridge", 2),
                                  Pair("valley", 1), Pair("verge", 8)));
}

TEST(Lines, name_the_valleys_between_three_wings) {
  // A comb with three teeth under one pitch: a valley from each of the four inner corners, sloping; they meet in pairs.
  const Ring comb{{0, 0},   {20, 0}, {20, 12}, {16, 12}, {16, 6}, {12, 6},
                  {12, 12}, {8, 12}, {8, 6},   {4, 6},   {4, 12}, {0, 12}};
  EXPECT_THAT(roof_lines(plan(comb, {hip})),
              ElementsAre(Pair("eave", 12), Pair("hip", 10), Pair("ridge", 4), Pair("valley", 4)));
}

TEST(Lines, name_the_roof_round_a_courtyard) {
  //  +-----------+
  //  |\ _______ /|     ridge all round, hips outside, valleys from the court's corners
  //  | |\ ___ /| |
  //  | | |   | | |
  //  | | |___| | |
  //  | |/_____\| |
  //  +-----------+
  EXPECT_THAT(turned_or_not(plan(box(20, 20), {hip}, {}, 100, {turned_in({{6, 6}, {14, 6}, {14, 14}, {6, 14}})})),
              ElementsAre(Pair("eave", 8), Pair("hip", 4), Pair("ridge", 4), Pair("valley", 4)));
}

TEST(Lines, name_the_edges_and_feet_of_terraces_and_flat_roofs) {
  EXPECT_THAT(turned_or_not(plan(box(10, 6), {wall}, {}, 5)), ElementsAre(Pair("flat edge", 4)));
  // A tower set back: the terrace's outer edge, the tower's foot, the tower's top.
  EXPECT_THAT(turned_or_not(plan(box(12, 12), {setback}, {}, 9)),
              ElementsAre(Pair("flat edge", 8), Pair("upstand", 4)));
  // A hip cut off flat.
  EXPECT_THAT(turned_or_not(plan(box(10, 10), {hip}, {}, 5)),
              ElementsAre(Pair("eave", 4), Pair("flat break", 4), Pair("hip", 4)));
  // A roof that stands on a terrace.
  EXPECT_THAT(turned_or_not(plan(box(12, 12), {{{0, 0}, {0, 3}, {1, 3}, {2, 4}}})),
              ElementsAre(Pair("flat edge", 4), Pair("hip", 4), Pair("upstand", 4)));
}

TEST(Lines, name_where_a_roof_runs_against_a_wall) {
  // Upright on the left half, sloped on the right: the connector stands above the slope.
  //   +-----------+
  //   |           |
  //   +-----+-----+
  //    wall   hip
  const auto counts = turned_or_not(plan({{0, 0}, {5, 0}, {10, 0}, {10, 8}, {0, 8}}, {hip, wall}, {1, 0, 0, 0, 0}, 9));
  EXPECT_EQ(counts.at("abutment"), 1);
  // A storey that rises out of a roof: its foot is an abutment, level.
  const auto level = turned_or_not(plan(box(12, 12), {{{0, 0}, {0, 2}, {2, 3}, {2, 6}, {3, 7}}}));
  EXPECT_THAT(level, ElementsAre(Pair("abutment", 4), Pair("eave", 8), Pair("hip", 8)));
}

TEST(Lines, name_a_tent_by_its_foot_and_hips) {
  EXPECT_THAT(roof_lines(plan(box(10, 10), {tent})), ElementsAre(Pair("hip", 4)));
}

TEST(Lines, keep_their_definitions_on_random_plans) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    const Plan p = seed % 3 == 2 ? turned(random_plan(seed), 0.3) : random_plan(seed);
    const Solid solid = solid_of(p);
    const auto found = lines_of(solid);
    // Each edge once, both faces walking it, one each way.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> walked;
    for (std::uint32_t f = 0; f < solid.faces.size(); ++f)
      for (const auto& loop : solid.faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) walked[{loop[i], loop[(i + 1) % loop.size()]}] = f;
    ASSERT_EQ(2 * found.size(), walked.size());
    std::size_t loops = 0;
    for (const auto& face : solid.faces) loops += face.loops.size();
    // Euler: V − E + F = 2 (shells − handles) + holes in faces; these solids have one shell and no handle.
    EXPECT_EQ(solid.vertices.size() + 2 * solid.faces.size() - loops, found.size() + 2);
    for (const Line& line : found) {
      EXPECT_EQ(walked.at({line.from, line.to}), line.left_face);
      EXPECT_EQ(walked.at({line.to, line.from}), line.right_face);
      const Point3 a = solid.vertices[line.from], b = solid.vertices[line.to];
      const double run = length(xy(b) - xy(a)), rise = std::abs(b.z - a.z);
      const Point3 left = solid.faces[line.left_face].normal, right = solid.faces[line.right_face].normal;
      const double bend = dot(cross(left, right), normalised(b - a));  // positive: convex
      const auto level = [&] { EXPECT_LT(rise, 1e-6 + 1e-3 * run) << solid::name(line.kind); };
      if (run + rise < 0.01) continue;  // arcs that were drawn together or nearly so lie anyhow
      switch (line.kind) {
        case LineKind::soffit_line: FAIL() << "a soffit without eaves";
        case LineKind::eave:
        case LineKind::ridge:
        case LineKind::flat_edge:
        case LineKind::flat_break:
        case LineKind::mono_ridge:
          level();
          EXPECT_GT(bend, 0) << solid::name(line.kind);
          break;
        case LineKind::hip:
        case LineKind::verge:
          EXPECT_GT(rise, 0);
          EXPECT_GT(bend, 0);
          break;
        case LineKind::corner:
          EXPECT_LT(run, 1e-3);
          EXPECT_GT(bend, 0);
          break;
        case LineKind::inner_corner:
          EXPECT_LT(run, 1e-3);
          EXPECT_LT(bend, 0);
          break;
        case LineKind::valley:
        case LineKind::abutment: EXPECT_LT(bend, 0); break;
        case LineKind::upstand:
          level();
          EXPECT_LT(bend, 0);
          break;
        case LineKind::pitch_break: level(); break;
        case LineKind::seam: EXPECT_NEAR(length(left - right), 0, 1e-8); break;
        case LineKind::foot: EXPECT_TRUE(a.z == p.base && b.z == p.base); break;
      }
    }
    EXPECT_EQ(lines_of(solid), found);
  }
}

}  // namespace
