// Every shape over outlines of every kind: valid, as high as it was asked to be, and of the volume that formulas give.
#include "roof/houses.hpp"

#include "mansard/roof/detail/shape_list.hpp"

namespace mansard::roof::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

struct Roof {
  std::vector<Planned> plans;
  std::vector<model::Solid> solids;
  double volume = 0, top = -1e9;
  bool as_asked = true;
};

auto raised(const Polygon& polygon, const Form& f, const Options& options = {}) -> Roof {
  Roof out;
  auto planned = plans_of(polygon, f, options);
  if (!planned) {
    ADD_FAILURE() << base::to_string(planned.error());
    return out;
  }
  out.plans = std::move(*planned);
  for (const auto& one : out.plans) {
    const auto made = extrude::raise(one.plan);
    if (!made) {
      ADD_FAILURE() << base::to_string(made.error());
      continue;
    }
    EXPECT_EQ(made->outcome, extrude::Outcome::full) << (made->warnings.empty() ? "" : made->warnings[0].message);
    EXPECT_THAT(solid::check(made->solid), IsEmpty());
    double top = -1e9;
    for (const Point3 p : made->solid.vertices) top = std::max(top, p.z);
    EXPECT_NEAR(top, one.plan.base + one.top, 0.02);
    out.top = std::max(out.top, top);
    out.volume += solid::volume(made->solid);
    out.as_asked = out.as_asked && one.as_asked;
    out.solids.push_back(made->solid);
  }
  return out;
}

auto sliver() -> Polygon { return box(20, 0.5); }
auto triangle() -> Polygon { return {{{0, 0}, {10, 0}, {3, 7}}, {}}; }
auto round_tower() -> Polygon { return tower(24, 5); }

/// What every outline is good for: 'x' as asked, '-' the nearest one that it takes, with a reason.
TEST(AllShapes, are_valid_and_as_high_as_asked_over_every_outline) {
  //                          rectangle  L  T  courtyard  round  sliver  triangle
  const std::vector<std::pair<Shape, std::string_view>> table{{Shape::flat, "xxxxxxx"},
                                                              {Shape::skillion, "xxxxxxx"},
                                                              {Shape::gabled, "xxx--x-"},
                                                              {Shape::half_hipped, "xxx--x-"},
                                                              {Shape::hipped, "xxxxxxx"},
                                                              {Shape::pyramidal, "xxx-xxx"},
                                                              {Shape::gambrel, "xxx--x-"},
                                                              {Shape::mansard, "xxxxxxx"},
                                                              {Shape::saltbox, "x----x-"},
                                                              {Shape::gabled_height_moved, "x----x-"},
                                                              {Shape::bellcast_gable, "xxx--x-"},
                                                              {Shape::side_hipped, "xxx--x-"},
                                                              {Shape::side_half_hipped, "xxx--x-"},
                                                              {Shape::hipped_and_gabled, "xxx--x-"},
                                                              {Shape::round, "xxx--x-"},
                                                              {Shape::cone, "xxx-xxx"},
                                                              {Shape::dome, "xxx-xxx"},
                                                              {Shape::onion, "-------"},
                                                              {Shape::butterfly, "xxxxxxx"},
                                                              {Shape::sawtooth, "xxxxxxx"}};
  EXPECT_EQ(table.size(), detail::shapes().size());
  const std::vector outlines{box(12, 8), ell(), tee(), courtyard(), round_tower(), sliver(), triangle()};
  for (const auto& [shape, taken] : table)
    for (std::size_t i = 0; i < outlines.size(); ++i)
      for (const double turn : {0.0, 0.7}) {
        SCOPED_TRACE(std::string(to_string(shape)) + " over outline " + std::to_string(i) + " turned by " +
                     std::to_string(turn));
        const auto roof = raised(moved(outlines[i], turn, {400, -300}), form(shape));
        EXPECT_NEAR(roof.top, 9, 0.02);
        EXPECT_GT(roof.volume, geometry::area(outlines[i]) * 6);
        EXPECT_LE(roof.volume, geometry::area(outlines[i]) * 9 * 1.001);
        EXPECT_EQ(roof.as_asked, taken[i] == 'x');
        std::vector<std::string> said;
        for (const auto& one : roof.plans)
          for (const auto& code : codes_of(one.warnings)) said.push_back(code);
        if (roof.as_asked) EXPECT_THAT(said, testing::Not(Contains("roof-shape-here")));
        else EXPECT_THAT(said, Contains("roof-shape-here"));
      }
}

