// What `mansard info` says of files of every kind.
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

class Info : public Command {
 protected:
  auto info(const std::string& files) const -> Json {
    const auto outcome = run("info --json " + files);
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }
  /// No line of the text is longer than a terminal's; letters are counted, not bytes.
  static void expect_narrow(const std::string& text, std::size_t not_counted) {
    std::istringstream in(text);
    std::size_t number = 0;
    for (std::string line; std::getline(in, line); ++number) {
      const auto letters =
          std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
      if (number >= not_counted) {
        EXPECT_LE(letters, 80) << line;
      }
    }
  }
};

TEST_F(Info, says_of_models_in_every_format_how_many_there_are_and_that_they_are_valid) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--formats all --sweep-gamma 7").exit, 0);
  for (const auto* name : {"model.city.json", "model.city.jsonl", "model.obj", "model.glb", "model.3dtiles",
                           "model.gpkg", "model.geojson", "plans.json"}) {
    const auto told = info(at("out") + "/" + name);
    ASSERT_EQ(told.size(), 1U) << name;
    const auto& it = told[0];
    EXPECT_EQ(it["kind"], "models") << name;
    EXPECT_EQ(it["by"], "mansard") << name;
    EXPECT_EQ(it["crs"], "EPSG:28992") << name;
    EXPECT_EQ(it["counts"], Json::parse(R"({"buildings":1,"parts":1,"faces":7,"triangles":16,"vertices":10})")) << name;
    EXPECT_EQ(it["validity"]["solids"], 1) << name;
    EXPECT_EQ(it["validity"]["valid"], 1) << name;
    EXPECT_EQ(it["footprints"], Json::parse(R"({"surveyed":1,"derived":0})")) << name;
    EXPECT_EQ(it["made_by"]["options_not_default"], Json::parse(R"({"sweep.gamma":"7"})")) << name;
    EXPECT_EQ(it["made_by"]["inputs"].size(), 2U) << name;
    EXPECT_EQ(it["made_by"]["inputs"][0]["sha256"].get<std::string>().size(), 64U) << name;
    EXPECT_NEAR(it["extent"][0].get<double>(), 0, 0.3) << name;
    EXPECT_NEAR(it["extent"][5].get<double>(), 8, 0.3) << name;
    const auto text = run("info " + at("out") + "/" + name).out;
    EXPECT_THAT(text, HasSubstr("1 of 1 solids (planarity tolerance 0.1 mm)")) << name;
    EXPECT_THAT(text, HasSubstr("sweep.gamma = 7")) << name;
    expect_narrow(text, 1);
  }
  const auto all = Json::parse(run("info --json -v " + at("out") + "/plans.json").out);
  EXPECT_GT(all[0]["made_by"]["options"].size(), 50U);
}

