// Models of other makers as truth: what is scanned of them, and what is said of them.
#include "mansard/ingest/model.hpp"
#include "base/scratch.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulate/houses.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point3;
using testing::HasSubstr;

/// The six faces of a box, one group a class. Boxes wall to wall may do without the wall between them.
auto box(const std::string& id, double x0, double x1, double high, bool ground = true, bool east = true)
    -> std::string {
  std::string text = "o " + id + "\n";
  for (const double z : {0.0, high})
    for (const auto& [x, y] : {std::pair{x0, 0.0}, {x1, 0.0}, {x1, 10.0}, {x0, 10.0}})
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  text += "g roof\nf -4 -3 -2 -1\ng wall\nf -8 -7 -3 -4\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n";
  if (east) text += "f -7 -6 -2 -3\n";
  return text + (ground ? "g ground\nf -5 -6 -7 -8\n" : "");
}

/// m²; of a roof of 12 × 10 m what its rounded edges leave, half a cell of 0.5 m at each.
constexpr double inner_roof = 11.5 * 9.5;

class ModelTruths : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path()); }

  auto read(const std::string& text, const std::string& name = ".obj") -> model::Model {
    ending_ = name;
    std::ofstream(path(), std::ios::binary) << text;
    auto model = ingest::read_model(path());
    EXPECT_TRUE(model) << base::to_string(model.error());
    return std::move(*model);
  }
  auto truth(const std::string& text, const std::string& name = ".obj") -> ModelTruth {
    auto made = truth_of(read(text, name), warnings_);
    EXPECT_TRUE(made) << base::to_string(made.error());
    return std::move(*made);
  }
  [[nodiscard]] auto warned(std::string_view code) const -> std::string {
    for (const auto& warning : warnings_)
      if (warning.code == code) return warning.message;
    return "";
  }
  /// Scanned with nothing lost and nothing added.
  static auto scanned(const ModelTruth& made) -> Scan {
    auto options = test::clean();
    options.resolution = 0.5;
    auto out = scan(made.surface, options, 1);
    EXPECT_TRUE(out) << base::to_string(out.error());
    return std::move(*out);
  }
  static auto outline_area(const ModelTruth& made, std::size_t building) -> double {
    double sum = 0;
    for (const auto& polygon : made.truth.city.buildings[building].footprint) sum += geometry::area(polygon);
    return sum;
  }
  static auto turned(std::string text) -> std::string {
    for (const auto& [face, back] : {std::pair<std::string, std::string>{"f -4 -3 -2 -1", "f -1 -2 -3 -4"},
                                     {"f -8 -7 -3 -4", "f -4 -3 -7 -8"},
                                     {"f -6 -5 -1 -2", "f -2 -1 -5 -6"},
                                     {"f -5 -8 -4 -1", "f -1 -4 -8 -5"},
                                     {"f -7 -6 -2 -3", "f -3 -2 -6 -7"},
                                     {"f -5 -6 -7 -8", "f -8 -7 -6 -5"}})
      text.replace(text.find(face), face.size(), back);
    return text;
  }

  std::vector<base::Diagnostic> warnings_;

 private:
  [[nodiscard]] auto path() const -> std::filesystem::path { return folder_ / ("truth" + ending_); }
  test::Scratch folder_;
  std::string ending_ = ".obj";
};

TEST_F(ModelTruths, keep_ids_outlines_and_the_wall_between_two_boxes) {
  const auto made = truth(box("low", 0, 12, 6) + box("high", 12, 24, 9));
  const auto& buildings = made.truth.city.buildings;
  ASSERT_EQ(buildings.size(), 2U);
  EXPECT_EQ(buildings[0].id, "low");
  EXPECT_EQ(buildings[1].id, "high");
  EXPECT_NEAR(outline_area(made, 0), 120, 1e-6);
  EXPECT_NEAR(outline_area(made, 1), 120, 1e-6);
  ASSERT_EQ(made.truth.party_walls.size(), 1U);
  const auto& wall = made.truth.party_walls[0];
  EXPECT_NEAR(length(wall.line.end - wall.line.start), 10, 1e-6);
  EXPECT_NEAR(wall.line.start.x, 12, 1e-6);
  EXPECT_NEAR(wall.first_top.value(), 6, 1e-6);
  EXPECT_NEAR(wall.second_top.value(), 9, 1e-6);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0].message;
}

