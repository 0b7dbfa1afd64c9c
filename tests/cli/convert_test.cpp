// Every format into every other, and models back in: convert, and the verbs that take what mansard wrote.
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;

struct Kind {
  std::string format, file;
  bool readable = true;
};
const std::vector<Kind> kinds{{"cityjson", "model.city.json"},
                              {"cityjsonseq", "model.city.jsonl"},
                              {"obj", "model.obj"},
                              {"glb", "model.glb"},
                              {"tiles", "model.3dtiles"},
                              {"geopackage", "model.gpkg"},
                              {"stl", "model.stl", false},
                              {"geojson", "model.geojson"},
                              {"plans", "plans.json"},
                              {"citygml", "model.gml", false},
                              {"dxf", "model.dxf", false},
                              {"flatgeobuf", "model.fgb", false}};

/// A file's bytes, or those of all files of a folder, by name.
auto bytes_of(const fs::path& path) -> std::map<std::string, std::string> {
  if (!fs::is_directory(path)) return {{"", read(path)}};
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) all[fs::relative(entry.path(), path).string()] = read(entry.path());
  return all;
}

class Convert : public Command {
 protected:
  /// The house in every format, in the folder "out".
  void make_all(const std::string& more = "") {
    const auto made = reconstruct(at("house.obj"), at("house.geojson"), "--formats all " + more);
    ASSERT_EQ(made.exit, 0) << made.err;
  }
  [[nodiscard]] auto out(const std::string& name) const -> std::string { return at("out") + "/" + name; }
  auto convert(const std::string& from, const std::string& to, const std::string& more = "") const -> Outcome {
    return run("convert -q " + from + " -o " + to + " " + more);
  }
  /// From each that can be read, all of them in one run, each compared to the byte with what was reconstructed.
  void expect_all_pairs(const std::string& folder) {
    for (const auto& from : kinds) {
      if (!from.readable) continue;
      const auto to = at("from-" + from.format);
      fs::create_directory(to);
      std::string outputs;
      for (const auto& kind : kinds) outputs += " -o " + to + "/" + kind.file;
      const auto outcome = run("convert -q " + folder + "/" + from.file + outputs);
      ASSERT_EQ(outcome.exit, 0) << from.format << ": " << outcome.err;
      for (const auto& kind : kinds)
        EXPECT_TRUE(bytes_of(to + "/" + kind.file) == bytes_of(folder + "/" + kind.file))
            << from.format << " to " << kind.format;
      for (const auto* beside : {"/model.mtl", "/model.plans.jsonl"})
        EXPECT_EQ(read(to + beside), read(folder + beside)) << from.format;
      fs::remove_all(to);
    }
  }
};

TEST_F(Convert, the_table_of_this_test_has_every_format) {
  std::vector<std::string> names;
  for (const auto& kind : kinds) names.push_back(kind.format);
  const auto listed = nlohmann::json::parse(run("options --json").out);
  for (const auto& verb : listed["verbs"])
    if (verb["verb"] == "convert")
      for (const auto& option : verb["options"])
        if (option["names"][0] == "--to") {
          EXPECT_EQ(option["words"].get<std::vector<std::string>>(), names);
        }
}

TEST_F(Convert, all_formats_of_a_house_become_all_others_to_the_byte) {
  make_all();
  for (const auto& kind : kinds) ASSERT_TRUE(fs::exists(out(kind.file))) << kind.file;
  expect_all_pairs(at("out"));
}

TEST_F(Convert, all_formats_of_the_hall_become_all_others_to_the_byte) {
  const std::string hall = MANSARD_DATA "/hall/";
  const auto made = reconstruct(hall + "mesh.off", hall + "footprints.geojson", "--formats all");
  ASSERT_LE(made.exit, 1) << made.err;
  expect_all_pairs(at("out"));
}

TEST_F(Convert, a_geopackage_with_layers_of_the_segmentation_keeps_them_to_the_byte) {
  make_all("--layers");
  const auto outcome = run("convert " + out("model.gpkg") + " -o " + at("again.gpkg") + " -o " + at("model.obj"));
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("write-layer-left")));
  EXPECT_TRUE(read(at("again.gpkg")) == read(out("model.gpkg")));
  const auto info = nlohmann::json::parse(run("info --json " + at("again.gpkg")).out)[0];
  std::set<std::string> layers;
  for (const auto& layer : info["layers"]) layers.insert(layer["name"]);
  for (const auto* name : {"sweep_edges", "segment_edges", "diagnostics", "layer_styles"})
    EXPECT_TRUE(layers.contains(name)) << name;
}