TEST_F(Info, knows_a_terrain_and_a_citygml_of_its_own) {
  const auto terrain = [&](const std::string& name) { return " --terrain-out " + at("out") + "/" + name; };
  const auto made = reconstruct(at("house.obj"), at("house.geojson"),
                                "--formats citygml --sweep-gamma 7" + terrain("t.city.json") + terrain("t.city.jsonl"));
  ASSERT_EQ(made.exit, 0) << made.err;
  for (const auto* name : {"t.city.json", "t.city.jsonl"}) {
    const auto it = info(at("out") + "/" + name)[0];
    EXPECT_EQ(it["kind"], "terrain") << name;
    EXPECT_EQ(it["by"], "mansard") << name;
    EXPECT_EQ(it["crs"], "EPSG:28992") << name;
    EXPECT_EQ(it["lods"], Json::parse(R"(["1"])")) << name;
    EXPECT_EQ(it["counts"]["triangles"], 8) << name;  // a plain around a rectangle
    EXPECT_FALSE(it["counts"].contains("buildings")) << name;
    EXPECT_FALSE(it.contains("validity")) << name;
    EXPECT_NEAR(it["extent"][0].get<double>(), -20, 1) << name;  // the house and 20 m around it
    EXPECT_NEAR(it["extent"][5].get<double>(), 0, 0.2) << name;
    EXPECT_EQ(it["made_by"]["inputs"].size(), 2U) << name;
    const auto text = run("info " + at("out") + "/" + name).out;
    EXPECT_THAT(text, HasSubstr("type        terrain, ")) << text;
    EXPECT_THAT(text, testing::Not(HasSubstr("buildings"))) << text;
    expect_narrow(text, 1);
  }
  const auto gml = info(at("out") + "/model.gml")[0];
  EXPECT_EQ(gml["by"], "mansard");
  EXPECT_EQ(gml["made_by"]["options_not_default"], Json::parse(R"({"sweep.gamma":"7"})"));
  EXPECT_EQ(gml["made_by"]["inputs"].size(), 2U);
  // Without the comment it is a file of anybody.
  auto text = read(at("out") + "/model.gml");
  const auto from = text.find("<!-- mansard "), to = text.find("-->", from) + 3;
  ASSERT_NE(from, std::string::npos);
  text.erase(from, to - from);
  EXPECT_EQ(info(put("theirs.gml", text))[0]["by"], "others");
}

TEST_F(Info, says_why_a_solid_is_not_valid) {
  const std::string hall = MANSARD_DATA "/hall/";
  ASSERT_LE(reconstruct(hall + "mesh.off", hall + "footprints.geojson", "--formats cityjson").exit, 1);
  auto model = Json::parse(read(at("out") + "/model.city.json"));
  // One of the two solids loses a face.
  std::size_t torn = 0;
  for (auto& object : model["CityObjects"]) {
    if (!object.contains("geometry")) continue;
    for (auto& geometry : object["geometry"])
      if (geometry["lod"] == "2.2" && torn < 1) {
        auto& shell = geometry["boundaries"][0];
        auto& values = geometry["semantics"]["values"][0];
        shell.erase(shell.size() - 1);
        values.erase(values.size() - 1);
        ++torn;
      }
  }
  const auto told = info(put("torn.city.json", model.dump()));
  EXPECT_EQ(told[0]["validity"]["solids"], 2);
  EXPECT_EQ(told[0]["validity"]["valid"], 1);
  ASSERT_EQ(told[0]["validity"]["invalid"].size(), 1U);
  EXPECT_EQ(told[0]["validity"]["invalid"][0]["reasons"][0]["code"], "solid-open");
  EXPECT_THAT(run("info " + at("torn.city.json")).out, HasSubstr("1 of 2 solids"));
}

