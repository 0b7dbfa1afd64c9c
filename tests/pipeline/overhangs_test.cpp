// Overhanging eaves from the scan to the solids that are written, and from their plans again.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/solid/solid.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using geometry::Polygon;
using model::FaceClass;
using test::footprint;
using test::rectangle;

/// A house as add_house() makes it, whose roof goes on beyond its south and north walls with a level soffit. Without
/// walls it is as seen from above: upright below the roof's edges.
void add_overhanging(geometry::Mesh& mesh, double x0, double y0, double x1, double y1, double eaves, double ridge,
                     double south, double north, bool walls = true) {
  const double ym = (y0 + y1) / 2, pitch = (ridge - eaves) / (ym - y0);
  const double ys = y0 - south, yn = y1 + north, zs = eaves - south * pitch, zn = eaves - north * pitch;
  test::add_quad(mesh, {x0, ys, zs}, {x1, ys, zs}, {x1, ym, ridge}, {x0, ym, ridge});
  test::add_quad(mesh, {x1, yn, zn}, {x0, yn, zn}, {x0, ym, ridge}, {x1, ym, ridge});
  const double foot_s = walls ? y0 : ys, foot_n = walls ? y1 : yn;
  test::add_quad(mesh, {x0, foot_s, 0}, {x1, foot_s, 0}, {x1, foot_s, zs}, {x0, foot_s, zs});
  test::add_quad(mesh, {x1, foot_n, 0}, {x0, foot_n, 0}, {x0, foot_n, zn}, {x1, foot_n, zn});
  if (walls) {
    test::add_quad(mesh, {x0, y0, zs}, {x1, y0, zs}, {x1, ys, zs}, {x0, ys, zs});
    test::add_quad(mesh, {x1, y1, zn}, {x0, y1, zn}, {x0, yn, zn}, {x1, yn, zn});
  }
  for (const double x : {x0, x1}) {
    const double low = std::min(zs, zn);
    test::add_quad(mesh, {x, foot_s, 0}, {x, foot_n, 0}, {x, foot_n, low}, {x, foot_s, low});
    test::add_quad(mesh, {x, ys, zs}, {x, yn, zn}, {x, ym, ridge}, {x, ym, ridge - 1e-3});
  }
}

auto field() -> model::Scene {
  model::Scene scene;
  test::add_quad(scene.mesh, {-20, -20, 0}, {50, -20, 0}, {50, 40, 0}, {-20, 40, 0});
  return scene;
}
auto lone(bool walls = true) -> model::Scene {
  auto scene = field();
  add_overhanging(scene.mesh, 0, 0, 12, 8, 5, 8, 0.4, 0.6, walls);
  scene.footprints.push_back(footprint("house", rectangle(0, 0, 12, 8)));
  return scene;
}

auto with(profile::Overhangs overhangs) -> Options {
  Options options;
  options.profile.overhangs = overhangs;
  return options;
}
auto reconstructed(const model::Scene& scene, profile::Overhangs overhangs) -> report::Reconstruction {
  auto result = reconstruct(scene, with(overhangs));
  EXPECT_TRUE(result) << base::to_string(result.error());
  return std::move(*result);
}

auto soffits_of(const model::Building& building) -> std::vector<Polygon> {
  std::vector<Polygon> out;
  for (const auto& one : building.solids)
    for (std::size_t f = 0; f < one.model.classes.size(); ++f)
      if (one.model.classes[f] == FaceClass::soffit)
        out.push_back(geometry::oriented(geometry::polygon_of(one.model.solid.faces[f].loops, [&](std::uint32_t v) {
          return geometry::xy(one.model.solid.vertices[v]);
        })));
  return out;
}
auto area_of(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}
auto shared(const std::vector<Polygon>& some, const std::vector<Polygon>& others) -> double {
  double sum = 0;
  for (const auto& a : some)
    for (const auto& b : others)
      if (const auto both = geometry::intersect(a, b)) sum += area_of(*both);
      else ADD_FAILURE();
  return sum;
}
void expect_valid(const model::City& city) {
  for (const auto& building : city.buildings)
    for (const auto& one : building.solids)
      EXPECT_THAT(solid::check(one.model.solid, solid::written_rules()), testing::IsEmpty()) << building.id;
}
auto number(const model::Attributes& attributes, std::string_view name) -> double {
  for (const auto& [key, value] : attributes)
    if (key == name) return std::get<double>(value);
  return std::nan("");
}

