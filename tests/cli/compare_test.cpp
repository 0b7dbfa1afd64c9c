// `mansard compare` as its users meet it.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Footprints in a row with a height each; a height of 0 leaves its place empty.
auto street(const std::vector<double>& heights, const std::string& crs = "EPSG::28992") -> std::string {
  std::string features;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (heights[i] == 0) continue;
    const std::string west = std::to_string(20 * i), east = std::to_string(20 * i + 12);
    features += std::string(features.empty() ? "" : ",") + R"({"type":"Feature","properties":{"id":"h)" +
                std::to_string(i) + R"(","height":)" + std::to_string(heights[i]) +
                R"(},"geometry":{"type":"Polygon","coordinates":[[[)" + west + ",0],[" + east + ",0],[" + east +
                ",9],[" + west + ",9],[" + west + ",0]]]}}";
  }
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:)" + crs +
         R"("}},"features":[)" + features + "]}";
}

class Compare : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    put("old.geojson", street({6, 6, 9, 6, 6, 6, 0}));
    put("new.geojson", street({9, 6, 6, 6, 0, 6, 6}));
  }
  auto report() const -> nlohmann::json { return nlohmann::json::parse(read(at("changes/changes.json"))); }
  auto kind_of(const std::string& id) const -> std::string {
    const auto all = report();
    for (const auto& building : all["buildings"])
      if (building["id"] == id) return building["ms_change"];
    return "";
  }
};

TEST_F(Compare, tells_what_is_new_gone_raised_and_lowered) {
  const auto outcome = run("compare -q " + at("old.geojson") + " " + at("new.geojson") + " -o " + at("changes") +
                           " --compare-old-error 0.3");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("new                1   +648 m³"), HasSubstr("gone               1   -648 m³"),
                    HasSubstr("raised             1   +324 m³"), HasSubstr("unchanged          3"),
                    HasSubstr("this is taken off"), HasSubstr("models alone")));
  EXPECT_EQ(kind_of("h0"), "raised");
  EXPECT_EQ(kind_of("h1"), "unchanged");
  EXPECT_EQ(kind_of("h2"), "lowered");
  EXPECT_EQ(kind_of("h6"), "new");
  EXPECT_EQ(report()["counts"]["gone"], 1);
  EXPECT_NEAR(report()["buildings"][0]["ms_change_height"].get<double>(), 3, 1e-3);
  const auto table = read(at("changes/changes.csv"));
  EXPECT_THAT(table, AllOf(HasSubstr("id,ms_change,ms_change_all,ms_change_height,"),
                           HasSubstr("\r\nh0,raised,raised,3,"), HasSubstr("\r\n,gone,gone,")));
  EXPECT_EQ(std::ranges::count(table, '\n'), 8);
  EXPECT_THAT(read(at("changes/changes.svg")), AllOf(HasSubstr("raised: 1"), HasSubstr("+3.0 m")));
  EXPECT_TRUE(read(at("changes/changes.gpkg")).starts_with("SQLite format 3"));
}

TEST_F(Compare, gives_the_new_models_what_has_changed_as_attributes) {
  const auto outcome = run("compare -q " + at("old.geojson") + " " + at("new.geojson") + " -o " + at("changes") +
                           " --formats cityjson,geopackage --compare-old-error 0.3");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto city = nlohmann::json::parse(read(at("changes/model.city.json")));
  const auto& attributes = city["CityObjects"]["h0"]["attributes"];
  EXPECT_EQ(attributes["ms_change"], "raised");
  EXPECT_NEAR(attributes["ms_change_volume"].get<double>(), 324, 1);
  EXPECT_EQ(attributes["ms_change_old"], "h0");
  EXPECT_TRUE(fs::exists(at("changes/model.gpkg")));
}

TEST_F(Compare, reads_models_of_every_kind) {
  ASSERT_EQ(
      run("extrude -q " + at("old.geojson") + " -o " + at("old") + " --formats cityjson,citygml,obj,geopackage,plans")
          .exit,
      0);
  for (const auto* name :
       {"old", "old/model.city.json", "old/model.gml", "old/model.obj", "old/model.gpkg", "old/plans.json"}) {
    const auto outcome = run("compare -q " + at(name) + " " + at("new.geojson") + " -o " + at("changes") +
                             " --overwrite --compare-old-error 0.3 --compare-new-error 0.3");
    EXPECT_EQ(outcome.exit, 0) << name << ": " << outcome.err;
    EXPECT_EQ(kind_of("h0"), "raised") << name;
    EXPECT_EQ(kind_of("h1"), "unchanged") << name;
    EXPECT_EQ(kind_of("h6"), "new") << name;
  }
}

TEST_F(Compare, uses_the_scan_of_a_run_while_it_is_there) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson")).exit, 0);
  const auto compared = [&](const std::string& more) {
    return run("compare " + at("out") + " " + at("out") + " -o " + at("changes") + " --overwrite " + more);
  };
  const auto with = compared("");
  EXPECT_EQ(with.exit, 0) << with.err;
  EXPECT_THAT(with.out, AllOf(HasSubstr("unchanged          1"), HasSubstr("Old: models and scan, noise")));
  EXPECT_TRUE(report()["old"]["scan"]);
  EXPECT_THAT(compared("--no-scans").out, HasSubstr("Old: models alone"));
  fs::rename(at("house.obj"), at("moved.obj"));
  const auto without = compared("");
  EXPECT_EQ(without.exit, 0);
  EXPECT_THAT(without.err, HasSubstr("compare-scan-gone"));
  EXPECT_THAT(without.out, HasSubstr("Old: models alone"));
  EXPECT_THAT(compared("--old-scan " + at("moved.obj")).out, HasSubstr("Old: models and scan"));
}

