// `mansard evaluate` and `mansard label` as their users meet them.
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;

/// A box of 12 × 8 as an OBJ object whose groups are classes.
auto box(const std::string& name, double west, double height) -> std::string {
  const auto v = [&](double x, double y, double z) {
    return "v " + std::to_string(west + x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  };
  std::string out = "o " + name + "\n";
  for (const double z : {0.0, height}) out += v(0, 0, z) + v(12, 0, z) + v(12, 8, z) + v(0, 8, z);
  return out + "g wall\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\ng roof\nf -4 -3 -2 -1\n" +
         "g ground\nf -5 -6 -7 -8\n";
}

/// The scan of such a box, 6 m high, on a field.
const std::string box_scan =
    "v -20 -20 0\nv 40 -20 0\nv 40 40 0\nv -20 40 0\nf 1 2 3 4\n" + box("scan", 0, 6).substr(7);

class Evaluate : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    put("scan.obj", box_scan);
  }
  auto evaluate(const std::string& model, const std::string& more = "") -> Outcome {
    return run("evaluate -q " + put("model.obj", model) + " " + at("scan.obj") + " -o " + at("report.json") +
               " --overwrite " + more);
  }
  auto report() const -> nlohmann::json { return nlohmann::json::parse(read(at("report.json"))); }
};

TEST_F(Evaluate, finds_a_box_that_is_off_by_a_metre) {
  const auto outcome = evaluate(box("a", 0, 7));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("the model's own footprints"), HasSubstr("1.0000 m²"),
                                          HasSubstr("missed, invented                    not measured")));
  const auto scores = report()["scores"];
  EXPECT_NEAR(scores["vertical_mse_m2"].get<double>(), 1, 1e-4);
  EXPECT_NEAR(scores["footprint_mse_m2"].get<double>(), 1, 1e-4);
  EXPECT_NEAR(scores["median_m"].get<double>(), 1, 1e-4);
  EXPECT_EQ(scores["cells"], 48 * 32);
  EXPECT_TRUE(scores["missed_m2"].is_null());
  EXPECT_EQ(report()["model"]["faces"], 6);
  EXPECT_EQ(report()["model"]["planes"], 6);
  EXPECT_NEAR(report()["distances"]["model_to_mesh"]["max_m"].get<double>(), 1, 1e-3);
}

TEST_F(Evaluate, compares_models_with_flat_prisms) {
  // A box of 12 × 8 whose east half is 2 m lower in the scan, and a model of it that is 3 m too high.
  put("scan.obj",
      "v -20 -20 0\nv 40 -20 0\nv 40 40 0\nv -20 40 0\nf 1 2 3 4\n" +
          std::string("v 0 0 6\nv 6 0 6\nv 6 8 6\nv 0 8 6\nf 5 6 7 8\nv 6 0 4\nv 12 0 4\nv 12 8 4\nv 6 8 4\n"
                      "f 9 10 11 12\n"));
  const auto outcome = evaluate(box("a", 0, 9), "--truth " + put("truth.obj", box("a", 0, 6)));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto r = report();
  const auto prism = r["buildings"][0]["prism"]["height_m"].get<double>();
  EXPECT_TRUE(std::abs(prism - 6) < 1e-3 || std::abs(prism - 4) < 1e-3) << prism;
  EXPECT_NEAR(r["prism"]["footprint_mse_m2"].get<double>(), 4.0 / 2, 1e-3);
  EXPECT_EQ(r["worse_than_prism"], nlohmann::json{"a"});
  EXPECT_TRUE(r["buildings"][0]["worse_than_prism"].get<bool>());
  EXPECT_NEAR(r["scores"]["inside"]["mse_m2"].get<double>(), (9 + 25) / 2.0, 1e-3);
  EXPECT_EQ(r["scores"]["inside"]["cells"], 42 * 26);
  EXPECT_THAT(outcome.out, HasSubstr("worse than their prism            1 of 1 buildings: a"));
  // Against the truth the model is 3 m off everywhere; the prism is where the scan is.
  EXPECT_NEAR(r["truth"]["scores"]["footprint_mse_m2"].get<double>(), 9, 1e-3);
  EXPECT_NEAR(r["truth"]["prism"]["footprint_mse_m2"].get<double>(), (prism - 6) * (prism - 6), 1e-3);
  EXPECT_EQ(r["truth"]["worse_than_prism"], nlohmann::json{"a"});
  EXPECT_NEAR(r["buildings"][0]["truth"]["footprint_mse_m2"].get<double>(), 9, 1e-3);
  const auto without = evaluate(box("a", 0, 9), "--evaluate-inset 0");
  EXPECT_TRUE(report()["scores"]["inside"].is_null());
  EXPECT_THAT(without.out, testing::Not(HasSubstr("inside them")));
}

