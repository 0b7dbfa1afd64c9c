// From inputs to results and exported files, as the page calls the server.
#include <gmock/gmock.h>

#include <set>

#include "apps/server/exports.hpp"
#include "apps/server/zip.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

TEST(Inputs, are_read_in_the_background_and_again_when_the_project_is_reopened) {
  const Folder folder;
  const auto hall = std::string(MANSARD_DATA) + "/hall/";
  fs::copy_file(hall + "mesh.off", folder / "mesh.off");
  {
    const Running server(folder / "project");
    EXPECT_TRUE(server.get("/api/project").json()["inputs"].is_null());
    const auto job = server.post("/api/project/inputs", {{"meshes", {(folder / "mesh.off").string()}},
                                                         {"footprints", hall + "footprints.geojson"}});
    EXPECT_EQ(job.json()["kind"], "read");
    server.settle();
    const auto scene = server.get("/api/scene").json();
    EXPECT_GT(scene["triangles"], 1000);
    EXPECT_FALSE(scene["blocks"].empty());
    const auto index = server.get("/api/scene/tiles").json();
    std::size_t triangles = 0;
    for (const auto& tile : index["tiles"]) {
      const auto bytes = server.get("/api/scene/tiles/" + tile["id"].get<std::string>()).text;
      const auto vertices = tile["vertices"].get<std::size_t>(), count = tile["triangles"].get<std::size_t>();
      EXPECT_EQ(bytes.size(), 8 + vertices * 12 + count * 12);
      if (tile["level"] == 0) triangles += count;
    }
    EXPECT_EQ(triangles, scene["triangles"]);
    const auto inputs = server.get("/api/project").json()["inputs"];
    EXPECT_EQ(inputs["meshes"][0]["path"], (folder / "mesh.off").string());
    EXPECT_EQ(inputs["meshes"][0]["changed"], false);
    EXPECT_EQ(inputs["footprints"][0]["bytes"], fs::file_size(hall + "footprints.geojson"));
  }
  const Running again(folder / "project");
  again.settle();
  EXPECT_EQ(again.get("/api/scene").status, 200);
  // A new modification time alone is no change; other contents of the same size are.
  fs::last_write_time(folder / "mesh.off", fs::last_write_time(folder / "mesh.off") + std::chrono::hours(1));
  const auto changed = [&] { return again.get("/api/project").json()["inputs"]["meshes"][0]["changed"].get<bool>(); };
  EXPECT_FALSE(changed());
  auto bytes = read(folder / "mesh.off");
  bytes[bytes.size() / 2] = bytes[bytes.size() / 2] == '1' ? '2' : '1';
  write(folder / "mesh.off", bytes);
  fs::last_write_time(folder / "mesh.off", fs::last_write_time(folder / "mesh.off") + std::chrono::hours(2));
  EXPECT_TRUE(changed());
  fs::remove(folder / "mesh.off");
  EXPECT_TRUE(changed());
}

TEST(Inputs, of_a_project_that_was_made_on_the_command_line_are_read_when_it_is_opened) {
  const Folder folder;
  const auto project = folder / "project";
  const auto command = std::string(MANSARD_BINARY) + " new -q " + project.string() + " " MANSARD_DATA "/hall >" +
                       (folder / "said").string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (int opened = 0; opened < 2; ++opened) {
    const Running server(project);
    server.settle();
    EXPECT_EQ(server.get("/api/scene").status, 200);
    const auto inputs = server.get("/api/project").json()["inputs"];
    EXPECT_EQ(inputs["meshes"][0]["path"], MANSARD_DATA "/hall/mesh.off");
    EXPECT_EQ(inputs["meshes"][0]["changed"], false);
    EXPECT_EQ(inputs["footprints"][0]["path"], MANSARD_DATA "/hall/footprints.geojson");
  }
  // Its files are known by their hashes before the first run.
  const auto record = Json::parse(read(project / "project.json"));
  EXPECT_EQ(record["inputs"]["mesh_files"][0]["sha256"].get<std::string>().size(), 64U);
}