TEST_F(Convert, says_once_which_layers_stay_behind_where_none_can_take_them) {
  make_all("--layers");
  const auto outcome = run("convert " + out("model.gpkg") + " -o " + at("model.obj") + " -o " + at("model.glb"));
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("sweep_edges, faces, segment_edges, conflicts, segment_footprints, diagnostics"));
  const auto first = outcome.err.find("write-layer-left");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(outcome.err.find("write-layer-left", first + 1), std::string::npos) << outcome.err;
  EXPECT_EQ(run("convert -q " + out("model.gpkg") + " -o " + at("quiet.obj")).err, "");
  EXPECT_THAT(run("convert " + out("model.city.json") + " -o " + at("other.obj")).err,
              testing::Not(HasSubstr("write-layer-left")));
}

TEST_F(Convert, extrude_keeps_those_layers_too) {
  make_all("--layers");
  const auto outcome = run("extrude " + out("model.gpkg") + " -o " + at("raised.gpkg"));
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("write-layer-left")));
  EXPECT_TRUE(read(at("raised.gpkg")) == read(out("model.gpkg")));
  EXPECT_THAT(run("extrude " + out("model.gpkg") + " -o " + at("raised.obj")).err, HasSubstr("write-layer-left"));
}

TEST_F(Convert, leaves_a_model_that_another_program_changed_as_it_is) {
  make_all();
  auto file = nlohmann::ordered_json::parse(read(out("model.city.json")));
  for (auto& vertex : file["vertices"]) vertex[2] = vertex[2].get<std::int64_t>() + 10000;  // 1 m up, the plans stay
  put("moved.city.json", file.dump());
  ASSERT_EQ(convert(at("moved.city.json"), at("moved.obj") + " -o " + at("moved.glb")).exit, 0);
  const auto extent = [&](const std::string& name) {
    return nlohmann::json::parse(run("info --json " + name).out)[0]["extent"];
  };
  const double top = extent(out("model.city.json"))[5];
  EXPECT_NEAR(extent(at("moved.city.json"))[5].get<double>() - top, 1, 1e-9);
  const auto before = read(out("model.glb")), after = read(at("moved.glb"));
  EXPECT_NE(before, after);
  const auto greatest_y = [](const std::string& glb) {
    const auto end = glb.find("BIN", 20) - 4;
    const auto json = nlohmann::json::parse(glb.substr(20, end - 20));
    double most = -1e9;
    for (const auto& accessor : json["accessors"])
      if (accessor.contains("max") && accessor["max"].size() == 3)
        most = std::max(most, accessor["max"][1].get<double>());
    return most;
  };
  EXPECT_NEAR(greatest_y(after) - greatest_y(before), 1, 1e-3);
}

TEST_F(Convert, keeps_the_solids_of_parts_and_unites_them_as_their_plans) {
  const std::string delft = MANSARD_DATA "/delft/";
  const auto made = reconstruct(delft + "mesh.ply", delft + "footprints.geojson",
                                "--mesh-offset 84800 447400 0 --write-solids part --lod cityjson=1.2,1.3,2.0,2.2 "
                                "--formats cityjson,cityjsonseq,glb,obj,dxf,stl,plans --write-stl-shell part");
  ASSERT_LE(made.exit, 1) << made.err;
  fs::create_directory(at("to"));
  const std::vector<std::string> files{"model.city.json", "model.city.jsonl", "model.glb",
                                       "model.obj",       "model.dxf",        "model.stl"};
  const std::string as_parts = "--write-solids part --lod cityjson=1.2,1.3,2.0,2.2 --write-stl-shell part --overwrite";
  for (const std::string from : {"model.city.json", "model.city.jsonl"}) {
    std::string outputs;
    for (const auto& file : files) outputs += " -o " + at("to/" + file);
    ASSERT_EQ(run("convert -q " + out(from) + outputs + " " + as_parts).exit, 0);
    for (const auto& file : files) EXPECT_TRUE(read(at("to/" + file)) == read(out(file))) << from << " to " << file;
    // One at a time: buildings are passed on as they are read.
    ASSERT_EQ(convert(out(from), at("to/model.city.json"), as_parts).exit, 0);
    EXPECT_TRUE(read(at("to/model.city.json")) == read(out("model.city.json"))) << from;
  }
  const auto city = [&](const std::string& name) {
    auto file = nlohmann::json::parse(read(at(name)));
    return std::pair(std::move(file["CityObjects"]), std::move(file["vertices"]));
  };
  ASSERT_LE(convert(out("plans.json"), at("plans.city.json")).exit, 1);
  ASSERT_LE(convert(out("model.city.json"), at("parts.city.json")).exit, 1);
  EXPECT_TRUE(city("parts.city.json") == city("plans.city.json"));
}