TEST_F(Info, compares_the_solids_of_a_building_with_each_other) {
  const auto part = [](const std::string& id, const std::string& ring) {
    return R"({"id":")" + id + R"(","attributes":{},"plan":{"base":0,"cap":5,"outer":{"points":)" + ring +
           R"(,"profile_of_edge":[0,0,0,0]},"holes":[],"profiles":[[[0,0],[0,9]]]}})";
  };
  const auto plans =
      put("plans.json", R"({"type":"mansard-plan","version":1,"frame":{"origin":[0,0,0],"crs":"EPSG:28992"},
"made_by":{"generator":"mansard","version":"0.1.0","options":{},"inputs":[]},"buildings":[{"id":"c","attributes":{},"parts":[)" +
                            part("a", "[[0,0],[10,0],[10,8],[0,8]]") + "," +
                            part("b", "[[10,0],[19,0],[19,8],[10,8]]") + "]}]}");
  const auto made = run("extrude " + plans + " -o " + at("out") + " --formats cityjson --write-solids part");
  ASSERT_EQ(made.exit, 0) << made.err;
  // In the order of the file: others are edited ones, which are made again from their plans.
  auto model = nlohmann::ordered_json::parse(read(at("out") + "/model.city.json"));
  EXPECT_EQ(info(put("sound.city.json", model.dump()))[0]["validity"]["valid"], 2);
  // An upright edge of one moves into the other by a unit of the file, which has 1 mm or less, and both are valid
  // still.
  auto& vertices = model["vertices"];
  for (auto& geometry : model["CityObjects"]["a"]["geometry"]) {
    if (geometry["lod"] != "2.2") continue;
    std::map<std::size_t, std::size_t> copies;
    for (auto& face : geometry["boundaries"][0])
      for (auto& ring : face)
        for (auto& v : ring) {
          const auto was = v.get<std::size_t>();
          const double x = vertices[was][0].get<double>() * model["transform"]["scale"][0].get<double>();
          const double y = vertices[was][1].get<double>() * model["transform"]["scale"][1].get<double>();
          if (std::abs(x - 10) > 1e-6 || std::abs(y) > 1e-6) continue;
          if (!copies.contains(was)) {
            auto moved = vertices[was];
            moved[0] = moved[0].get<int>() + 1;
            copies[was] = vertices.size();
            vertices.push_back(std::move(moved));
          }
          v = copies[was];
        }
    ASSERT_EQ(copies.size(), 2U);
  }
  const auto validity = info(put("leaning.city.json", model.dump()))[0]["validity"];
  EXPECT_EQ(validity["solids"], 2) << validity.dump();
  EXPECT_EQ(validity["valid"], 1);
  ASSERT_EQ(validity["invalid"].size(), 1U);
  EXPECT_EQ(validity["invalid"][0]["reasons"][0]["code"], "solid-overlap");
}

TEST_F(Info, compares_solids_with_each_other_as_a_run_does_in_every_format) {
  const auto two = put("two.geojson", R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"id":"a"},"geometry":)" +
                                          polygon("[0,0],[10,0],[10,8],[0,8],[0,0]") +
                                          R"(},
{"type":"Feature","properties":{"id":"b"},"geometry":)" +
                                          polygon("[9,0],[19,0],[19,8],[9,8],[9,0]") + "}]}");
  const auto made = run("extrude --crs local " + two + " -o " + at("out") + " --formats all");
  ASSERT_LE(made.exit, 1) << made.err;
  EXPECT_THAT(made.err, HasSubstr("1 pair of solids overlap"));
  for (const auto* file : {"model.city.json", "model.city.jsonl", "model.obj", "model.glb", "model.3dtiles",
                           "model.gpkg", "model.geojson", "plans.json"}) {
    const auto name = "out/" + std::string(file);
    const auto validity = info(at(name))[0]["validity"];
    ASSERT_EQ(validity["overlaps"].size(), 3U) << name;
    EXPECT_EQ(validity["overlaps"][0]["code"], "pipeline-overlap") << name;
    EXPECT_EQ(validity["overlaps"][1]["solid"], "a-1") << name;
    EXPECT_THAT(validity["overlaps"][1]["message"].get<std::string>(), HasSubstr("8.000 m² of ground")) << name;
    EXPECT_EQ(validity["valid"], 2) << name;
    EXPECT_THAT(run("info " + at(name)).out, HasSubstr("overlaps    1 pair of solids overlap")) << name;
  }
}

TEST_F(Info, describes_every_file_of_a_run) {
  ASSERT_LE(reconstruct(at("house.obj"), at("house.geojson"),
                        "--formats all --picture --terrain-out " + at("out") + "/t.glb --terrain-out " + at("out") +
                            "/t.3dtiles --terrain-out " + at("out") + "/t.stl")
                .exit,
            1);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(at("out"))) {
    if (entry.path().filename() == ".mansard") continue;
    ++files;
    const auto told = run("info " + entry.path().string());
    EXPECT_EQ(told.exit, 0) << entry.path() << told.err;
    EXPECT_THAT(told.out, HasSubstr("type        ")) << entry.path();
    expect_narrow(told.out, 1);
  }
  EXPECT_GT(files, 18U);
  const auto report = info(at("out") + "/run.json")[0];
  EXPECT_EQ(report["kind"], "report");
  EXPECT_EQ(report["outcomes"]["full"], 1);
  EXPECT_EQ(report["made_by"]["inputs"].size(), 2U);
  EXPECT_EQ(info(at("out") + "/model.mtl")[0]["format"], "obj");
  EXPECT_EQ(info(at("out") + "/picture.png")[0]["kind"], "raster");
}

