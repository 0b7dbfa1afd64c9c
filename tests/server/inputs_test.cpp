// Inputs other than plain files: archives, compressed files, rasters, databases.
#include <gmock/gmock.h>

#include "apps/server/zip.hpp"
#include "ingest/database.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;
using testing::Not;

const auto hall = std::string(MANSARD_DATA) + "/hall/";
constexpr const char* password = "sesame-open-7";

/// The project's inputs, after they have been read.
auto inputs_of(const Running& server) -> Json {
  server.settle();
  EXPECT_EQ(server.get("/api/scene").status, 200) << server.get("/api/jobs").text;
  return server.get("/api/project").json()["inputs"];
}

auto some_changed(const Json& inputs) -> bool {
  for (const auto* kind : {"meshes", "terrain", "footprints"})
    for (const auto& file : inputs[kind])
      if (file["changed"].get<bool>()) return true;
  return false;
}

/// All answers about a project, and the contents of all files in its folder.
auto all_told(const Running& server, const fs::path& project) -> std::string {
  std::string all;
  for (const auto* path : {"/api/project", "/api/jobs", "/api/scene"}) all += server.get(path).text + "\n";
  for (const auto& file : fs::recursive_directory_iterator(project))
    if (file.is_regular_file()) all += file.path().string() + "\n" + read(file.path()) + "\n";
  return all;
}

/// The events that a page receives while `work` runs, which is repeated until the page receives some.
template <class Work>
auto heard_of(const Running& server, Work work) -> std::string {
  std::string text;
  std::atomic<bool> some = false, enough = false;
  std::thread page([&] {
    httplib::Client client("127.0.0.1", server.port());
    client.set_read_timeout(60);
    (void)client.Get("/api/events", server.headers(), [&](const char* bytes, std::size_t size) {
      text.append(bytes, size);
      some = true;
      return !enough;
    });
  });
  while (!some) work();
  enough = true;
  work();
  page.join();
  return text;
}

TEST(Inputs, are_read_from_archives_and_compressed_files_and_recognised_again) {
  const Folder folder;
  fs::create_directories(folder / "both/tiles");
  fs::copy_file(hall + "mesh.off", folder / "both/tiles/mesh.off");
  fs::copy_file(hall + "footprints.geojson", folder / "both/footprints.geojson");
  const auto archive = zip_of(folder / "both");
  ASSERT_TRUE(archive);
  write(folder / "both.zip", *archive);
  const auto name = "/vsizip/" + (folder / "both.zip").string();
  std::string scene;
  {
    const Running server(folder / "project");
    const Json asked{{"meshes", {name + "/tiles"}}, {"footprints", name + "/footprints.geojson"}};
    ASSERT_EQ(server.post("/api/project/inputs", asked).status, 200);
    const auto inputs = inputs_of(server);
    scene = server.get("/api/scene").text;
    EXPECT_EQ(inputs["given"]["meshes"][0], name + "/tiles");
    ASSERT_EQ(inputs["meshes"].size(), 1U) << inputs;
    EXPECT_EQ(inputs["meshes"][0]["path"], name + "/tiles/mesh.off");
    EXPECT_EQ(inputs["meshes"][0]["bytes"], fs::file_size(hall + "mesh.off"));
    ASSERT_EQ(inputs["footprints"].size(), 1U);
    EXPECT_FALSE(some_changed(inputs)) << inputs;
  }
  {
    const Running again(folder / "project");
    EXPECT_FALSE(some_changed(inputs_of(again)));
    EXPECT_EQ(again.get("/api/scene").text, scene);
    auto bytes = *archive;
    const auto number = bytes.find("OFF");
    ASSERT_NE(number, std::string::npos);
    bytes.replace(number, 3, "OOF");
    write(folder / "both.zip", bytes);
    fs::last_write_time(folder / "both.zip", fs::last_write_time(folder / "both.zip") + std::chrono::hours(1));
    const auto inputs = again.get("/api/project").json()["inputs"];
    EXPECT_EQ(inputs["meshes"][0]["changed"], true);
    EXPECT_EQ(inputs["footprints"][0]["changed"], false) << "this file is the same in both archives";
  }
  // The same from files on disk.
  fs::copy_file(hall + "mesh.off", folder / "mesh.off");
  ASSERT_EQ(std::system(("gzip " + (folder / "mesh.off").string()).c_str()), 0);
  const Running compressed(folder / "compressed");
  ASSERT_EQ(compressed
                .post("/api/project/inputs",
                      {{"meshes", {(folder / "mesh.off.gz").string()}}, {"footprints", hall + "footprints.geojson"}})
                .status,
            200);
  EXPECT_FALSE(some_changed(inputs_of(compressed)));
  EXPECT_EQ(compressed.get("/api/scene").json()["triangles"], Json::parse(scene)["triangles"]);
}