/// m³ over a base of `area` whose sections shrink in one shape: shares of its width at shares of its height.
auto shrinking(double area, double rise, const std::vector<std::pair<double, double>>& width_at) -> double {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < width_at.size(); ++i) {
    const auto [r, h] = width_at[i];
    const auto [s, k] = width_at[i + 1];
    sum += area * rise * (k - h) * (r * r + r * s + s * s) / 3;
  }
  return sum;
}

TEST(AllShapes, over_a_box_have_the_volume_of_formulas) {
  constexpr double walls = 12 * 8 * 6, quarter = std::numbers::pi / 2;
  // Sections across the ridge, 8 m wide and 3 m high, times 12 m; what a hip takes off an end is 16 m³.
  const double high_eaves = 3 * 3.2 / 5.6;  // of a saltbox: the ridge is 5.6 m from its low eaves
  std::vector<std::pair<double, double>> circle;
  for (int i = 0; i <= 5; ++i) circle.emplace_back(std::cos(quarter * i / 5), std::sin(quarter * i / 5));
  for (const auto& [shape, roof] :
       {std::pair{Shape::saltbox, 12 * (5.6 * 3 / 2 + 2.4 * (high_eaves + 3) / 2)},
        std::pair{Shape::gabled_height_moved, 12 * (4 * 3 / 2.0 + 4 * (1.5 + 3) / 2)},
        std::pair{Shape::bellcast_gable, 12 * 2 * (1.2 * 0.45 / 2 + 2.8 * (0.45 + 3) / 2)},
        std::pair{Shape::side_hipped, 144 - 16.0}, std::pair{Shape::side_half_hipped, 144 - 2.0},
        std::pair{Shape::hipped_and_gabled, 144 - 2 * 14.0}, std::pair{Shape::cone, 96.0},
        std::pair{Shape::dome, shrinking(96, 3, circle)}, std::pair{Shape::butterfly, 144.0},
        std::pair{Shape::sawtooth, 144.0}}) {
    SCOPED_TRACE(to_string(shape));
    EXPECT_NEAR(raised(box(12, 8), form(shape)).volume, walls + roof, 0.05);
  }
  const double radius = (16 + 9) / 6.0, half = std::atan2(4, radius - 3);
  const double segment = radius * radius * (half - std::sin(half) * std::cos(half));
  const double round = raised(box(12, 8), form(Shape::round)).volume - walls;
  EXPECT_LT(round, 12 * segment);
  EXPECT_GT(round, 12 * (segment - 0.1 * 2 * half * radius));  // no plane is farther than 0.1 m from the arc
}

TEST(AllShapes, have_as_many_pitches_as_the_detail_asks_for_and_at_most_twelve) {
  std::size_t before = 0;
  for (const double detail : {1.0, 0.3, 0.1, 0.03, 0.01, 0.001}) {
    Options options;
    options.detail = detail;
    for (const auto shape : {Shape::dome, Shape::onion, Shape::round}) {
      const auto roof = raised(box(12, 8), form(shape), options);
      std::size_t longest = 0;
      for (const auto& profile : roof.plans.front().plan.profiles) longest = std::max(longest, profile.size() - 2);
      EXPECT_LE(longest, 12U) << to_string(shape) << " " << detail;
      if (shape != Shape::dome) continue;
      EXPECT_GE(longest, before) << detail;
      before = longest;
    }
  }
  EXPECT_EQ(before, 12U);
}