TEST_F(Convert, keeps_parts_that_another_program_changed) {
  const std::string hall = MANSARD_DATA "/hall/";
  ASSERT_LE(reconstruct(hall + "mesh.off", hall + "footprints.geojson", "--write-solids part").exit, 1);
  auto file = nlohmann::ordered_json::parse(read(out("model.city.json")));
  for (auto& vertex : file["vertices"]) vertex[2] = vertex[2].get<std::int64_t>() + 10000;  // 1 m up, the plans stay
  put("moved.city.json", file.dump());
  const auto extent = [&](const std::string& name) {
    return nlohmann::json::parse(run("info --json " + name).out)[0]["extent"];
  };
  const double top = extent(out("model.city.json"))[5];
  for (const std::string solids : {"part", "building"}) {
    ASSERT_LE(convert(at("moved.city.json"), at("to.city.json"), "--overwrite --write-solids " + solids).exit, 1);
    EXPECT_NEAR(extent(at("to.city.json"))[5].get<double>() - top, 1, 1e-9) << solids;
  }
}

TEST_F(Convert, takes_no_file_for_the_value_of_a_flag) {
  make_all();
  const auto first = run("convert -q --write-compress " + out("plans.json") + " -o " + at("a.glb"));
  ASSERT_EQ(first.exit, 0) << first.err;
  ASSERT_EQ(convert(out("plans.json"), at("b.glb"), "--write-compress true").exit, 0);
  ASSERT_EQ(convert(out("plans.json"), at("c.glb"), "--write-compress=false").exit, 0);
  EXPECT_TRUE(read(at("a.glb")) == read(at("b.glb")));
  EXPECT_FALSE(read(at("a.glb")) == read(at("c.glb")));
  EXPECT_EQ(run("convert -q --write-compress=1 " + out("plans.json") + " -o " + at("d.glb")).exit, 4);
}

TEST_F(Convert, raises_the_good_parts_of_a_file_of_plans_and_lists_the_bad_ones) {
  make_all();
  auto plans = nlohmann::ordered_json::parse(read(out("plans.json")));
  auto& parts = plans["buildings"][0]["parts"];
  ASSERT_EQ(parts.size(), 1U);
  for (const auto* id : {"crossed", "low"}) {
    auto other = parts[0];
    other["id"] = id;
    parts.push_back(other);
  }
  parts[1]["plan"]["outer"] = {{"points", {{0, 0}, {9, 4}, {9, 0}, {0, 5}}}, {"profile_of_edge", {0, 0, 0, 0}}};
  parts[2]["plan"]["cap"] = -1;
  const auto bad = put("bad.json", plans.dump());
  for (const std::string verb : {"extrude -q ", "convert -q "}) {
    const auto to = at(verb.substr(0, 4) + ".city.json");
    const auto outcome = run(verb + bad + " -o " + to);
    EXPECT_EQ(outcome.exit, 1) << outcome.err;
    EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("parts[2].plan.cap"), HasSubstr("crossed: edge")));
    const auto city = nlohmann::json::parse(read(to));
    EXPECT_EQ(city["CityObjects"][plans["buildings"][0]["id"].get<std::string>()]["children"].size(), 1U);
  }
  const auto info = nlohmann::json::parse(run("info --json " + bad).out);
  EXPECT_EQ(info[0]["counts"]["parts"], 1);
  EXPECT_EQ(info[0]["warnings"].size(), 2U);
}

