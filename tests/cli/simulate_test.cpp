// `mansard simulate`, and a reconstruction of what it makes.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using nlohmann::json;

class Simulate : public Command {
 protected:
  auto simulate(const std::string& what, const std::string& out = "block") const -> Outcome {
    return run("simulate -q " + what + " -o " + at(out));
  }
};

TEST_F(Simulate, makes_a_terrace_that_is_reconstructed_building_by_building) {
  const auto made = simulate("--block terrace --simulate-size 30 --preset oblique-aerial --simulate-merged 0");
  ASSERT_EQ(made.exit, 0) << made.err;
  EXPECT_EQ(made.out, at("block") + "/mesh.ply\n");
  const auto truth = json::parse(read(at("block/truth.json")));
  ASSERT_GE(truth["buildings"].size(), 4U);
  const auto outcome = reconstruct(at("block/mesh.ply"), at("block/footprints.geojson"));
  EXPECT_TRUE(outcome.exit == 0 || outcome.exit == 1) << outcome.err;
  const auto report = json::parse(read(at("out/run.json")));
  ASSERT_EQ(report["buildings"].size(), truth["buildings"].size());
  for (const auto& building : report["buildings"]) {
    EXPECT_TRUE(building["outcome"] == "full" || building["outcome"] == "fallback") << building.dump();
    EXPECT_GT(building["volume_m3"], 0) << building.dump();
  }
}

TEST_F(Simulate, scans_its_own_plans_and_finds_the_same_truth_again) {
  ASSERT_EQ(simulate("--block detached --simulate-size 40 --resolution 0.6").exit, 0);
  ASSERT_EQ(simulate(at("block/plans.json") + " --resolution 0.6", "again").exit, 0);
  ASSERT_EQ(simulate(at("block/truth.city.json") + " --resolution 0.6", "city").exit, 0);
  for (const auto* name : {"mesh.ply", "footprints.geojson", "truth.obj", "plans.json"}) {
    EXPECT_EQ(read(at("block/") + name), read(at("again/") + name)) << name;
  }
  EXPECT_EQ(json::parse(read(at("block/truth.json")))["party_walls"],
            json::parse(read(at("city/truth.json")))["party_walls"]);
}

TEST_F(Simulate, scans_a_labelled_model_which_is_then_the_truth) {
  const std::string model =  // the gabled house, each of its faces labelled
      field + "o villa\ng wall\nf 5 6 10 9\nf 6 7 11 14 10\nf 7 8 12 11\nf 8 5 9 13 12\ng roof\nf 9 10 14 13\n" +
      "f 11 12 13 14\ng ground\nf 8 7 6 5\n";
  put("villa.obj", model);
  const auto made = simulate(at("villa.obj") + " --preset clean");
  ASSERT_EQ(made.exit, 0) << made.err;
  EXPECT_FALSE(fs::exists(at("block/truth.obj")));
  EXPECT_FALSE(fs::exists(at("block/plans.json")));
  const auto truth = json::parse(read(at("block/truth.json")));
  EXPECT_EQ(truth["model"]["file"], at("villa.obj"));
  EXPECT_EQ(truth["buildings"][0]["id"], "villa");
  const auto footprints = json::parse(read(at("block/footprints.geojson")));
  EXPECT_EQ(footprints["features"][0]["properties"]["buildings"], "villa");
  const auto score = run("evaluate -q " + at("villa.obj") + " " + at("block/mesh.ply") + " --truth " + at("villa.obj") +
                         " -o " + at("score.json"));
  ASSERT_EQ(score.exit, 0) << score.err;
  const auto report = json::parse(read(at("score.json")));
  EXPECT_LT(report["distances"]["model_to_mesh"]["mean_m"], 0.1);
  EXPECT_EQ(report["truth"]["buildings"]["matched"], 1);
}

TEST_F(Simulate, has_the_same_bytes_with_one_thread_and_two) {
  ASSERT_EQ(simulate("--block perimeter --resolution 0.8 -j 1", "one").exit, 0);
  ASSERT_EQ(simulate("--block perimeter --resolution 0.8 -j 2", "two").exit, 0);
  for (const auto* name :
       {"mesh.ply", "footprints.geojson", "truth.obj", "truth.mtl", "truth.city.json", "truth.json", "plans.json"}) {
    EXPECT_GT(fs::file_size(at("one/") + name), 100U) << name;
    EXPECT_EQ(read(at("one/") + name), read(at("two/") + name)) << name;
  }
}

TEST_F(Simulate, builds_on_footprints) {
  const auto made = simulate("--footprints " + at("house.geojson") + " --resolution 0.6 --picture");
  ASSERT_EQ(made.exit, 0) << made.err;
  EXPECT_GT(fs::file_size(at("block/picture.png")), 10000U);
  const auto truth = json::parse(read(at("block/truth.json")));
  EXPECT_EQ(truth["crs"], "EPSG:28992");
  ASSERT_EQ(truth["buildings"].size(), 1U);
  EXPECT_EQ(truth["buildings"][0]["id"], "a");
}

TEST_F(Simulate, takes_options_from_a_file_too) {
  put("options.toml", "preset = \"lidar-2.5d\"\n[simulate]\nseed = 9\nresolution = 1\n");
  ASSERT_EQ(simulate("--block towers --seed 4 --config " + at("options.toml")).exit, 0);
  const auto options = json::parse(read(at("block/truth.json")))["options"];
  EXPECT_EQ(options["simulate.seed"], "4");
  EXPECT_EQ(options["simulate.resolution"], "1");
  EXPECT_EQ(options["simulate.height_field"], "true");
}

TEST_F(Simulate, says_what_is_wrong) {
  const auto refused = [&](const std::string& what) { return run("simulate -q " + what + " -o " + at("out")); };
  expect_refusal(refused(""), 2, "usage", "one of a MODEL");
  expect_refusal(refused("--block terrace --footprints x.geojson"), 2, "usage", "one of a MODEL");
  expect_refusal(refused("--block castle"), 4, "option-value", "terrace");
  expect_refusal(refused("--block terrace --noise -1"), 4, "option-unknown");
  expect_refusal(refused("--block terrace --simulate-noise -1"), 4, "option-value");
  expect_refusal(refused("--block terrace --preset drone"), 4, "option-value", "nadir-drone");
  expect_refusal(refused("--footprints " + at("nothing.geojson")), 3, "file-missing");
  expect_refusal(refused(at("house.geojson")), 3, "ingest-model-format");
  put("broken.json", R"({"type":"mansard-plan","version":1})");
  expect_refusal(refused(at("broken.json")), 3, "write-plan-missing");
  ASSERT_EQ(simulate("--block towers --resolution 2").exit, 0);
  EXPECT_THAT(simulate("--block towers --resolution 2").err, testing::HasSubstr("error[output-exists]"));
}

}  // namespace
}  // namespace mansard::cli
