// Parts above each other. Sections are drawn from the side: a letter a metre, '.' air, a row a metre of height.
#include <gmock/gmock.h>
#include <cstdlib>
#include <map>
#include <set>

#include "mansard/base/run.hpp"
#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/stack.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::solid {
namespace {

using model::LabelledSolid;
using testing::IsEmpty;

/// A flat-roofed box.
auto block(double x0, double x1, double y0, double y1, double base, double top) -> LabelledSolid {
  model::Plan plan;
  plan.profiles = {{{0, 0}, {0, top - base}}};
  plan.outer = {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {0, 0, 0, 0}};
  plan.base = base;
  plan.cap = top - base;
  LabelledSolid out{extrude::raise(plan)->solid, {}};
  for (const auto& face : out.solid.faces)
    out.classes.push_back(face.normal.z > 0.5    ? model::FaceClass::roof
                          : face.normal.z < -0.5 ? model::FaceClass::ground
                                                 : model::FaceClass::wall);
  return out;
}

/// The blocks of a section, each letter one, all from y 0 to 6.
auto drawn(const std::vector<std::string>& rows) -> std::vector<LabelledSolid> {
  struct Extent {
    double x0 = 1e9, x1 = -1e9, z0 = 1e9, z1 = -1e9;
  };
  std::map<char, Extent> extents;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      if (rows[r][c] == '.') continue;
      auto& e = extents[rows[r][c]];
      const double x = static_cast<double>(c), z = static_cast<double>(rows.size() - 1 - r);
      e = {std::min(e.x0, x), std::max(e.x1, x + 1), std::min(e.z0, z), std::max(e.z1, z + 1)};
    }
  std::vector<LabelledSolid> out;
  for (const auto& [letter, e] : extents) out.push_back(block(e.x0, e.x1, 0, 6, e.z0, e.z1));
  return out;
}

struct Made {
  std::size_t solids = 0;
  double volume = 0;
  std::set<std::size_t> layers;
};
/// The union of every layer, as pipeline makes it.
auto made(const std::vector<LabelledSolid>& parts) -> Made {
  std::vector<const LabelledSolid*> all;
  for (const auto& part : parts) all.push_back(&part);
  const auto pieces = stack(all);
  std::map<std::size_t, std::vector<const LabelledSolid*>> layers;
  for (const auto& piece : pieces) layers[piece.layer].push_back(&piece.model);
  if (pieces.empty()) layers[0] = all;
  Made out;
  std::vector<LabelledSolid> solids;
  std::vector<std::vector<const LabelledSolid*>> of_layers;
  for (const auto& [layer, models] : layers) {
    out.layers.insert(layer);
    of_layers.push_back(models);
  }
  const std::vector<std::size_t> families(of_layers.size(), 0);
  for (const auto& united : unite_all(of_layers, families)) {
    EXPECT_THAT(united.lost, IsEmpty());
    EXPECT_THAT(united.simplified, IsEmpty());
    for (const auto& one : united.solids) {
      EXPECT_THAT(check(one.model.solid, written_rules()), IsEmpty());
      out.volume += volume(one.model.solid);
      solids.push_back(one.model);
    }
  }
  std::vector<const LabelledSolid*> standing;
  for (const auto& solid : solids) standing.push_back(&solid);
  EXPECT_THAT(overlapping(standing), IsEmpty());
  out.solids = solids.size();
  return out;
}

/// m³ of a section as drawn, each letter once, 6 m deep.
auto drawn_volume(const std::vector<std::string>& rows) -> double {
  double sum = 0;
  for (const auto& row : rows)
    for (const char c : row) sum += c == '.' ? 0 : 6;
  return sum;
}

TEST(Stack, leaves_parts_alone_that_stand_on_the_ground) {
  const auto parts = drawn({"aa....", "aabbcc", "aabbcc"});
  std::vector<const LabelledSolid*> all;
  for (const auto& part : parts) all.push_back(&part);
  EXPECT_THAT(stack(all), IsEmpty());
}

TEST(Stack, joins_what_stands_on_another_part) {
  const std::vector<std::string> tower{".bb.", ".bb.", "aaaa", "aaaa"};
  const auto one = made(drawn(tower));
  EXPECT_EQ(one.solids, 1U);
  EXPECT_NEAR(one.volume, drawn_volume(tower), 0.01);
}

TEST(Stack, joins_storeys_of_any_number) {
  const std::vector<std::string> storeys{"..d..", ".ccc.", ".bbb.", "aaaaa"};
  const auto one = made(drawn(storeys));
  EXPECT_EQ(one.solids, 1U);
  EXPECT_NEAR(one.volume, drawn_volume(storeys), 0.01);
}

TEST(Stack, keeps_air_under_what_overhangs) {
  const std::vector<std::string> mushroom{"bbbbbb", "bbbbbb", "..aa..", "..aa..", "..aa.."};
  const auto one = made(drawn(mushroom));
  EXPECT_EQ(one.solids, 1U);
  EXPECT_NEAR(one.volume, drawn_volume(mushroom), 0.01);
}

