// Buildings whose source draws their parts, without a mesh. Plans are drawn: a letter a corner of the box of a part,
// 2 m a character.
#include <gmock/gmock.h>
#include <map>
#include <nlohmann/json.hpp>

#include "mansard/formats/documents.hpp"
#include "mansard/formats/plans.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/pipeline/solids.hpp"
#include "mansard/solid/solid.hpp"
#include "mansard/solid/unite.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using model::Attributes;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

auto text(const char* value) -> model::Value { return std::string(value); }

class Drawn {
 public:
  explicit Drawn(std::vector<std::string> rows) : rows_(std::move(rows)) {}
  /// The box that a letter spans.
  [[nodiscard]] auto box(char letter) const -> geometry::Polygon {
    double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (std::size_t c = 0; c < rows_[r].size(); ++c) {
        if (rows_[r][c] != letter) continue;
        const double x = 2.0 * static_cast<double>(c), y = 2.0 * static_cast<double>(rows_.size() - 1 - r);
        x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
      }
    return test::rectangle(x0, y0, x1, y1);
  }

 private:
  std::vector<std::string> rows_;
};

struct Part {
  char letter;
  Attributes tags;
};
auto building(const Drawn& drawn, char outline, Attributes tags, const std::vector<Part>& parts) -> model::Footprint {
  auto out = test::footprint(std::string(1, outline), drawn.box(outline));
  out.attributes = std::move(tags);
  for (const auto& [letter, of] : parts) out.parts.push_back({std::string(1, letter), {drawn.box(letter)}, of});
  return out;
}

/// Extruded, every solid valid and none in another one of its building.
auto raised(const model::Scene& scene, const Options& options = {}) -> report::Reconstruction {
  auto result = raise_footprints(scene, options);
  if (!result) {
    ADD_FAILURE() << base::to_string(result.error());
    return {};
  }
  for (const auto& one : result->city.buildings) {
    std::vector<const model::LabelledSolid*> solids;
    for (const auto& solid : one.solids) {
      EXPECT_THAT(solid::check(solid.model.solid, solid::written_rules()), IsEmpty()) << one.id;
      solids.push_back(&solid.model);
    }
    EXPECT_THAT(solid::overlapping(solids), IsEmpty()) << one.id;
  }
  return std::move(*result);
}
auto raised(model::Footprint footprint, const Options& options = {}) -> report::Reconstruction {
  model::Scene scene;
  scene.footprints.push_back(std::move(footprint));
  return raised(scene, options);
}
auto codes_of(const report::BuildingReport& report) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& reason : report.reasons) out.push_back(reason.code);
  return out;
}
auto attribute(const Attributes& attributes, std::string_view name) -> model::Value {
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return text("none");
}

TEST(BuildingParts, replace_their_outline) {
  const Drawn drawn({"a.......a", "n....nt.t", ".........", "n....nt.t", "a.......a"});
  // The nave has 10 × 4 m, the tower 4 × 4 m; the outline, 16 × 8 m, would be 40 m high.
  const auto r = raised(building(
      drawn, 'a', {{"building", text("church")}, {"height", text("40 m")}},
      {{'n', {{"height", 9.0}, {"roof:shape", text("gabled")}, {"roof:height", 3.0}}}, {'t', {{"height", 20.0}}}}));
  ASSERT_EQ(r.city.buildings.size(), 1U);
  EXPECT_EQ(r.buildings[0].outcome, report::Outcome::full);
  EXPECT_NEAR(r.buildings[0].volume, 10 * 4 * 7.5 + 4 * 4 * 20, 0.1);
  EXPECT_NEAR(r.buildings[0].roof_max, 20, 1e-3);
  EXPECT_EQ(r.buildings[0].roof, "several");
  EXPECT_EQ(r.city.buildings[0].parts.size(), 2U);
  EXPECT_EQ(attribute(r.city.buildings[0].parts[0].attributes, "ms_source_id"), text("n"));
  EXPECT_EQ(attribute(r.city.buildings[0].parts[0].attributes, "ms_roof_shape"), text("gabled"));
  // 128 m² of outline, 56 m² of parts.
  EXPECT_EQ(attribute(r.city.buildings[0].attributes, "ms_area_uncovered"), model::Value(72.0));
  ASSERT_THAT(codes_of(r.buildings[0]), Contains("roof-uncovered"));
  EXPECT_THAT(r.buildings[0].reasons[0].message, HasSubstr("leave 72 m² (56 %)"));
}

TEST(BuildingParts, that_cover_too_little_are_beside_their_outline_where_that_is_asked) {
  const Drawn drawn({"a.......a", ".p.p.....", ".p.p.....", "a.......a"});
  const auto church = building(drawn, 'a', {{"height", 6.0}}, {{'p', {{"height", 10.0}}}});
  Options options;
  options.roof.outline_cover = 0.9;
  const auto both = raised(church, options);
  EXPECT_NEAR(both.buildings[0].volume, 16 * 6 * 6 + 4 * 2 * 4, 0.1);
  EXPECT_THAT(codes_of(both.buildings[0]), testing::Not(Contains("roof-uncovered")));
  EXPECT_NEAR(raised(church).buildings[0].volume, 4 * 2 * 10, 0.1);
}

