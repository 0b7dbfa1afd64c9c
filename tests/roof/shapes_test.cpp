// Every shape on outlines whose volumes can be worked out by hand.
#include "roof/houses.hpp"

namespace mansard::roof::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double walls = 12 * 8 * 6;  // of a box of 12 × 8 m under form()

/// m³ of a hipped roof over a box.
auto hip(double length, double width, double rise) -> double {
  return rise * ((length - width) * width / 2 + width * width / 3);
}

TEST(Shapes, over_a_box_have_the_volume_and_the_faces_of_the_textbook) {
  const double run = 2.1 / 2.747, l = 12 - 2 * run, w = 8 - 2 * run;  // of a mansard's steep part, 70°
  const double mansard = 2.1 / 6 * (96 + (12 + l) * (8 + w) + l * w) + hip(l, w, 0.9);
  struct Case {
    Shape shape;
    double roof;
    std::size_t faces, roofs;
  };
  for (const auto& c :
       {Case{Shape::flat, 12 * 8 * 3, 6, 1}, Case{Shape::skillion, 144, 6, 1}, Case{Shape::gabled, 144, 7, 2},
        Case{Shape::half_hipped, 144 - 2 * 2, 9, 4}, Case{Shape::hipped, hip(12, 8, 3), 9, 4},
        Case{Shape::pyramidal, 96, 9, 4}, Case{Shape::gambrel, 12 * ((8 + 5.2) / 2 * 1.95 + 5.2 * 1.05 / 2), 9, 4},
        Case{Shape::mansard, mansard, 13, 8}})
    for (const double turn : {0.0, 0.5, 2.2}) {
      const auto house = built(moved(box(12, 8), turn, {300, -200}), form(c.shape));
      SCOPED_TRACE(std::string(to_string(c.shape)) + " turned by " + std::to_string(turn));
      EXPECT_NEAR(house.volume, walls + c.roof, 0.05);
      EXPECT_EQ(house.faces, c.faces);
      EXPECT_EQ(roofs(house.solid), c.roofs);
      EXPECT_NEAR(house.top, 9, 1e-3);
      EXPECT_THAT(house.planned.warnings, IsEmpty());
      EXPECT_EQ(house.planned.shape, c.shape);
    }
}

TEST(Shapes, over_an_L_have_the_volume_worked_out_by_hand) {
  // The offset outline's area is 95 − 48 t + 4 t², used up at t = 2.5 m; a gable adds what its hip took from the wing.
  const double hipped = 95 * 2.5 - 24 * 6.25 + 4.0 / 3 * 15.625, gable = 5 * 2.5 / 2 * 2.5 - 25 * 2.5 / 6;
  struct Case {
    Shape shape;
    double roof;
    std::size_t roofs;
  };
  for (const auto& c : {Case{Shape::hipped, hipped * 3 / 2.5, 6},
                        Case{Shape::gabled, (hipped + 2 * gable) * 3 / 2.5, 4}, Case{Shape::pyramidal, 95, 6},
                        Case{Shape::flat, 95 * 3, 1}, Case{Shape::skillion, 3.0 / 12 * (60 * 2.5 + 35 * 8.5), 1},
                        Case{Shape::half_hipped, (hipped + 2 * gable * 7 / 8) * 3 / 2.5, 6}})
    for (const double turn : {0.0, 1.0}) {
      SCOPED_TRACE(std::string(to_string(c.shape)) + " turned by " + std::to_string(turn));
      const auto house = built(moved(ell(), turn, {}), form(c.shape));
      EXPECT_NEAR(house.volume, 95 * 6 + c.roof, 0.05);
      EXPECT_EQ(roofs(house.solid), c.roofs);
      EXPECT_NEAR(house.top, 9, 1e-3);
    }
  EXPECT_EQ(roofs(built(ell(), form(Shape::mansard)).solid), 12U);
  EXPECT_EQ(roofs(built(ell(), form(Shape::gambrel)).solid), 8U);
}

