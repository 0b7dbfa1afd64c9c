// Solids of one building whose walls are beside each other, off by rounding.
#include "mansard/solid/detail/disjoint.hpp"

#include <gmock/gmock.h>

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

}  // namespace
