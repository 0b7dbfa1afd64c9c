// What is written of a building: nothing of its parts is lost.
#include <gmock/gmock.h>

#include <filesystem>

#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"

namespace {

namespace formats = mansard::formats;
namespace pipeline = mansard::pipeline;
namespace solid = mansard::solid;

TEST(Solids, of_wings_that_share_rounding_only_have_all_of_them) {
  // The walls of these wings are in each other by a few micrometres. Their union over one plan fails at first, and two
  // of the three largest were lost when that rounding was taken off one of them.
  auto read =
      formats::read_plans(std::filesystem::path(MANSARD_TEST_DATA) / "fixtures/wings_that_share_rounding.plans.json");
  ASSERT_TRUE(read) << to_string(read.error());
  const auto raised = pipeline::raise_plans(std::move(*read), {});
  ASSERT_TRUE(raised) << to_string(raised.error());
  const auto& building = raised->city.buildings.at(0);
  double parts = 0, whole = 0;
  for (const auto& part : building.parts) parts += solid::volume(part.model.solid);
  for (const auto& one : building.solids) {
    whole += solid::volume(one.model.solid);
    EXPECT_TRUE(solid::check(one.model.solid, solid::written_rules()).empty());
  }
  ASSERT_GT(parts, 39'000);
  EXPECT_NEAR(whole, parts, 0.002 * parts);
}

TEST(Solids, that_stay_apart_share_no_space_be_it_a_tenth_of_a_millimetre) {
  // Random plans whose parts meet in a line or have no plan in common, and that val3dity refused with 601: a wall
  // around a corner that the other solid has was one face that bends there by 0.03 mm, or walls leaned by rounding. The
  // fourth one took all memory: edges over each other were broken in each round twice as often as before. A corner of
  // the fifth one is on a wall of its other solid by its decimals, and inside of it when they are read.
  auto read =
      formats::read_plans(std::filesystem::path(MANSARD_TEST_DATA) / "fixtures/solids_beside_each_other.plans.json");
  ASSERT_TRUE(read) << to_string(read.error());
  const auto raised = pipeline::raise_plans(std::move(*read), {});
  ASSERT_TRUE(raised) << to_string(raised.error());
  ASSERT_EQ(raised->city.buildings.size(), 5U);
  for (const auto& building : raised->city.buildings) {
    double whole = 0;
    std::vector<const mansard::model::LabelledSolid*> solids;
    for (const auto& one : building.solids) {
      whole += solid::volume(one.model.solid);
      solids.push_back(&one.model);
      EXPECT_TRUE(solid::check(one.model.solid, solid::written_rules()).empty()) << building.id;
    }
    EXPECT_FALSE(solids.empty()) << building.id;
    EXPECT_TRUE(solid::overlapping(solids).empty()) << building.id;
    double parts = 0;
    for (const auto& part : building.parts) parts += solid::volume(part.model.solid);
    // The parts of the second one share ground, so that the sum is more.
    if (building.id == "b394") parts = 3092;
    EXPECT_NEAR(whole, parts, 0.01 * parts) << building.id;
  }
}

}  // namespace