TEST_F(Convert, raises_plans_whose_coordinates_are_far_from_their_origin) {
  make_all();
  auto plans = nlohmann::ordered_json::parse(read(out("plans.json")));
  for (auto& building : plans["buildings"]) {
    building.erase("footprint");
    for (auto& part : building["parts"])
      for (auto& point : part["plan"]["outer"]["points"]) point[0] = point[0].get<double>() + 1.5e7;
  }
  const auto far = put("far.json", plans.dump());
  for (const auto* to : {"far.city.json", "far.glb", "far.gpkg", "far.obj"}) {
    const auto outcome = run("extrude -q " + far + " -o " + at(to));
    EXPECT_EQ(outcome.exit, 0) << to << ": " << outcome.err;
  }
}

TEST_F(Convert, names_each_result_on_stdout) {
  make_all();
  const auto outcome = convert(out("plans.json"), at("a.glb") + " -o " + at("b.gpkg"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("a.glb") + "\n" + at("b.gpkg") + "\n");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Convert, takes_the_format_from_to_where_the_name_does_not_say_it) {
  make_all();
  ASSERT_EQ(convert(out("model.glb"), at("model.data"), "--to obj").exit, 0);
  EXPECT_THAT(read(at("model.data")), HasSubstr("\nv "));
  fs::rename(out("model.glb"), at("own.glb"));
  fs::remove_all(at("out"));
  expect_refusal(convert(at("own.glb"), at("model.fbx")), 2, "usage", ".gpkg");
  expect_refusal(convert(at("own.glb"), at("model.data"), "--to geopakage"), 4, "option-value", "'geopackage'");
  expect_refusal(convert(at("own.glb"), at("a.obj") + " -o " + at("b.obj"), "--to obj"), 2, "usage");
}

TEST_F(Convert, raises_models_by_the_options_that_the_file_was_made_with) {
  make_all("--extrude-overhang 0.4");
  for (const auto* name : {"same", "bare", "raised"}) fs::create_directory(at(name));
  for (const auto* from : {"plans.json", "model.glb", "model.city.json"}) {
    ASSERT_EQ(convert(out(from), at("same/model.obj"), "--overwrite").exit, 0) << from;
    EXPECT_EQ(read(at("same/model.obj")), read(out("model.obj"))) << from;
    // The command line goes before the file, and is in what comes out.
    ASSERT_EQ(
        convert(out(from), at("bare/model.obj") + " -o " + at("bare.json"), "--extrude-overhang 0 --overwrite").exit,
        0);
    EXPECT_NE(read(at("bare/model.obj")), read(out("model.obj"))) << from;
    const auto plans = nlohmann::json::parse(read(at("bare.json")));
    EXPECT_EQ(plans["made_by"]["options"]["extrude.overhang"], "0") << from;
  }
  ASSERT_EQ(run("extrude -q " + out("plans.json") + " -o " + at("raised/model.obj")).exit, 0);
  EXPECT_EQ(read(at("raised/model.obj")), read(out("model.obj")));
}

TEST_F(Convert, overwrites_nothing_silently_and_no_input_at_all) {
  make_all();
  const auto before = read(out("model.glb"));
  fs::copy_file(out("model.glb"), at("own.glb"));
  const auto there = convert(out("plans.json"), at("own.glb"));
  EXPECT_EQ(there.exit, 2);
  EXPECT_THAT(there.err, HasSubstr("output-exists"));
  EXPECT_EQ(convert(out("plans.json"), at("own.glb"), "--overwrite").exit, 0);
  const auto over = convert(out("model.glb"), out("model.glb"), "--overwrite");
  EXPECT_EQ(over.exit, 2);
  EXPECT_THAT(over.err, HasSubstr("output-input"));
  EXPECT_EQ(read(out("model.glb")), before);
  const auto twice = convert(out("plans.json"), at("x.obj") + " -o " + at("x.obj"));
  EXPECT_EQ(twice.exit, 2);
  EXPECT_THAT(twice.err, HasSubstr("two outputs"));
  const auto long_name = [this](char c) { return at(std::string(300, c) + ".obj"); };  // longer than any file's
  const auto apart = convert(out("plans.json"), long_name('x') + " -o " + long_name('y'));
  EXPECT_EQ(apart.exit, 3) << apart.err;
  EXPECT_THAT(apart.err, testing::Not(HasSubstr("two outputs")));
}

TEST_F(Convert, replaces_a_folder_of_tiles_alone) {
  make_all();
  ASSERT_EQ(convert(out("plans.json"), at("t.3dtiles")).exit, 0);
  EXPECT_THAT(convert(out("plans.json"), at("t.3dtiles")).err, HasSubstr("output-exists"));
  EXPECT_EQ(convert(out("plans.json"), at("t.3dtiles"), "--overwrite").exit, 0);
  fs::create_directory(at("mine"));
  put("mine/thesis.txt", "years of work");
  const auto outcome = convert(out("plans.json"), at("mine"), "--overwrite");
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_THAT(outcome.err, HasSubstr("would be lost"));
  EXPECT_EQ(read(at("mine/thesis.txt")), "years of work");
}

TEST_F(Convert, writes_nothing_where_one_result_cannot_be) {
  make_all();
  const auto outcome = convert(out("plans.json"), at("good.obj") + " -o " + at("nowhere/x.glb"));
  EXPECT_EQ(outcome.exit, 3) << outcome.err;
  EXPECT_FALSE(fs::exists(at("good.obj")));
  EXPECT_FALSE(fs::exists(at("good.mtl")));
}

TEST_F(Convert, says_what_can_be_done_with_files_without_plans) {
  const auto foreign = put("foreign.city.json", R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],
      "translate":[0,0,0]},"CityObjects":{},"vertices":[]})");
  expect_refusal(convert(foreign, at("x.glb")), 3, "ingest-model-format", "it has no buildings");
  expect_refusal(convert(at("house.obj"), at("x.glb")), 3, "write-read-plans", "mansard extrude");
  expect_refusal(convert(at("house.geojson"), at("x.glb")), 3, "write-read-plans", "mansard extrude");
  expect_refusal(convert(at("none.glb"), at("x.obj")), 3, "file-missing");
  expect_refusal(convert(put("x.fbx", "?"), at("x.obj")), 3, "write-read-format");
  make_all();
  const auto stl = convert(out("model.stl"), at("x.glb"));
  EXPECT_EQ(stl.exit, 3);
  EXPECT_THAT(stl.err, HasSubstr("error[write-read-format]"));
}

