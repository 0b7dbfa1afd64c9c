// Models that mansard wrote, imported into a project.
#include <gmock/gmock.h>

#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

const std::string footprints = R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},
  "features":[{"type":"Feature","properties":{"id":"a"},"geometry":{"type":"Polygon","coordinates":
  [[[85000,447000],[85012,447000],[85012,447008],[85000,447008],[85000,447000]]]}}]})";

/// The models of the footprint, written to a file of that name.
auto made(const Folder& folder, const std::string& name) -> std::string {
  write(folder / "a.geojson", footprints);
  const auto out = (folder / name).string();
  const auto command = std::string(MANSARD_BINARY) + " extrude -q " + (folder / "a.geojson").string() +
                       " --profile '0,0 0,6 4,9' -o " + out + " >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return out;
}

TEST(Import, is_a_finished_run_that_can_be_shown_edited_and_exported_without_a_mesh) {
  const Folder folder;
  const auto model = made(folder, "model.json");
  {
    const Running server(folder / "project");
    const auto job = server.post("/api/runs/import", {{"path", model}});
    ASSERT_EQ(job.status, 200) << job.text;
    server.settle();
    const auto run = server.get("/api/project").json()["runs"][0];
    EXPECT_EQ(run["state"], "done") << run;
    EXPECT_EQ(run["label"], "model.json");
    EXPECT_EQ(run["buildings"], 1);
    EXPECT_EQ(server.get("/api/runs/run-1/export/plans.json").text, read(model));
    EXPECT_EQ(server.get("/api/runs/run-1/export/segment.gpkg").status, 404);
    auto building = server.get("/api/runs/run-1/buildings").json()["buildings"][0];
    auto part = building["parts"][0];
    part["plan"]["cap"] = 7.0;
    const Json changes = {{{"building", "a"},
                           {"revision", building["revision"]},
                           {"parts", {{{"id", part["id"]}, {"plan", part["plan"]}}}}}};
    EXPECT_EQ(server.post("/api/runs/run-1/edits", {{"what", "cap"}, {"changes", changes}}).status, 200);
    EXPECT_NE(server.get("/api/runs/run-1/export/plans.json").text, read(model));
    EXPECT_EQ(server.post("/api/runs/run-1/export", {{"overwrite", false}}).status, 200);
    // Inputs that are read later would have another frame.
    EXPECT_EQ(server.post("/api/project/inputs", {{"meshes", {model}}, {"footprints", model}}).code(), "server-inputs");
  }
  const Running again(folder / "project");
  again.settle();
  EXPECT_EQ(again.get("/api/runs/run-1/buildings").json()["history"]["done"], 1);
  // tried: the project has models that were opened without a mesh; delete them
  ASSERT_EQ(again.call("DELETE", "/api/runs/run-1").status, 200);
  const std::string hall = std::string(MANSARD_DATA) + "/hall/";
  EXPECT_EQ(
      again.post("/api/project/inputs", {{"meshes", {hall + "mesh.off"}}, {"footprints", hall + "footprints.geojson"}})
          .status,
      200);
  again.settle();
  EXPECT_EQ(again.get("/api/scene").status, 200);
}

TEST(Import, reads_every_format_with_plans_and_refuses_others) {
  const Folder folder;
  const Running server(folder / "project");
  std::string first;
  for (const auto* name :
       {"m.city.json", "m.city.jsonl", "m.obj", "m.glb", "m.gpkg", "m.3dtiles", "m.geojson", "m.json"}) {
    const auto reply = server.post("/api/runs/import", {{"path", made(folder, name)}});
    ASSERT_EQ(reply.status, 200) << name << reply.text;
    server.settle();
    const auto plans = server.get("/api/runs/" + reply.json()["run"].get<std::string>() + "/export/plans.json").text;
    if (first.empty()) first = plans;
    EXPECT_EQ(plans, first) << name;
  }
  EXPECT_THAT(first, HasSubstr("mansard-plan"));
  const auto stl = server.post("/api/runs/import", {{"path", made(folder, "m.stl")}});
  EXPECT_EQ(stl.status, 400);
  EXPECT_EQ(stl.code(), "write-read-format");
  EXPECT_EQ(server.post("/api/runs/import", {{"path", (folder / "a.geojson").string()}}).code(), "write-read-plans");
  EXPECT_EQ(server.post("/api/runs/import", {{"path", (folder / "none.glb").string()}}).code(), "file-missing");
  EXPECT_EQ(server.post("/api/runs/import", Json::object()).code(), "server-body");
  EXPECT_EQ(server.get("/api/project").json()["runs"].size(), 8U);
}