TEST(BuildingParts, above_each_other_are_one_solid) {
  const Drawn drawn({"a....a", ".t..t.", ".d..d.", ".d..d.", ".t..t.", "a....a"});
  const auto r = raised(building(drawn, 'a', {},
                                 {{'a', {{"height", 6.0}}},
                                  {'t', {{"min_height", 6.0}, {"height", 12.0}}},
                                  {'d',
                                   {{"min_height", text("12 m")},
                                    {"height", text("15 m")},
                                    {"roof:shape", text("pyramidal")},
                                    {"roof:height", 3.0}}}}));
  EXPECT_EQ(r.city.buildings[0].solids.size(), 1U);
  EXPECT_NEAR(r.buildings[0].volume, 10 * 10 * 6 + 6 * 6 * 6 + 6 * 2 * 3 / 3.0, 0.1);
  EXPECT_THAT(r.buildings[0].reasons, IsEmpty());
}

TEST(BuildingParts, that_float_are_solids_with_their_own_base) {
  const Drawn drawn({"ab...ba", ".......", "a.....a"});
  const auto r =
      raised(building(drawn, 'a', {}, {{'a', {{"height", 5.0}}}, {'b', {{"min_height", 8.0}, {"height", 9.0}}}}));
  // 'b' is a line: no part without an area comes out.
  EXPECT_EQ(r.city.buildings[0].solids.size(), 1U);
  const Drawn gate({"l.l.r.r", "d.....d", "d.....d", "l.l.r.r"});
  const auto bridge = raised(
      building(gate, 'l', {},
               {{'l', {{"height", 12.0}}}, {'r', {{"height", 12.0}}}, {'d', {{"min_height", 8.0}, {"height", 11.0}}}}));
  EXPECT_EQ(bridge.city.buildings[0].solids.size(), 1U);
  EXPECT_NEAR(bridge.buildings[0].volume, 2 * 4 * 6 * 12 + 4 * 2 * 3, 0.1);
  const auto roof =
      raised(building(gate, 'd', {}, {{'l', {{"height", 5.0}}}, {'d', {{"min_height", 8.0}, {"height", 9.0}}}}));
  EXPECT_EQ(roof.city.buildings[0].solids.size(), 2U);
  EXPECT_NEAR(roof.buildings[0].volume, 4 * 6 * 5 + 12 * 2 * 1, 0.1);
}

TEST(BuildingParts, that_overlap_are_counted_once) {
  const Drawn drawn({"p...p..", "..q...q", "p...p..", "..q...q"});
  const auto r = raised(building(drawn, 'p', {}, {{'p', {{"height", 6.0}}}, {'q', {{"height", 9.0}}}}));
  EXPECT_EQ(r.city.buildings[0].solids.size(), 1U);
  EXPECT_NEAR(r.buildings[0].volume, (8 * 4 - 4 * 2) * 6 + 8 * 4 * 9, 0.1);
}

TEST(BuildingParts, have_the_colours_of_their_tags) {
  const Drawn drawn({"a..t..a", ".......", "a..t..a"});
  auto church = building(drawn, 'a', {{"building:colour", text("#102030")}, {"height", 6.0}}, {});
  church.parts.push_back({"w", {test::rectangle(0, 0, 6, 4)}, {{"height", 6.0}}});
  church.parts.push_back({"e",
                          {test::rectangle(6, 0, 12, 4)},
                          {{"height", 9.0}, {"building:material", text("brick")}, {"roof:colour", text("red")}}});
  model::Scene scene;
  scene.footprints.push_back(church);
  scene.footprints.push_back(test::footprint("plain", test::rectangle(40, 0, 50, 10)));
  const auto r = raised(scene);
  const auto& one = r.city.buildings[0];
  EXPECT_EQ(attribute(one.parts[0].attributes, "ms_wall_colour"), text("#102030"));
  EXPECT_EQ(attribute(one.parts[1].attributes, "ms_wall_material"), text("brick"));
  ASSERT_TRUE(one.texture && r.city.buildings[1].texture);
  ASSERT_EQ(one.texture->solids.size(), 1U);
  const auto& solid = one.solids[0].model;
  std::map<std::vector<std::uint8_t>, double> area;
  for (std::size_t f = 0; f < solid.solid.faces.size(); ++f) {
    const auto& pixels = one.texture->solids[0].faces[f].pixels;
    EXPECT_EQ(pixels.width * pixels.height, 1U);
    area[pixels.rgb] += solid::area(solid.solid, solid.solid.faces[f]);
  }
  EXPECT_NEAR((area[{0x10, 0x20, 0x30}]), (6 + 4 + 6) * 6, 0.1);
  EXPECT_NEAR((area[{255, 0, 0}]), 6 * 4, 0.1);
  EXPECT_NEAR((area[{0xa5, 0x59, 0x3f}]), (6 + 4 + 6) * 9 + 4 * 3, 0.1);
}