TEST(Inputs, without_footprints_derive_them_from_the_mesh) {
  const Folder folder;
  const auto hall = std::string(MANSARD_DATA) + "/hall/";
  {
    const Running server(folder / "project");
    const auto job =
        server.post("/api/project/inputs",
                    {{"meshes", {hall + "mesh.off"}}, {"footprints", ""}, {"reading", {{"derive.cell", "1"}}}});
    EXPECT_EQ(job.json()["kind"], "read") << job.text;
    server.settle();
    const auto scene = server.get("/api/scene").json();
    ASSERT_EQ(scene["footprints"].size(), 1U);
    EXPECT_EQ(scene["footprints"][0]["id"], "derived-1");
    EXPECT_TRUE(server.get("/api/project").json()["inputs"]["footprints"].empty());
  }
  const Running again(folder / "project");
  again.settle();
  EXPECT_EQ(again.get("/api/scene").json()["footprints"].size(), 1U);
}

TEST(Inputs, that_cannot_be_read_are_reported_and_leave_the_project_unchanged) {
  const Folder folder;
  write(folder / "mesh.ply", "no mesh");
  write(folder / "f.geojson", "no footprints");
  const Running server(folder / "project");
  const auto begun = server.post("/api/project/inputs", {{"meshes", {(folder / "mesh.ply").string()}},
                                                         {"footprints", (folder / "f.geojson").string()}});
  ASSERT_EQ(begun.status, 200) << begun.text;
  server.settle();
  const auto job = server.get("/api/jobs").json()["jobs"][0];
  EXPECT_EQ(job["state"], "failed");
  EXPECT_THAT(job["failure"]["code"].get<std::string>(), HasSubstr("ingest-"));
  EXPECT_TRUE(server.get("/api/project").json()["inputs"].is_null());
  EXPECT_THAT(server.get("/api/scene").text, HasSubstr("could not be read"));
}

TEST(Inputs, can_be_uploaded) {
  const Folder folder;
  const auto hall = fs::path(MANSARD_DATA) / "hall";
  const Running server(folder / "project");
  std::vector<std::string> paths;
  for (const auto* name : {"mesh.off", "footprints.geojson"}) {
    const auto reply = server.call("PUT", std::string("/api/uploads/") + name, read(hall / name));
    ASSERT_EQ(reply.status, 200) << reply.text;
    paths.push_back(reply.json()["path"]);
    EXPECT_EQ(read(paths.back()), read(hall / name));
  }
  EXPECT_EQ(server.post("/api/project/inputs", {{"meshes", {paths[0]}}, {"footprints", paths[1]}}).status, 200);
  server.settle();
  EXPECT_EQ(server.get("/api/scene").status, 200);
}

TEST(Inputs, can_have_names_with_spaces_and_umlauts) {
  const Folder folder;
  const auto hall = fs::path(MANSARD_DATA) / "hall";
  const Running server(folder / "project");
  const auto mesh = server.call("PUT", "/api/uploads/Halle%20Nord%20(1).off", read(hall / "mesh.off"));
  const auto plans =
      server.call("PUT", "/api/uploads/Grundst%C3%BCcke%20Stra%C3%9Fe.geojson", read(hall / "footprints.geojson"));
  ASSERT_EQ(mesh.status, 200) << mesh.text;
  ASSERT_EQ(plans.status, 200) << plans.text;
  EXPECT_TRUE(fs::exists(folder / "project/inputs/Grundstücke Straße.geojson"));
  const Json asked{{"meshes", {mesh.json()["path"]}}, {"footprints", plans.json()["path"]}};
  ASSERT_EQ(server.post("/api/project/inputs", asked).status, 200);
  server.settle();
  EXPECT_EQ(server.get("/api/scene").status, 200) << server.get("/api/jobs").text;
}

