#include <gmock/gmock.h>

#include "apps/server/disk.hpp"
#include "apps/server/project.hpp"
#include "mansard/edit/edit.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

auto code(const base::Result<Project>& result) -> std::string { return result ? "" : result.error().code; }

TEST(Project, is_created_in_an_empty_or_missing_folder_only) {
  const Folder folder;
  EXPECT_EQ(code(Project::open(folder / "new" / "deep")), "");
  EXPECT_TRUE(fs::exists(folder / "new" / "deep" / "project.json"));
  EXPECT_EQ(code(Project::open(folder / "new/deep/")), "") << "a second time";
  fs::create_directories(folder / "empty");
  EXPECT_EQ(code(Project::open(folder / "empty")), "");
  fs::create_directories(folder / "full");
  write(folder / "full/thesis.txt", "mine");
  EXPECT_EQ(code(Project::open(folder / "full")), "server-folder");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "full"), {}), 1) << "nothing may be written there";
  EXPECT_EQ(code(Project::open(folder / "full/thesis.txt")), "server-folder");
}

TEST(Project, cannot_be_opened_twice) {
  const Folder folder;
  auto first = Project::open(folder / "p");
  ASSERT_TRUE(first);
  EXPECT_EQ(code(Project::open(folder / "p")), "server-locked");
  { const auto gone = std::move(*first); }
  EXPECT_EQ(code(Project::open(folder / "p")), "");
}

TEST(Project, refuses_invalid_files) {
  for (const auto* text : {"", "{", "[]", "{}", R"({"type":"other","version":1,"inputs":null})",
                           R"({"type":"mansard-project","version":2,"inputs":null})",
                           R"({"type":"mansard-project","version":1,"inputs":{"meshes":1}})"}) {
    const Folder folder;
    fs::create_directories(folder / "p");
    write(folder / "p/project.json", text);
    EXPECT_EQ(code(Project::open(folder / "p")), "server-project") << text;
  }
}

TEST(Project, stores_inputs_and_runs) {
  const Folder folder;
  const std::string archive = "/vsizip//elsewhere/f.zip/f.shp";
  Inputs inputs{{(folder / "p/inputs/mesh.ply").string(), "/elsewhere/tiles"},
                archive,
                {{"ingest.crs", "local"}, {terrain_option, (folder / "p/inputs/dtm.tif").string()}},
                {{(folder / "p/inputs/mesh.ply").string(), 5, "ab", {5, 17}}},
                {{(folder / "p/inputs/dtm.tif").string(), 7, "ef", {7, 19}}},
                {{archive, 6, "cd", {60, 18}}}};
  RunRecord run{"run-1",
                "first",
                State::done,
                base::error("code", "message", "subject"),
                "2024-01-01T00:00:00Z",
                "paper",
                {{"sweep.gamma", "15"}},
                {"block-1"},
                RunScores{1, 2, 3, 4, 5, 6},
                {{0.75, 0.5, {}}, {{"block", {0.25, 0.5, {}}}}},
                7,
                6,
                9,
                80,
                {{"block-1", {1, 2}, 0.25, 3, 4}}};
  {
    auto project = Project::open(folder / "p");
    ASSERT_TRUE(project);
    ASSERT_TRUE(project->save(inputs));
    ASSERT_EQ(*project->new_run(), "run-1");
    ASSERT_TRUE(project->save(run));
  }
  // Paths inside the folder move with it.
  fs::rename(folder / "p", folder / "q");
  auto project = Project::open(folder / "q");
  ASSERT_TRUE(project) << project.error().message;
  ASSERT_TRUE(project->inputs());
  EXPECT_EQ(project->inputs()->meshes.front(), (folder / "q/inputs/mesh.ply").string());
  EXPECT_EQ(project->inputs()->meshes.back(), "/elsewhere/tiles");
  EXPECT_EQ(project->inputs()->reading.at("ingest.crs"), "local");
  EXPECT_EQ(project->inputs()->reading.at(terrain_option), (folder / "q/inputs/dtm.tif").string());
  ASSERT_EQ(project->inputs()->terrain_files.size(), 1U);
  EXPECT_EQ(project->inputs()->terrain_files.front().path, (folder / "q/inputs/dtm.tif").string());
  EXPECT_EQ(project->inputs()->footprints, archive);
  EXPECT_EQ(project->inputs()->footprint_files, inputs.footprint_files);
  const auto runs = project->runs();
  ASSERT_TRUE(runs) << runs.error().message;
  ASSERT_EQ(runs->size(), 1U);
  const auto& kept = runs->front();
  EXPECT_EQ(kept.label, run.label);
  EXPECT_EQ(kept.state, State::done);
  EXPECT_EQ(kept.failure, run.failure);
  EXPECT_EQ(kept.options, run.options);
  EXPECT_EQ(kept.blocks, run.blocks);
  EXPECT_EQ(kept.scores->invented, 6);
  EXPECT_EQ(kept.times.total.cpu_seconds, 0.75);
  EXPECT_EQ(kept.times.total.wall_seconds, 0.5);
  EXPECT_EQ(kept.times.stages.front().spent.cpu_seconds, 0.25);
  EXPECT_EQ(kept.faces, 80U);
  EXPECT_EQ(kept.maps.front().columns, 3U);
}

