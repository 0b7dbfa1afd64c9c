// `mansard new`: a project of one's own data, and what is said of data that do not make one.
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class New : public Command {
 protected:
  const std::string delft = MANSARD_DATA "/delft";
  /// The lines that the verb prints to stdout: the commands.
  static auto second_line(const std::string& out) -> std::string {
    const auto first = out.find('\n');
    return out.substr(first + 1, out.find('\n', first + 1) - first - 1);
  }
  auto options() const -> std::string { return read(at("project") + "/options.toml"); }
  auto inputs() const -> Json { return Json::parse(read(at("project") + "/project.json"), nullptr, false)["inputs"]; }
  void expect_nothing() const { EXPECT_FALSE(fs::exists(at("project"))); }
};

TEST_F(New, makes_a_project_and_prints_commands_that_work) {
  const auto outcome = run("new " + at("project") + " " + at("house.geojson") + " " + at("house.obj"));
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("mesh and footprints match"));
  EXPECT_THAT(outcome.out, testing::StartsWith("mansard serve " + at("project") + " --open\n"));
  const auto command = second_line(outcome.out);
  EXPECT_EQ(command, "mansard reconstruct " + at("house.obj") + " " + at("house.geojson") + " --config " +
                         at("project") + "/options.toml -o " + at("project") + "/models --picture");
  const auto made = run(command.substr(std::string("mansard ").size()));
  EXPECT_EQ(made.exit, 0) << made.err;
  EXPECT_TRUE(fs::exists(at("project") + "/models/model.city.json"));
  EXPECT_EQ(inputs()["meshes"], Json::array({at("house.obj")}));
  EXPECT_EQ(inputs()["footprints"], at("house.geojson"));
  EXPECT_EQ(inputs()["reading"], Json::object());
}

TEST_F(New, finds_the_files_in_a_folder_and_the_offset_that_is_missing) {
  const auto outcome = run("new " + at("project") + " " + delft);
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("mesh: " + delft + "/mesh.ply"));
  EXPECT_THAT(outcome.err, HasSubstr("left out: " + delft + "/points.laz, because there is a mesh"));
  EXPECT_THAT(options(), HasSubstr("[ingest]\n"));
  EXPECT_THAT(options(), HasSubstr("\nmesh_offset = [84800, 447400, 0]\n"));
  EXPECT_THAT(options(), HasSubstr("Found by comparing mesh and footprints"));
  EXPECT_THAT(options(), HasSubstr("EPSG:28992"));
  EXPECT_EQ(inputs()["reading"], Json::parse(R"({"ingest.mesh_offset": "84800 447400 0"})"));
  // The file is one that other verbs take.
  EXPECT_EQ(
      run("doctor " + delft + "/mesh.ply " + delft + "/footprints.geojson --config " + at("project") + "/options.toml")
          .exit,
      0);
}