TEST(Inputs, that_were_uploaded_are_never_replaced) {
  const Folder folder;
  const Running server(folder / "project");
  ASSERT_EQ(server.call("PUT", "/api/uploads/mesh.ply", "first").status, 200);
  for (const std::string other : {"other", "a longer file"}) {  // of the same size, of another size
    const auto again = server.call("PUT", "/api/uploads/mesh.ply", other);
    EXPECT_EQ(again.status, 409) << again.text;
    EXPECT_EQ(again.code(), "server-exists");
  }
  EXPECT_EQ(read(folder / "project/inputs/mesh.ply"), "first");
  EXPECT_EQ(server.call("PUT", "/api/uploads/mesh.ply", "first").status, 200) << "the same file again";
  const auto beside = server.call("PUT", "/api/uploads/mesh.ply?folder=2", "other");
  ASSERT_EQ(beside.status, 200) << beside.text;
  EXPECT_EQ(beside.json()["path"], (folder / "project/inputs/2/mesh.ply").string());
  EXPECT_EQ(read(folder / "project/inputs/2/mesh.ply"), "other");
  for (const std::string wrong : {"1", "-2", "x", "..", "2%2f..", "1001"})
    EXPECT_EQ(server.call("PUT", "/api/uploads/a.ply?folder=" + wrong, "x").code(), "server-upload") << wrong;
  std::size_t files = 0;
  for (const auto& file : fs::recursive_directory_iterator(folder / "project/inputs")) files += file.is_regular_file();
  EXPECT_EQ(files, 2U) << "nothing is left of what was refused";
}

TEST(Inputs, are_not_written_through_symbolic_links) {
  const Folder folder;
  fs::create_directories(folder / "elsewhere");
  const Running server(folder / "project");
  fs::remove(folder / "project/inputs");
  fs::create_directory_symlink(folder / "elsewhere", folder / "project/inputs");
  EXPECT_EQ(server.call("PUT", "/api/uploads/a.ply", "x").code(), "file-write");
  fs::remove(folder / "project/inputs");
  fs::create_directories(folder / "project/inputs");
  write(folder / "elsewhere/a.ply", "kept");
  fs::create_symlink(folder / "elsewhere/a.ply", folder / "project/inputs/a.ply");
  EXPECT_EQ(server.call("PUT", "/api/uploads/a.ply", "x").code(), "server-exists");
  fs::create_directory_symlink(folder / "elsewhere", folder / "project/inputs/2");
  EXPECT_EQ(server.call("PUT", "/api/uploads/b.ply?folder=2", "x").code(), "file-write");
  EXPECT_EQ(read(folder / "elsewhere/a.ply"), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "elsewhere"), {}), 1);
}

TEST(Inputs, of_runs_cannot_change) {
  const Folder folder;
  const auto hall = fs::path(MANSARD_DATA) / "hall";
  for (const auto* name : {"mesh.off", "footprints.geojson"}) fs::copy_file(hall / name, folder / name);
  const Json asked{{"meshes", {(folder / "mesh.off").string()}},
                   {"footprints", (folder / "footprints.geojson").string()}};
  const auto failure = [&](const Running& server) {
    const auto jobs = server.get("/api/jobs").json()["jobs"];
    const auto& last = jobs[jobs.size() - 1]["failure"];
    return last.is_null() ? std::string() : last["code"].get<std::string>();
  };
  {
    const Running server(folder / "project");
    ASSERT_EQ(server.post("/api/project/inputs", asked).status, 200);
    server.settle();
    ASSERT_EQ(server.reconstruct(), "run-1");
    const auto scene = server.get("/api/scene").text;
    auto text = read(folder / "footprints.geojson");
    write(folder / "footprints.geojson", text + "\n");  // the same footprints, and still another file
    ASSERT_EQ(server.post("/api/project/inputs", asked).status, 200);
    server.settle();
    EXPECT_EQ(failure(server), "server-changed");
    EXPECT_EQ(server.get("/api/scene").text, scene) << "the scene of the runs stays";
  }
  const Running again(folder / "project");
  again.settle();
  // tried: this input has changed since the runs of the project were made from it
  EXPECT_EQ(failure(again), "server-changed");
  EXPECT_EQ(again.get("/api/scene").code(), "server-no-scene");
  EXPECT_EQ(again.get("/api/runs/run-1/buildings").status, 200) << "the models are still shown";
  ASSERT_EQ(again.call("DELETE", "/api/runs/run-1").status, 200);
  ASSERT_EQ(again.post("/api/project/inputs", asked).status, 200);
  again.settle();
  EXPECT_EQ(again.get("/api/scene").status, 200) << "without runs, inputs may be others";
}

