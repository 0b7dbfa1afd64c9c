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

/// The gabled house, each of its faces labelled.
auto labelled_house() -> std::string {
  return field + "o villa\ng wall\nf 5 6 10 9\nf 6 7 11 14 10\nf 7 8 12 11\nf 8 5 9 13 12\ng roof\nf 9 10 14 13\n" +
         "f 11 12 13 14\ng ground\nf 8 7 6 5\n";
}

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

TEST_F(Simulate, writes_dormers_as_solids_of_their_own_because_a_union_does_not_show_them) {
  ASSERT_EQ(simulate("--block terrace --simulate-size 30 --simulate-dormers 1 --resolution 0.6").exit, 0);
  const auto truth = json::parse(read(at("block/truth.city.json")));
  std::size_t dormers = 0;
  for (const auto& [id, object] : truth["CityObjects"].items())
    if (object.contains("attributes") && object["attributes"].value("ms_role", "") == "dormer") {
      ++dormers;
      EXPECT_TRUE(object.contains("geometry") && !object["geometry"].empty()) << id;
    }
  EXPECT_GT(dormers, 0U);
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
  const std::string model = labelled_house();
  put("villa.obj", model);
  const auto made = simulate(at("villa.obj") + " --preset clean");
  ASSERT_EQ(made.exit, 0) << made.err;
  EXPECT_EQ(read(at("block/truth.obj")), model);
  EXPECT_FALSE(fs::exists(at("block/plans.json")));
  const auto outlines = json::parse(read(at("block/truth.geojson")));
  EXPECT_EQ(outlines["features"][0]["properties"]["id"], "villa");
  EXPECT_EQ(outlines["features"][0]["geometry"]["coordinates"][0].size(), 5U);
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

TEST_F(Simulate, says_how_accurate_its_scan_and_its_points_are) {
  const auto made =
      simulate("--block towers --preset clean --points 4 --simulate-points-noise 0.03 --simulate-direction 0");
  ASSERT_EQ(made.exit, 0) << made.err;
  const auto planted = json::parse(read(at("block/truth.json")))["planted"];
  for (const auto* name : {"noise_m", "correlated_area_m2", "spacing_m", "blur_m"}) EXPECT_EQ(planted[name], 0) << name;
  EXPECT_NEAR(planted["offset_m"][0].get<double>(), -0.2, 1e-9);
  EXPECT_NEAR(planted["points"]["noise_m"].get<double>(), 0.03, 0.002);
  EXPECT_NEAR(planted["points"]["correlated_area_m2"].get<double>(), 0.25, 1e-9);
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

TEST_F(Simulate, writes_models_whose_parts_are_counted_by_building) {
  ASSERT_EQ(simulate("--block terrace --simulate-size 30 --resolution 0.8").exit, 0);
  const auto buildings = json::parse(read(at("block/truth.json")))["buildings"];
  ASSERT_EQ(run("evaluate -q " + at("block/truth.obj") + " " + at("block/mesh.ply") + " -o " + at("obj.json")).exit, 0);
  const auto counted = json::parse(read(at("obj.json")))["model"];
  EXPECT_EQ(counted["buildings"], buildings.size());
  EXPECT_GT(counted["parts"], buildings.size());  // annexes
  const auto outlines = json::parse(read(at("block/truth.geojson")))["features"];
  ASSERT_EQ(outlines.size(), buildings.size());
  EXPECT_EQ(outlines[0]["properties"]["ground"], buildings[0]["ground"]);
}

TEST_F(Simulate, keeps_what_is_in_a_box_and_says_how_much_is_too_much) {
  const auto box = [](int west) {  // a house of 4 × 4 m
    const auto v = [&](int x, int y, int z) {
      return "v " + std::to_string(west + x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    };
    std::string text = "o at_" + std::to_string(west) + "\n";
    for (const int z : {0, 6}) text += v(0, 0, z) + v(4, 0, z) + v(4, 4, z) + v(0, 4, z);
    return text +
           "g wall\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\ng roof\nf -4 -3 -2 -1\ng ground\n"
           "f -5 -6 -7 -8\n";
  };
  const auto town = put("town.obj", box(0) + box(2000000));
  expect_refusal(run("simulate -q " + town + " -o " + at("out")), 4, "simulate-size", "keep a part of it with --bbox");
  const auto made = simulate(town + " --bbox -10 -10 10 10 --preset clean");
  ASSERT_EQ(made.exit, 0) << made.err;
  const auto truth = json::parse(read(at("block/truth.json")));
  ASSERT_EQ(truth["buildings"].size(), 1U);
  EXPECT_EQ(truth["buildings"][0]["id"], "at_0");
  const auto score = run("evaluate -q " + at("block/truth.obj") + " " + at("block/mesh.ply") + " --truth " +
                         at("block/truth.obj") + " -o " + at("score.json"));
  ASSERT_EQ(score.exit, 0) << score.err;
  const auto counted = json::parse(read(at("score.json")))["model"];
  EXPECT_EQ(counted["buildings"], 1);
  EXPECT_EQ(counted["planes"], 6);
  EXPECT_NEAR(counted["area_m2"]["wall"].get<double>(), 4 * 4 * 6, 1e-9);
  expect_refusal(run("simulate -q " + town + " --bbox 50 50 60 60 -o " + at("out")), 5, "simulate-nothing");
  expect_refusal(run("simulate -q --block towers --bbox 0 0 1 1 -o " + at("out")), 2, "usage", "--simulate-size");
}

TEST_F(Simulate, leaves_nothing_of_an_earlier_run_and_all_else) {
  ASSERT_EQ(simulate("--block towers --resolution 2 --picture").exit, 0);
  put("block/mine.txt", "mine");
  put("villa.obj", labelled_house());
  ASSERT_EQ(simulate(at("villa.obj") + " --resolution 1 --overwrite").exit, 0);
  for (const auto* name : {"truth.city.json", "truth.mtl", "plans.json", "picture.png"})
    EXPECT_FALSE(fs::exists(at("block/") + name)) << name;
  EXPECT_EQ(read(at("block/truth.obj")), labelled_house());
  EXPECT_EQ(read(at("block/mine.txt")), "mine");
  // Where no simulation has been, the same names are somebody else's.
  fs::create_directories(at("other"));
  put("other/plans.json", "mine");
  ASSERT_EQ(simulate(at("villa.obj") + " --resolution 1 --overwrite", "other").exit, 0);
  EXPECT_EQ(read(at("other/plans.json")), "mine");
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
  expect_refusal(refused(""), 2, "usage", "exactly one of MODEL");
  expect_refusal(refused("--block terrace --footprints x.geojson"), 2, "usage", "exactly one of MODEL");
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
