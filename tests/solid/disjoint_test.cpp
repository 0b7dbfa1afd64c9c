// Solids of one building whose walls are beside each other, off by rounding.
#include "mansard/solid/detail/disjoint.hpp"

#include <gmock/gmock.h>

#include <random>

#include "mansard/solid/detail/interiors.hpp"

namespace {

using mansard::geometry::Point3;
using mansard::model::Face;
using mansard::model::FaceClass;
using mansard::model::FaceKind;
using mansard::model::LabelledSolid;

/// From x to x + 10, 10 m deep, 5 m high; where its walls to the west and east end at the top, m.
auto box(double x, double west_top, double east_top) -> LabelledSolid {
  LabelledSolid out;
  out.solid.vertices = {{x, 0, 0},        {x + 10, 0, 0},   {x + 10, 10, 0},   {x, 10, 0},
                        {west_top, 0, 5}, {east_top, 0, 5}, {east_top, 10, 5}, {west_top, 10, 5}};
  const auto add = [&](std::vector<std::uint32_t> loop, Point3 normal, FaceClass kind) {
    out.solid.faces.push_back(Face{{std::move(loop)}, FaceKind::side, {}, normal});
    out.classes.push_back(kind);
  };
  add({3, 2, 1, 0}, {0, 0, -1}, FaceClass::ground);
  add({4, 5, 6, 7}, {0, 0, 1}, FaceClass::roof);
  add({0, 1, 5, 4}, {0, -1, 0}, FaceClass::wall);
  add({1, 2, 6, 5}, {1, 0, 0}, FaceClass::wall);
  add({2, 3, 7, 6}, {0, 1, 0}, FaceClass::wall);
  add({3, 0, 4, 7}, {-1, 0, 0}, FaceClass::wall);
  return out;
}

using mansard::solid::detail::overlap;
using mansard::solid::detail::share_ground;

TEST(Overlap, of_a_wall_that_leans_into_a_neighbour_by_a_tenth_of_a_millimetre) {
  const auto leaning = box(0, 0, 10.0001), upright = box(10, 10, 20), same = box(10, 10.0001, 20);
  EXPECT_FALSE(share_ground(leaning, upright)) << "their grounds only touch";
  EXPECT_TRUE(overlap(leaning, upright));
  EXPECT_TRUE(overlap(upright, leaning));
  EXPECT_FALSE(overlap(leaning, same)) << "both have the same wall";
  EXPECT_FALSE(overlap(box(0, 0, 10), upright));
  EXPECT_FALSE(overlap(leaning, box(10.001, 10.001, 20))) << "a millimetre apart";
}

using mansard::solid::detail::insides_meet;

using Units = std::array<std::int64_t, 3>;
using Tetrahedron = std::array<Units, 4>;

auto minus(const Units& a, const Units& b) -> Units { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
auto crossed(const Units& a, const Units& b) -> Units {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
auto product(const Units& a, const Units& b) -> std::int64_t { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

auto solid_of(Tetrahedron t) -> mansard::model::Solid {
  if (product(crossed(minus(t[1], t[0]), minus(t[2], t[0])), minus(t[3], t[0])) < 0) std::swap(t[2], t[3]);
  mansard::model::Solid out;
  for (const Units& p : t)
    out.vertices.push_back(
        {1e-4 * static_cast<double>(p[0]), 1e-4 * static_cast<double>(p[1]), 1e-4 * static_cast<double>(p[2])});
  for (const std::vector<std::uint32_t>& loop : {std::vector<std::uint32_t>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
    out.faces.push_back(Face{{loop}, FaceKind::side, {}, {}});
  return out;
}

/// Whether a plane parts the insides of two: one with a face of either, or along an edge of each, is among them.
auto are_parted(const Tetrahedron& a, const Tetrahedron& b) -> bool {
  const auto parts = [&](const Units& normal) {
    std::array<std::int64_t, 2> least{INT64_MAX, INT64_MAX}, most{INT64_MIN, INT64_MIN};
    for (std::size_t i = 0; i < 4; ++i)
      for (const std::size_t k : {0, 1}) {
        const std::int64_t at = product(normal, k == 0 ? a[i] : b[i]);
        least[k] = std::min(least[k], at), most[k] = std::max(most[k], at);
      }
    return normal != Units{} && (most[0] <= least[1] || most[1] <= least[0]);
  };
  for (const Tetrahedron& t : {a, b})
    for (std::size_t i = 0; i < 4; ++i) {
      const Units &p = t[(i + 1) % 4], &q = t[(i + 2) % 4], &r = t[(i + 3) % 4];
      if (parts(crossed(minus(q, p), minus(r, p)))) return true;
    }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < k; ++l)
          if (parts(crossed(minus(a[i], a[j]), minus(b[k], b[l])))) return true;
  return false;
}

auto is_flat(const Tetrahedron& t) -> bool {
  return product(crossed(minus(t[1], t[0]), minus(t[2], t[0])), minus(t[3], t[0])) == 0;
}

/// Whether all corners of one are in the other or on it.
auto holds(const Tetrahedron& outer, const Tetrahedron& inner) -> bool {
  for (std::size_t i = 0; i < 4; ++i) {
    const Units &p = outer[(i + 1) % 4], &q = outer[(i + 2) % 4], &r = outer[(i + 3) % 4];
    const Units normal = crossed(minus(q, p), minus(r, p));
    const std::int64_t side = product(normal, minus(outer[i], p));
    for (const Units& v : inner)
      if (side * product(normal, minus(v, p)) < 0) return false;
  }
  return true;
}

/// On a grid so small that nearly all of them share planes, edges or corners.
TEST(InsidesMeet, agrees_with_planes_between_convex_solids) {
  std::mt19937_64 chance(7);
  for (const int size : {3, 4, 7, 40}) {
    int apart = 0, meeting = 0;
    while (apart + meeting < 6000) {
      std::array<Tetrahedron, 2> two;
      for (auto& t : two)
        for (auto& p : t)
          for (auto& c : p) c = static_cast<std::int64_t>(chance() % static_cast<std::uint64_t>(size));
      const auto& [a, b] = two;
      if (is_flat(a) || is_flat(b) || holds(a, b) || holds(b, a)) continue;
      const bool parted = are_parted(a, b);
      (parted ? apart : meeting) += 1;
      ASSERT_EQ(insides_meet(solid_of(a), solid_of(b)), !parted)
          << testing::PrintToString(a) << " and " << testing::PrintToString(b);
    }
    EXPECT_GT(apart, 500);
    EXPECT_GT(meeting, 500);
  }
}

/// Two boxes side by side whose walls end at corners that are in no plane: cut along different diagonals they have a
/// space between them or in common.
TEST(InsidesMeet, of_one_bent_wall_cut_along_both_diagonals) {
  const auto west = [](bool first) {
    auto out = box(0, 0, 10).solid;
    out.vertices[5].x = 10.0001;
    auto& wall = out.faces[3].loops[0];
    const auto [a, b, c, d] = std::array{wall[0], wall[1], wall[2], wall[3]};
    wall = first ? std::vector{a, b, c} : std::vector{a, b, d};
    out.faces.push_back(Face{{first ? std::vector{a, c, d} : std::vector{b, c, d}}, FaceKind::side, {}, {1, 0, 0}});
    return out;
  };
  const auto east = [](bool first) {
    auto out = box(10, 10, 20).solid;
    out.vertices[4].x = 10.0001;
    auto& wall = out.faces[5].loops[0];
    const auto [a, b, c, d] = std::array{wall[0], wall[1], wall[2], wall[3]};
    wall = first ? std::vector{a, b, c} : std::vector{a, b, d};
    out.faces.push_back(Face{{first ? std::vector{a, c, d} : std::vector{b, c, d}}, FaceKind::side, {}, {-1, 0, 0}});
    return out;
  };
  int meeting = 0;
  for (const bool first : {false, true})
    for (const bool second : {false, true}) meeting += insides_meet(west(first), east(second)) ? 1 : 0;
  EXPECT_EQ(meeting, 1) << "both diagonals alike twice, a space between once, and a space in common once";
}

TEST(InsidesMeet, of_an_edge_through_a_wall) {
  auto house = box(0, 0, 10), beside = box(10, 10, 20);
  EXPECT_FALSE(insides_meet(house.solid, beside.solid));
  for (auto& v : beside.solid.vertices) v.y = 2 + v.y / 2;  // a part of the wall
  EXPECT_FALSE(insides_meet(house.solid, beside.solid));
  for (auto& v : beside.solid.vertices) v.z += 1;
  EXPECT_FALSE(insides_meet(house.solid, beside.solid));
  beside.solid.vertices[0].x -= 1e-4;  // one corner
  EXPECT_TRUE(insides_meet(house.solid, beside.solid));
}

TEST(TouchByChance, of_a_corner_on_a_slanting_wall_that_has_none_there) {
  using mansard::solid::detail::touch_by_chance;
  const auto turned = [](LabelledSolid solid) {
    for (auto& v : solid.solid.vertices) v = {v.x - v.y / 2, v.y + v.x / 2, v.z};  // in whole units of files
    return solid;
  };
  const auto house = box(0, 0, 10), beside = box(10, 10, 20);
  EXPECT_FALSE(touch_by_chance(turned(house).solid, turned(beside).solid)) << "the same corners";
  auto shorter = beside;
  for (auto& v : shorter.solid.vertices) v.y = 2 + v.y / 2;
  EXPECT_FALSE(touch_by_chance(house.solid, shorter.solid)) << "on a wall along y";
  EXPECT_TRUE(touch_by_chance(turned(house).solid, turned(shorter).solid));
  EXPECT_TRUE(touch_by_chance(turned(shorter).solid, turned(house).solid));
  EXPECT_TRUE(overlap(turned(house), turned(shorter)));
  auto higher = beside;
  for (auto& v : higher.solid.vertices) v.z += 2;
  EXPECT_FALSE(touch_by_chance(turned(house).solid, turned(higher).solid)) << "corners above each other";
}

}  // namespace
