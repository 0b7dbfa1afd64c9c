// Plans that each hold one kind of difficulty, drawn. '#' is a metre of building; a digit outside of it is the
// profile of the edge beside it, anything else profile 0. Each is extruded in full, checked, and compared with the
// oracle.
#include <gmock/gmock.h>

#include "exact.hpp"
#include "families.hpp"
#include "mansard/extrude/extrude.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace model = mansard::model;

using namespace plans;
using model::FaceKind;

/// The plan of a drawing, each character so many metres wide and high.
auto drawn(const std::vector<std::string>& rows, std::vector<Profile> profiles, double cap = 100, double metres = 1)
    -> Plan {
  std::set<std::pair<int, int>> cells;
  const auto height = static_cast<int>(rows.size());
  const auto at = [&](int x, int y) {
    if (y < 0 || y >= height) return ' ';
    const std::string& row = rows[static_cast<std::size_t>(height - 1 - y)];
    return x < 0 || x >= static_cast<int>(row.size()) ? ' ' : row[static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 80; ++x)
      if (at(x, y) == '#') cells.insert({x, y});
  const auto profile_beside = [&](std::pair<int, int> a, std::pair<int, int> b) -> std::uint32_t {
    const int dx = b.first - a.first, dy = b.second - a.second;  // outside is on the right
    const char c = at(std::min(a.first, b.first) + (dy < 0 ? -1 : 0), std::min(a.second, b.second) + (dx > 0 ? -1 : 0));
    return c >= '0' && c <= '9' ? static_cast<std::uint32_t>(c - '0') : 0;
  };
  std::vector<model::PlanRing> rings;
  for (const auto& steps : boundary_of(cells)) {
    model::PlanRing ring;
    const std::size_t n = steps.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto before = steps[(i + n - 1) % n], here = steps[i], after = steps[(i + 1) % n];
      const bool straight = (before.first == here.first) == (here.first == after.first);
      const std::uint32_t profile = profile_beside(here, after);
      if (straight && profile == profile_beside(before, here)) continue;
      ring.points.push_back({metres * here.first, metres * here.second});
      ring.profile_of_edge.push_back(profile);
    }
    rings.push_back(std::move(ring));
  }
  Plan p;
  p.profiles = std::move(profiles);
  p.cap = cap;
  p.outer = rings.at(0);
  p.holes.assign(rings.begin() + 1, rings.end());
  return p;
}

/// Extruded in full, without fault, and exactly as the oracle says.
auto judged(const Plan& p) -> model::Solid {
  const auto raised = extrude::raise(p);
  if (!raised) {
    ADD_FAILURE() << base::to_string(raised.error()) << " " << text(p);
    return {};
  }
  EXPECT_EQ(raised->outcome, extrude::Outcome::full)
      << (raised->warnings.empty() ? "" : raised->warnings.back().message) << " " << text(p);
  EXPECT_EQ(faults(raised->solid), "") << text(p);
  const Footprint footprint = footprint_of(p);
  EXPECT_EQ(oracle::difference(surface_of(footprint, cap_of(p)), oracle::raise(footprint, cap_of(p))), "") << text(p);
  return raised->solid;
}
auto volume(const Plan& p) -> Rational {
  judged(p);
  return oracle::volume(surface_of(p));
}

TEST(Zoo, square) { EXPECT_EQ(volume(drawn({"####", "####", "####", "####"}, {tent})), Rational(32, 3)); }

TEST(Zoo, regular_polygons) {
  for (std::size_t n = 3; n <= 16; ++n) {
    Ring ring;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      ring.push_back({8 * std::cos(angle), 8 * std::sin(angle)});
    }
    for (const Profile& profile : {tent, two_pitch, setback}) judged(plan(ring, {profile}, {}, 12));
  }
}

const std::vector<std::string> plus{"  ##  ",  //
                                    "  ##  ",  //
                                    "######",  //
                                    "######",  //
                                    "  ##  ",  //
                                    "  ##  "};

TEST(Zoo, plus_has_one_crossing) {
  EXPECT_EQ(volume(drawn(plus, {tent})), Rational(28, 3));
  EXPECT_EQ(judged(drawn(plus, {tent})).vertices.size(), 12U + 4 + 1);
}

TEST(Zoo, h_t_and_comb) {
  for (const Profile& profile : {tent, hip, two_pitch, setback}) {
    judged(drawn({"##  ##", "##  ##", "######", "######", "##  ##", "##  ##"}, {profile}, 9, 2));
    judged(drawn({"######", "######", "  ##  ", "  ##  ", "  ##  "}, {profile}, 9, 2));
    judged(drawn({"# # # # #", "# # # # #", "#########"}, {profile}, 9, 2));
  }
}