TEST(Shapes, over_wings_end_every_wing_in_a_gable) {
  // The bar's front roof goes on over the stem's lower ridge: one face on both sides of it.
  EXPECT_EQ(roofs(built(tee(), form(Shape::hipped)).solid), 7U);
  EXPECT_EQ(roofs(built(tee(), form(Shape::gabled)).solid), 4U);  // three gables
  EXPECT_EQ(roofs(built(you(), form(Shape::hipped)).solid), 8U);
  EXPECT_EQ(roofs(built(you(), form(Shape::gabled)).solid), 6U);  // two: the back's own ends are no wings
  for (const auto shape : {Shape::flat, Shape::skillion, Shape::half_hipped, Shape::gambrel, Shape::mansard})
    for (const auto& polygon : {tee(), you()}) {
      const auto house = built(polygon, form(shape));
      EXPECT_NEAR(house.top, 9, 1e-3) << to_string(shape);
    }
}

TEST(Shapes, go_round_a_courtyard) {
  const auto hipped = built(courtyard(), form(Shape::hipped));
  EXPECT_NEAR(hipped.volume, 336 * 6 + 504, 0.05);  // ∫ 336 − 112 t up to 3 m
  EXPECT_EQ(roofs(hipped.solid), 8U);
  EXPECT_NEAR(built(courtyard(), form(Shape::flat)).volume, 336 * 9, 1e-3);
  EXPECT_EQ(roofs(built(courtyard(), form(Shape::mansard)).solid), 16U);
  const auto skillion = built(courtyard(), form(Shape::skillion));
  EXPECT_NEAR(skillion.volume, 336 * (6 + 1.5), 0.05);  // the centroid is in the middle of the slope
  for (const auto& [shape, made] : {std::pair{Shape::pyramidal, Shape::hipped}, std::pair{Shape::gabled, Shape::hipped},
                                    std::pair{Shape::gambrel, Shape::mansard}}) {
    const auto other = built(courtyard(), form(shape), false);
    EXPECT_EQ(other.planned.shape, made);
    EXPECT_THAT(codes_of(other.planned.warnings), ElementsAre("roof-shape-here"));
    EXPECT_NEAR(other.top, 9, 1e-3);
  }
}

TEST(Shapes, put_a_spire_on_a_tower) {
  for (const std::size_t corners : {3U, 6U, 8U, 12U, 32U}) {
    const auto polygon = moved(tower(corners, 5), 0.3, {1000, 1000});
    const auto house = built(polygon, form(Shape::pyramidal));
    EXPECT_NEAR(house.volume, geometry::area(polygon) * (6 + 1), 0.1) << corners;
    EXPECT_EQ(roofs(house.solid), corners);
  }
  EXPECT_NEAR(built(tower(64, 5), form(Shape::hipped)).top, 9, 1e-3);
  EXPECT_THAT(codes_of(built(tower(8, 5), form(Shape::gabled), false).planned.warnings),
              ElementsAre("roof-shape-here"));
}

TEST(Ridge, goes_along_the_longer_side_or_as_orientation_and_direction_say) {
  const auto ridge_along_x = [](const Form& f) {
    const auto house = built(box(12, 8), f);
    std::vector<double> y;
    for (const Point3 p : house.solid.vertices)
      if (p.z > 8.9) y.push_back(p.y);
    EXPECT_EQ(y.size(), 2U);
    return std::abs(y[0] - y[1]) < 1e-6;
  };
  Form f = form(Shape::gabled);
  EXPECT_TRUE(ridge_along_x(f));
  f.orientation = Orientation::across;
  EXPECT_FALSE(ridge_along_x(f));
  f.direction = std::numbers::pi;  // looks south: the ridge goes east, whatever the orientation
  EXPECT_TRUE(ridge_along_x(f));
  f.direction = 1.4;
  EXPECT_FALSE(ridge_along_x(f));
  f.direction.reset();
  EXPECT_THAT(codes_of(built(ell(), f).planned.warnings), ElementsAre("roof-orientation"));
}

TEST(Skillion, is_lowest_where_its_direction_looks) {
  for (const double degrees : {0.0, 90.0, 180.0, 270.0, 8.0}) {
    Form f = form(Shape::skillion);
    f.direction = degrees * std::numbers::pi / 180;
    const auto house = built(box(12, 8), f);
    EXPECT_EQ(roofs(house.solid), 1U);
    EXPECT_THAT(house.planned.warnings, IsEmpty());
    for (const auto& face : house.solid.faces) {
      if (face.normal.z < 1e-3) continue;
      const Point2 downhill = normalised(xy(face.normal)), looks{std::sin(*f.direction), std::cos(*f.direction)};
      EXPECT_GT(dot(downhill, looks), 0.98) << degrees;
    }
  }
}