TEST_F(ModelTruths, are_scanned_where_their_faces_are) {
  const auto made = truth(box("low", 0, 12, 6) + box("high", 12, 24, 9));
  const auto seen = scanned(made);
  // As the same houses raised from plans; the wall between them is not seen.
  auto options = test::clean();
  options.resolution = 0.5;
  const auto raised = test::scanned(test::pair_of_houses(), options);
  for (const auto kind : {Class::wall, Class::roof, Class::ground}) {
    EXPECT_GT(test::area_of(raised, kind), 200) << to_string(kind);
    EXPECT_NEAR(test::area_of(seen, kind), test::area_of(raised, kind), 2) << to_string(kind);
  }
  for (std::size_t t = 0; t < seen.classes.size(); ++t) {
    const Point3 at = test::centre(seen.mesh, seen.mesh.triangles[t]);
    if (seen.classes[t] == Class::roof) {
      EXPECT_EQ(seen.buildings[t], at.z > 7.5 ? 1U : 0U) << at.x << " " << at.z;
    }
  }
}

TEST_F(ModelTruths, are_scanned_exactly_as_the_same_houses_of_plans) {
  auto options = test::clean();
  options.exact = true;
  const auto seen = scan(truth(box("low", 0, 12, 6) + box("high", 12, 24, 9)).surface, options, 1);
  ASSERT_TRUE(seen) << base::to_string(seen.error());
  const auto raised = test::scanned(test::pair_of_houses(), options);
  for (const auto kind : {Class::wall, Class::roof, Class::ground})
    EXPECT_NEAR(test::area_of(*seen, kind), test::area_of(raised, kind), 1e-6) << to_string(kind);
}

TEST_F(ModelTruths, say_nothing_of_the_height_of_a_wall_that_is_not_there) {
  const auto made = truth(box("a", 0, 12, 6, true, false) + box("b", 12, 24, 9));
  ASSERT_EQ(made.truth.party_walls.size(), 1U);
  EXPECT_FALSE(made.truth.party_walls[0].first_top);
  EXPECT_TRUE(made.truth.party_walls[0].second_top);
  EXPECT_EQ(warned("simulate-model-open"), "");  // from above and from below it is closed
}

TEST_F(ModelTruths, stand_on_their_outline_where_they_have_no_ground) {
  const auto made = truth(box("a", 0, 12, 6, false));
  EXPECT_THAT(warned("simulate-model-ground"), HasSubstr("1 building (a)"));
  EXPECT_NEAR(outline_area(made, 0), 120, 1e-6);
  EXPECT_EQ(made.truth.city.buildings[0].ground, 0);
  ASSERT_TRUE(made.truth.model);
  EXPECT_FALSE(made.truth.model->buildings[0].ground_faces);
  EXPECT_EQ(made.truth.model->buildings[0].area[static_cast<std::size_t>(Class::ground)], 0);
  EXPECT_GT(test::area_of(scanned(made), Class::roof), inner_roof);
}

TEST_F(ModelTruths, are_solid_below_a_roof_even_when_they_are_open) {
  // The ground lies under half of the roof only.
  const auto made =
      truth(box("a", 0, 12, 6, false) + "v 0 0 0\nv 6 0 0\nv 6 10 0\nv 0 10 0\ng ground\nf -1 -2 -3 -4\n");
  EXPECT_THAT(warned("simulate-model-open"), HasSubstr("1 building (a)"));
  const auto seen = scanned(made);
  EXPECT_GT(test::area_of(seen, Class::roof), inner_roof);
  EXPECT_GT(test::area_of(seen, Class::wall, [](Point3 p) { return p.x > 11.5 && p.z < 3; }), 20);
}

