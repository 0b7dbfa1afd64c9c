#include "mansard/evaluate/planes.hpp"

#include <gtest/gtest.h>

#include "evaluate/models.hpp"

namespace {

using mansard::evaluate::planes_of;
using models::in_triangles;
using models::model_of;
using models::SurfaceClass;
using solids::box;
using solids::gable;

TEST(Planes, of_a_box_are_six_also_when_its_faces_are_cut_into_triangles) {
  const auto model = model_of({{box({0, 0}, {10, 8}, 0, 6)}});
  const auto whole = planes_of(model), cut = planes_of(in_triangles(model));
  EXPECT_EQ(whole.planes.size(), 6U);
  EXPECT_EQ(cut.planes.size(), 6U);
  EXPECT_EQ(cut.of_face.size(), 12U);
  double area = 0;
  for (const auto& plane : cut.planes) area += plane.area;
  EXPECT_NEAR(area, 2 * 80 + 2 * 60 + 2 * 48, 1e-9);
}

TEST(Planes, join_walls_of_parts_in_line_but_not_of_buildings) {
  const auto west = box({0, 0}, {10, 8}, 0, 6), east = box({10, 0}, {20, 8}, 0, 6);
  // Base, roof, north and south join; the ends and the two walls between stay.
  EXPECT_EQ(planes_of(model_of({{west, east}})).planes.size(), 8U);
  EXPECT_EQ(planes_of(model_of({{west}, {east}})).planes.size(), 12U);
}

TEST(Planes, keep_apart_what_lies_in_one_plane_without_an_edge_in_common) {
  EXPECT_EQ(planes_of(model_of({{box({0, 0}, {10, 8}, 0, 6), box({20, 0}, {30, 8}, 0, 6)}})).planes.size(), 12U);
}

TEST(Planes, keep_apart_what_turns_by_more_than_a_degree_or_lies_a_centimetre_off) {
  const auto roof = [](double rise) {
    models::Model model;
    model.buildings.push_back(
        {"a",
         {{"a",
           {{{{{0, 0, 5}, {10, 0, 5}, {10, 10, 5}, {0, 10, 5}}}, SurfaceClass::roof, false},
            {{{{10, 0, 5}, {10.4, 0, 5 + rise}, {10.4, 10, 5 + rise}, {10, 10, 5}}}, SurfaceClass::roof, false}}}}});
    return planes_of(model).planes.size();
  };
  EXPECT_EQ(roof(0.4 * std::tan(0.5 * 0.0174533)), 1U);
  EXPECT_EQ(roof(0.4 * std::tan(2 * 0.0174533)), 2U);
}

TEST(Planes, of_a_gable_know_their_class_and_direction) {
  const auto planes = planes_of(in_triangles(model_of({{gable({0, 0}, {10, 8}, 0, 6, 9)}}))).planes;
  EXPECT_EQ(planes.size(), 7U);
  double roof = 0;
  for (const auto& plane : planes)
    if (plane.kind == SurfaceClass::roof) {
      EXPECT_NEAR(plane.normal.z, 0.8, 1e-9);  // 3 up over 4
      roof += plane.area;
    }
  EXPECT_NEAR(roof, 2 * 50, 1e-9);
}

}  // namespace