TEST(Skillion, sweeps_one_plane_from_corners_too) {
  for (const auto& polygon : {box(12, 8), ell(), tee(), you(), courtyard(), tower(7, 6)})
    for (const double degrees : {45.0, 110.0, 200.0, 305.0}) {
      Form f = form(Shape::skillion);
      f.direction = degrees * std::numbers::pi / 180;
      const auto house = built(polygon, f);
      SCOPED_TRACE(degrees);
      // All of the roof is in one plane, and nothing of it is level.
      std::optional<Point3> normal;
      for (const auto& face : house.solid.faces) {
        if (face.normal.z < 1e-3 || solid::area(house.solid, face) < 0.01) continue;
        if (!normal) normal = face.normal;
        EXPECT_LT(length(face.normal - *normal), 1e-3);
        EXPECT_LT(face.normal.z, 0.999);
      }
      EXPECT_NEAR(house.top, 9, 1e-3);
    }
}

TEST(Heights, give_the_angle_to_the_roof_where_there_is_no_height) {
  Form f = form(Shape::hipped);
  f.rise.reset();
  f.angle = std::numbers::pi / 4;
  const auto steep = built(box(12, 8), f);  // 4 m of roof, 5 m of wall
  EXPECT_NEAR(steep.volume, 96 * 5 + hip(12, 8, 4), 0.05);
  f.roof_included = false;
  EXPECT_NEAR(built(box(12, 8), f).top, 13, 1e-3);  // 9 m to the eaves
  f.shape = Shape::skillion;
  f.roof_included = true;
  f.angle = std::atan(0.5);
  EXPECT_NEAR(built(box(12, 8), f).volume, 96 * (9 - 2), 0.05);  // 4 m over 8 m
}

TEST(Heights, keep_a_roof_without_any_to_its_pitch_and_share) {
  Form f = form(Shape::gabled);
  f.rise.reset();
  f.pitch = std::atan(0.5);
  EXPECT_NEAR(built(box(12, 8), f).volume, 96 * 7 + 96, 0.05);  // 2 m of roof
  f.pitch = 1.3;
  EXPECT_NEAR(built(box(12, 8), f).volume, 96 * 4.5 + 96 * 2.25, 0.05);  // half of 9 m
  f.roof_included = false;
  EXPECT_NEAR(built(box(12, 8), f).top, 18, 1e-3);
}

TEST(Heights, put_a_roof_on_the_ground_and_a_building_on_stilts) {
  Form f = form(Shape::gabled);
  f.rise = 9;
  const auto tent = built(box(12, 8), f);
  EXPECT_NEAR(tent.volume, 96 * 4.5, 0.05);
  EXPECT_EQ(tent.faces, 5U);
  f = form(Shape::hipped);
  f.ground = 40;
  f.base = 4;
  const auto high = built(box(12, 8), f);
  EXPECT_NEAR(high.planned.plan.base, 44, 1e-9);
  EXPECT_NEAR(high.top, 49, 1e-3);
  EXPECT_NEAR(high.volume, 96 * 2 + hip(12, 8, 3), 0.05);
}

TEST(Heights, make_a_roof_lower_that_its_pitch_would_carry_over_the_building) {
  Form f = form(Shape::gabled);
  f.rise.reset();
  f.angle = 1.3;  // 14 m over 4 m
  const auto house = built(box(12, 8), f, false);
  EXPECT_THAT(codes_of(house.planned.warnings), ElementsAre("roof-height"));
  EXPECT_NEAR(house.top, 9, 1e-3);
  f.height = 0;
  const auto none = plan_of(box(12, 8), f);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, "roof-form");
}

TEST(Plans, of_nearly_rectangular_houses_have_the_ridge_in_one_direction) {
  // A jog of half a metre, a cut corner, and a corner in the middle of a wall.
  const Polygon jogged{{{0, 0}, {6, 0}, {6, 0.5}, {12, 0.5}, {12, 4}, {12, 8}, {1, 8}, {0, 7}}, {}};
  const auto house = built(jogged, form(Shape::gabled));
  EXPECT_THAT(house.planned.warnings, IsEmpty());
  EXPECT_NEAR(house.top, 9, 1e-3);
}