TEST_F(WithHall, one_damaged_run_does_not_keep_the_others_from_being_opened) {
  fs::copy(project() / "runs/run-1", project() / "runs/run-2", fs::copy_options::recursive);
  fs::copy(project() / "runs/run-1", project() / "runs/run-3", fs::copy_options::recursive);
  const std::string damaged = "{\"version\": 1, \"id\"";
  write(project() / "runs/run-2/run.json", damaged);
  const Running server(project());
  server.settle();
  const auto runs = server.get("/api/project").json()["runs"];
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0]["state"], "done");
  EXPECT_EQ(runs[1]["state"], "failed");
  EXPECT_EQ(runs[1]["failure"]["code"], "server-damaged");
  EXPECT_EQ(runs[2]["state"], "done");
  EXPECT_EQ(server.get("/api/runs/run-3/buildings").status, 200);
  EXPECT_EQ(server.call("PATCH", "/api/runs/run-2", R"({"label":"new"})").code(), "server-damaged");
  EXPECT_EQ(read(project() / "runs/run-2/run.json"), damaged) << "it may be restored by hand";
  EXPECT_EQ(server.call("DELETE", "/api/runs/run-2").status, 200);
}

TEST(Sample, is_read_with_the_options_in_its_folder) {
  const Folder folder;
  const Running server(folder / "project", {"--sample", std::string(MANSARD_DATA) + "/delft"});
  EXPECT_EQ(server.get("/api/project").json()["sample"], true);
  ASSERT_EQ(server.call("POST", "/api/project/sample", "{}").status, 200);
  server.settle();
  EXPECT_EQ(server.get("/api/project").json()["reading"]["ingest.mesh_offset"], "84800 447400 0");
  EXPECT_EQ(server.get("/api/scene").json()["footprints"].size(), 87U);
}

class Runs : public WithHall {};

TEST_F(Runs, keep_their_results_across_a_restart) {
  const Running server(project());
  const auto summary = server.get("/api/project").json()["runs"][0];
  EXPECT_EQ(summary["state"], "done");
  EXPECT_GT(summary["parts"], 0);
  EXPECT_LT(summary["scores"]["footprint_mse"], 1);
  EXPECT_TRUE(summary["options"].empty()) << summary["options"];
  const auto models = server.buildings("run-1");
  ASSERT_EQ(models["buildings"].size(), summary["buildings"]);
  for (const auto& building : models["buildings"]) {
    EXPECT_TRUE(building["valid"].get<bool>());
    EXPECT_FALSE(building["edited"].get<bool>());
    for (const auto& part : building["parts"]) {
      EXPECT_GT(part["volume"], 0);
      EXPECT_FALSE(part["geometry"]["triangles"].empty());
    }
  }
  EXPECT_FALSE(server.get("/api/runs/run-1/layers").json()["edges"].empty());
  EXPECT_GT(server.get("/api/runs/run-1/report").json()["counts"]["full"], 0);
  const auto maps = server.get("/api/runs/run-1/error").json()["maps"];
  for (const auto& map : maps)
    EXPECT_EQ(server.get("/api/runs/run-1/error/" + map["block"].get<std::string>()).text.size(),
              map["columns"].get<std::size_t>() * map["rows"].get<std::size_t>() * 4);
  EXPECT_EQ(server.get("/api/runs/run-1/error/block-99").code(), "server-unknown");
}

