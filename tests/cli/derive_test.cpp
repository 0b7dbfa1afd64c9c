// --derive-footprints: meshes alone, and models that say where their footprints are from.
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Derive : public Command {};

TEST_F(Derive, reconstructs_a_mesh_without_footprints_and_says_so_in_every_format) {
  const auto outcome = run("reconstruct " + at("house.obj") + " --derive-footprints --formats all -o " + at("out"));
  EXPECT_LE(outcome.exit, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 footprints were derived from the mesh"));
  const auto report = nlohmann::json::parse(read(at("out") + "/run.json"));
  EXPECT_EQ(report["footprints_derived"], true);
  EXPECT_EQ(report["buildings"][0]["id"], "derived-1");
  EXPECT_EQ(report["buildings"][0]["derived"], true);
  EXPECT_NEAR(report["buildings"][0]["areas_m2"]["ground"].get<double>(), 96, 12);
  for (const auto* name : {"model.city.json", "model.city.jsonl", "model.plans.jsonl", "model.glb", "model.gpkg",
                           "model.geojson", "plans.json"})
    EXPECT_THAT(read(at("out") + "/" + name), HasSubstr("ms_derived")) << name;
}

TEST_F(Derive, shows_why_walls_were_drawn_without_footprints_too) {
  const auto outcome = run("segment " + at("house.obj") + " --derive-footprints -o " + at("out.gpkg"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(read(at("out.gpkg")), HasSubstr("derived-1"));
}

TEST_F(Derive, is_named_where_footprints_are_missing) {
  const auto outcome = run("reconstruct " + at("house.obj") + " -o " + at("out"));
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--derive-footprints"));
  EXPECT_THAT(run("explore --help").out, Not(HasSubstr("--derive-footprints")));
}

TEST_F(Derive, fails_with_a_reason_where_there_is_no_building) {
  const auto outcome =
      run("reconstruct " + at("house.obj") + " --derive-footprints --derive-above-ground 50 -o " + at("out"));
  EXPECT_EQ(outcome.exit, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("derive-nothing"), HasSubstr("give footprints")));
}

TEST_F(Derive, with_a_box_gives_the_buildings_of_the_full_run) {
  const auto mesh = std::string(MANSARD_DATA) + "/delft/mesh.ply";
  const auto buildings = [&](const std::string& more) {
    fs::remove_all(at("out"));
    const auto outcome =
        run("reconstruct -q " + mesh + " --derive-footprints --formats cityjsonseq -o " + at("out") + more);
    EXPECT_LE(outcome.exit, 1) << outcome.err;
    std::map<std::string, std::string> out;
    std::istringstream lines(read(at("out") + "/model.city.jsonl"));
    for (std::string line; std::getline(lines, line);)
      if (const auto json = nlohmann::json::parse(line); json["type"] == "CityJSONFeature") out[json["id"]] = line;
    return out;
  };
  const auto all = buildings(""), some = buildings(" --bbox 60 90 110 140");
  EXPECT_GT(some.size(), 1U);
  EXPECT_LT(some.size(), all.size());
  for (const auto& [id, line] : some) EXPECT_TRUE(all.contains(id) && all.at(id) == line) << id;
  for (const auto* written : {" --bbox 60,90,110,140", " --bbox=60,90,110,140", " --bbox 60, 90, 110, 140"})
    EXPECT_EQ(buildings(written), some) << written;
}

}  // namespace
}  // namespace mansard::cli
