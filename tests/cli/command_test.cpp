// The product as its users meet it: the program, its files, its one line of complaint, its exit code.
#include <array>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;

/// A footprint of that ring, "bad", and then the house's own, "good".
auto beside_a_good_one(const std::string& ring) -> std::string {
  const auto feature = [](const std::string& id, const std::string& of) {
    return R"({"type":"Feature","properties":{"id":")" + id + R"("},"geometry":)" + polygon(of) + "}";
  };
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
         feature("bad", ring) + "," + feature("good", square) + "]}";
}

TEST_F(Command, reconstructs_a_house_and_names_the_model_on_stdout) {
  const auto outcome = reconstruct(at("house.obj"), at("house.geojson"), "--picture --report " + at("copy.json"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, at("out") + "/model.city.json\n" + at("out") + "/picture.png\n");
  for (const auto* name : {"model.city.json", "model.obj", "model.mtl", "model.glb", "plans.json", "run.json",
                           "picture.png", "above.png", "error.png"})
    EXPECT_GT(fs::file_size(folder_ / "out" / name), 100U) << name;
  EXPECT_EQ(read(at("copy.json")), read(at("out") + "/run.json"));
  const auto report = nlohmann::json::parse(read(at("copy.json")));
  EXPECT_EQ(report["counts"]["full"], 1);
  EXPECT_EQ(report["crs"], "EPSG:28992");
  const auto model = nlohmann::json::parse(read(at("out") + "/model.city.json"));
  EXPECT_EQ(model["version"], "2.0");
  EXPECT_EQ(model["metadata"]["referenceSystem"], "https://www.opengis.net/def/crs/EPSG/0/28992");
}

TEST_F(Command, gives_identical_model_files_with_one_thread_and_two) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "-j 1 --picture").exit, 0);
  fs::rename(at("out"), at("one"));
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "-j 2 --picture").exit, 0);
  for (const auto* name : {"model.city.json", "model.obj", "model.mtl", "model.glb", "plans.json", "picture.png",
                           "above.png", "error.png"})
    EXPECT_EQ(read(at("one") + "/" + name), read(at("out") + "/" + name)) << name;
}

TEST_F(Command, draws_the_same_pictures_from_cells_on_any_number_of_threads_and_when_resumed) {
  const std::string in_cells = "--picture --ingest-cells-from 0 ";
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), in_cells + "-j 1 --no-resume").exit, 0);
  fs::rename(at("out"), at("one"));
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), in_cells + "-j 2").exit, 0);
  const auto same = [&] {
    for (const auto* name : {"picture.png", "above.png", "error.png"})
      EXPECT_EQ(read(at("one") + "/" + name), read(at("out") + "/" + name)) << name;
  };
  same();
  // All blocks taken over from the run before.
  const auto again = reconstruct(at("house.obj"), at("house.geojson"), in_cells + "--overwrite");
  ASSERT_EQ(again.exit, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(read(at("out") + "/run.json"))["times"]["reuse"]["blocks_taken_over"], 1);
  same();
}

TEST_F(Command, raises_its_own_plans_to_the_same_model_again) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson")).exit, 0);
  const auto again = run("extrude " + at("out") + "/plans.json -o " + at("again.obj"));
  EXPECT_EQ(again.exit, 0) << again.err;
  const auto vertices = [&](const std::string& path) {
    std::vector<std::string> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("v ") || line.starts_with("f ")) lines.push_back(line);
    return lines;
  };
  EXPECT_EQ(vertices(at("again.obj")), vertices(at("out") + "/model.obj"));
  const auto twice = run("extrude " + at("out") + "/plans.json -o " + at("again.obj"));
  EXPECT_EQ(twice.exit, 2);
  EXPECT_THAT(twice.err, HasSubstr("output-exists"));
}