TEST_F(Runs, take_presets_options_and_blocks_and_store_values_that_differ_from_the_defaults) {
  const Running server(project());
  server.settle();
  const auto block = server.get("/api/scene").json()["blocks"][0]["name"];
  const auto run = server.reconstruct(
      {{"label", "a try"}, {"preset", "paper"}, {"options", {{"sweep.gamma", "12"}}}, {"blocks", {block}}});
  EXPECT_EQ(run, "run-2");
  const auto summary = server.get("/api/project").json()["runs"][1];
  EXPECT_EQ(summary["state"], "done") << summary;
  EXPECT_EQ(summary["label"], "a try");
  EXPECT_EQ(summary["preset"], "paper");
  EXPECT_EQ(summary["options"]["sweep.gamma"], "12");
  EXPECT_EQ(summary["options"]["refine.effort"], "caps") << "a value of the preset";
  EXPECT_EQ(summary["blocks"][0], block);
  EXPECT_EQ(server.call("PATCH", "/api/runs/run-2", R"({"label":"kept"})").json()["label"], "kept");
  EXPECT_EQ(server.post("/api/runs", {{"options", {{"sweep.gama", "1"}}}}).code(), "option-unknown");
  EXPECT_EQ(server.post("/api/runs", {{"options", {{"sweep.gamma", "-1"}}}}).code(), "option-value");
  EXPECT_EQ(server.post("/api/runs", {{"options", {{"ingest.crs", "local"}}}}).code(), "option-value");
  EXPECT_EQ(server.post("/api/runs", {{"preset", "none such"}}).code(), "option-value");
  EXPECT_EQ(server.post("/api/runs", {{"blocks", {"block-99"}}}).code(), "pipeline-block-unknown");
}

TEST_F(Runs, fix_the_inputs_of_the_project_until_they_are_deleted) {
  const Running server(project());
  server.settle();
  const std::string b9 = std::string(MANSARD_DATA) + "/b9/";
  const Json other{{"meshes", {b9 + "mesh.off"}}, {"footprints", b9 + "footprints.geojson"}};
  // tried: the project has runs with other inputs; delete them
  EXPECT_EQ(server.post("/api/project/inputs", other).code(), "server-inputs");
  EXPECT_EQ(server.call("DELETE", "/api/runs/run-1").status, 200);
  EXPECT_TRUE(fs::exists(project() / "trash/run-1/plans.json"));
  EXPECT_EQ(server.get("/api/runs/run-1/buildings").code(), "server-unknown");
  EXPECT_EQ(server.post("/api/project/inputs", other).status, 200);
  server.settle();
}

TEST_F(Runs, can_be_cancelled_while_queued_or_running) {
  const Running server(project());
  server.settle();
  const auto running = server.post("/api/runs", Json::object()).json();
  const auto waiting = server.post("/api/runs", Json::object()).json();
  EXPECT_EQ(server.call("DELETE", "/api/runs/" + waiting["run"].get<std::string>()).code(), "server-busy");
  EXPECT_EQ(server.call("DELETE", "/api/jobs/" + waiting["id"].get<std::string>()).status, 200);
  EXPECT_EQ(server.call("DELETE", "/api/jobs/" + running["id"].get<std::string>()).status, 200);
  server.settle();
  const auto runs = server.get("/api/project").json()["runs"];
  EXPECT_EQ(runs[1]["state"], "cancelled") << runs.dump();
  EXPECT_EQ(runs[2]["state"], "cancelled");
  EXPECT_EQ(server.get("/api/runs/run-2/buildings").code(), "server-not-done");
  EXPECT_EQ(server.get("/api/runs/run-1/buildings").status, 200);
  EXPECT_FALSE(fs::exists(project() / "runs/run-2/plans.json"));
}

TEST_F(Runs, that_were_running_when_the_server_was_killed_are_interrupted) {
  {
    Running server(project());
    server.settle();
    ASSERT_EQ(server.post("/api/runs", Json::object()).status, 200);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    server.kill();
  }
  const Running server(project());
  const auto runs = server.get("/api/project").json()["runs"];
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_THAT(runs[1]["state"], testing::AnyOf("interrupted", "done"));
  EXPECT_EQ(server.buildings("run-1")["history"]["done"], 0);
}