TEST_F(Info, says_what_a_mesh_and_footprints_hold) {
  const auto told = info(at("house.obj") + " " + at("house.geojson"));
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0]["kind"], "mesh");
  EXPECT_EQ(told[0]["counts"]["triangles"], 2 + 2 + 3 + 2 + 3 + 2 + 2);
  EXPECT_EQ(told[0]["extent"], Json::parse("[-20.0,-20.0,0.0,40.0,40.0,8.0]"));
  EXPECT_EQ(told[1]["kind"], "footprints");
  EXPECT_EQ(told[1]["format"], "GeoJSON");
  EXPECT_EQ(told[1]["layers"][0]["crs"], "EPSG:28992");
  EXPECT_EQ(told[1]["layers"][0]["features"], 1);
  EXPECT_EQ(told[1]["layers"][0]["fields"][0]["name"], "id");
  const auto text = run("info " + at("house.obj") + " " + at("house.geojson"));
  EXPECT_THAT(text.out, testing::AllOf(HasSubstr("x -20.00 to 40.00"), HasSubstr("1 features, Polygon")));
  expect_narrow(text.out, 1);
}

TEST_F(Info, describes_models_tilesets_and_shells_of_other_producers) {
  const auto cube = put("other.city.json", R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],
      "translate":[0,0,0]},"CityObjects":{"h":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",
      "boundaries":[[[0,1,2]],[[0,2,3]]]}]}},"vertices":[[0,0,0],[5,0,0],[5,5,1],[0,5,1]]})");
  const auto model = info(cube);
  EXPECT_EQ(model[0]["by"], "others");
  EXPECT_EQ(model[0]["counts"]["faces"], 2);
  EXPECT_EQ(model[0]["lods"], Json::parse(R"(["2"])"));
  fs::create_directory(at("tiles"));
  put("tiles/tileset.json", R"({"asset":{"version":"1.0"},"geometricError":40,"root":{"geometricError":20,
      "boundingVolume":{"sphere":[0,0,0,9]},"children":[{"geometricError":0,"content":{"uri":"a.b3dm"}},
      {"geometricError":1,"content":{"uri":"b.b3dm"}}]}})");
  for (const auto* path : {"tiles", "tiles/tileset.json"}) {
    const auto tileset = info(at(path));
    EXPECT_EQ(tileset[0]["kind"], "tileset") << path;
    EXPECT_EQ(tileset[0]["tileset"]["levels"][1],
              Json::parse(R"({"tiles":2,"contents":2,"geometric_error_m":[0.0,1.0]})"));
  }
  EXPECT_THAT(run("info " + at("tiles")).out, HasSubstr("2 tiles, 2 with content, geometric error 0.00 to 1.00 m"));
  std::string stl = "shells" + std::string(74, '\0') + std::string("\1\0\0\0", 4) + std::string(50, '\0');
  const auto shells = info(put("a.stl", stl));
  EXPECT_EQ(shells[0]["counts"]["triangles"], 1);
  EXPECT_EQ(shells[0]["header"], "shells");
}