/// The side on which the eaves of a roof over box(12, 8) are lowest: 'n', 'e', 's' or 'w'.
auto lowest_side(const Roof& roof) -> char {
  // Height of the roof just inside the middle of each side.
  const auto height_at = [&](Point2 p) {
    double high = 0;
    for (const auto& solid : roof.solids)
      for (const auto& face : solid.faces) {
        if (face.normal.z < 1e-3) continue;
        geometry::Ring ring;
        for (const auto v : face.loops.front()) ring.push_back(xy(solid.vertices[v]));
        if (!geometry::contains(ring, p)) continue;
        const auto a = solid.vertices[face.loops.front().front()];
        high = std::max(high, a.z - (face.normal.x * (p.x - a.x) + face.normal.y * (p.y - a.y)) / face.normal.z);
      }
    return high;
  };
  const std::array sides{std::pair{'n', height_at({4, 7.9})}, std::pair{'e', height_at({11.9, 3})},
                         std::pair{'s', height_at({4, 0.1})}, std::pair{'w', height_at({0.1, 3})}};
  return std::ranges::min(sides, {}, [](const auto& side) { return side.second; }).first;
}

TEST(Direction, is_where_the_low_side_of_a_roof_looks) {
  for (const auto shape :
       {Shape::skillion, Shape::saltbox, Shape::gabled_height_moved, Shape::side_hipped, Shape::sawtooth})
    for (const auto& [degrees, side] :
         {std::pair{0.0, 'n'}, std::pair{90.0, 'e'}, std::pair{180.0, 's'}, std::pair{270.0, 'w'}}) {
      Form f = form(shape);
      f.direction = degrees * std::numbers::pi / 180;
      const auto roof = raised(box(12, 8), f);
      // A hip looks along its ridge, of which both long sides are as low.
      if (shape == Shape::side_hipped) EXPECT_EQ(roofs(roof.solids.front()), 3U) << degrees;
      else EXPECT_EQ(lowest_side(roof), side) << to_string(shape) << " " << degrees;
    }
}

TEST(Orientation, turns_the_teeth_of_a_sawtooth) {
  Form f = form(Shape::sawtooth);
  f.rise = 1.5;
  const auto along = raised(box(30, 12), f);
  f.orientation = Orientation::across;
  const auto across = raised(box(30, 12), f);
  EXPECT_GT(across.plans.size(), along.plans.size());
  f.rise = 0.05;
  EXPECT_EQ(raised(box(30, 12), f).plans.size(), 12U);  // no more than a curve has pitches
}

TEST(Heights, of_domes_without_any_are_those_of_half_a_sphere) {
  Form f = form(Shape::dome);
  f.rise.reset();
  f.height = 30;
  const auto roof = raised(round_tower(), f);
  double eaves = 1e9;
  for (const auto& face : roof.solids.front().faces)
    if (face.normal.z > 1e-3)
      for (const auto v : face.loops.front()) eaves = std::min(eaves, roof.solids.front().vertices[v].z);
  EXPECT_NEAR(30 - eaves, 5 * std::cos(std::numbers::pi / 24), 0.01);
}

TEST(PlanOf, takes_the_nearest_shape_of_one_plan_for_those_of_several) {
  for (const auto& [shape, made] :
       {std::pair{Shape::butterfly, Shape::flat}, std::pair{Shape::sawtooth, Shape::skillion}}) {
    const auto planned = plan_of(box(12, 8), form(shape));
    ASSERT_TRUE(planned);
    EXPECT_EQ(planned->shape, made);
    EXPECT_FALSE(planned->as_asked);
    EXPECT_THAT(codes_of(planned->warnings), ElementsAre("roof-shape-here"));
  }
}

}  // namespace
}  // namespace mansard::roof::test
