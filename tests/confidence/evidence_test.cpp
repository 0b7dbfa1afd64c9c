#include "mansard/confidence/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "label/solids.hpp"
#include "mansard/label/label.hpp"
#include "mansard/solid/solid.hpp"

namespace {

using namespace mansard;
using confidence::Evidence;
using geometry::Mesh;
using geometry::Point2;
using geometry::Polygon;
using enum confidence::Measure;

auto rectangle(Point2 least, Point2 most) -> Polygon {
  return {{least, {most.x, least.y}, most, {least.x, most.y}}, {}};
}

void add(Mesh& mesh, const Mesh& more) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

auto level(Point2 least, Point2 most, double z) -> Mesh {
  return {{{least.x, least.y, z}, {most.x, least.y, z}, {most.x, most.y, z}, {least.x, most.y, z}},
          {{0, 1, 2}, {0, 2, 3}}};
}

auto mesh_of(const model::Solid& solid) -> Mesh {
  const auto pieces = solid::triangulate(solid);
  EXPECT_TRUE(pieces.has_value());
  return {solid.vertices, pieces->triangles};
}

/// A gabled house of 12 by 8 m on level ground, as a sharp scan without noise shows it.
struct House {
  std::vector<Polygon> footprint{rectangle({0, 0}, {12, 8})}, others;
  std::vector<model::LabelledSolid> models;
  Mesh scan;
  model::Accuracy accuracy;