TEST(Stack, keeps_air_under_a_bridge) {
  // The deck reaches over both towers' roofs, and over the gap between them.
  const std::vector<std::string> gate{".cccccc.", "aa....bb", "aa....bb", "aa....bb"};
  const auto one = made(drawn(gate));
  EXPECT_EQ(one.solids, 1U);
  EXPECT_NEAR(one.volume, drawn_volume(gate), 0.01);
}

TEST(Stack, puts_what_floats_into_a_layer_of_its_own) {
  const std::vector<std::string> roof{"bbbbbb", "......", "......", "aaaa..", "aaaa.."};
  const auto two = made(drawn(roof));
  EXPECT_EQ(two.solids, 2U);
  EXPECT_EQ(two.layers.size(), 2U);
  EXPECT_NEAR(two.volume, drawn_volume(roof), 0.01);
}

TEST(Stack, joins_a_part_that_begins_within_another_one) {
  // A turret whose base is inside of the block below it, and beside it, counted once.
  std::vector<LabelledSolid> parts;
  parts.push_back(block(0, 8, 0, 6, 0, 5));
  parts.push_back(block(6, 10, 1, 4, 3, 9));
  const auto one = made(parts);
  EXPECT_EQ(one.solids, 1U);
  EXPECT_NEAR(one.volume, 8 * 6 * 5 + 4 * 3 * 6 - 2 * 3 * 2, 0.01);
}

TEST(Stack, joins_a_roof_without_walls) {
  // A pyramid of 6 × 6 m that begins on its own base, on a block of the same plan.
  model::Plan plan;
  plan.profiles = {{{0, 0}, {3, 4}}};
  plan.outer = {{{0, 0}, {6, 0}, {6, 6}, {0, 6}}, {0, 0, 0, 0}};
  plan.base = 5;
  plan.cap = 10;
  std::vector<LabelledSolid> parts;
  parts.push_back(block(0, 6, 0, 6, 0, 5));
  parts.push_back({extrude::raise(plan)->solid, {}});
  for (const auto& face : parts.back().solid.faces)
    parts.back().classes.push_back(face.normal.z < 0 ? model::FaceClass::ground : model::FaceClass::roof);
  const auto one = made(parts);
  EXPECT_EQ(one.solids, 1U);
  EXPECT_NEAR(one.volume, 6 * 6 * (5 + 4 / 3.0), 0.01);
}

TEST(Stack, of_random_blocks_has_the_volume_of_their_union) {
  const char* given = std::getenv("MANSARD_SEED");
  const auto seed = given != nullptr ? std::stoull(given) : 20261129ULL;
  constexpr int size = 8;
  for (std::uint64_t i = 0; i < 300; ++i) {
    base::Random random(seed, i);
    SCOPED_TRACE("MANSARD_SEED=" + std::to_string(seed) + " case " + std::to_string(i));
    const auto extent = [&] {
      const auto a = static_cast<int>(random.index(size)), b = static_cast<int>(random.index(size));
      return std::pair(std::min(a, b), std::max(a, b) + 1);
    };
    std::vector<LabelledSolid> parts;
    std::set<std::array<int, 3>> filled;
    std::string boxes;
    const std::size_t count = 2 + random.index(5);
    for (std::size_t p = 0; p < count; ++p) {
      const auto [x0, x1] = extent();
      const auto [y0, y1] = extent();
      auto [z0, z1] = extent();
      if (random.index(2) == 0) z0 = 0;
      parts.push_back(block(x0, x1, y0, y1, z0, z1));
      boxes += " x" + std::to_string(x0) + "-" + std::to_string(x1) + " y" + std::to_string(y0) + "-" +
               std::to_string(y1) + " z" + std::to_string(z0) + "-" + std::to_string(z1) + ";";
      for (int x = x0; x < x1; ++x)
        for (int y = y0; y < y1; ++y)
          for (int z = z0; z < z1; ++z) filled.insert({x, y, z});
    }
    // Layers are 2.2 mm apart: at most that on a wall of each part.
    EXPECT_NEAR(made(parts).volume, static_cast<double>(filled.size()), 0.0022 * 4 * size * size) << boxes;
  }
}

TEST(Stack, gives_the_same_pieces_for_the_same_parts) {
  const auto parts = drawn({".bbbb.", "aa..cc", "aa..cc"});
  std::vector<const LabelledSolid*> all;
  for (const auto& part : parts) all.push_back(&part);
  const auto a = stack(all), b = stack(all);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].part, b[i].part);
    EXPECT_EQ(a[i].layer, b[i].layer);
    EXPECT_EQ(a[i].model.solid.vertices, b[i].model.solid.vertices);
  }
}

}  // namespace
}  // namespace mansard::solid
