// What a run hands on: attributes of buildings, joined tables, levels of detail, other producers' models.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

class HandedOn : public Command {
 protected:
  auto extrude(const std::string& more, const std::string& out = "out.city.json") const -> Outcome {
    return run("extrude -q --overwrite " + at("house.geojson") + " -o " + at(out) + " " + more);
  }
  [[nodiscard]] auto attributes() const -> Json {
    const auto file = Json::parse(read(at("out.city.json")));
    for (const auto& [id, object] : file["CityObjects"].items())
      if (object["type"] == "Building") return object["attributes"];
    return {};
  }
};

TEST_F(HandedOn, a_building_of_a_run_has_the_attributes_that_consumers_join) {
  ASSERT_LE(reconstruct(at("house.obj"), at("house.geojson"), "--formats cityjson").exit, 1);
  const auto file = Json::parse(read(at("out/model.city.json")));
  const auto& all = file["CityObjects"]["a"]["attributes"];
  for (const char* name :
       {"ms_h_ground",     "ms_h_eave",         "ms_h_ridge",        "ms_h_roof_min",   "ms_h_roof_50p",
        "ms_h_roof_70p",   "ms_h_roof_max",     "ms_area_footprint", "ms_area_ground",  "ms_area_wall",
        "ms_volume_lod12", "ms_volume_lod13",   "ms_volume_lod20",   "ms_volume_lod22", "ms_rmse_lod12",
        "ms_rmse_lod13",   "ms_rmse_lod20",     "ms_rmse_lod22",     "ms_nodata_share", "ms_nodata_radius",
        "measuredHeight",  "storeysAboveGround"}) {
    ASSERT_TRUE(all.contains(name)) << name;
    EXPECT_TRUE(all[name].is_number()) << name;
  }
  EXPECT_EQ(all["ms_val3dity_lod13"], "[]");
  EXPECT_EQ(all["ms_success"], true);
  EXPECT_NEAR(all["ms_h_ridge"].get<double>(), 8, 0.1);
  EXPECT_NEAR(all["ms_h_eave"].get<double>(), 5, 0.1);
  EXPECT_NEAR(all["ms_area_ground"].get<double>(), 96, 1);
  EXPECT_LT(all["ms_rmse_lod22"].get<double>(), all["ms_rmse_lod12"].get<double>());
  EXPECT_EQ(all["ms_nodata_share"], 0.0);
}

TEST_F(HandedOn, the_ground_is_that_of_an_attribute_of_the_footprints) {
  std::string footprints = geojson(polygon(square));
  footprints.replace(footprints.find(R"("id":"a")"), 8, R"("id":"a","maaiveld":-1.5)");
  put("ground.geojson", footprints);
  expect_refusal(reconstruct(at("house.obj"), at("ground.geojson"), "--ground-attribute hoogte"), 3,
                 "pipeline-ground-attribute", "'hoogte'");
  ASSERT_LE(reconstruct(at("house.obj"), at("ground.geojson"), "--formats cityjson --ground-attribute maaiveld").exit,
            1);
  const auto file = Json::parse(read(at("out/model.city.json")));
  EXPECT_EQ(file["CityObjects"]["a"]["attributes"]["ms_ground_source"], "attribute");
  EXPECT_EQ(file["CityObjects"]["a"]["attributes"]["ms_h_ground"], -1.5);
}

TEST_F(HandedOn, a_table_is_joined_by_the_id) {
  const auto table = put("more.csv", "code,owner,year\na,somebody,1900\nb,nobody,1950\n");
  const auto told = run("extrude --overwrite " + at("house.geojson") + " -o " + at("out.city.json") + " --join " +
                        table + " --on code");
  ASSERT_LE(told.exit, 1) << told.err;
  EXPECT_THAT(told.err, AllOf(HasSubstr("ingest-join-unmatched"), HasSubstr("1 rows"), HasSubstr("b")));
  EXPECT_EQ(attributes()["owner"], "somebody");
  EXPECT_FALSE(attributes().contains("code"));
}