TEST_F(Evaluate, finds_a_building_that_is_missing_by_the_truth) {
  put("scan.obj", box_scan + box("second", 20, 6));
  const auto truth = put("truth.obj", box("a", 0, 6) + box("b", 20, 6));
  const auto outcome = evaluate(box("a", 0, 6), "--truth " + truth);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto r = report();
  EXPECT_EQ(r["footprints_of"], "truth");
  EXPECT_NEAR(r["scores"]["vertical_mse_m2"].get<double>(), 0, 1e-6);
  EXPECT_NEAR(r["scores"]["footprint_mse_m2"].get<double>(), 36.0 / 2, 0.01);
  EXPECT_NEAR(r["scores"]["missed_m2"].get<double>(), 96, 1e-9);
  EXPECT_EQ(r["scores"]["invented_m2"], 0);
  EXPECT_EQ(r["truth"]["buildings"]["matched"], 1);
  EXPECT_EQ(r["truth"]["roofs"]["planes_found"], 1);
  EXPECT_EQ(r["truth"]["roofs"]["planes"], 2);
  EXPECT_EQ(r["truth"]["classes"]["accuracy"], 1);
  ASSERT_EQ(r["buildings"].size(), 2U);
  EXPECT_EQ(r["buildings"][1]["id"], "b");
  EXPECT_FALSE(r["buildings"][1]["modelled"].get<bool>());
  EXPECT_NEAR(r["buildings"][1]["scores"]["footprint_mse_m2"].get<double>(), 36, 0.01);
  EXPECT_EQ(r["blocks"].size(), 2U);
  // The other way round the second one is invented.
  const auto invented = evaluate(box("a", 0, 6) + box("b", 20, 6), "--truth " + put("one.obj", box("a", 0, 6)));
  EXPECT_EQ(invented.exit, 0) << invented.err;
  EXPECT_NEAR(report()["scores"]["invented_m2"].get<double>(), 96, 1e-6);
  EXPECT_EQ(report()["beside_all_footprints"], nlohmann::json{"b"});
}

/// The size of a PNG file, from its header.
auto png_size(const std::string& bytes) -> std::pair<std::size_t, std::size_t> {
  const auto number = [&](std::size_t at) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < 4; ++i) n = 256 * n + static_cast<unsigned char>(bytes[at + i]);
    return n;
  };
  return {number(16), number(20)};
}