TEST_F(New, every_line_of_the_options_can_be_set) {
  ASSERT_EQ(run("new --no-check " + at("project") + " " + at("house.obj") + " " + at("house.geojson")).exit, 0);
  // Names are set by removing the comment sign before them; those of other words are sentences.
  std::istringstream lines(options());
  std::string all, line;
  std::size_t set = 0;
  while (std::getline(lines, line)) {
    const bool option = line.starts_with("# ") && line.find(" = ") != std::string::npos &&
                        line.substr(2, line.find(" = ") - 2).find(' ') == std::string::npos;
    set += option ? 1 : 0;
    all += (option ? line.substr(2) : line) + "\n";
  }
  EXPECT_GE(set, 8U);
  std::erase(all, '\r');
  put("all.toml", all);
  const auto outcome = run("doctor --json --config " + at("all.toml"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
}

TEST_F(New, takes_options_that_are_given) {
  const auto outcome = run("new " + at("project") + " " + delft + "/mesh.ply " + delft +
                           "/footprints.geojson --mesh-offset 84800 447400 0 --id-attribute bag_id");
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(options(), HasSubstr("\nmesh_offset = [84800, 447400, 0]\n"));
  EXPECT_THAT(options(), HasSubstr("\nid_attribute = \"bag_id\"\n"));
  EXPECT_EQ(inputs()["reading"]["ingest.id_attribute"], "bag_id");
}

TEST_F(New, overwrites_nothing) {
  ASSERT_EQ(run("new -q " + at("project") + " " + at("house.obj") + " " + at("house.geojson")).exit, 0);
  put("project/options.toml", "# mine\n");
  const auto again = run("new " + at("project") + " " + at("house.obj") + " " + at("house.geojson"));
  EXPECT_EQ(again.exit, 2);
  EXPECT_THAT(again.err, HasSubstr("error[output-exists]"));
  EXPECT_THAT(again.err, HasSubstr("mansard serve " + at("project") + " --open"));
  EXPECT_EQ(options(), "# mine\n");
  // A folder with other files, and a file.
  fs::create_directory(at("taken"));
  put("taken/mine.txt", "mine");
  for (const auto* name : {"taken", "house.obj"}) {
    const auto refused = run("new " + at(name) + " " + at("house.geojson"));
    EXPECT_EQ(refused.exit, 2) << name;
    EXPECT_THAT(refused.err, HasSubstr("the name of a new folder")) << name;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(at("taken")), {}), 1);
}

TEST_F(New, says_which_input_is_missing) {
  const auto none = run("new " + at("project"));
  EXPECT_EQ(none.exit, 2);
  EXPECT_THAT(none.err, HasSubstr("mansard new " + at("project") + " MESH... FOOTPRINTS"));
  const auto footprints = run("new " + at("project") + " " + at("house.geojson"));
  EXPECT_EQ(footprints.exit, 2);
  EXPECT_THAT(footprints.err, HasSubstr("mansard extrude " + at("house.geojson") + " -o models"));
  fs::create_directory(at("nothing"));
  const auto nothing = run("new " + at("project") + " " + at("nothing"));
  EXPECT_EQ(nothing.exit, 2);
  EXPECT_THAT(nothing.err, HasSubstr("no mesh, point cloud or footprints found"));
  const auto missing = run("new " + at("project") + " " + at("nowhere.ply"));
  EXPECT_EQ(missing.exit, 3);
  EXPECT_THAT(missing.err, HasSubstr("error[file-missing]"));
  const auto unknown = run("new " + at("project") + " " + put("notes.txt", "notes"));
  EXPECT_EQ(unknown.exit, 2);
  EXPECT_THAT(unknown.err, HasSubstr("neither a mesh nor footprints"));
  expect_nothing();
}

TEST_F(New, a_mesh_alone_has_its_footprints_derived) {
  const auto outcome = run("new " + at("project") + " " + at("house.obj"));
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("footprints: none found"));
  EXPECT_THAT(second_line(outcome.out), HasSubstr("--derive-footprints --config"));
  EXPECT_EQ(inputs()["footprints"], "");
}

TEST_F(New, asks_which_of_several_vector_files_has_the_footprints) {
  fs::create_directory(at("data"));
  put("data/house.obj", house);
  put("data/plots.geojson", geojson(polygon(square)));
  put("data/houses.geojson", geojson(polygon(square)));
  put("data/trees.geojson", geojson(R"({"type":"Point","coordinates":[1,1]})"));
  const auto outcome = run("new " + at("project") + " " + at("data"));
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_THAT(outcome.err, HasSubstr("houses.geojson, "));
  EXPECT_THAT(outcome.err, HasSubstr("plots.geojson: several vector files were found"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("trees")));  // they have no polygons
  expect_nothing();
  // One of the name that footprints usually have, or one that is named, is the one.
  EXPECT_EQ(run("new " + at("named") + " " + at("data") + " " + at("data/plots.geojson")).exit, 0);
  put("data/footprints.geojson", geojson(polygon(square)));
  EXPECT_EQ(run("new " + at("project") + " " + at("data")).exit, 0);
  EXPECT_EQ(inputs()["footprints"], at("data") + "/footprints.geojson");
}

TEST_F(New, a_folder_of_tiles_is_one_mesh) {
  fs::create_directories(at("data/tiles"));
  for (const auto* name : {"a.obj", "b.obj", "c.obj", "d.obj", "e.obj"}) put(std::string("data/tiles/") + name, house);
  put("data/houses.geojson", geojson(polygon(square)));
  ASSERT_EQ(run("new " + at("project") + " " + at("data")).exit, 0);
  EXPECT_EQ(inputs()["meshes"], Json::array({at("data") + "/tiles"}));
  EXPECT_EQ(inputs()["footprints"], at("data") + "/houses.geojson");
}

TEST_F(New, inputs_of_different_places_make_no_project_unless_asked_for) {
  const auto inputs = MANSARD_DATA "/hall/mesh.off " + delft + "/footprints.geojson";
  const auto outcome = run("new " + at("project") + " " + inputs);
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error[new-match]"));
  EXPECT_THAT(outcome.err, HasSubstr("--no-check"));
  expect_nothing();
  EXPECT_EQ(run("new --no-check " + at("project") + " " + inputs).exit, 0);
}