TEST_F(HandedOn, numbers_of_a_joined_csv_are_numbers) {
  const auto table = put("more.csv",
                         "code,year,area,share,postcode,phone,mixed,nothing,partly\n"
                         "a,1900,12.50,-0.25,0363,+31152,1,,\n"
                         "b,1950,8,0,0364,+31153,x,,3\n");
  ASSERT_LE(extrude("--join " + table + " --on code").exit, 1);
  const auto all = attributes();
  EXPECT_TRUE(all["year"].is_number_integer());
  EXPECT_EQ(all["year"], 1900);
  EXPECT_EQ(all["area"], 12.5);
  EXPECT_EQ(all["share"], -0.25);
  EXPECT_EQ(all["postcode"], "0363") << "a code keeps its zeros";
  EXPECT_EQ(all["phone"], "+31152");
  EXPECT_EQ(all["mixed"], "1") << "a column has one type";
  EXPECT_TRUE(!all.contains("partly") || all["partly"].is_null()) << "a number that is not there is no text";
}

TEST_F(HandedOn, tables_that_do_not_fit_are_refused_with_what_to_do) {
  const auto refused = [&](const std::string& table, const std::string& key, int exit, const std::string& code,
                           const std::string& words) {
    const auto told = extrude("--join " + put("t.csv", table) + (key.empty() ? "" : " --on " + key));
    EXPECT_EQ(told.exit, exit) << told.err;
    EXPECT_THAT(told.err, AllOf(HasSubstr("error[" + code + "]"), HasSubstr(words)));
    EXPECT_FALSE(fs::exists(at("out.city.json")));
  };
  refused("code,x\na,1\n", "cod", 2, "ingest-join-key", "did you mean 'code'");
  refused("code,x\na,1\na,2\n", "code", 3, "ingest-join-duplicate", "more than once (a)");
  refused("code,x\nz,1\n", "code", 3, "ingest-join-none", "--ingest-id-attribute");
  refused("code,x\na,1\n", "", 2, "usage", "--on");
  const auto missing = extrude("--join " + at("none.csv") + " --on a");
  EXPECT_THAT(missing.err, HasSubstr("error[ingest-join-table]"));
}

TEST_F(HandedOn, levels_and_attributes_are_chosen_on_the_command_line) {
  ASSERT_LE(extrude("--lod 1.3,2.0 --attributes 3dbag --write-title Town").exit, 1);
  const auto file = Json::parse(read(at("out.city.json")));
  EXPECT_EQ(file["metadata"]["title"], "Town");
  EXPECT_TRUE(attributes().contains("b3_h_maaiveld"));
  EXPECT_FALSE(attributes().contains("ms_h_ground"));
  const auto wrong = extrude("--lod 4");
  EXPECT_THAT(wrong.err, AllOf(HasSubstr("error[option-value]"), HasSubstr("'4' is not a level of detail")));
}

TEST_F(HandedOn, models_of_other_producers_are_converted_where_no_plans_are_needed) {
  const auto other = put("other.city.json", R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],
    "translate":[0,0,0]},"CityObjects":{"h":{"type":"Building","attributes":{"year":1900},"geometry":[{"type":"Solid",
    "lod":"2","boundaries":[[[[0,3,2,1]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]],[[4,5,6,7]]]]}]}},
    "vertices":[[0,0,0],[5,0,0],[5,5,0],[0,5,0],[0,0,5],[5,0,5],[5,5,5],[0,5,5]]})");
  const auto told = run("convert " + other + " -o " + at("o.glb") + " -o " + at("o.gpkg") + " -o " + at("o.gml") +
                        " -o " + at("o.stl") + " -o " + at("o.dxf") + " -o " + at("o.obj") + " -o " + at("tiles"));
  EXPECT_EQ(told.exit, 0) << told.err;
  for (const char* name : {"o.glb", "o.gpkg", "o.gml", "o.stl", "o.dxf", "o.obj", "tiles/tileset.json"})
    EXPECT_TRUE(fs::exists(at(name))) << name;
  EXPECT_THAT(read(at("o.glb")), HasSubstr("\"year\":1900"));
  const auto plans = run("convert " + other + " -o " + at("o.city.jsonl"));
  EXPECT_EQ(plans.exit, 2) << plans.err;
  EXPECT_THAT(plans.err, HasSubstr("needs plans"));
}

}  // namespace
}  // namespace mansard::cli