TEST_F(Runs, export_the_bytes_that_extrude_makes_from_their_plans) {
  const Running server(project());
  server.settle();
  auto building = server.buildings("run-1")["buildings"][0];
  ASSERT_EQ(server.post("/api/runs/run-1/edits", lift(building, 0.75)).status, 200);
  const auto reply = server.post("/api/runs/run-1/export", {{"overwrite", false}});
  ASSERT_EQ(reply.status, 200) << reply.text;
  const fs::path folder(reply.json()["folder"].get<std::string>());
  EXPECT_EQ(server.post("/api/runs/run-1/export", {{"overwrite", false}}).code(), "output-exists");
  EXPECT_EQ(server.post("/api/runs/run-1/export", {{"overwrite", true}}).status, 200);

  const auto again = folder_ / "extruded";
  const auto command = std::string(MANSARD_BINARY) + " extrude -q " + (folder / "plans.json").string() +
                       " --formats all -o " + again.string() + " >/dev/null";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) <= 1);
  // Every file of every format, and no others.
  std::set<std::string> made, wanted{run_layers};
  for (const auto& file : fs::recursive_directory_iterator(folder))
    if (file.is_regular_file()) made.insert(file.path().lexically_relative(folder).string());
  for (const auto& file : fs::recursive_directory_iterator(again))
    if (file.is_regular_file()) wanted.insert(file.path().lexically_relative(again).string());
  EXPECT_EQ(made, wanted);
  EXPECT_GE(wanted.size(), written_formats().size() + 2);
  for (const auto& name : wanted)
    if (name != run_layers) {
      EXPECT_EQ(read(again / name) == read(folder / name), true) << name;
    }
  // Single files have the same bytes.
  std::size_t fetched = 0;
  const auto formats = server.get("/api/options").json()["formats"];
  for (const auto& format : formats)
    for (const auto& file : format["files"]) {
      const auto name = file.get<std::string>();
      const auto bytes = server.get("/api/runs/run-1/export/" + name).text;
      ++fetched;
      if (!name.ends_with(".zip")) {
        EXPECT_EQ(bytes == read(folder / name), true) << name;
        continue;
      }
      const auto compressed = zip_of(folder / name.substr(0, name.size() - 4));
      ASSERT_TRUE(compressed);
      EXPECT_EQ(bytes == *compressed, true) << name;
    }
  EXPECT_EQ(fetched, written_formats().size() + 2) << "an OBJ has three files";
  EXPECT_THAT(read(folder / "plans.json"), HasSubstr("ms_edited"));
  EXPECT_THAT(server.get("/api/runs/run-1/export/segment.gpkg").text, testing::StartsWith("SQLite format 3"));
  EXPECT_EQ(server.get("/api/runs/run-1/export/run.json").code(), "server-unknown");
  EXPECT_EQ(server.get("/api/runs/run-1/export/model.3dtiles").code(), "server-unknown");

  // Some formats only: files of the other formats are deleted, as they are of an older state.
  write(folder / "notes.txt", "mine");
  const auto some = server.post("/api/runs/run-1/export", {{"overwrite", true}, {"formats", {"stl", "plans"}}});
  EXPECT_THAT(some.json()["files"].get<std::vector<std::string>>(),
              testing::ElementsAre("model.stl", "plans.json", "segment.gpkg"));
  std::set<std::string> left;
  for (const auto& file : fs::directory_iterator(folder)) left.insert(file.path().filename().string());
  EXPECT_THAT(left, testing::ElementsAre("model.stl", "notes.txt", "plans.json", "segment.gpkg"));
  EXPECT_EQ(server.post("/api/runs/run-1/export", {{"overwrite", true}, {"formats", {"stp"}}}).code(), "option-value");
  EXPECT_EQ(std::distance(fs::directory_iterator(project() / "exports"), {}), 1) << "work folders are deleted";
}

TEST_F(Runs, show_the_mesh_across_an_edge) {
  const Running server(project());
  server.settle();
  const auto part = server.buildings("run-1")["buildings"][0]["parts"][0];
  const auto stored = server.get(
      "/api/runs/run-1/section?building=" + server.buildings("run-1")["buildings"][0]["id"].get<std::string>() +
      "&part=" + part["id"].get<std::string>() + "&ring=0&edge=0&share=0.5");
  ASSERT_EQ(stored.status, 200) << stored.text;
  EXPECT_FALSE(stored.json()["pieces"].empty());
  const auto drawn =
      server.post("/api/runs/run-1/section", {{"plan", part["plan"]}, {"ring", 0}, {"edge", 0}, {"share", 0.5}});
  EXPECT_EQ(drawn.text, stored.text);
  EXPECT_EQ(server.post("/api/runs/run-1/section", {{"plan", part["plan"]}, {"ring", 0}, {"edge", 999}, {"share", 0.5}})
                .code(),
            "server-body");
}

}  // namespace
}  // namespace mansard::server