TEST(Import, opens_what_was_downloaded_also_where_it_is_a_zip) {
  const Folder folder;
  const Running server(folder / "project");
  ASSERT_EQ(server.post("/api/runs/import", {{"path", made(folder, "model.json")}}).status, 200);
  server.settle();
  const auto building = server.buildings("run-1")["buildings"][0];
  ASSERT_EQ(server.post("/api/runs/run-1/edits", lift(building, 1)).status, 200);
  const auto plans = server.get("/api/runs/run-1/export/plans.json").text;
  int run = 1;
  for (const std::string name : {"model.3dtiles.zip", "model.obj.zip"}) {
    write(folder / name, server.get("/api/runs/run-1/export/" + name).text);
    const auto reply = server.post("/api/runs/import", {{"path", (folder / name).string()}});
    ASSERT_EQ(reply.status, 200) << name << reply.text;
    server.settle();
    const auto id = "run-" + std::to_string(++run);
    const auto again = server.buildings(id)["buildings"];
    ASSERT_EQ(again.size(), 1U) << server.get("/api/jobs").text;
    EXPECT_EQ(again[0]["edited"], true) << "the mark of an edit is kept";
    EXPECT_EQ(again[0]["parts"][0]["plan"], server.buildings("run-1")["buildings"][0]["parts"][0]["plan"]);
  }
  EXPECT_TRUE(fs::is_empty(folder / "project/exports")) << "what was unpacked is deleted";
  write(folder / "text.zip", "no archive");
  EXPECT_EQ(server.post("/api/runs/import", {{"path", (folder / "text.zip").string()}}).code(), "server-archive");
}

TEST(Import, is_moved_into_the_frame_of_the_mesh) {
  const Folder folder;
  const auto model = made(folder, "model.glb");
  // A field around the house, in the same coordinates.
  write(folder / "field.obj", "v 84900 446900 0\nv 85100 446900 0\nv 85100 447100 0\nv 84900 447100 0\nf 1 2 3 4\n");
  const std::string large = R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},
    "features":[{"type":"Feature","properties":{"id":"a"},"geometry":{"type":"Polygon","coordinates":
    [[[84950,447000],[85090,447000],[85090,447008],[84950,447008],[84950,447000]]]}}]})";
  write(folder / "large.geojson", large);
  const Running server(folder / "project");
  ASSERT_EQ(server
                .post("/api/project/inputs", {{"meshes", {(folder / "field.obj").string()}},
                                              {"footprints", (folder / "large.geojson").string()}})
                .status,
            200);
  server.settle();
  const auto origin = server.get("/api/scene").json()["origin"];
  ASSERT_EQ(server.post("/api/runs/import", {{"path", model}}).status, 200);
  server.settle();
  const auto run = server.get("/api/project").json()["runs"][0];
  ASSERT_EQ(run["state"], "done") << run;
  const auto point =
      server.get("/api/runs/run-1/buildings").json()["buildings"][0]["parts"][0]["plan"]["outer"]["points"][0];
  const double x = point[0].get<double>() + origin[0].get<double>();
  EXPECT_TRUE(x == 85000 || x == 85012) << x;
  // A model in another CRS than the mesh is refused.
  auto other = footprints;
  other.replace(other.find("28992"), 5, "25831");
  write(folder / "b.geojson", other);
  const auto command = std::string(MANSARD_BINARY) + " extrude -q " + (folder / "b.geojson").string() +
                       " --profile '0,0 0,6' -o " + (folder / "b.json").string() + " >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  ASSERT_EQ(server.post("/api/runs/import", {{"path", (folder / "b.json").string()}}).status, 200);
  server.settle();
  const auto failed = server.get("/api/project").json()["runs"][1];
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["failure"]["code"], "server-import");
}

}  // namespace
}  // namespace mansard::server