TEST_F(Evaluate, reports_and_draws_the_roof_planes_that_are_wrong) {
  const auto truth = put("truth.obj", box("a", 0, 6) + box("b", 20, 6) + box("c", 40, 6));
  const auto model = put("model.obj", box("A", 0, 6) + box("B", 20, 6.5) + box("D", 70, 6));
  const auto command = "evaluate -q " + model + " " + at("scan.obj") + " --truth " + truth + " -o " + at("folder");
  const auto outcome = run(command);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("  buildings with every plane right: 1 of 3\n"));
  const auto form = nlohmann::json::parse(read(at("folder/report.json")))["truth"]["form"];
  EXPECT_EQ(form["buildings"], 3);
  EXPECT_EQ(form["buildings_with_every_plane_right"], 1);
  const auto& buildings = form["planes_by_building"];
  ASSERT_EQ(buildings.size(), 4U);
  EXPECT_EQ(buildings[0]["id"], "a");
  EXPECT_EQ(buildings[0]["model_ids"], nlohmann::json{"A"});
  EXPECT_TRUE(buildings[0]["every_plane_right"].get<bool>());
  EXPECT_EQ(buildings[0]["truth_found"], 1);
  EXPECT_TRUE(buildings[0]["truth_not_found"].empty());
  EXPECT_FALSE(buildings[1]["every_plane_right"].get<bool>());
  EXPECT_EQ(buildings[1]["model"], 1);
  EXPECT_EQ(buildings[1]["model_right"], 0);
  const auto& wrong = buildings[1]["model_wrong"][0];
  EXPECT_EQ(wrong["pitch_deg"], 0);
  EXPECT_TRUE(wrong["azimuth_deg"].is_null());
  EXPECT_NEAR(wrong["area_m2"].get<double>(), 96, 1e-9);
  EXPECT_NEAR(wrong["height_above_ground_m"].get<double>(), 6.5, 1e-9);
  EXPECT_NEAR(wrong["centre"][0].get<double>(), 26, 1e-9);
  EXPECT_NEAR(wrong["nearest"]["height_m"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(buildings[1]["truth_not_found"][0]["nearest"]["height_m"].get<double>(), -0.5, 1e-9);
  EXPECT_EQ(buildings[2]["model_ids"], nlohmann::json::array());
  EXPECT_TRUE(buildings[2]["truth_not_found"][0]["nearest"].is_null());
  EXPECT_TRUE(buildings[3]["id"].is_null());
  EXPECT_EQ(buildings[3]["model_ids"], nlohmann::json{"D"});

  // Three buildings in two rows, or as many as are asked for.
  const auto whole = read(at("folder/planes.png"));
  const auto [width, height] = png_size(whole);
  expect_refusal(run(command), 2, "output-exists");
  ASSERT_EQ(run(command + " --overwrite --plane-plans 1 -j 1").exit, 0);
  EXPECT_LT(png_size(read(at("folder/planes.png"))).first, width);
  EXPECT_LT(png_size(read(at("folder/planes.png"))).second, height);
  ASSERT_EQ(run(command + " --overwrite -j 1").exit, 0);
  EXPECT_EQ(read(at("folder/planes.png")), whole);
  // A folder has the pictures of one evaluation only.
  ASSERT_EQ(run("evaluate -q " + model + " " + at("scan.obj") + " -o " + at("folder") + " --overwrite").exit, 0);
  EXPECT_FALSE(fs::exists(folder_ / "folder" / "planes.png"));
}

TEST_F(Evaluate, says_what_the_number_of_plans_needs) {
  const auto model = put("model.obj", box("a", 0, 6));
  const auto command = "evaluate -q " + model + " " + at("scan.obj") + " --plane-plans 5 ";
  expect_refusal(run(command + "-o " + at("folder")), 2, "usage", "name it with --truth");
  expect_refusal(run(command + "--truth " + model), 2, "usage", "name the folder with -o");
  expect_refusal(run(command + "--truth " + model + " -o " + at("report.json")), 2, "usage", "into a folder");
}

TEST_F(Evaluate, measures_over_footprints_that_are_given) {
  const std::string wide = geojson(polygon("[0,0],[16,0],[16,8],[0,8],[0,0]"), "");
  const auto outcome = evaluate(box("a", 0, 6), "--footprints " + put("wide.geojson", wide));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NEAR(report()["scores"]["missed_m2"].get<double>(), 32, 1e-9);
  EXPECT_EQ(report()["footprints_of"], "footprints");
}

TEST_F(Evaluate, gives_a_model_of_ours_the_scores_of_its_run) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson")).exit, 0);
  const auto run_report = nlohmann::json::parse(read(at("out") + "/run.json"));
  const auto outcome = run("evaluate -q " + at("out") + "/model.city.json " + at("house.obj") + " --footprints " +
                           at("house.geojson") + " -o " + at("report"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  for (const auto* name : {"report.json", "error.png", "error.tif"})
    EXPECT_GT(fs::file_size(folder_ / "report" / name), 300U) << name;
  const auto scores = nlohmann::json::parse(read(at("report") + "/report.json"))["scores"];
  for (const auto* name : {"vertical_mse_m2", "footprint_mse_m2", "missed_m2", "invented_m2", "cells"})
    EXPECT_NEAR(scores[name].get<double>(), run_report["scores"][name].get<double>(), 1e-4) << name;
}

TEST_F(Evaluate, gives_the_same_bytes_with_one_thread_and_two) {
  const auto model = put("model.obj", box("a", 0.3, 7));
  for (const auto* threads : {"1", "2"})
    ASSERT_EQ(run("evaluate -q " + model + " " + at("scan.obj") + " --truth " + put("truth.obj", box("a", 0, 6)) +
                  " -o " + at(threads) + " -j " + threads)
                  .exit,
              0);
  for (const auto* name : {"/report.json", "/error.png", "/error.tif", "/planes.png"})
    EXPECT_EQ(read(at("1") + name), read(at("2") + name)) << name;
}

TEST_F(Evaluate, names_what_is_wrong) {
  const auto model = put("model.obj", box("a", 500, 6));
  expect_refusal(run("evaluate -q " + model + " " + at("scan.obj")), 3, "ingest-model-overlap",
                 "the mesh in x -20.0 to 40.0");
  expect_refusal(run("evaluate -q " + at("scan.obj")), 2, "usage", "a model, then one or more meshes");
  expect_refusal(run("evaluate -q " + put("m.json", "[]") + " " + at("scan.obj")), 3, "ingest-model-format");
  const auto beside = put("beside.geojson", geojson(polygon("[300,0],[316,0],[316,8],[300,8],[300,0]"), ""));
  expect_refusal(
      run("evaluate -q " + put("here.obj", box("a", 0, 6)) + " " + at("scan.obj") + " --footprints " + beside), 3,
      "ingest-model-overlap", "the footprints lie in x 300.0 to 316.0");
  const auto crs = put("rd.obj", "# crs EPSG:28992\n" + box("a", 0, 6));
  expect_refusal(run("evaluate -q " + crs + " " + at("scan.obj") + " --crs EPSG:25831"), 3, "ingest-model-crs",
                 "EPSG:25831");
  const auto truth = put("utm.obj", "# crs EPSG:25831\n" + box("a", 0, 6));
  expect_refusal(run("evaluate -q " + crs + " " + at("scan.obj") + " --truth " + truth), 3, "ingest-model-crs",
                 "EPSG:28992");
  expect_refusal(
      run("evaluate -q " + put("a.json", "{}") + " " + at("scan.obj") + " -o " + at("a.json") + " --overwrite"), 2,
      "output-input");
}

TEST_F(Evaluate, labels_the_scan_and_counts_what_is_right) {
  const auto model = put("model.obj", box("a", 0, 6));
  const auto outcome = run("label -q " + at("scan.obj") + " " + model + " -o " + at("labelled.ply"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("wall 8  roof 2"));
  const auto again = run("label -q " + at("scan.obj") + " " + model + " -o " + at("labelled.glb") + " --truth-mesh " +
                         at("labelled.ply"));
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_THAT(again.out, testing::AllOf(HasSubstr("by the model: 100.0 % of the area is right"),
                                        HasSubstr("by the normal alone: ")));
  EXPECT_GT(fs::file_size(folder_ / "labelled.glb"), 500U);
  // Of the walls 6 × 40 m² and the roof 96 m²; half of each wall's triangles have their centres at 2 m and at 4 m.
  const auto truth = put("higher.obj", box("a", 0, 12));
  const auto held = run("label -q " + at("scan.obj") + " " + model + " -o " + at("third.ply") + " --truth " + truth);
  EXPECT_EQ(held.exit, 0) << held.err;
  EXPECT_THAT(held.out, HasSubstr("of 336 m²: by the nearest wall or roof of the model "));
  EXPECT_THAT(held.out, HasSubstr("by the normal alone "));
  const auto same = run("label -q " + at("scan.obj") + " " + model + " -o " + at("fourth.ply") + " --truth " + model);
  EXPECT_THAT(same.out, HasSubstr("of the model 100.0 %, by this labelling 100.0 %, by the normal alone 100.0 %"));
  expect_refusal(run("label -q " + at("scan.obj") + " " + model + " -o " + at("labelled.ply")), 2, "output-exists");
  expect_refusal(run("label -q " + at("scan.obj") + " " + model + " -o " + at("labelled.obj")), 2, "usage",
                 ".ply or .glb");
  expect_refusal(
      run("label -q " + at("scan.obj") + " " + model + " -o " + at("b.ply") + " --truth-mesh " + at("scan.obj")), 2,
      "usage", "have no class");
}

}  // namespace
}  // namespace mansard::cli