/// A feature of that ring with those properties, as JSON.
auto feature(const std::string& properties, const std::string& ring) -> std::string {
  return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":)" + polygon(ring) + "}";
}
auto collection(const std::string& features) -> std::string {
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
         features + "]}";
}
const std::string two_houses =
    collection(feature(R"("id":"gabled","roof:shape":"gabled","height":"9 m","roof:height":"3")", square) + "," +
               feature(R"("id":"odd","roof:shape":"hipped","height":"tall","building:levels":2)",
                       "[20,0],[32,0],[32,8],[20,8],[20,0]"));

TEST_F(Command, raises_footprints_by_their_attributes) {
  const auto file = put("two.geojson", two_houses);
  const auto outcome = run("extrude " + file + " -o " + at("out") + " --picture --report " + at("copy.json"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("out") + "\n");
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("2 of 2 buildings with a full model (1 of them with remarks)"),
                                          HasSubstr("warning[roof-value] odd: height = \"tall\"")));
  for (const auto* name :
       {"model.city.json", "model.obj", "model.mtl", "model.glb", "plans.json", "run.json", "picture.png"})
    EXPECT_GT(fs::file_size(folder_ / "out" / name), 100U) << name;
  EXPECT_EQ(read(at("copy.json")), read(at("out") + "/run.json"));
  const auto report = nlohmann::json::parse(read(at("copy.json")));
  EXPECT_NEAR(report["buildings"][0]["volume_m3"].get<double>(), 12 * 8 * 7.5, 0.01);
  EXPECT_NEAR(report["buildings"][0]["roof_max_m"].get<double>(), 9, 1e-3);
  EXPECT_EQ(report["buildings"][1]["height_from"], "levels");
  EXPECT_EQ(report["crs"], "EPSG:28992");
  // What it wrote is a plan file, which raises to the same model.
  const auto again = run("extrude " + at("out") + "/plans.json -o " + at("again.city.json"));
  EXPECT_EQ(again.exit, 0) << again.err;
  const auto vertices = [](const std::string& text) { return nlohmann::json::parse(text)["vertices"]; };
  EXPECT_EQ(vertices(read(at("again.city.json"))), vertices(read(at("out") + "/model.city.json")));
}