TEST(Zoo, spokes) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    base::Random random(seed);
    const Outline wheel = outline(Shape::spokes, random, 24);
    for (const Profile& profile : {tent, two_pitch}) judged(plan(wheel[0], {profile}));
  }
}

TEST(Zoo, dog_bone_is_pulled_apart) {
  const Plan bone = drawn({"####   ####",  //
                           "###########",  //
                           "###########",  //
                           "####   ####"},
                          {tent});
  // After the neck of 2 m has closed at 1 m, two squares are left; the neck's ridge is 1 m high.
  EXPECT_EQ(judged(bone).vertices.size(), bone.outer.points.size() + 2 + 2);
}

TEST(Zoo, courtyard) {
  // Four wings of 2 m around a yard of 4 m: mitred bars of 6 m, all told, of a triangle of 1 m².
  const Plan yard =
      drawn({"########", "########", "##    ##", "##    ##", "##    ##", "##    ##", "########", "########"}, {tent});
  EXPECT_EQ(volume(yard), 4 * 6);
  for (const Profile& profile : {hip, two_pitch, setback})
    judged(plan(yard.outer.points, {profile}, {}, 9, {yard.holes[0].points}));
}

TEST(Zoo, a_hole_merges_with_the_outside) {
  for (const Profile& profile : {tent, hip, two_pitch, setback}) {
    Plan p = drawn({"##########",  //
                    "##########",  //
                    "#    #####",  //
                    "#    #####",  //
                    "##########",  //
                    "##########"},
                   {profile}, 9, 2);
    judged(p);
  }
}

TEST(Zoo, two_holes_merge_with_each_other_and_with_the_outside_at_one_moment) {
  for (const Profile& profile : {tent, hip, setback})
    judged(drawn({"#########",  //
                  "#  ##  ##",  //
                  "#  ##  ##",  //
                  "#########"},
                 {profile}, 9, 2));
}

TEST(Zoo, a_knot_at_the_height_of_an_event) {
  // The neck closes at 1 m (2 m above the wall's foot), just where the pitch changes.
  const std::vector<std::string> bone{"####   ####", "###########", "###########", "####   ####"};
  judged(drawn(bone, {{{0, 0}, {1, 1}, {2, 3}}}));
  judged(drawn(bone, {{{0, 0}, {1, 1}, {1, 2}, {2, 3}}}));
  judged(drawn(bone, {{{0, 0}, {1, 1}, {1.5, 1}, {2, 3}}}));
}

TEST(Zoo, a_cap_at_the_height_of_an_event) {
  const std::vector<std::string> bone{"####   ####", "###########", "###########", "####   ####"};
  EXPECT_EQ(count(judged(drawn(bone, {tent}, 1)), FaceKind::cap), 2U);
  EXPECT_EQ(count(judged(drawn(bone, {tent}, 2)), FaceKind::cap), 0U);
  EXPECT_EQ(count(judged(drawn(plus, {tent}, 1)), FaceKind::cap), 0U);
}

TEST(Zoo, a_terrace_that_exactly_annihilates) {
  const Profile all{{0, 0}, {0, 3}, {1, 3}, {1, 5}}, half{{0, 0}, {0, 3}, {0.5, 3}, {0.5, 5}};
  EXPECT_EQ(volume(drawn({"######", "######"}, {all}, 9)), 36);
  EXPECT_EQ(volume(drawn({"######", "######"}, {half}, 4)), 36 + 5);
  EXPECT_EQ(volume(drawn({"####   ####", "###########", "###########", "####   ####"}, {all}, 4)), 38 * 3 + 4 + 4);
}

TEST(Zoo, zero_speed_walls_and_corridors) {
  //   1111111      the roofs of both ends run along a corridor between vertical walls, and meet
  const std::vector<Profile> profiles{tent, wall};
  judged(drawn({"    1111111    ",  //
                "####       ####",  //
                "####1111111####",  //
                "###############",  //
                "###############",  //
                "####1111111####",  //
                "####       ####"},
               profiles, 40));
  EXPECT_EQ(volume(drawn({" 11111111 ", "0########0", "0########0", " 11111111 "}, profiles, 40)), 2 * 8 * 2);
  EXPECT_EQ(volume(drawn({"##", "##"}, {wall}, 7)), 28);
}

