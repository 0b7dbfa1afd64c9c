// What a project keeps, so that it is shown at once when it is opened again.
#include <gmock/gmock.h>

#include "apps/server/scene_view.hpp"
#include "apps/server/workspace.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

auto replaced(std::string text, const std::string& what, const std::string& by) -> std::string {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

auto some_tiles() -> std::vector<picture::Tile> {
  std::vector<picture::Tile> tiles(2);
  tiles[0].positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  tiles[0].triangles = {0, 1, 2};
  tiles[1].column = 3;
  tiles[1].positions = {5, 5, 5, 6, 5, 5, 5, 6, 5, 6, 6, 5};
  tiles[1].triangles = {0, 1, 2, 1, 3, 2};
  return tiles;
}

void give_tiles(const picture::TakeTile& take) {
  for (auto& tile : some_tiles()) take(std::move(tile));
}

TEST(SceneView, is_kept_with_all_its_tiles_and_opened_with_the_same_key_only) {
  const Folder folder;
  const auto made = SceneView::make(R"({"crs":"EPSG:1"})", give_tiles);
  ASSERT_TRUE(made);
  ASSERT_TRUE((*made)->keep(folder / "scene", "key"));
  const auto kept = SceneView::open(folder / "scene", "key");
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->scene_json(), (*made)->scene_json());
  EXPECT_EQ(kept->tiles_json(), (*made)->tiles_json());
  for (const auto* id : {"0-0-0", "0-3-0"}) {
    const auto was = (*made)->tile_bytes(id), is = kept->tile_bytes(id);
    ASSERT_TRUE(was && *was && is && *is) << id;
    EXPECT_EQ(**was, **is);
    const auto tile = kept->tile(id);
    ASSERT_TRUE(tile && *tile);
    EXPECT_EQ((*tile)->positions, some_tiles()[id == std::string("0-0-0") ? 0 : 1].positions);
  }
  EXPECT_FALSE(*kept->tile_bytes("9-9-9"));
  EXPECT_EQ(SceneView::open(folder / "scene", "other"), nullptr);
  EXPECT_EQ(SceneView::open(folder / "none", "key"), nullptr);
}

TEST(SceneView, that_is_damaged_is_not_opened) {
  const Folder folder;
  const auto made = SceneView::make("{}", give_tiles);
  ASSERT_TRUE(made && (*made)->keep(folder / "scene", "key"));
  const auto whole = read(folder / "scene");
  ASSERT_NE(SceneView::open(folder / "scene", "key"), nullptr);
  for (const auto& bytes :
       {whole.substr(0, whole.size() - 1), whole + "x", std::string(), std::string("\n"), whole.substr(0, 20),
        replaced(whole, "\"vertices\":3", "\"vertices\":4"), replaced(whole, "\"scene\":2", "\"scene\":-2")}) {
    write(folder / "scene", bytes);
    EXPECT_EQ(SceneView::open(folder / "scene", "key"), nullptr) << bytes.substr(0, 40);
  }
}

/// A project with one run of the hall.
void make_project(const fs::path& project) {
  const Running server(project);
  server.open_hall();
  ASSERT_EQ(server.post("/api/runs", {{"label", "one"}}).status, 200);
  server.settle();
  ASSERT_EQ(server.get("/api/runs/run-1/buildings").status, 200);
}

TEST(Reopening, shows_the_scene_that_was_kept_until_the_inputs_have_been_read) {
  const Folder folder;
  // In this process: what was kept is for the program that kept it.
  const auto open = [&] {
    auto project = Project::open(folder / "project");
    EXPECT_TRUE(project);
    auto workspace = Workspace::open(std::move(*project), {});
    EXPECT_TRUE(workspace);
    return std::move(*workspace);
  };
  const auto settle = [](const Workspace& workspace) {
    while (Json::parse(*workspace.status())["busy"].get<bool>())
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  };
  const auto hall = std::string(MANSARD_DATA) + "/hall/";
  {
    const auto workspace = open();
    EXPECT_EQ(Json::parse(*workspace->project())["scene"], false);
    ASSERT_TRUE(workspace->open_inputs({{hall + "mesh.off"}, hall + "footprints.geojson", {}}));
    settle(*workspace);
    EXPECT_EQ(Json::parse(*workspace->project())["scene"], true);
  }
  const auto file = folder / "project/kept/scene";
  write(file, replaced(read(file), "\"triangles\":", "\"triangleS\":"));  // to recognise it
  const auto workspace = open();
  const auto scene = workspace->scene();  // long before the mesh has been read
  ASSERT_TRUE(scene);
  EXPECT_NE(scene->find("triangleS"), std::string::npos);
  EXPECT_EQ(Json::parse(*workspace->project())["scene"], true);
  settle(*workspace);
  EXPECT_EQ(workspace->scene()->find("triangleS"), std::string::npos) << "then that of the inputs";
}

TEST(Reopening, measures_only_what_was_edited) {
  const Folder folder;
  make_project(folder / "project");
  const auto file = folder / "project/runs/run-1/measured.json";
  auto measured = Json::parse(read(file));
  ASSERT_EQ(measured["buildings"].size(), 2U);
  for (auto& building : measured["buildings"]) building["mse"] = 42.0;  // to recognise it
  write(file, measured.dump());
  std::string edited;
  const auto errors = [](const Running& server) {
    std::map<std::string, double> out;
    const auto all = server.get("/api/runs/run-1/buildings").json();
    for (const auto& building : all["buildings"]) out[building["id"]] = building["mse"];
    return out;
  };
  {
    const Running again(folder / "project");
    for (const auto& [id, mse] : errors(again)) EXPECT_EQ(mse, 42.0) << id;
    again.settle();
    for (const auto& [id, mse] : errors(again)) EXPECT_EQ(mse, 42.0) << id << " after the mesh has been read";
    const auto all = again.get("/api/runs/run-1/buildings").json();
    const auto& building = all["buildings"][0];
    edited = building["id"];
    Json parts = Json::array();
    for (const auto& part : building["parts"]) parts.push_back({{"id", part["id"]}, {"plan", part["plan"]}});
    parts[0]["plan"]["cap"] = parts[0]["plan"]["cap"].get<double>() + 0.5;
    const Json changes = {{{"building", edited}, {"revision", building["revision"]}, {"parts", parts}}};
    ASSERT_EQ(again.post("/api/runs/run-1/edits", {{"what", "cap"}, {"changes", changes}}).status, 200);
  }
  const Running last(folder / "project");
  (void)last.get("/api/runs/run-1/buildings");
  last.settle();
  EXPECT_NE(errors(last)[edited], 42.0);
}

TEST(Reopening, keeps_nothing_of_other_inputs) {
  const Folder folder;
  make_project(folder / "project");
  const auto file = folder / "project/runs/run-1/measured.json";
  auto measured = Json::parse(read(file));
  measured["inputs"] = "of another mesh";
  for (auto& building : measured["buildings"]) building["mse"] = 42.0;
  write(file, measured.dump());
  write(folder / "project/kept/scene", replaced(read(folder / "project/kept/scene"), "{\"key\":\"", "{\"key\":\"x"));
  const Running again(folder / "project");
  const auto all = again.get("/api/runs/run-1/buildings").json();
  for (const auto& building : all["buildings"]) EXPECT_NE(building["mse"], 42.0);
  again.settle();
  EXPECT_EQ(again.get("/api/scene").status, 200);
}

}  // namespace
}  // namespace mansard::server