TEST_F(Command, raises_footprints_in_degrees_with_hstore_tags_in_their_utm_zone) {
  const auto file =
      put("osm.geojson",
          R"({"type":"FeatureCollection","features":[)" +
              feature(R"("osm_way_id":"7","other_tags":"\"roof:shape\"=>\"hipped\",\"building:levels\"=>\"3\"")",
                      "[4.36,52.0],[4.3602,52.0],[4.3602,52.0001],[4.36,52.0001],[4.36,52.0]") +
              "]}");
  const auto outcome = run("extrude -q " + file + " -o " + at("out"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto report = nlohmann::json::parse(read(at("out") + "/run.json"));
  EXPECT_EQ(report["crs"], "EPSG:32631");
  EXPECT_EQ(report["buildings"][0]["id"], "7");
  EXPECT_EQ(report["buildings"][0]["roof"], "hipped");
  EXPECT_EQ(report["buildings"][0]["height_from"], "levels");
  EXPECT_NEAR(report["buildings"][0]["areas_m2"]["ground"].get<double>(), 13.73 * 11.12, 1.5);
}

TEST_F(Command, raises_footprints_along_one_profile_to_one_file) {
  const auto file = put("two.geojson", two_houses);
  const auto outcome =
      run("extrude -q " + file + " -o " + at("p.obj") + " --profile '0,0 0,6 4,9' --where \"id = 'odd'\"");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_GT(fs::file_size(at("p.obj")), 100U);
  EXPECT_EQ(std::ranges::count(read(at("p.obj")), 'v') > 10, true);
  expect_refusal(run("extrude -q " + file + " -o " + at("out") + " --profile '0,0 0,6 -4,9'"), 4, "roof-profile",
                 "-4,9");
  expect_refusal(run("extrude -q " + file + " -o " + at("out") + " --height-attribute hight"), 4, "roof-attribute",
                 "'height'");
  expect_refusal(run("extrude -q " + file + " -o " + at("out") + " --roof-shape tulip"), 4, "option-value", "mansard");
}

TEST_F(Command, gives_the_same_roofs_with_one_thread_and_two) {
  const auto file = put("two.geojson", two_houses);
  ASSERT_EQ(run("extrude -q -j 1 " + file + " -o " + at("one")).exit, 0);
  ASSERT_EQ(run("extrude -q -j 2 " + file + " -o " + at("out")).exit, 0);
  for (const auto* name : {"model.city.json", "model.obj", "model.glb", "plans.json"})
    EXPECT_EQ(read(at("one") + "/" + name), read(at("out") + "/" + name)) << name;
}

TEST_F(Command, lets_a_bad_footprint_affect_no_other_without_a_mesh_too) {
  const auto bad = put("bad.geojson", beside_a_good_one("[0,0],[12,8],[12,0],[0,8],[0,0]"));
  const auto outcome = run("extrude -q " + bad + " -o " + at("out"));
  EXPECT_EQ(outcome.exit, 1) << outcome.err;
  const auto buildings = nlohmann::json::parse(read(at("out") + "/run.json"))["buildings"];
  EXPECT_EQ(buildings[0]["outcome"], "refused");
  EXPECT_EQ(buildings[1]["outcome"], "full");
  const auto only = put("only.geojson", geojson(polygon("[0,0],[12,8],[12,0],[0,8],[0,0]")));
  EXPECT_EQ(run("extrude -q " + only + " -o " + at("none")).exit, 5);
}

TEST_F(Command, tells_plans_from_footprints_by_their_contents) {
  expect_refusal(run("extrude " + put("a.json", R"({"type":"mansard-plan"})") + " -o " + at("out")), 3,
                 "write-plan-missing");
  expect_refusal(run("extrude " + put("b.json", R"({"type":"recipe"})") + " -o " + at("out")), 3, "write-plan-type");
  expect_refusal(run("extrude -q " + put("c.shp", "no shapes") + " -o " + at("out")), 3, "ingest-footprints-format");
  expect_refusal(run("extrude -q " + at("none.gpkg") + " -o " + at("out")), 3, "file-missing");
  EXPECT_EQ(run("extrude -q " + put("plan-like-name.json", geojson(polygon(square))) + " -o " + at("ok")).exit, 0);
  const auto own = put("own.geojson", two_houses);
  expect_refusal(run("extrude -q " + own + " -o " + own), 2, "output-input");
  expect_refusal(run("extrude -q " + own + " -o " + at("x.obj") + " --report " + own + " --overwrite"), 2,
                 "output-input");
  EXPECT_EQ(read(own), two_houses);
}

TEST_F(Command, says_one_plain_line_per_stage_when_piped) {
  const auto outcome = run("reconstruct " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out"));
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_THAT(outcome.err, HasSubstr("mansard: done block-"));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 1 buildings with a full model"));
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
  EXPECT_EQ(outcome.err.find('\r'), std::string::npos);
}

TEST_F(Command, tells_its_version_and_help) {
  EXPECT_THAT(run("--version").out, testing::StartsWith("mansard "));
  EXPECT_EQ(run("--help").exit, 0);
  EXPECT_THAT(run("reconstruct --help-all").out, HasSubstr("--sweep-gamma"));
}

TEST_F(Command, lists_its_options_as_text_and_json) {
  EXPECT_THAT(run("options").out, HasSubstr("gamma"));
  const auto json = nlohmann::json::parse(run("options --json").out);
  bool found = false;
  for (const auto& option : json["options"])
    if (option["module"] == "segment" && option["name"] == "alpha") {
      found = true;
      EXPECT_EQ(option["default"], "40");
    }
  EXPECT_TRUE(found);
  EXPECT_EQ(json["presets"].size(), 2U);
  EXPECT_TRUE(std::ranges::any_of(json["options"], [](const auto& option) {
    return option["module"] == "simulate" && option["name"] == "melt" && option["default"] == "0.25";
  }));
  EXPECT_EQ(json["simulate_presets"][2]["name"], "oblique-aerial");
  EXPECT_THAT(run("options").out, testing::AllOf(HasSubstr("[simulate]"), HasSubstr("lidar-2.5d")));
}

TEST_F(Command, leaves_no_pictures_of_an_earlier_run) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--picture").exit, 0);
  ASSERT_TRUE(fs::exists(at("out/picture.png")));
  put("out/mine.png", "mine");
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--overwrite").exit, 0);
  for (const auto* name : {"picture.png", "above.png", "error.png"})
    EXPECT_FALSE(fs::exists(at("out/") + name)) << name;
  EXPECT_TRUE(fs::exists(at("out/mine.png")));
  EXPECT_TRUE(fs::exists(at("out/model.glb")));
}

TEST_F(Command, explains_every_code) {
  EXPECT_THAT(run("explain option-value").out, HasSubstr("exit code: 4"));
  const auto all = run("explain").out;
  EXPECT_GT(std::ranges::count(all, '\n'), 20);
  expect_refusal(run("explain option-valu"), 2, "code-unknown", "'option-value'");
}

TEST_F(Command, takes_options_from_a_file_below_the_command_line) {
  const auto config = put("c.toml", "preset = \"paper\"\n[segment]\nalpha = 30\n[sweep]\ngamma = 12\n");
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--config " + config + " --gamma 11").exit, 0);
  const auto options = nlohmann::json::parse(read(at("out") + "/run.json"))["options"];
  EXPECT_EQ(options["segment.alpha"], "30");
  EXPECT_EQ(options["sweep.gamma"], "11");
  EXPECT_EQ(options["segment.gis_edges"], "ignore");
}

TEST_F(Command, refuses_bad_usage) {
  expect_refusal(run("reconstuct a b -o c"), 2, "usage", "did you mean 'reconstruct'");
  expect_refusal(run("reconstruct " + at("house.obj") + " -o " + at("out")), 2, "usage");
  expect_refusal(run("reconstruct " + at("house.obj") + " " + at("house.geojson")), 2, "usage", "--output");
}

TEST_F(Command, refuses_bad_options) {
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--sweep-gama 5"), 4, "option-unknown",
                 "--sweep-gamma");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--refine-pieces-aside 0.1"), 4, "option-unknown",
                 "removed; use 'refine.pieces_slit'");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--slice-interval -1"), 4, "option-value",
                 "--slice-interval");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--slice-interval abc"), 4, "option-value");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--profile-quality best"), 4, "option-value",
                 "moderate");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--preset london"), 4, "option-value", "chordatlas");
}