TEST_F(Convert, tells_where_a_plan_is_broken) {
  make_all();
  auto plans = nlohmann::json::parse(read(out("plans.json")));
  plans["buildings"][0]["parts"][0]["plan"]["profiles"][0][0] = {0.5, 0.5};
  const auto outcome = convert(put("broken.json", plans.dump()), at("x.glb"));
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error[write-plan-profile]"));
  EXPECT_FALSE(fs::exists(at("x.glb")));
}

// ---- the other verbs

TEST_F(Convert, solids_of_one_building_have_the_same_ground_at_all_levels) {
  // Two parts that are two solids: a corner of one is on a wall of the other, 0.03 mm beside its line.
  const auto plans = put("pair.json", R"({"type":"mansard-plan","version":1,
    "made_by":{"generator":"mansard","version":"0.1.0","options":{},"inputs":[]},
    "frame":{"origin":[84000,447000,0],"crs":"EPSG:28992"},"buildings":[{"id":"b","attributes":{},"parts":[
    {"id":"b-0","attributes":{},"plan":{"base":4.1963,"cap":17.4754,"holes":[],"outer":{
      "points":[[1.2429,3.0507],[-0.0001,0],[1.8123,0.1149],[8.3907,3.0507]],"profile_of_edge":[0,0,0,0]},
      "profiles":[[[0,0],[0,5.1094],[3.5485,5.4512],[3.5671,7.1882],[3.5885,8.8527]]]}},
    {"id":"b-1","attributes":{},"plan":{"base":4.1914,"cap":11.3919,"holes":[],"outer":{
      "points":[[6.9557,2.4103],[1.8124,0.1149],[11.2457,0.713],[8.5011,3.0508],[7.066,2.4103]],
      "profile_of_edge":[1,2,1,2,3]},"profiles":[[[0,0],[0,1.1242],[0.731,1.8979],[0.7562,1.8988]],
      [[0,0],[2.2543,3.6]],[[0,0],[0,2.517],[3.1473,2.517],[5.3344,2.5251]],
      [[0,0],[0,1.2585],[2.509,1.9495],[4.7972,1.9651],[8.6768,1.9651],[9.3768,2.4651]]]}}]}]})");
  ASSERT_LE(convert(plans, at("pair.city.json"), "--lod cityjson=1.2,1.3,2.0,2.2").exit, 1);
  const auto file = nlohmann::json::parse(read(at("pair.city.json")));
  for (const auto* part : {"b-0", "b-1"}) {
    std::map<std::string, std::set<std::pair<int, int>>> corners;  // of the ground, by level
    ASSERT_TRUE(file["CityObjects"][part].contains("geometry")) << "it is one solid with the other";
    for (const auto& solid : file["CityObjects"][part]["geometry"])
      for (std::size_t f = 0; f < solid["boundaries"][0].size(); ++f) {
        const auto& semantics = solid["semantics"];
        if (semantics["surfaces"][semantics["values"][0][f].get<std::size_t>()]["type"] != "GroundSurface") continue;
        for (const auto& ring : solid["boundaries"][0][f])
          for (const auto& corner : ring) {
            const auto& v = file["vertices"][corner.get<std::size_t>()];
            corners[solid["lod"]].emplace(v[0].get<int>(), v[1].get<int>());
          }
      }
    ASSERT_EQ(corners.size(), 4U) << part;
    for (const auto& [lod, ground] : corners) EXPECT_EQ(ground, corners["2.2"]) << part << " at LoD " << lod;
  }
}