/// Heights in cells of a metre, from the south-west corner at (0, 0), of a flat house on flat ground.
auto raster(int side, double ground, double house) -> std::string {
  std::string text = "ncols " + std::to_string(side) + "\nnrows " + std::to_string(side) +
                     "\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const bool inside = r >= 10 && r < side - 10 && c >= 10 && c < side - 10;
      text += std::to_string(inside ? house : ground) + (c + 1 < side ? " " : "\n");
    }
  return text;
}

TEST(Inputs, can_be_rasters_with_a_terrain_and_footprints_derived_from_them) {
  const Folder folder;
  {
    const Running server(folder / "project");
    // Paths of uploads, also that of the terrain, move with the project's folder.
    ASSERT_EQ(server.call("PUT", "/api/uploads/dtm.asc", raster(40, 2, 2)).status, 200);
    write(folder / "dsm.asc", raster(40, 3, 11));
    const Json reading{{"ingest.crs", "EPSG:28992"}, {"ingest.terrain", (folder / "project/inputs/dtm.asc").string()}};
    const auto job = server.post(
        "/api/project/inputs", {{"meshes", {(folder / "dsm.asc").string()}}, {"footprints", ""}, {"reading", reading}});
    ASSERT_EQ(job.status, 200) << job.text;
    const auto inputs = inputs_of(server);
    ASSERT_EQ(inputs["meshes"].size(), 1U) << inputs;
    ASSERT_EQ(inputs["terrain"].size(), 1U) << inputs;
    EXPECT_TRUE(inputs["footprints"].empty());
    EXPECT_FALSE(some_changed(inputs));
    const auto scene = server.get("/api/scene").json();
    ASSERT_EQ(scene["footprints"].size(), 1U) << scene["footprints"];
    EXPECT_NEAR(scene["footprints"][0]["ground"].get<double>() + scene["origin"][2].get<double>(), 2, 0.01)
        << "the terrain's, not the surface's around it";
  }
  fs::rename(folder / "project", folder / "moved");
  const Running moved(folder / "moved");
  EXPECT_EQ(inputs_of(moved)["terrain"][0]["path"], (folder / "moved/inputs/dtm.asc").string());
  EXPECT_EQ(moved.get("/api/project").json()["reading"]["ingest.terrain"], (folder / "moved/inputs/dtm.asc").string());
}

TEST(Inputs, are_refused_at_once_if_they_do_not_exist) {
  const Folder folder;
  const Running server(folder / "project");
  const auto code = [&](const std::string& mesh, const std::string& footprints, const Json& reading = Json::object()) {
    const Json asked{{"meshes", {mesh}}, {"footprints", footprints}, {"reading", reading}};
    return server.post("/api/project/inputs", asked).code();
  };
  const auto footprints = hall + "footprints.geojson";
  EXPECT_EQ(code("/vsizip/" + (folder / "none.zip").string() + "/a.obj", footprints), "file-missing");
  EXPECT_EQ(code("/vsinone/a.obj", footprints), "file-missing");
  EXPECT_EQ(code(hall + "mesh.off", "/vsizip/" + (folder / "none.zip").string()), "file-missing");
  EXPECT_EQ(code(hall + "mesh.off", footprints, {{"ingest.terrain", (folder / "none.tif").string()}}), "file-missing");
  const auto database = std::string("PG:host=127.0.0.1 port=9 password=") + password;
  EXPECT_EQ(code(database, footprints), "server-input");
  EXPECT_EQ(code(hall + "mesh.off", footprints, {{"ingest.terrain", database}}), "server-input");
  const auto import = server.post("/api/runs/import", {{"path", database}});
  EXPECT_EQ(import.status, 400);
  EXPECT_THAT(import.text, Not(HasSubstr(password)));
  EXPECT_TRUE(server.get("/api/project").json()["inputs"].is_null());
  EXPECT_THAT(all_told(server, folder / "project"), Not(HasSubstr(password)));
}