TEST_F(Command, refuses_bad_config_files) {
  const auto with = [&](const std::string& text) {
    return reconstruct(at("house.obj"), at("house.geojson"), "--config " + put("c.toml", text));
  };
  expect_refusal(with("[sweep\n"), 4, "config", "line 1");
  expect_refusal(with("[sweep]\ngama = 5\n"), 4, "option-unknown", "'sweep.gamma'");
  expect_refusal(with("[profile]\nstep = 1\n"), 4, "option-unknown", "this option was removed");
  expect_refusal(with("[sweep]\ngamma = \"much\"\n"), 4, "option-value");
  expect_refusal(with("gamma = 5\n"), 4, "config");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--config " + at("none.toml")), 3, "file-missing");
}

TEST_F(Command, refuses_missing_empty_truncated_and_foreign_meshes) {
  const auto with = [&](const std::string& name, const std::string& bytes) {
    return reconstruct(put(name, bytes), at("house.geojson"));
  };
  expect_refusal(reconstruct(at("none.obj"), at("house.geojson")), 3, "file-missing", "none.obj");
  for (const auto* ending : {"obj", "ply", "off", "glb"}) {
    const auto outcome = with(std::string("empty.") + ending, "");
    EXPECT_EQ(outcome.exit, 3) << ending << ": " << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
  for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"cut.off", "OFF\n4 2 0\n0 0 0\n1 0"},
           {"cut.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\1\2\3"},
           {"huge.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\nproperty float x\n"
            "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"},
           {"text.glb", "this is no glTF"},
           {"mesh.docx", "PK"}}) {
    const auto outcome = with(name, bytes);
    EXPECT_EQ(outcome.exit, 3) << name << ": " << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(name));
  }
}