TEST(Overhangs, of_a_house_are_measured_and_made) {
  const auto off = reconstructed(lone(), profile::Overhangs::off);
  EXPECT_TRUE(std::isnan(number(off.city.buildings[0].attributes, "ms_overhang")));

  const auto seen = reconstructed(lone(), profile::Overhangs::measured);
  EXPECT_NEAR(number(seen.city.buildings[0].attributes, "ms_overhang"), 0.5, 0.05);
  EXPECT_NEAR(number(seen.city.buildings[0].attributes, "ms_overhang_share"), 1, 0.01);
  EXPECT_EQ(soffits_of(seen.city.buildings[0]).size(), 0U);

  const auto made = reconstructed(lone(), profile::Overhangs::soffits);
  const auto& building = made.city.buildings[0];
  EXPECT_EQ(made.buildings[0].outcome, report::Outcome::full);
  expect_valid(made.city);
  EXPECT_EQ(soffits_of(building).size(), 2U);
  EXPECT_NEAR(area_of(soffits_of(building)), 12 * (0.4 + 0.6), 0.6);
  EXPECT_NEAR(number(building.attributes, "ms_overhang"), 0.5, 0.05);
  std::string changes;
  for (const auto& [key, value] : building.parts[0].attributes)
    if (key == "ms_refined") changes = std::get<std::string>(value);
  EXPECT_THAT(changes, testing::HasSubstr("eaves overhang by 0."));
  EXPECT_THAT(changes, testing::HasSubstr("; soffits along 24.0"));
}

TEST(Overhangs, come_again_from_plans_and_can_be_edited_there) {
  const auto made = reconstructed(lone(), profile::Overhangs::soffits);
  const auto again = raise_plans(made.city, {});
  ASSERT_TRUE(again) << base::to_string(again.error());
  EXPECT_EQ(formats::obj(again->city, "m")->obj, formats::obj(made.city, "m")->obj);

  auto changed = made.city;
  auto& overhangs = changed.buildings[0].parts[0].plan.outer.overhang_of_edge;
  ASSERT_EQ(overhangs.size(), 4U);
  for (double& overhang : overhangs)
    if (overhang > 0) overhang = 1;
  const auto wider = raise_plans(changed, {});
  ASSERT_TRUE(wider);
  expect_valid(wider->city);
  EXPECT_NEAR(area_of(soffits_of(wider->city.buildings[0])), 24, 0.3);

  overhangs.clear();
  const auto none = raise_plans(changed, {});
  ASSERT_TRUE(none);
  EXPECT_TRUE(soffits_of(none->city.buildings[0]).empty());
}

TEST(Overhangs, never_reach_into_a_neighbour) {
  // Three houses wall to wall: the middle one stands back by 0.3 m in the south, its eaves reach out by 0.5.
  auto scene = field();
  add_overhanging(scene.mesh, 0, 0, 10, 8, 5, 8, 0.4, 0.4);
  add_overhanging(scene.mesh, 10, 0.3, 20, 8, 5, 8, 0.5, 0.4);
  add_overhanging(scene.mesh, 20, 0, 30, 8, 6, 9, 0.4, 0.4);
  scene.footprints.push_back(footprint("a", rectangle(0, 0, 10, 8)));
  scene.footprints.push_back(footprint("b", rectangle(10, 0.3, 20, 8)));
  scene.footprints.push_back(footprint("c", rectangle(20, 0, 30, 8)));
  const auto made = reconstructed(scene, profile::Overhangs::soffits);
  expect_valid(made.city);
  ASSERT_EQ(made.city.buildings.size(), 3U);
  double all = 0;
  for (const auto& building : made.city.buildings) {
    const auto own = soffits_of(building);
    all += area_of(own);
    for (const auto& other : made.city.buildings) {
      if (&other == &building) continue;
      std::vector<Polygon> grounds;
      for (const auto& part : other.parts) grounds.push_back(geometry::oriented(model::polygon_of(part.plan)));
      EXPECT_LT(shared(own, grounds), 0.01) << building.id << " " << other.id;
      EXPECT_LT(shared(own, soffits_of(other)), 0.01) << building.id << " " << other.id;
    }
  }
  EXPECT_GT(all, 0.7 * 2 * 30 * 0.4);
}

TEST(Overhangs, of_a_height_field_change_nothing) {
  for (const double drawn : {0.0, 0.4}) {  // footprints at the walls, and at the eaves
    auto scene = lone(false);
    scene.footprints[0].polygons = {rectangle(0, -drawn, 12, 8 + drawn)};
    const auto off = reconstructed(scene, profile::Overhangs::off);
    const auto on = reconstructed(scene, profile::Overhangs::soffits);
    auto same = on.city;
    same.made_by = off.city.made_by;  // the option differs
    EXPECT_EQ(formats::obj(same, "m")->obj, formats::obj(off.city, "m")->obj);
    EXPECT_EQ(on.city.buildings[0].attributes, off.city.buildings[0].attributes);
    EXPECT_TRUE(on.city.buildings[0].parts[0].plan.outer.overhang_of_edge.empty());
  }
}

}  // namespace
}  // namespace mansard::pipeline