TEST_F(ModelTruths, are_the_same_inside_out) {
  const auto right = truth(box("a", 0, 12, 6)), back = truth(turned(box("a", 0, 12, 6)));
  const auto seen = scanned(right), seen_back = scanned(back);
  EXPECT_EQ(seen.classes, seen_back.classes);
  EXPECT_EQ(seen.mesh.vertices, seen_back.mesh.vertices);
}

TEST_F(ModelTruths, are_refused_without_any_area_from_above) {
  const auto model = read("v 0 0 0\nv 9 0 0\nv 9 0 5\nv 0 0 5\no a\ng wall\nf 1 2 3 4\n");
  const auto made = truth_of(model, warnings_);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, "simulate-nothing");
  EXPECT_THAT(warned("simulate-model-outline"), HasSubstr("(a)"));
}

TEST_F(ModelTruths, lose_only_the_building_that_has_no_outline) {
  const auto made = truth("v 0 0 0\nv 9 0 0\nv 9 0 5\nv 0 0 5\no a\ng wall\nf 1 2 3 4\n" + box("b", 20, 30, 5));
  ASSERT_EQ(made.truth.city.buildings.size(), 1U);
  EXPECT_EQ(made.truth.city.buildings[0].id, "b");
  EXPECT_EQ(*std::ranges::max_element(made.surface.buildings), 0U);
}

/// A gabled house of 10 × 8 m, 5 m to the eaves and 8 m to the ridge.
const std::string house_cityjson =
    R"({"type":"CityJSON","version":"2.0","metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/28992"},
"transform":{"scale":[0.001,0.001,0.001],"translate":[85000,447000,2]},
"CityObjects":{"villa":{"type":"Building","geometry":[{"type":"Solid","lod":"2.2","boundaries":[[
[[0,3,2,1]],[[0,1,5,4]],[[1,2,6,9,5]],[[2,3,7,6]],[[3,0,4,8,7]],[[4,5,9,8]],[[6,7,8,9]]]],
"semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"WallSurface"},{"type":"RoofSurface"}],
"values":[[0,1,1,1,1,2,2]]}}]}},
"vertices":[[0,0,0],[10000,0,0],[10000,8000,0],[0,8000,0],[0,0,5000],[10000,0,5000],[10000,8000,5000],[0,8000,5000],
[0,4000,8000],[10000,4000,8000]]})";

TEST_F(ModelTruths, say_where_they_come_from_and_what_their_faces_measure) {
  const auto made = truth(house_cityjson, ".city.json");
  const auto json = nlohmann::json::parse(truth_json(made.truth, {}, {}, "villa.city.json"));
  EXPECT_EQ(json["model"]["sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(json["model"]["lod"], "2.2");
  EXPECT_EQ(json["crs"], "EPSG:28992");
  ASSERT_EQ(json["buildings"].size(), 1U);
  const auto& villa = json["buildings"][0];
  EXPECT_EQ(villa["id"], "villa");
  EXPECT_NEAR(villa["ground"].get<double>(), 2, 1e-9);
  EXPECT_NEAR(villa["top"].get<double>(), 10, 1e-9);
  EXPECT_NEAR(villa["area_ground"].get<double>(), 80, 1e-6);
  EXPECT_NEAR(villa["area_roof"].get<double>(), 2 * 5 * 10, 1e-6);
  EXPECT_NEAR(villa["area_wall"].get<double>(), 2 * 5 * 10 + 2 * (8 * 5 + 8 * 3 / 2.0), 1e-6);
  EXPECT_TRUE(villa["ground_faces"]);
  EXPECT_FALSE(villa.contains("parts"));
}

}  // namespace
}  // namespace mansard::simulate