TEST(Plans, are_the_same_at_every_call_and_keep_the_polygon) {
  for (const auto& polygon : {ell(), courtyard()})
    for (const auto shape : {Shape::gabled, Shape::mansard, Shape::pyramidal}) {
      const auto a = plan_of(polygon, form(shape)), b = plan_of(polygon, form(shape));
      ASSERT_TRUE(a && b);
      EXPECT_EQ(a->plan, b->plan);
      EXPECT_EQ(model::polygon_of(a->plan), polygon);
    }
}

TEST(Plans, of_random_outlines_are_raised_to_their_top_under_every_shape) {
  const char* given = std::getenv("MANSARD_SEED");
  const auto seed = given != nullptr ? std::stoull(given) : 20260401ULL;
  for (std::uint64_t i = 0; i < 60; ++i) {
    base::Random random(seed, i);
    Polygon star;
    const std::size_t corners = 4 + random.index(9);
    for (std::size_t k = 0; k < corners; ++k) {
      const double a =
          2 * std::numbers::pi * (static_cast<double>(k) + random.uniform(0.1, 0.9)) / static_cast<double>(corners);
      star.outer.push_back(random.uniform(4, 12) * Point2{std::cos(a), std::sin(a)});
    }
    SCOPED_TRACE("MANSARD_SEED=" + std::to_string(seed) + " case " + std::to_string(i));
    for (const auto shape : {Shape::skillion, Shape::gabled, Shape::half_hipped, Shape::hipped, Shape::pyramidal,
                             Shape::gambrel, Shape::mansard}) {
      SCOPED_TRACE(to_string(shape));
      Form f = form(shape);
      f.direction = random.uniform(0, 6.28);
      const auto planned = plan_of(star, f);
      ASSERT_TRUE(planned) << base::to_string(planned.error());
      const auto raised = extrude::raise(planned->plan);
      ASSERT_TRUE(raised) << base::to_string(raised.error());
      double top = 0;
      for (const Point3 p : raised->solid.vertices) top = std::max(top, p.z);
      // A short edge that the kernel turns by a millimetre has a long lever at the apex.
      EXPECT_NEAR(top, 9, shape == Shape::pyramidal ? 0.05 : 5e-3);
      EXPECT_EQ(raised->outcome, extrude::Outcome::full) << raised->warnings.back().message;
    }
  }
}

TEST(Profiles, are_read_from_pairs) {
  const auto profile = profile_of("0,0 0,6  4,9");
  ASSERT_TRUE(profile);
  EXPECT_THAT(*profile, ElementsAre(model::ProfilePoint{0, 0}, model::ProfilePoint{0, 6}, model::ProfilePoint{4, 9}));
  EXPECT_EQ(*profile_of("0,6 4,9"), *profile);  // 0,0 goes without saying
  for (const auto* bad : {"", "0,0", "0,0 1", "0,0 0,6 x,9", "0,0 0,6 -1,7", "0,0 0,6 1,5", "0,0 0,6 0,6", "0,0 4,0",
                          "0,0 0,nan", "0,0 0,1e9"}) {
    const auto refused = profile_of(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, "roof-profile");
  }
}

TEST(Profiles, rise_from_every_edge_until_roofs_meet_or_the_cap) {
  const auto raise_along = [](const char* text, std::optional<double> cap) {
    Options options;
    options.cap = cap;
    const auto planned = plan_along(box(12, 8), *profile_of(text), Form{}, options);
    auto raised = extrude::raise(planned.plan);
    EXPECT_TRUE(raised);
    return solid::volume(raised->solid);
  };
  EXPECT_NEAR(raise_along("0,0 0,6 4,9", {}), walls + hip(12, 8, 3), 0.05);
  EXPECT_NEAR(raise_along("0,0 0,6 1,6.75", {}), walls + hip(12, 8, 3), 0.05);  // goes on
  EXPECT_NEAR(raise_along("0,0 0,6", {}), walls, 0.05);
  EXPECT_NEAR(raise_along("0,0 0,6 1,6 1,8", {}), walls + 10 * 6 * 2, 0.05);
  EXPECT_NEAR(raise_along("0,0 0,6 4,9", 7.5), walls + 1.5 / 6 * (96 + 4 * 10 * 6 + 8 * 4), 0.05);
}

}  // namespace
}  // namespace mansard::roof::test