/// A box of 12 m by 9 m on a field that is there once.
auto box(int west, double height, int& vertices) -> std::string {
  std::string out;
  for (const double z : {0.0, height})
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{12, 0}, std::pair{12, 9}, std::pair{0, 9}})
      out += "v " + std::to_string(west + x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  const auto face = [&](int a, int b, int c, int d) {
    out += "f";
    for (const int v : {a, b, c, d}) out += " " + std::to_string(vertices + v);
    out += "\n";
  };
  face(1, 2, 6, 5), face(2, 3, 7, 6), face(3, 4, 8, 7), face(4, 1, 5, 8), face(5, 6, 7, 8);
  vertices += 8;
  return out;
}

auto scan_of(const std::vector<double>& heights) -> std::string {
  std::string out = "v -20 -20 0\nv 200 -20 0\nv 200 40 0\nv -20 40 0\nf 1 2 3 4\n";
  int vertices = 4;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (heights[i] > 0) out += box(static_cast<int>(20 * i), heights[i], vertices);
  return out;
}

TEST_F(Compare, makes_again_only_what_has_changed_since_an_earlier_run) {
  const std::string footprints = put("six.geojson", street({1, 1, 1, 1, 1, 1})) + " -o ";
  ASSERT_EQ(run("reconstruct -q " + put("a.obj", scan_of({6, 6, 6, 6, 6, 6})) + " " + footprints + at("first") +
                " --formats cityjson,plans --crs local")
                .exit,
            0);
  const auto again = run("reconstruct " + put("b.obj", scan_of({6, 9, 6, 6, 6, 6})) + " " + footprints + at("second") +
                         " --formats cityjson,plans --crs local --since " + at("first"));
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("5 of 6 blocks are as"));
  const auto city = nlohmann::json::parse(read(at("second/model.city.json")));
  const auto& objects = city["CityObjects"];
  EXPECT_EQ(objects["h0"]["attributes"]["ms_kept_from"], at("first"));
  EXPECT_NEAR(objects["h0"]["attributes"]["ms_h_roof_max"].get<double>(), 6, 0.01);
  EXPECT_FALSE(objects["h1"]["attributes"].contains("ms_kept_from"));
  EXPECT_NEAR(objects["h1"]["attributes"]["ms_h_roof_max"].get<double>(), 9, 0.01);
  const auto report = nlohmann::json::parse(read(at("second/run.json")));
  EXPECT_EQ(report["buildings"].size(), 6);
  EXPECT_EQ(report["buildings"][0]["outcome"], "full");
  // Again with nothing changed: all is taken over, and the models are the same.
  const auto same = run("reconstruct " + at("b.obj") + " " + footprints + at("third") +
                        " --formats cityjson,plans --crs local --since " + at("second"));
  EXPECT_EQ(same.exit, 0) << same.err;
  EXPECT_THAT(same.err, HasSubstr("6 of 6 blocks are as"));
  EXPECT_EQ(nlohmann::json::parse(read(at("third/model.city.json")))["vertices"], city["vertices"]);
  expect_refusal(run("reconstruct -q " + at("b.obj") + " " + footprints + at("out") + " --since " + at("b.obj")), 3,
                 "since-models");
}

TEST_F(Compare, refuses_what_cannot_be_compared) {
  const std::string to = " -o " + at("out");
  put("far.geojson", street({6, 6, 6}, "EPSG::25832"));
  expect_refusal(run("compare -q " + at("old.geojson") + " " + at("far.geojson") + to), 3, "compare-crs", "EPSG:25832");
  put("away.obj", house);
  expect_refusal(run("compare -q " + at("nothing.json") + " " + at("new.geojson") + to), 3, "file-missing");
  fs::create_directory(at("empty"));
  put("empty/run.json", "{}");
  expect_refusal(run("compare -q " + at("empty") + " " + at("new.geojson") + to), 3, "compare-state");
  put("empty/run.json", "[");
  put("empty/model.city.json", "{}");
  expect_refusal(run("compare -q " + at("empty") + " " + at("new.geojson") + to), 3, "report-run");
  expect_refusal(
      run("compare -q " + at("old.geojson") + " " + at("new.geojson") + " -o " + at("c.csv") + " --formats obj"), 2,
      "usage", "--formats");
}

TEST_F(Compare, writes_one_file_by_its_extension) {
  for (const auto* name : {"c.csv", "c.json", "c.svg", "c.gpkg"}) {
    const auto outcome = run("compare -q " + at("old.geojson") + " " + at("new.geojson") + " -o " + at(name));
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(at(name))) << name;
    EXPECT_THAT(outcome.out, HasSubstr(name));
  }
  const auto printed = run("compare -q " + at("old.geojson") + " " + at("new.geojson") + " --json");
  EXPECT_EQ(printed.out, read(at("c.json")));
}

}  // namespace
}  // namespace mansard::cli