TEST(Inputs, in_an_unreachable_database_are_reported_without_the_password) {
  const Folder folder;
  const Running server(folder / "project");
  const auto name = std::string("PG:host=127.0.0.1 port=9 dbname=a password=") + password;
  const auto heard = heard_of(server, [&] {
    const auto job = server.post("/api/project/inputs", {{"meshes", {hall + "mesh.off"}}, {"footprints", name}});
    ASSERT_EQ(job.status, 200) << job.text;
    EXPECT_THAT(job.text, Not(HasSubstr(password)));
    server.settle();
  });
  EXPECT_THAT(heard, HasSubstr("password=***"));
  EXPECT_THAT(heard, Not(HasSubstr(password)));
  const auto told = server.get("/api/jobs").json()["jobs"][0];
  EXPECT_EQ(told["state"], "failed");
  EXPECT_EQ(told["failure"]["code"], "file-read") << told;
  EXPECT_EQ(told["failure"]["subject"], "PG:host=127.0.0.1 port=9 dbname=a password=***");
  EXPECT_THAT(all_told(server, folder / "project"), Not(HasSubstr(password)));
}

class FromDatabase : public ingest::test::Database {};

TEST_F(FromDatabase, stores_no_password) {
  sql("CREATE EXTENSION postgis; CREATE TABLE houses (gid serial PRIMARY KEY, geom geometry(Polygon, 28992));"
      "INSERT INTO houses (geom) VALUES (ST_MakeEnvelope(84000, 447000, 84010, 447010, 28992));");
  file("field.obj", "v 83900 446900 0\nv 84100 446900 0\nv 84100 447100 0\nv 83900 447100 0\nf 1 2 3 4\n");
  const auto mesh = at("field.obj").string(), name = address(std::string(" password=") + password);
  const auto project = at("project");
  {
    const Running server(project);
    const auto ask = [&](const std::string& footprints) {
      return server.post("/api/project/inputs", {{"meshes", {mesh}}, {"footprints", footprints}});
    };
    const auto heard = heard_of(server, [&] {
      ASSERT_EQ(ask(name).status, 200);
      server.settle();
    });
    EXPECT_THAT(heard, HasSubstr("password=***"));
    EXPECT_THAT(heard, Not(HasSubstr(password)));
    const auto inputs = inputs_of(server);
    EXPECT_EQ(inputs["given"]["footprints"], address(" password=***"));
    ASSERT_EQ(inputs["footprints"].size(), 1U) << inputs;
    EXPECT_EQ(inputs["footprints"][0]["path"], address(" password=***"));
    EXPECT_FALSE(some_changed(inputs));
    // The name as it was shown is enough to read the inputs again.
    ASSERT_EQ(ask(address(" password=***")).status, 200);
    EXPECT_EQ(inputs_of(server)["given"]["footprints"], address(" password=***"));
    const auto run = server.reconstruct();
    EXPECT_EQ(server.post("/api/runs/" + run + "/export", {{"overwrite", false}}).status, 200);
    for (const auto& same : {address(), name}) {
      EXPECT_EQ(ask(same).status, 200) << "the password does not change the inputs";
      server.settle();
    }
    EXPECT_THAT(all_told(server, project), Not(HasSubstr(password)));
  }
  const Running again(project);
  EXPECT_EQ(inputs_of(again)["given"]["footprints"], address()) << "no password is stored";
  EXPECT_EQ(again.get("/api/scene").json()["footprints"].size(), 1U);
}

}  // namespace
}  // namespace mansard::server
