// Attributes, levels of detail, models of others, and what makes inputs match.
#include <gmock/gmock.h>

#include "server/running.hpp"

namespace mansard::server {
namespace {

/// A house with attributes of its own, as CityJSON that mansard wrote.
auto made(const Folder& folder) -> std::string {
  write(folder / "a.geojson", R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},
    "features":[{"type":"Feature","properties":{"id":"a","street":"Lange Geer","built":1890},"geometry":{"type":"Polygon",
    "coordinates":[[[85000,447000],[85012,447000],[85012,447008],[85000,447008],[85000,447000]]]}}]})");
  const auto out = (folder / "model.city.json").string();
  const auto command = std::string(MANSARD_BINARY) + " extrude -q " + (folder / "a.geojson").string() +
                       " --profile '0,0 0,6 4,9' -o " + out + " >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return out;
}

auto named(const Json& list, const std::string& name) -> Json {
  for (const auto& one : list)
    if (one["name"] == name) return one;
  return nullptr;
}

TEST(Inspect, attributes_are_those_of_the_source_and_of_mansard_with_units_and_meanings) {
  const Folder folder;
  const Running server(folder / "project");
  ASSERT_EQ(server.post("/api/runs/import", {{"path", made(folder)}}).status, 200);
  server.settle();
  const auto table = server.get("/api/runs/run-1/attributes").json();
  const auto building = table["buildings"][0];
  EXPECT_EQ(building["id"], "a");
  EXPECT_EQ(building["values"]["street"], "Lange Geer");
  EXPECT_EQ(building["values"]["built"], 1890);
  EXPECT_EQ(named(table["attributes"], "street")["source"], true);
  const auto height = named(table["attributes"], "ms_h_roof_max");
  EXPECT_EQ(height["source"], false);
  EXPECT_EQ(height["unit"], "m");
  EXPECT_NE(height["meaning"], "");
  const double before = building["values"]["ms_h_roof_max"];
  EXPECT_GT(building["parts"][0]["values"].size(), 3U);
  // They follow edits.
  ASSERT_EQ(server.post("/api/runs/run-1/edits", lift(server.buildings("run-1")["buildings"][0], 1)).status, 200);
  const auto after = server.get("/api/runs/run-1/attributes").json()["buildings"][0]["values"];
  EXPECT_NEAR(after["ms_h_roof_max"].get<double>(), before + 1, 1e-6);
  EXPECT_EQ(after["ms_edited"], true);
  EXPECT_EQ(after["street"], "Lange Geer");
}

TEST(Inspect, levels_of_detail_are_solids_of_every_building) {
  const Folder folder;
  const Running server(folder / "project");
  ASSERT_EQ(server.post("/api/runs/import", {{"path", made(folder)}}).status, 200);
  server.settle();
  for (const std::string lod : {"1.2", "1.3", "2.0"}) {
    const auto level = server.get("/api/runs/run-1/levels/" + lod).json();
    ASSERT_EQ(level["buildings"].size(), 1U) << lod;
    EXPECT_EQ(level["buildings"][0]["id"], "a");
    if (lod == "1.2") {
      // A box: four walls, a roof, a ground.
      EXPECT_EQ(level["buildings"][0]["solids"][0]["faces"].size(), 6U);
    }
  }
  EXPECT_EQ(server.get("/api/runs/run-1/levels/2.2").code(), "server-unknown");
}

TEST(Inspect, models_of_other_programs_are_shown_in_the_frame_of_the_project) {
  const Folder folder;
  const Running server(folder / "project");
  const auto path = made(folder);
  const auto model = server.post("/api/models", {{"path", path}});
  ASSERT_EQ(model.status, 200) << model.text;
  const auto json = model.json();
  EXPECT_EQ(json["buildings"], Json::array({"a"}));
  EXPECT_EQ(json["triangles"].size(), 3 * json["classes"].size());
  EXPECT_EQ(json["building_of"].size(), json["classes"].size());
  EXPECT_EQ(server.post("/api/models", {{"path", (folder / "none.json").string()}}).code(), "file-missing");
}

TEST(Inspect, finds_the_offset_of_a_mesh) {
  const Folder folder;
  const Running server(folder / "project");
  const std::string hall = std::string(MANSARD_DATA) + "/hall/";
  const Json request = {{"meshes", {hall + "mesh.off"}},
                        {"footprints", hall + "footprints.geojson"},
                        {"reading", {{"ingest.mesh_offset", "200 -100 0"}}}};
  const auto reply = server.post("/api/project/alignment", request);
  ASSERT_EQ(reply.status, 200) << reply.text;
  const auto proposal = reply.json()["proposal"];
  ASSERT_FALSE(proposal.is_null());
  EXPECT_TRUE(proposal["reading"].contains("ingest.mesh_offset")) << proposal;
  EXPECT_GT(proposal["correlation"].get<double>(), proposal["next"].get<double>());
  Json again = request;
  again["reading"] = proposal["reading"];
  ASSERT_EQ(server.post("/api/project/inputs", again).status, 200);
  server.settle();
  EXPECT_EQ(server.get("/api/scene").status, 200) << server.get("/api/jobs").text;
}

}  // namespace
}  // namespace mansard::server
