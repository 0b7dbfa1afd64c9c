#include <gmock/gmock.h>

#include "apps/server/disk.hpp"
#include "apps/server/project.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

auto code(const base::Result<Project>& result) -> std::string { return result ? "" : result.error().code; }

TEST(Project, is_made_where_there_is_nothing_and_nowhere_else) {
  const Folder folder;
  EXPECT_EQ(code(Project::open(folder / "new" / "deep")), "");
  EXPECT_TRUE(fs::exists(folder / "new" / "deep" / "project.json"));
  EXPECT_EQ(code(Project::open(folder / "new/deep/")), "") << "a second time";
  fs::create_directories(folder / "empty");
  EXPECT_EQ(code(Project::open(folder / "empty")), "");
  fs::create_directories(folder / "full");
  write(folder / "full/thesis.txt", "mine");
  EXPECT_EQ(code(Project::open(folder / "full")), "server-folder");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "full"), {}), 1) << "something was left there";
  EXPECT_EQ(code(Project::open(folder / "full/thesis.txt")), "server-folder");
}

TEST(Project, is_open_once_at_a_time) {
  const Folder folder;
  auto first = Project::open(folder / "p");
  ASSERT_TRUE(first);
  EXPECT_EQ(code(Project::open(folder / "p")), "server-locked");
  { const auto gone = std::move(*first); }
  EXPECT_EQ(code(Project::open(folder / "p")), "");
}

TEST(Project, refuses_files_that_it_cannot_read) {
  for (const auto* text : {"", "{", "[]", "{}", R"({"type":"other","version":1,"inputs":null})",
                           R"({"type":"mansard-project","version":2,"inputs":null})",
                           R"({"type":"mansard-project","version":1,"inputs":{"meshes":1}})"}) {
    const Folder folder;
    fs::create_directories(folder / "p");
    write(folder / "p/project.json", text);
    EXPECT_EQ(code(Project::open(folder / "p")), "server-project") << text;
  }
}

TEST(Project, keeps_inputs_and_runs) {
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
                {{"block", 0.5}},
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
  // What is in the folder goes with it.
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
  EXPECT_EQ(kept.times.front().seconds, 0.5);
  EXPECT_EQ(kept.faces, 80U);
  EXPECT_EQ(kept.maps.front().columns, 3U);
}

TEST(Project, reads_files_of_earlier_versions_and_writes_no_password) {
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

TEST(Project, calls_runs_interrupted_that_had_not_ended_and_counts_on_past_deleted_ones) {
  const Folder folder;
  auto project = Project::open(folder / "p");
  ASSERT_TRUE(project);
  for (const auto state : {State::queued, State::running, State::failed}) {
    RunRecord run;
    run.id = *project->new_run();
    run.state = state;
    ASSERT_TRUE(project->save(run));
  }
  ASSERT_EQ(*project->new_run(), "run-4") << "cut short before its run.json";
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

TEST(Journal, cuts_off_what_was_torn_and_appends_whole_lines) {
  const Folder folder;
  write(folder / "j", "one\ntw");
  {
    auto journal = Journal::open(folder / "j", 4);
    ASSERT_TRUE(journal);
    ASSERT_TRUE(journal->append("three"));
    EXPECT_EQ(read(folder / "j"), "one\nthree\n") << "before it is closed";
  }
  write(folder / "k", "{\"what\":\"a\"}\n{\"undo\":true}\n{\"what\":\"b\"}\n{\"redo\":true}\n{\"wh");
  EXPECT_EQ(standing_edits(folder / "k"), 2U);
  EXPECT_EQ(standing_edits(folder / "none"), 0U);
}

TEST(Arriving, leaves_nothing_when_it_is_given_up) {
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