TEST(Zoo, delayed_starts) {
  // Eaves at 2 m and at 5 m; and an edge whose roof would start after its neighbours have met it.
  const Profile low{{0, 0}, {0, 2}, {1, 3}}, high{{0, 0}, {0, 5}, {1, 6}}, late{{0, 0}, {0, 50}, {1, 51}};
  EXPECT_EQ(volume(drawn({" 0000000000 ",  //
                          "1##########1",  //
                          "1##########1",  //
                          "1##########1",  //
                          "1##########1",  //
                          " 0000000000 "},
                         {low, late})),
            40 * 2 + 40);
  judged(drawn({" 0000000000 ",  //
                "1##########1",  //
                "1##########1",  //
                "1##########1",  //
                "1##########1",  //
                "1##########1",  //
                "1##########1",  //
                "1##########1",  //
                "1##########1",  //
                " 0000000000 "},
               {low, high}));
}

TEST(Zoo, knots_at_unequal_heights) {
  const Profile early{{0, 0}, {0, 1}, {0.5, 2}, {3, 3}}, later{{0, 0}, {0, 2}, {0.5, 3.5}, {3, 5}};
  judged(drawn({" 00001111 ",  //
                "1########0",  //
                "1########1",  //
                "0###  ###1",  //
                "0###01###0",  //
                " 111  000 "},
               {early, later}, 100, 2));
}

TEST(Zoo, connectors_between_collinear_neighbours) {
  const std::vector<std::string> facade{"            ",  //
                                        " ########## ",  //
                                        " ########## ",  //
                                        " ########## ",  //
                                        " ########## ",  //
                                        " 0000011111 "};
  EXPECT_EQ(count(judged(drawn(facade, {hip, wall}, 5)), FaceKind::connector), 1U);
  EXPECT_EQ(count(judged(drawn(facade, {hip, tent}, 5)), FaceKind::connector), 1U);
  // Ahead, behind, ahead again: the connector turns round.
  const Profile hasty{{0, 0}, {0, 1}, {1, 2}, {1, 6}}, slow{{0, 0}, {0, 2}, {1.75, 3.75}};
  std::set<double> facing;
  for (const auto& face : judged(drawn(facade, {hasty, slow, wall}, 5, 2)).faces)
    if (face.kind == FaceKind::connector) facing.insert(std::round(face.normal.x));
  EXPECT_THAT(facing, testing::ElementsAre(-1, 1));
}

TEST(Zoo, several_buildings_profiles_on_one_facade_line) {
  const std::vector<Profile> profiles{wall, hip, two_pitch, setback, tent};
  for (const double cap : {2.0, 3.0, 4.0, 5.0, 6.5, 20.0})
    judged(drawn({" 234012340123401234 ",  //
                  "0##################1",  //
                  "0##################1",  //
                  "0##################1",  //
                  "0##################1",  //
                  " 001122334401234321 "},
                 profiles, cap, 2));
}

TEST(Zoo, one_quantum_jogs) {
  constexpr double quantum = 0x1p-16;
  for (const double jog : {quantum, 2 * quantum, 1e-4, 0.02, 0.06})
    for (const double out : {-1.0, 1.0})
      for (const Profile& profile : {tent, hip, setback}) {
        const double y = out * jog;
        judged(plan({{0, 0}, {5, 0}, {5, y}, {10, y}, {10, 6}, {0, 6}}, {profile}, {}, 9));
        judged(plan({{0, 0}, {4, 0}, {4, y}, {6, y}, {6, 0}, {10, 0}, {10, 6}, {0, 6}}, {profile}, {}, 9));
      }
}

TEST(Zoo, raster_traced_outlines) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    base::Random random(seed);
    const Outline traced = outline(Shape::raster, random, 16);
    for (const Profile& profile : {tent, hip, setback}) judged(plan(traced[0], {profile}, {}, 9));
  }
}

TEST(Zoo, walls_that_meet_in_a_line_or_a_point) {
  // Setbacks of half the depth, on one half from the front, on the other from behind.
  const Profile half{{0, 0}, {0, 3}, {2, 3}, {2, 6}};
  const Plan p = drawn({" 000111 ",  //
                        "0######0",  //
                        "0######0",  //
                        "0######0",  //
                        "0######0",  //
                        " 111000 "},
                       {wall, half}, 6);
  const auto raised = extrude::raise(p);
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->outcome, extrude::Outcome::full);
  EXPECT_EQ(faults(raised->solid), "");
}

}  // namespace