/// Level roofs of class 67 whose points are within 0.02 m of a plane, beside points of class 1 that are within 0.4 m.
auto cloud_of_class_67() -> std::string {
  std::ostringstream out;
  out << "x y z class\n";
  std::uint32_t state = 1;
  const auto within = [&](double reach) {  // Numerical Recipes' generator: the same numbers everywhere
    state = 1664525U * state + 1013904223U;
    return reach * (2.0 * state / 4294967296.0 - 1);
  };
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 120; ++x)
      out << 0.5 * x << " " << 0.5 * y << " " << (x < 60 ? 6 + within(0.02) : within(0.4)) << (x < 60 ? " 67" : " 1")
          << "\n";
  return out.str();
}

TEST_F(Info, measures_the_noise_of_points_on_the_classes_that_are_said_to_be_buildings) {
  put("cloud.xyz", cloud_of_class_67());
  const auto noise = [&](const std::string& options) {
    const auto told = info(at("cloud.xyz") + options);
    EXPECT_EQ(told[0]["classes"], Json::parse(R"({"1":3600,"67":3600})"));
    return told[0]["accuracy"]["noise_m"].get<double>();
  };
  EXPECT_GT(noise(""), 0.1);
  EXPECT_NEAR(noise(" --cloud-building-classes 6,67"), 0.04 / std::sqrt(12.0), 0.005);
  put("classes.toml", "[cloud]\nbuilding_classes = \"67\"\n");
  EXPECT_LT(noise(" --config " + at("classes.toml")), 0.02);
  expect_refusal(run("info " + at("cloud.xyz") + " --cloud-building-classes roofs"), 4, "option-value");
}

TEST_F(Info, follows_tilesets_in_tilesets_once) {
  fs::create_directories(folder_ / "nested/inner");
  put("nested/tileset.json", R"({"asset":{"version":"1.1"},"geometricError":40,"root":{"geometricError":20,
      "children":[{"geometricError":9,"content":{"uri":"inner/tileset.json?v=1"}},{"content":{"uri":"lost.json"}}]}})");
  put("nested/inner/tileset.json", R"({"asset":{"version":"1.1"},"geometricError":9,"root":{"geometricError":9,
      "children":[{"content":{"uri":"a.glb"}},{"content":{"uri":"../tileset.json"}},{"content":{"uri":"tileset.json"}}]}})");
  const auto tileset = info(at("nested"))[0]["tileset"];
  EXPECT_GE(tileset["tilesets_within"].get<int>(), 1);
  std::size_t contents = 0;
  for (const auto& level : tileset["levels"]) contents += level["contents"].get<std::size_t>();
  EXPECT_GE(contents, 1U);
  EXPECT_LE(tileset["levels"].size(), 12U) << "a tileset that names itself comes to an end";
}

TEST_F(Info, looks_into_folders_of_meshes_and_of_sources) {
  fs::create_directories(folder_ / "meshes");
  put("meshes/house.obj", house);
  const auto told = run("info --json " + at("meshes"));
  ASSERT_EQ(told.exit, 0) << told.err;
  EXPECT_EQ(Json::parse(told.out)[0]["kind"], "mesh");
  fs::create_directories(folder_ / "none");
  const auto nothing = run("info " + at("none"));
  EXPECT_EQ(nothing.exit, 3);
  EXPECT_THAT(nothing.err, HasSubstr("error[ingest-mesh-empty] " + at("none")));
}

TEST_F(Info, tells_of_the_others_where_one_file_is_missing_or_broken) {
  const auto outcome = run("info " + at("none.glb") + " " + at("house.obj"));
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error[file-missing]"));
  EXPECT_THAT(outcome.out, HasSubstr("mesh, obj"));
  EXPECT_EQ(run("info " + put("x.ply", "ply\n")).exit, 3);
  EXPECT_EQ(run("info " + put("x.bin", "nothing known")).exit, 3);
  EXPECT_EQ(run("info " + put("x.json", R"({"type":"mansard-plan"})")).exit, 3);
  EXPECT_EQ(run("info " + put("x.stl", "short")).exit, 3);
  EXPECT_EQ(run("info").exit, 2);
}

}  // namespace
}  // namespace mansard::cli