TEST_F(Command, refuses_meshes_without_a_usable_triangle) {
  for (const auto& [name, faces] : std::vector<std::pair<std::string, std::string>>{
           {"no_faces.obj", ""}, {"outside.obj", "f 1 2 99\n"}, {"flat.obj", "f 1 1 2\n"}}) {
    const auto outcome = reconstruct(put(name, field + faces), at("house.geojson"));
    EXPECT_EQ(outcome.exit, 3) << name << ": " << outcome.err;
  }
  const auto nan = reconstruct(put("nan.obj", "v nan 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"), at("house.geojson"));
  EXPECT_EQ(nan.exit, 3) << nan.err;
}

TEST_F(Command, goes_on_with_a_mesh_that_is_only_partly_bad) {
  const auto mesh = put("rough.obj", house + "v nan 1 2\nf 5 6 15\nf 5 5 6\nf 5 6 10 9\nf 9 10 6\nf 1 2 999\n");
  const auto outcome = reconstruct(mesh, at("house.geojson"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto counts = nlohmann::json::parse(read(at("out") + "/run.json"))["mesh"];
  EXPECT_GE(counts["dropped_not_finite"], 1);
  EXPECT_GE(counts["dropped_degenerate"], 1);
  EXPECT_GE(counts["dropped_duplicate"], 1);
  EXPECT_GE(counts["dropped_out_of_range"], 1);
}

TEST_F(Command, refuses_footprint_files_that_hold_none) {
  const auto with = [&](const std::string& name, const std::string& bytes) {
    return reconstruct(at("house.obj"), put(name, bytes));
  };
  expect_refusal(reconstruct(at("house.obj"), at("none.geojson")), 3, "file-missing");
  for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
           {"empty.geojson", ""},
           {"foreign.geojson", "hello"},
           {"cut.geojson", geojson(polygon(square)).substr(0, 90)},
           {"none.geojson", R"({"type":"FeatureCollection","features":[]})"},
           {"points.geojson", geojson(R"({"type":"Point","coordinates":[1,2]})")}}) {
    const auto outcome = with(name, bytes);
    EXPECT_TRUE(outcome.exit == 3 || outcome.exit == 5) << name << ": " << outcome.exit << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << name << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error["));
  }
}

TEST_F(Command, lets_a_bad_footprint_affect_no_other) {
  for (const auto* ring :
       {"[0,0],[12,8],[12,0],[0,8],[0,0]", "[20,20],[30,20],[20,20],[20,20]", "[1,1],[1,1],[1,1],[1,1]"}) {
    const auto outcome = reconstruct(at("house.obj"), put("two.geojson", beside_a_good_one(ring)), "--overwrite");
    EXPECT_EQ(outcome.exit, 1) << outcome.err;
    const auto buildings = nlohmann::json::parse(read(at("out") + "/run.json"))["buildings"];
    ASSERT_EQ(buildings.size(), 2U);
    EXPECT_EQ(buildings[0]["outcome"], "refused");
    EXPECT_FALSE(buildings[0]["reasons"].empty());
    EXPECT_EQ(buildings[1]["outcome"], "full");
  }
}

TEST_F(Command, repairs_repeated_points_and_spikes) {
  const auto file = put("rough.geojson", geojson(polygon("[0,0],[0,0],[12,0],[12,0],[12,8],[0,8],[-3,8],[0,8],[0,0]")));
  const auto outcome = reconstruct(at("house.obj"), file);
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
}

TEST_F(Command, refuses_an_unknown_crs) {
  const auto outcome = reconstruct(at("house.obj"), at("house.geojson"), "--crs EPSG:999999");
  EXPECT_TRUE(outcome.exit == 3 || outcome.exit == 4) << outcome.exit;
  EXPECT_THAT(outcome.err, HasSubstr("crs"));
}

TEST_F(Command, says_where_mesh_and_footprints_lie_when_they_do_not_overlap) {
  const auto outcome = reconstruct(
      at("house.obj"), put("far.geojson", geojson(polygon("[5000,5000],[5010,5000],[5010,5010],[5000,5000]"))));
  EXPECT_EQ(outcome.exit, 3) << outcome.err;
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("error["), HasSubstr("5000"), HasSubstr("-20")));
}