TEST_F(Convert, extrude_raises_whatever_has_plans) {
  make_all();
  for (const auto& from : kinds) {
    if (!from.readable) continue;
    const auto outcome = run("extrude -q " + out(from.file) + " -o " + at(from.format + ".city.json"));
    EXPECT_EQ(outcome.exit, 0) << from.format << ": " << outcome.err;
    EXPECT_EQ(read(at(from.format + ".city.json")), read(out("model.city.json"))) << from.format;
  }
}

TEST_F(Convert, extrude_writes_any_format_by_its_extension) {
  make_all();
  for (const auto& kind : kinds) {
    const auto place = at("again-" + kind.file);
    const auto outcome = run("extrude -q " + out("plans.json") + " -o " + place);
    ASSERT_EQ(outcome.exit, 0) << kind.format << ": " << outcome.err;
    EXPECT_EQ(outcome.out, place + "\n");
    if (kind.format != "obj") {
      EXPECT_TRUE(bytes_of(place) == bytes_of(out(kind.file))) << kind.format;
    }
  }
}

TEST_F(Convert, formats_say_what_a_folder_of_results_has) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--formats plans,stl").exit, 0);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(at("out"))) names.insert(entry.path().filename());
  EXPECT_THAT(names, testing::ElementsAre(".mansard", "model.stl", "plans.json", "run.json"));
  // Another run with other formats leaves nothing of this one, but what is not its own.
  put("out/notes.txt", "mine");
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--formats obj --overwrite").exit, 0);
  names.clear();
  for (const auto& entry : fs::directory_iterator(at("out"))) names.insert(entry.path().filename());
  EXPECT_THAT(names,
              testing::ElementsAre(".mansard", "model.mtl", "model.obj", "model.plans.jsonl", "notes.txt", "run.json"));
  fs::remove_all(at("out"));
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--formats obj,geopakage"), 4, "option-value",
                 "'geopackage'");
  ASSERT_EQ(run("extrude -q --profile '0,0 0,6' " + at("house.geojson") + " -o " + at("e") + " --formats geojson").exit,
            0);
  EXPECT_TRUE(fs::exists(at("e/model.geojson")));
  EXPECT_FALSE(fs::exists(at("e/model.glb")));
}

TEST_F(Convert, evaluate_gives_the_same_numbers_for_every_format) {
  make_all();
  std::string first;
  for (const auto& kind : kinds) {
    if (!kind.readable || kind.format == "obj") continue;
    const auto report = at(kind.format + ".report.json");
    const auto outcome = run("evaluate -q " + out(kind.file) + " " + at("house.obj") + " --footprints " +
                             at("house.geojson") + " -o " + report);
    ASSERT_EQ(outcome.exit, 0) << kind.format << ": " << outcome.err;
    auto scores = nlohmann::json::parse(read(report))["scores"].dump();
    if (first.empty()) first = scores;
    EXPECT_EQ(scores, first) << kind.format;
  }
}

}  // namespace
}  // namespace mansard::cli