  House() {
    auto solid = solids::gable({0, 0}, {12, 8}, 0, 6, 9);
    scan = level({-20, -20}, {32, 28}, 0);
    add(scan, mesh_of(solid));
    models = label::classify({solid}, {}, {});
    accuracy.noise = 0.02;
    accuracy.correlated_area = 0.25;
    accuracy.spacing = 0.25;
    accuracy.blur = 0;
    accuracy.edge_noise = 0.1;
  }
  [[nodiscard]] auto evidence() const -> Evidence {
    const rays::Scene scene(scan);
    std::vector<const model::LabelledSolid*> solids;
    for (const auto& one : models) solids.push_back(&one);
    return confidence::evidence_of({footprint, others, solids, scene, scene, 0, accuracy});
  }
};

TEST(Evidence, of_an_exact_model_has_nothing_against_it) {
  const auto found = House().evidence();
  for (const auto measure :
       {unseen,     crowns, bare,  rms,          bias,      above,     below,     patch_above, patch_below,
        stacked,    sunk,   top,   rough,        ring_high, ring_side, gap,       rim_low,     rim_side,
        ground_off, low,    steep, small_planes, steps,     seamless,  misplaced, razed})
    EXPECT_NEAR(found[measure], 0, 1e-6) << confidence::name_of(measure);
  EXPECT_NEAR(found[area], 96, 1);
  EXPECT_NEAR(found[height], 7.5, 0.15);
  EXPECT_NEAR(found[free], 1, 1e-9);
  EXPECT_EQ(found[planes], 2);
  EXPECT_NEAR(found[relief], 3 / std::sqrt(12.0), 0.05) << "heights spread evenly over 3 m";
}

TEST(Evidence, of_a_tower_has_no_error_at_its_walls) {
  House house;
  house.models = label::classify({solids::box({0, 0}, {12, 8}, 0, 4), solids::box({4, 2}, {8, 6}, 0, 40)}, {}, {});
  house.scan = level({-20, -20}, {32, 28}, 0);
  add(house.scan, mesh_of(solids::box({0, 0}, {12, 8}, 0, 4)));
  add(house.scan, mesh_of(solids::box({4.2, 2.2}, {8.2, 6.2}, 0, 40)));  // 0.2 m beside it
  const auto found = house.evidence();
  EXPECT_NEAR(found[rms], 0, 1e-6);
  EXPECT_GT(found[walls], 0.15);
  EXPECT_NEAR(found[steps], 36.0 * 36 * 16 / 96, 1) << "36 m high, 16 m long";
  EXPECT_NEAR(found[misplaced], 36.0 * 36 * 4 * 4 * 0.2 / 96, 15) << "0.2 m along each of four walls of 4 m, in cells";
}

TEST(Evidence, says_how_much_is_not_seen) {
  House house;
  house.scan = level({-20, -20}, {32, 28}, 0);
  add(house.scan, mesh_of(solids::box({0, 0}, {3, 8}, 0, 6)));
  std::erase_if(house.scan.triangles, [](const auto& t) { return t[0] < 4; });  // no ground: nothing beyond 3 m
  EXPECT_NEAR(house.evidence()[unseen], 0.75, 0.01);
}

TEST(Evidence, finds_a_crown_on_the_roof) {
  House house;
  add(house.scan, level({2, 2}, {5, 5}, 10));
  const auto found = house.evidence();
  EXPECT_NEAR(found[above], 9.0 / 96, 0.04);
  EXPECT_NEAR(found[patch_above], 9, 1);
  EXPECT_GT(found[top], 1);
  EXPECT_EQ(found[below], 0);
}

TEST(Evidence, finds_pits) {
  House house;
  house.models = label::classify({solids::box({0, 0}, {12, 8}, 0, 9)}, {}, {});
  const auto found = house.evidence();
  EXPECT_GT(found[below], 0.8) << "the gable's roof is below a flat one at the height of its ridge";
  EXPECT_GT(found[sunk], 1);
}

TEST(Evidence, finds_what_stands_against_the_building) {
  House house;
  add(house.scan, mesh_of(solids::box({12, 0}, {14, 8}, 0, 6)));
  const auto found = house.evidence();
  EXPECT_GT(found[ring_side], 0.9);
  EXPECT_LT(found[ring_high], 0.4);
  EXPECT_NEAR(found[gap], 16.0 / 96, 0.04);
  EXPECT_EQ(found[rim_side], 0);
  EXPECT_LT(found[seamless], 0.2) << "as high as the eaves, beside a gable";
}

TEST(Evidence, takes_a_neighbour_for_one) {
  House house;
  add(house.scan, mesh_of(solids::box({12, 0}, {20, 8}, 0, 6)));
  house.others = {rectangle({12, 0}, {20, 8})};
  const auto found = house.evidence();
  EXPECT_EQ(found[ring_high], 0);
  EXPECT_EQ(found[gap], 0);
  EXPECT_NEAR(found[free], 1 - 8.0 / 40, 0.05);
}

TEST(Evidence, finds_a_footprint_that_is_beside_its_building) {
  House house;
  house.footprint = {rectangle({2, 0}, {14, 8})};
  house.models = label::classify({solids::gable({2, 0}, {14, 8}, 0, 6, 9)}, {}, {});
  const auto found = house.evidence();
  EXPECT_GT(found[rim_side], 0.9) << "east";
  EXPECT_GT(found[ring_side], 0.9) << "west";
  EXPECT_GT(found[seamless], 0.9) << "west";
}

TEST(Evidence, knows_a_roof_that_goes_on_from_one_that_overhangs) {
  House house;
  house.models = label::classify({solids::box({0, 0}, {12, 8}, 0, 6)}, {}, {});
  const auto seen_with = [&](Point2 least, Point2 most) {
    house.scan = level({-20, -20}, {32, 28}, 0);
    add(house.scan, mesh_of(solids::box(least, most, 0, 6)));
    return house.evidence()[seamless];
  };
  EXPECT_EQ(seen_with({0, 0}, {12, 8}), 0);
  EXPECT_GT(seen_with({0, 0}, {14, 8}), 0.9) << "to the east";
  EXPECT_LT(seen_with({-1.5, -1.5}, {13.5, 9.5}), 0.1) << "all around";
  house.others = {rectangle({12.5, -2}, {22, 10})};
  EXPECT_LT(seen_with({0, 0}, {22, 8}), 0.1) << "to a neighbour, whose wall is nearer";
}

TEST(Evidence, tells_ground_without_a_model_from_what_should_have_one) {
  House house;
  house.models = label::classify({solids::box({0, 0}, {6, 8}, 0, 6)}, {}, {});
  house.scan = level({-20, -20}, {32, 28}, 0);
  add(house.scan, mesh_of(solids::box({0, 0}, {9, 8}, 0, 6)));
  const auto found = house.evidence();
  EXPECT_NEAR(found[bare], 0.25, 0.03) << "9 m stand, 6 m are modelled";
  EXPECT_NEAR(found[razed], 0.25, 0.03);
  EXPECT_EQ(found[low], 0);
}

TEST(Evidence, finds_an_empty_footprint) {
  House house;
  house.scan = level({-20, -20}, {32, 28}, 0);
  const auto found = house.evidence();
  EXPECT_NEAR(found[low], 1, 1e-9);
  EXPECT_NEAR(found[rim_low], 1, 1e-9);
}

TEST(Evidence, sees_nothing_where_there_is_no_scan) {
  House house;
  house.scan = level({100, 100}, {101, 101}, 0);
  const auto found = house.evidence();
  EXPECT_NEAR(found[unseen], 1, 1e-9);
  EXPECT_EQ(found[rms], 0);
}

TEST(Evidence, has_a_name_for_every_measure) {
  std::set<std::string_view> names;
  for (std::size_t m = 0; m < confidence::measures; ++m)
    names.insert(confidence::name_of(static_cast<confidence::Measure>(m)));
  EXPECT_EQ(names.size(), confidence::measures);
  EXPECT_FALSE(names.contains(""));
  EXPECT_EQ(confidence::name_of(fallback), "fallback") << "the last one: names are in the order of the measures";
  EXPECT_EQ(confidence::name_of(ring_high), "ring_high");
}

}  // namespace