TEST_F(Command, overwrites_nothing_silently) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson")).exit, 0);
  const auto before = read(at("out") + "/model.obj");
  const auto outcome = reconstruct(at("house.obj"), at("house.geojson"));
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--overwrite"));
  EXPECT_EQ(read(at("out") + "/model.obj"), before);
  EXPECT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--overwrite").exit, 0);
}

TEST_F(Command, never_writes_over_its_inputs) {
  fs::create_directory(at("tiles"));
  fs::copy_file(at("house.obj"), at("tiles") + "/model.obj");
  const auto over = run("reconstruct -q " + at("tiles") + "/model.obj " + at("house.geojson") + " -o " + at("tiles") +
                        " --overwrite");
  EXPECT_EQ(over.exit, 2) << over.err;
  EXPECT_THAT(over.err, HasSubstr("output-input"));
  EXPECT_EQ(read(at("tiles") + "/model.obj"), house);
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--report " + at("house.obj")), 2, "output-input");
  EXPECT_EQ(read(at("house.obj")), house);
}

TEST_F(Command, leaves_no_file_behind_when_one_of_them_cannot_be_written) {
  const auto outcome =
      reconstruct(at("house.obj"), at("house.geojson"), "--report " + at("no such folder") + "/run.json");
  EXPECT_EQ(outcome.exit, 3) << outcome.err;
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_TRUE(!fs::exists(at("out")) || fs::is_empty(at("out")));
}

TEST_F(Command, leaves_no_folder_behind_when_nothing_was_made) {
  EXPECT_EQ(run("reconstruct " + at("none.obj") + " " + at("house.geojson") + " -o " + at("new/deep/out")).exit, 3);
  EXPECT_FALSE(fs::exists(at("new")));
  fs::create_directories(at("mine"));
  EXPECT_EQ(run("reconstruct " + at("none.obj") + " " + at("house.geojson") + " -o " + at("mine")).exit, 3);
  EXPECT_TRUE(fs::is_directory(at("mine")));
}

TEST_F(Command, refuses_a_footprint_source_whose_crs_is_unknown) {
  const auto outcome = reconstruct(at("house.obj"), put("odd.geojson", geojson(polygon(square), "EPSG::999999")));
  expect_refusal(outcome, 3, "ingest-crs-unknown");
  EXPECT_EQ(reconstruct(at("house.obj"), at("odd.geojson"), "--crs local").exit, 0);
}

TEST_F(Command, refuses_a_footprint_of_impossible_size_alone) {
  for (const auto* ring : {"[-100000,-100000],[100000,-100000],[100000,100000],[-100000,-100000]",
                           "[0,0],[1e300,0],[1e300,1e300],[0,0]"}) {
    const auto outcome = reconstruct(at("house.obj"), put("two.geojson", beside_a_good_one(ring)), "--overwrite");
    EXPECT_EQ(outcome.exit, 1) << outcome.err;
    const auto buildings = nlohmann::json::parse(read(at("out") + "/run.json"))["buildings"];
    EXPECT_EQ(buildings[0]["outcome"], "refused");
    EXPECT_EQ(buildings[1]["outcome"], "full");
  }
}

TEST_F(Command, refuses_a_negative_number_of_jobs) {
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "-j -1"), 4, "option-value");
}