TEST(BuildingParts, without_any_colour_leave_models_without_textures) {
  const Drawn drawn({"a....a", "......", "a....a"});
  EXPECT_FALSE(raised(building(drawn, 'a', {{"height", 6.0}}, {})).city.buildings[0].texture);
}

TEST(BuildingParts, come_back_from_their_plans_as_they_were) {
  const Drawn drawn({"a....a", ".t..t.", ".t..t.", "a....a"});
  const auto r =
      raised(building(drawn, 'a', {}, {{'a', {{"height", 6.0}}}, {'t', {{"min_height", 6.0}, {"height", 12.0}}}}));
  auto city = r.city;
  for (auto& one : city.buildings) {
    one.solids.clear();
    for (auto& part : one.parts) part.model = {};
  }
  const auto again = raise_plans(std::move(city), {});
  ASSERT_TRUE(again) << base::to_string(again.error());
  ASSERT_EQ(again->city.buildings[0].solids.size(), 1U);
  EXPECT_NEAR(solid::volume(again->city.buildings[0].solids[0].model.solid), r.buildings[0].volume, 0.01);
}

TEST(BuildingParts, with_hostile_tags_take_no_building_with_them) {
  const Drawn drawn({"a....a", ".t..t.", ".t..t.", "a....a"});
  const std::vector<Attributes> hostile{
      {{"height", text("-5")}},
      {{"height", text("1e9")}, {"min_height", text("nan")}},
      {{"height", text("3")}, {"min_height", text("7")}},
      {{"height", text("7")}, {"min_height", text("7")}},
      {{"building:levels", text("0")}},
      {{"building:levels", text("2;3")}, {"building:min_level", text("9")}},
      {{"height", text("5")}, {"roof:shape", text("dome")}, {"roof:height", text("5")}},
      {{"height", text("5")}, {"roof:shape", text("onion")}, {"roof:height", text("50")}},
      {{"height", text("5")}, {"roof:shape", text("sawtooth")}, {"roof:height", text("0.001")}},
      {{"height", text("5")}, {"roof:shape", text("butterfly")}, {"roof:direction", text("upwards")}},
      {{"height", text("5")}, {"roof:shape", text("round")}, {"roof:angle", text("89.999")}},
      {{"height", text("5")}, {"roof:shape", text(";;;")}},
      {{"height", text("5")}, {"roof:shape", text("dome;flat")}, {"roof:levels", text("1000")}},
      {{"height", text("12'6\"")}, {"min_height", text("3,5 m")}, {"roof:colour", text("#zzz")}}};
  for (std::size_t i = 0; i < hostile.size(); ++i) {
    SCOPED_TRACE(i);
    model::Scene scene;
    scene.footprints.push_back(building(drawn, 'a', {{"height", 6.0}}, {{'a', {{"height", 6.0}}}, {'t', hostile[i]}}));
    scene.footprints.push_back(test::footprint("other", test::rectangle(40, 0, 50, 10)));
    const auto r = raised(scene);
    ASSERT_EQ(r.buildings.size(), 2U);
    EXPECT_EQ(r.buildings[1].outcome, report::Outcome::full);
    EXPECT_GE(r.buildings[0].volume, 10 * 6 * 6 - 0.1);
    EXPECT_LT(r.buildings[0].roof_max, 2000);
  }
}

TEST(BuildingParts, give_the_same_bytes_at_any_thread_count) {
  const Drawn drawn({"a....a", ".t..t.", ".t..t.", "a....a"});
  model::Scene scene;
  for (int i = 0; i < 30; ++i) {
    auto one = building(drawn, 'a', {},
                        {{'a', {{"height", 6.0}, {"roof:shape", text(i % 2 == 0 ? "flat" : "round")}}},
                         {'t', {{"min_height", 5.0 + i % 4}, {"height", 12.0}}}});
    one.id += std::to_string(i);
    const auto move = [&](auto& polygons) {
      for (auto& polygon : polygons)
        for (auto& p : polygon.outer) p.x += 14.0 * i;
    };
    move(one.polygons);
    for (auto& part : one.parts) move(part.polygons), part.id += std::to_string(i);
    scene.footprints.push_back(std::move(one));
  }
  std::vector<std::string> bytes;
  for (const std::size_t threads : {1U, 3U}) {
    base::limit_threads(threads);
    auto r = raised(scene);
    r.times = {};
    bytes.push_back(*formats::cityjson(r.city) + report::run_json(r, scene));
  }
  base::limit_threads(0);
  EXPECT_EQ(bytes[0], bytes[1]);
}

}  // namespace
}  // namespace mansard::pipeline
