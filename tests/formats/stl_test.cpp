// STL, read back byte by byte.
#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>

#include "base/scratch.hpp"
#include "cities.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/stream.hpp"

namespace {

namespace model = mansard::model;

using namespace cities;
using namespace mansard::formats;
namespace base = mansard::base;

using Corner = std::array<float, 3>;
using Triangle = std::array<Corner, 4>;  // the normal first

struct Stl {
  std::string header;
  std::vector<Triangle> triangles;
  std::vector<base::Diagnostic> warnings;
};

auto written(const model::City& city, Shell shell) -> Stl {
  const mansard::test::Scratch folder;
  const auto path = folder / "shells.stl";
  base::Outputs outputs;
  WriteOptions options;
  options.stl_shell = shell;
  auto writer = open_writer(Format::stl, path, {city.frame, city.made_by}, options, outputs);
  EXPECT_TRUE(writer);
  const auto done = write_city(city, **writer);
  EXPECT_TRUE(done) << base::to_string(done.error());
  const auto kept = outputs.commit();
  EXPECT_TRUE(kept) << base::to_string(kept.error());
  const auto bytes = base::read_file(path);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes->data() + 80, 4);
  EXPECT_EQ(bytes->size(), 84 + 50 * std::size_t{count});
  Stl stl{bytes->substr(0, 80), std::vector<Triangle>(count), (*writer)->warnings()};
  for (std::size_t i = 0; i < count; ++i) std::memcpy(&stl.triangles[i], bytes->data() + 84 + 50 * i, 48);
  return stl;
}

/// The volume of triangles that are closed: every edge is walked as often one way as the other.
auto closed_volume(const Stl& stl) -> double {
  std::map<std::pair<Corner, Corner>, int> edges;
  double volume = 0;
  for (const auto& [normal, a, b, c] : stl.triangles) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      ++edges[{from, to}];
      --edges[{to, from}];
    }
    const auto point = [](const Corner& p) { return Point3{p[0], p[1], p[2]}; };
    volume += dot(point(a), cross(point(b), point(c))) / 6;
    EXPECT_GT(dot(point(normal), cross(point(b) - point(a), point(c) - point(a))), 0);
    EXPECT_NEAR(length(point(normal)), 1, 1e-5);
  }
  for (const auto& [edge, net] : edges) EXPECT_EQ(net, 0);
  return volume;
}

TEST(Stl, says_where_it_belongs_and_does_not_look_like_text) {
  const Stl stl = written(street(), Shell::building);
  EXPECT_THAT(stl.header, testing::StartsWith("mansard; metres, z up; add 84800 447400 0 for EPSG:28992"));
}

TEST(Stl, is_closed_and_outward_whatever_a_shell_stands_for) {
  // A gabled house of 10 by 8 m, walls of 6 m and a roof of 4; a court block of 300 m² and 12 m; an annex of 100 by 4.
  for (const Shell shell : {Shell::part, Shell::building, Shell::block}) {
    const Stl stl = written(street(), shell);
    EXPECT_NEAR(closed_volume(stl), 80 * 6 + 80 * 4 / 2 + 300 * 12 + 100 * 4, 1e-2);
    EXPECT_THAT(stl.warnings, testing::IsEmpty());
  }
}

TEST(Stl, has_no_wall_between_parts_of_a_building_but_with_a_shell_per_part) {
  const auto inside = [](const Stl& stl) {  // between block and annex, below the annex's roof
    return std::ranges::count_if(stl.triangles, [](const Triangle& t) {
      return std::abs(t[0][0]) > 0.9F && t[1][0] == 40 && t[2][0] == 40 && t[3][0] == 40 &&
             (t[1][2] + t[2][2] + t[3][2]) / 3 < 4.5F;
    });
  };
  EXPECT_GT(inside(written(street(), Shell::part)), 0);
  EXPECT_EQ(inside(written(street(), Shell::building)), 0);
}

TEST(Stl, has_no_wall_between_buildings_only_with_a_shell_per_block) {
  model::City city = street();
  city.buildings.resize(1);
  model::Building next = city.buildings[0];
  next.id = "next";
  next.parts[0].id = "next-1";
  for (auto& v : next.parts[0].model.solid.vertices) v.x += 10;
  city.buildings.push_back(next);
  const auto single = written(city, Shell::building).triangles.size();
  const auto block = written(city, Shell::block);
  EXPECT_LT(block.triangles.size(), single);
  EXPECT_NEAR(closed_volume(block), 2 * (80 * 6 + 80 * 4 / 2), 1e-2);
}

TEST(Stl, says_where_parts_share_ground) {
  model::City city = street();
  auto& parts = city.buildings[0].parts;
  parts.clear();
  for (int i = 0; i < 2; ++i) {
    const auto plot = rectangle(9 * i, 0, 10, 10);  // they overlap by a metre
    parts.push_back({"house-" + std::to_string(i), plan_of(plot, 0, 9), prism(plot, 0, 9), {}});
  }
  const Stl stl = written(city, Shell::building);
  ASSERT_EQ(stl.warnings.size(), 1U);
  EXPECT_EQ(stl.warnings[0].code, "solid-parted");
  EXPECT_EQ(stl.warnings[0].subject, "house");
  closed_volume(stl);
}

TEST(Stl, of_nothing_is_an_empty_one) {
  model::City city = street();
  city.buildings.clear();
  EXPECT_TRUE(written(city, Shell::block).triangles.empty());
}

}  // namespace