TEST_F(Command, refuses_an_output_folder_that_cannot_be_made) {
  const auto outcome =
      run("reconstruct -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("house.obj") + "/out");
  EXPECT_EQ(outcome.exit, 3) << outcome.err;
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1);
  expect_refusal(run("reconstruct -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("house.obj")), 2,
                 "output-exists");
}

TEST_F(Command, refuses_a_folder_that_is_named_as_a_file) {
  const auto inputs = at("house.obj") + " " + at("house.geojson");
  expect_refusal(run("reconstruct -q " + inputs + " -o " + at("city.gpkg")), 2, "usage",
                 "leave the file extension out");
  expect_refusal(run("extrude -q " + at("house.geojson") + " -o " + at("city.SHP")), 2, "usage",
                 "leave the file extension out");
  EXPECT_FALSE(fs::exists(at("city.gpkg")));
  EXPECT_EQ(run("extrude -q " + at("house.geojson") + " -o " + at("city.v2")).exit, 0)
      << "a file extension of no kind of file";
}

TEST_F(Command, gives_one_line_when_memory_runs_out) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's own memory does not fit under a limit";
#endif
  // A mesh as large as it says (a sparse file) that is read whole, and a process that may not have that much memory.
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 60000000\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto mesh = put("huge.ply", header);
  fs::resize_file(mesh, header.size() + 60000000ULL * 12 + 13);
  const int status = std::system(("bash -c 'ulimit -v 700000; exec " + std::string(MANSARD_BINARY) +
                                  " reconstruct -q -j 1 --ingest-cells-from 1000000 " + mesh + " " +
                                  at("house.geojson") + " -o " + at("out") + "' 2>" + at("stderr"))
                                     .c_str());
  ASSERT_TRUE(WIFEXITED(status));
  expect_refusal({WEXITSTATUS(status), "", read(at("stderr"))}, 3, "ingest-memory", "huge.ply");
}

TEST_F(Command, stops_cleanly_on_interrupt) {
  // Enough houses to be busy for a while.
  std::string mesh;
  std::string features;
  for (int i = 0; i < 400; ++i) {
    const double x = 30.0 * (i % 20), y = 30.0 * (i / 20);
    const std::string shift[2] = {std::to_string(x), std::to_string(y)};
    for (const auto& [dx, dy, z] : std::vector<std::array<double, 3>>{{0, 0, 0},
                                                                      {12, 0, 0},
                                                                      {12, 8, 0},
                                                                      {0, 8, 0},
                                                                      {0, 0, 5},
                                                                      {12, 0, 5},
                                                                      {12, 8, 5},
                                                                      {0, 8, 5},
                                                                      {0, 4, 8},
                                                                      {12, 4, 8}})
      mesh += "v " + std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + std::to_string(z) + "\n";
    mesh += "f -10 -9 -5 -6\nf -9 -8 -4 -1 -5\nf -8 -7 -3 -4\nf -7 -10 -6 -2 -3\nf -6 -5 -1 -2\nf -4 -3 -2 -1\n";
    const auto corner = [&](double dx, double dy) {
      return "[" + std::to_string(x + dx) + "," + std::to_string(y + dy) + "]";
    };
    features +=
        std::string(i > 0 ? "," : "") + R"({"type":"Feature","properties":{},"geometry":)" +
        polygon(corner(0, 0) + "," + corner(12, 0) + "," + corner(12, 8) + "," + corner(0, 8) + "," + corner(0, 0)) +
        "}";
  }
  put("town.obj", mesh);
  put("town.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
          features + "]}");
  const pid_t child = ::fork();
  if (child == 0) {
    std::freopen(at("stderr").c_str(), "w", stderr);
    std::freopen("/dev/null", "w", stdout);
    ::execl(MANSARD_BINARY, "mansard", "reconstruct", "-q", at("town.obj").c_str(), at("town.geojson").c_str(), "-o",
            at("out").c_str(), nullptr);
    ::_exit(127);
  }
  while (!fs::exists(at("out"))) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 6) << read(at("stderr"));
  EXPECT_FALSE(fs::exists(at("out")));
}

}  // namespace
}  // namespace mansard::cli