TEST(Project, reads_files_of_earlier_versions_and_stores_no_password) {
  const Folder folder;
  fs::create_directories(folder / "p");
  write(folder / "p/project.json",
        R"({"type":"mansard-project","version":1,"inputs":{"meshes":["/a.ply"],"footprints":"/f.shp",
    "reading":{},"mesh_files":[{"path":"/a.ply","bytes":5,"sha256":"ab","modified_ns":17}],"footprint_files":[]}})");
  auto project = Project::open(folder / "p");
  ASSERT_TRUE(project) << project.error().message;
  EXPECT_EQ(project->inputs()->mesh_files.front().stamp, (Stamp{5, 17}));
  EXPECT_TRUE(project->inputs()->terrain_files.empty());
  auto inputs = *project->inputs();
  inputs.footprints = "PG:host=h password=sesame";
  inputs.footprint_files = {{"PG:host=h password=***", 5, "ab", {}}};
  ASSERT_TRUE(project->save(inputs));
  EXPECT_EQ(project->inputs()->footprints, inputs.footprints) << "as long as it is open";
  EXPECT_THAT(read(folder / "p/project.json"), testing::Not(testing::HasSubstr("password")));
  EXPECT_THAT(read(folder / "p/project.json"), testing::HasSubstr("PG:host=h"));
  auto kept = inputs;
  kept.footprints = "PG:host=h";
  EXPECT_TRUE(inputs.same_request(kept));
}

TEST(Project, reads_the_times_of_runs_of_earlier_versions) {
  const Folder folder;
  auto project = Project::open(folder / "p");
  ASSERT_TRUE(project);
  RunRecord run;
  run.id = *project->new_run();
  run.state = State::done;
  ASSERT_TRUE(project->save(run));
  const auto path = folder / "p/runs/run-1/run.json";
  auto json = nlohmann::json::parse(read(path));
  json["times"] = {{{"stage", "slice"}, {"seconds", 0.5}}, {{"stage", "sweep"}, {"seconds", 0.25}}};
  write(path, json.dump());
  const auto runs = project->runs();
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_EQ(runs->front().times.stages.back().stage, "sweep");
  EXPECT_EQ(runs->front().times.total.wall_seconds, 0.75);
}

TEST(Project, marks_unfinished_runs_as_interrupted_and_never_reuses_numbers) {
  const Folder folder;
  auto project = Project::open(folder / "p");
  ASSERT_TRUE(project);
  for (const auto state : {State::queued, State::running, State::failed}) {
    RunRecord run;
    run.id = *project->new_run();
    run.state = state;
    ASSERT_TRUE(project->save(run));
  }
  ASSERT_EQ(*project->new_run(), "run-4") << "a run without run.json";
  const auto runs = project->runs();
  ASSERT_TRUE(runs);
  ASSERT_EQ(runs->size(), 3U);
  EXPECT_EQ((*runs)[0].state, State::interrupted);
  EXPECT_EQ((*runs)[1].state, State::interrupted);
  EXPECT_EQ((*runs)[2].state, State::failed);
  EXPECT_THAT(read(folder / "p/runs/run-1/run.json"), testing::HasSubstr("interrupted"));
  fs::remove_all(folder / "p/runs/run-4");
  ASSERT_TRUE(project->trash("run-3"));
  EXPECT_EQ(*project->new_run(), "run-4");
}

TEST(Journal, truncates_an_incomplete_line_and_appends_complete_ones) {
  const Folder folder;
  write(folder / "j", "one\ntw");
  {
    auto journal = Journal::open(folder / "j", 4);
    ASSERT_TRUE(journal);
    ASSERT_TRUE(journal->append("three"));
    EXPECT_EQ(read(folder / "j"), "one\nthree\n") << "before it is closed";
  }
  EXPECT_EQ(edit::applied_edits("{\"what\":\"a\"}\n{\"undo\":true}\n{\"what\":\"b\"}\n{\"redo\":true}\n{\"wh"), 2U);
  EXPECT_EQ(*read_journal(folder / "none"), "");
}

TEST(Arriving, leaves_no_file_when_it_is_incomplete) {
  const Folder folder;
  {
    auto file = Arriving::open(folder / "a");
    ASSERT_TRUE(file && file->add("half"));
  }
  EXPECT_FALSE(fs::exists(folder / "a"));
  {
    auto file = Arriving::open(folder / "b");
    ASSERT_TRUE(file && file->add("who") && file->add("le") && file->finish());
  }
  EXPECT_EQ(read(folder / "b"), "whole");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / ""), {}), 1);
}

}  // namespace
}  // namespace mansard::server
