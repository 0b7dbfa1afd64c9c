#include <gmock/gmock.h>

#include <algorithm>
#include <ranges>

#include "lab/simulate/simulate.hpp"
#include "mansard/formats/documents.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/solid/solid.hpp"
#include "simulate/apart.hpp"

namespace mansard::simulate {
namespace {

auto made(Kind kind, const BlockOptions& options, std::uint64_t seed) -> Truth {
  auto truth = make_block(kind, options, seed);
  EXPECT_TRUE(truth) << (truth ? "" : base::to_string(truth.error()));
  return truth ? std::move(*truth) : Truth{};
}

auto role_of(const model::Part& part) -> std::string {
  for (const auto& [name, value] : part.attributes)
    if (const auto* text = std::get_if<std::string>(&value); text && name == "ms_role") return *text;
  return {};
}

auto with_role(const Truth& truth, const std::string& role) -> std::vector<const model::Part*> {
  std::vector<const model::Part*> parts;
  for (const auto& building : truth.city.buildings)
    for (const auto& part : building.parts)
      if (role_of(part) == role) parts.push_back(&part);
  return parts;
}

auto width_of(const model::Part& part) -> double {
  const auto& ring = part.plan.outer.points;
  return std::min(length(ring[1] - ring[0]), length(ring[2] - ring[1]));
}

auto top_of(const model::Part& part) -> double {
  return std::ranges::max(part.model.solid.vertices, {}, &geometry::Point3::z).z;
}

TEST(Details, are_valid_solids_of_their_role_in_every_kind_of_block) {
  BlockOptions options;
  options.dormers = options.plant_rooms = options.bays = options.extensions = 1;
  options.overhang = 0.5;
  std::size_t dormers = 0, rooms = 0, bays = 0, extensions = 0;
  for (const auto kind : {Kind::terrace, Kind::perimeter, Kind::courtyard, Kind::towers, Kind::detached})
    for (const std::uint64_t seed : {2U, 4U}) {
      const auto truth = made(kind, options, seed);
      for (const auto& building : truth.city.buildings)
        for (const auto& part : building.parts)
          EXPECT_THAT(solid::check(part.model.solid), testing::IsEmpty()) << part.id;
      for (const auto* part : with_role(truth, "dormer")) {
        const auto& ring = part->plan.outer.points;
        EXPECT_GE(length(ring[1] - ring[0]), 1.2 - 1e-6);
        ++dormers;
      }
      for (const auto* part : with_role(truth, "extension")) {
        EXPECT_GE(width_of(*part), 0.8 - 1e-6);
        ++extensions;
      }
      rooms += with_role(truth, "plant room").size();
      bays += with_role(truth, "bay window").size();
    }
  EXPECT_GT(dormers, 20U);
  EXPECT_GT(rooms, 5U);
  EXPECT_GT(bays, 20U);
  EXPECT_GT(extensions, 10U);
}

TEST(Details, of_files_are_those_that_are_scanned) {
  // The eaves of a wing between two courtyards run into each other.
  BlockOptions options;
  options.overhang = 0.3;
  const auto truth = made(Kind::courtyard, options, 22);
  std::vector<base::Diagnostic> warnings;
  ASSERT_TRUE(formats::cityjson(truth.city, formats::Solids::building, &warnings));
  EXPECT_THAT(warnings, testing::Each(testing::Field(&base::Diagnostic::code, testing::Ne("solid-simplified"))));
}

TEST(Details, leave_the_houses_themselves_as_they_are_without) {
  BlockOptions options;
  const auto plain = made(Kind::terrace, options, 4);
  options.dormers = options.bays = 1;
  const auto detailed = made(Kind::terrace, options, 4);
  ASSERT_EQ(plain.city.buildings.size(), detailed.city.buildings.size());
  for (std::size_t b = 0; b < plain.city.buildings.size(); ++b)
    EXPECT_EQ(plain.city.buildings[b].parts[0].model.solid.vertices,
              detailed.city.buildings[b].parts[0].model.solid.vertices);
}

TEST(Details, end_dormers_below_the_ridge_of_their_house) {
  BlockOptions options;
  options.dormers = 1;
  const auto truth = made(Kind::terrace, options, 2);
  for (const auto& building : truth.city.buildings)
    for (const auto& part : building.parts)
      if (role_of(part) == "dormer") {
        EXPECT_LT(top_of(part), top_of(building.parts[0]) - 0.3) << part.id;
      }
}

TEST(Details, are_buildings_that_do_not_overlap) {
  BlockOptions options;
  options.bays = options.extensions = 1;
  for (const auto kind : {Kind::terrace, Kind::perimeter, Kind::detached}) {
    SCOPED_TRACE(static_cast<int>(kind));
    simulated::expect_apart(made(kind, options, 2).city.buildings);
  }
}

TEST(Rows, that_are_alike_have_one_eave_and_one_ridge_height_and_one_width) {
  BlockOptions options;
  options.alike = 1;
  options.annexes = 0;
  const auto truth = made(Kind::terrace, options, 2);
  // Two rows: houses of one row have one height, so there are two heights at most.
  std::vector<double> tops, widths;
  for (const auto& building : truth.city.buildings) {
    tops.push_back(top_of(building.parts[0]));
    widths.push_back(length(building.parts[0].plan.outer.points[1] - building.parts[0].plan.outer.points[0]));
  }
  const auto distinct = [](std::vector<double> values) {
    std::ranges::sort(values);
    return 1 + std::ranges::count_if(std::views::iota(std::size_t{1}, values.size()),
                                     [&](std::size_t i) { return values[i] - values[i - 1] > 2e-3; });
  };
  EXPECT_LE(distinct(tops), 2);
  EXPECT_LE(distinct(widths), 2);
  options.alike = 0;
  options.equal_heights = 0;
  EXPECT_GT(distinct([&] {
              std::vector<double> all;
              for (const auto& building : made(Kind::terrace, options, 2).city.buildings)
                all.push_back(top_of(building.parts[0]));
              return all;
            }()),
            8);
}

/// Vertices of the scan that are more than 0.6 m above everything that is true there.
auto above_truth(const Truth& truth, const ScanOptions& options) -> std::size_t {
  const auto surface = surface_of(truth.city);
  EXPECT_TRUE(surface);
  const auto scanned = scan(*surface, options, 2);
  EXPECT_TRUE(scanned);
  const rays::Scene top(surface->mesh);
  std::size_t high = 0;
  for (const auto v : scanned->mesh.vertices)
    if (const auto z = top.top(xy(v)); z && v.z > *z + 0.6) ++high;
  return high;
}

TEST(Trees, over_roofs_are_in_the_scan_and_not_in_the_truth) {
  const auto truth = made(Kind::detached, {}, 2);
  ScanOptions options;
  options.noise = options.bulge = options.holes = options.missing_walls = options.trees = options.chimneys =
      options.melt = 0;
  options.resolution = 0.5;
  const auto plain = above_truth(truth, options);  // along walls, by the width of a cell
  auto crowns = options, inside = options;
  crowns.crowns = 1;
  inside.roof_trees = 1;
  EXPECT_GT(above_truth(truth, crowns), plain + 200);
  EXPECT_GT(above_truth(truth, inside), plain + 200);
}

}  // namespace
}  // namespace mansard::simulate
