// Short arcs drawn together before rounding: solids made by hand as a sweep leaves them, in doubles.
#include "mansard/extrude/detail/rounding.hpp"
#include "mansard/solid/solid.hpp"

#include <gmock/gmock.h>

#include "plans.hpp"

namespace {

namespace extrude = mansard::extrude;
namespace solid = mansard::solid;

namespace model = mansard::model;

using namespace plans;
using extrude::detail::ExactSurface;
using extrude::detail::FaceNode;
using extrude::detail::rounded;
using model::Face;
using model::FaceKind;
using model::Solid;

/// Vertical walls over a ring of whole directions, ground to lid.
auto block(const Ring& ring, double height = 3) -> ExactSurface {
  ExactSurface surface;
  const auto n = static_cast<std::uint32_t>(ring.size());
  for (const double z : {0.0, height})
    for (const Point2 p : ring) surface.places.push_back({p.x, p.y, z});
  std::vector<std::uint32_t> below, above;
  for (std::uint32_t i = 0; i < n; ++i) {
    below.insert(below.begin(), i);
    above.push_back(n + i);
  }
  const auto add = [&](std::vector<std::uint32_t> loop, FaceKind kind, Point2 along) {
    FaceNode node;
    node.kind = kind;
    node.direction = extrude::detail::direction_of(extrude::detail::bearing_of(along));
    surface.faces.push_back({{std::move(loop)}, node});
  };
  add(below, FaceKind::base, {1, 0});
  add(above, FaceKind::cap, {1, 0});
  for (std::uint32_t i = 0; i < n; ++i)
    add({i, (i + 1) % n, n + (i + 1) % n, n + i}, FaceKind::side, ring[(i + 1) % n] - ring[i]);
  return surface;
}

auto codes_of(const Solid& solid) -> std::string { return faults(solid); }

TEST(Rounding, leaves_a_surface_without_short_arcs_as_it_is) {
  const auto surface = block(box(8, 5));
  const auto result = rounded(surface, {{100, 200}, 7}, 1e-3);
  EXPECT_EQ(result.collapsed, 0U);
  EXPECT_EQ(result.residual, 0);
  EXPECT_EQ(codes_of(result.solid), "");
  EXPECT_EQ(result.solid.vertices.size(), 8U);
  EXPECT_EQ(result.solid.faces.size(), 6U);
  EXPECT_NEAR(solid::volume(result.solid), 120, 1e-9);
  for (const Point3 p : result.solid.vertices) {
    EXPECT_GE(p.x, 100);
    EXPECT_GE(p.y, 200);
    EXPECT_GE(p.z, 7);
  }
}

TEST(Rounding, draws_together_two_apexes_that_are_one_but_for_rounding) {
  // A hip over an almost square house: the ridge is a few micrometres long.
  //  +-----+
  //  | \ / |
  //  |  =  |
  //  | / \ |
  //  +-----+
  const auto ridge_of = [](double ridge) {
    ExactSurface surface;
    surface.places = {{0, 0, 0}, {8 + ridge, 0, 0}, {8 + ridge, 8, 0}, {0, 8, 0}, {4, 4, 4}, {4 + ridge, 4, 4}};
    const auto add = [&](std::vector<std::uint32_t> loop, FaceKind kind, Point2 along) {
      FaceNode node;
      node.kind = kind;
      node.slope = 1;
      node.direction = extrude::detail::direction_of(extrude::detail::bearing_of(along));
      surface.faces.push_back({{std::move(loop)}, node});
    };
    add({3, 2, 1, 0}, FaceKind::base, {1, 0});
    add({0, 1, 5, 4}, FaceKind::side, {1, 0});
    add({1, 2, 5}, FaceKind::side, {0, 1});
    add({2, 3, 4, 5}, FaceKind::side, {-1, 0});
    add({3, 0, 4}, FaceKind::side, {0, -1});
    return surface;
  };
  for (const double ridge : {1e-9, 2e-6, 4e-5}) {
    const auto result = rounded(ridge_of(ridge), {}, 1e-3);
    EXPECT_EQ(result.collapsed, 1U) << ridge;
    EXPECT_EQ(codes_of(result.solid), "") << ridge;
    EXPECT_EQ(result.solid.vertices.size(), 5U);
    EXPECT_EQ(result.solid.faces.size(), 5U);
    EXPECT_LE(result.residual, 4e-5);
    EXPECT_GE(result.residual, ridge / 8);  // it says what that cost
  }
  // No point is near enough to all planes, or the arc is no short one: kept.
  for (const double ridge : {9e-4, 2e-3}) {
    const auto result = rounded(ridge_of(ridge), {}, 1e-3);
    EXPECT_EQ(result.collapsed, 0U) << ridge;
    EXPECT_EQ(codes_of(result.solid), "") << ridge;
    EXPECT_LT(result.residual, 1e-12);
  }
  EXPECT_EQ(rounded(ridge_of(2e-6), {}, 0).collapsed, 0U);
}

TEST(Rounding, keeps_a_short_wall_whose_collapse_would_move_its_neighbours) {
  // A jog of half a millimetre: drawn together, two long walls would miss their planes by more than allowed.
  const auto result = rounded(block({{0, 0}, {4, 0}, {4, 0.0005}, {9, 0.0005}, {9, 5}, {0, 5}}), {}, 1e-3);
  EXPECT_EQ(result.collapsed, 0U);
  EXPECT_EQ(codes_of(result.solid), "");
  EXPECT_EQ(result.solid.faces.size(), 8U);
}

TEST(Rounding, draws_together_a_jog_below_what_a_face_may_bend) {
  const auto result = rounded(block({{0, 0}, {4, 0}, {4, 0.00002}, {9, 0.00002}, {9, 5}, {0, 5}}), {}, 1e-3);
  EXPECT_EQ(result.collapsed, 2U);  // below and above
  EXPECT_EQ(codes_of(result.solid), "");
  EXPECT_EQ(result.solid.faces.size(), 7U);
  EXPECT_LE(result.residual, 4e-5);
}

TEST(Rounding, keeps_what_is_so_small_that_nothing_would_be_left) {
  // All arcs are short; the link condition keeps a solid, whatever is drawn together.
  for (const double size : {2e-5, 1e-6}) {
    const auto result = rounded(block({{0, 0}, {size, 0}, {size, size}, {0, size}}, size), {}, 1e-3);
    ASSERT_GE(result.solid.faces.size(), 4U);
    for (const auto& fault : solid::check(result.solid)) EXPECT_EQ(fault.code, "solid-degenerate");
  }
}

TEST(Rounding, keeps_a_shaft_of_three_sides_in_its_lid) {
  // The shaft's mouth is a loop of three arcs in the lid and the floor, one of them short: without it the loop would
  // be gone and the faces in it would meet in a line of four.
  auto surface = block(box(8, 5));
  const double e = 1e-5;
  const Ring mouth{{3, 2}, {3, 2 + e}, {5, 2}};  // clockwise
  for (const double z : {0.0, 3.0})
    for (const Point2 p : mouth) surface.places.push_back({p.x, p.y, z});
  surface.faces[0].loops.push_back({10, 9, 8});
  surface.faces[1].loops.push_back({11, 12, 13});
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t j = (i + 1) % 3;
    FaceNode node;
    node.direction = extrude::detail::direction_of(extrude::detail::bearing_of(mouth[j] - mouth[i]));
    surface.faces.push_back({{{8 + i, 8 + j, 11 + j, 11 + i}}, node});
  }
  const auto result = rounded(surface, {}, 1e-3);
  EXPECT_EQ(result.collapsed, 0U);
  EXPECT_EQ(result.solid.faces.size(), 9U);
  EXPECT_EQ(result.solid.vertices.size(), 14U);
  EXPECT_EQ(result.solid.faces[1].loops.size(), 2U);
}

}  // namespace