TEST_F(New, names_with_spaces_and_umlauts_are_printed_as_a_shell_takes_them) {
  fs::create_directory(at("Meine Häuser"));
  put("Meine Häuser/Straße 1.obj", house);
  put("Meine Häuser/Grundrisse.geojson", geojson(polygon(square)));
  const auto outcome = run("new '" + at("mein Projekt") + "' '" + at("Meine Häuser") + "'");
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const auto command = second_line(outcome.out);
  EXPECT_THAT(command, HasSubstr("'" + at("Meine Häuser") + "/Straße 1.obj'"));
  EXPECT_EQ(run(command.substr(std::string("mansard ").size())).exit, 0);
}

TEST_F(New, leaves_nothing_behind_where_it_cannot_write) {
  const auto outcome = run("new /proc/project " + at("house.obj") + " " + at("house.geojson"));
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error[file-write]"));
}

// ---- the order of inputs, of other verbs

TEST_F(New, footprints_before_a_mesh_are_answered_with_the_command_to_run) {
  for (const std::string verb : {"reconstruct", "segment"}) {
    const auto out = verb == "segment" ? at("why.gpkg") : at("out");
    const auto outcome = run(verb + " " + at("house.geojson") + " -o " + out + " --gamma 7 " + at("house.obj"));
    expect_refusal(outcome, 2, "usage",
                   "run: mansard " + verb + " " + at("house.obj") + " -o " + out + " --gamma 7 " + at("house.geojson"));
    const auto end = outcome.err.find("run: mansard ") + 13;
    EXPECT_EQ(run(outcome.err.substr(end, outcome.err.size() - end - 1)).exit, 0) << outcome.err;
    fs::remove_all(at("out"));
  }
  expect_refusal(run("explore table " + at("house.geojson") + " " + at("house.obj") + " -o " + at("out")), 2, "usage",
                 "the footprints are given before a mesh");
  expect_refusal(
      run("reconstruct --derive-footprints " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out")), 2,
      "usage", "leave out the file or the option");
}

TEST_F(New, a_mesh_in_place_of_a_model_is_answered_with_the_order) {
  const auto model = put("model.city.json", "{}"), mesh = at("house.off");
  expect_refusal(run("evaluate " + mesh + " " + model), 2, "usage",
                 "call it as: mansard evaluate " + model + " " + mesh);
  expect_refusal(run("label " + model + " " + mesh + " -o " + at("x.ply")), 2, "usage",
                 "call it as: mansard label " + mesh + " " + model + " -o " + at("x.ply"));
}

TEST_F(New, a_folder_in_place_of_footprints_is_called_one) {
  fs::create_directory(at("folder"));
  expect_refusal(reconstruct(at("house.obj"), at("folder")), 3, "ingest-footprints-format", "this is a folder");
}

TEST_F(New, a_call_without_its_output_shows_how_the_verb_is_called) {
  expect_refusal(run("reconstruct " + at("house.obj") + " " + at("house.geojson")), 2, "usage",
                 "mansard reconstruct MESH... FOOTPRINTS -o OUTDIR");
}

TEST_F(New, an_offset_that_is_missing_is_answered_with_the_command_to_run) {
  const auto outcome = run("reconstruct " + delft + "/mesh.ply " + delft + "/footprints.geojson -o " + at("out"));
  EXPECT_THAT(outcome.err, HasSubstr("run: mansard reconstruct " + delft + "/mesh.ply " + delft +
                                     "/footprints.geojson -o " + at("out") + " --mesh-offset 84800 447400 0\n"));
}

TEST_F(New, an_offset_that_is_wrong_is_replaced_in_the_command) {
  const auto files = delft + "/mesh.ply " + delft + "/footprints.geojson";
  const auto outcome = run("reconstruct " + files + " --mesh-offset 1 2 0 -o " + at("out"));
  EXPECT_THAT(outcome.err, testing::ContainsRegex("with --mesh-offset 84[0-9]+ 447[0-9]+ 0 in place of"));
  const auto doctor = run("doctor " + files + " --mesh-offset 1 2 0 --layer bgt_pand");
  EXPECT_THAT(doctor.out, HasSubstr("-> mansard reconstruct " + files + " --layer bgt_pand --mesh-offset 84"));
}

}  // namespace
}  // namespace mansard::cli
