// Large runs: a list of all buildings, and models by tile.
#include <gmock/gmock.h>

#include <map>
#include <set>

#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::ElementsAre;

/// Pairs of houses that share a wall, every 40 m, in rows of 100 pairs.
auto pairs(const fs::path& path, int houses) -> std::string {
  std::string text =
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)";
  for (int i = 0; i < houses; ++i) {
    const int x = 85'000 + i / 2 % 100 * 40 + i % 2 * 10, y = 447'000 + i / 200 * 40, w = 10, d = i % 2 == 0 ? 8 : 7;
    const auto at = [](int px, int py) { return "[" + std::to_string(px) + "," + std::to_string(py) + "]"; };
    text += (i == 0 ? "" : ",") + std::string(R"({"type":"Feature","properties":{"id":"b)") + std::to_string(i) +
            R"(","year":)" + std::to_string(1900 + i % 100) + R"(,"street":")" + (i % 7 == 0 ? "Canal" : "Market") +
            R"("},"geometry":{"type":"Polygon","coordinates":[[)" + at(x, y) + "," + at(x + w, y) + "," +
            at(x + w, y + d) + "," + at(x, y + d) + "," + at(x, y) + "]]}}";
  }
  write(path, text + "]}");
  return path.string();
}

/// A project with the models of so many houses as its first run.
void import_houses(const Folder& folder, const Running& server, int houses, const std::string& name) {
  const auto model = (folder / (name + ".json")).string();
  const auto command = std::string(MANSARD_BINARY) + " extrude -q " + pairs(folder / (name + ".geojson"), houses) +
                       " --profile '0,0 0,6 4,9' -o " + model + " >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  ASSERT_EQ(server.post("/api/runs/import", {{"path", model}}).status, 200);
  server.settle();
}

TEST(Large, list_tiles_and_search_say_the_same_as_the_buildings_of_a_small_run) {
  const Folder folder;
  const Running server(folder / "project");
  import_houses(folder, server, 210, "small");
  const auto all = server.get("/api/runs/run-1/buildings").json();
  const auto list = server.get("/api/runs/run-1/list").json();
  ASSERT_EQ(list["ids"].size(), 210U);
  EXPECT_EQ(list["history"], all["history"]);
  std::map<std::string, Json> by_id;
  std::set<std::string> tiles;
  for (std::size_t i = 0; i < all["buildings"].size(); ++i) {
    const auto& building = all["buildings"][i];
    by_id[building["id"]] = building;
    EXPECT_EQ(list["ids"][i], building["id"]);
    EXPECT_EQ(list["blocks"][i], building["block"]);
    EXPECT_EQ(list["outcomes"][i], building["outcome"]);
    EXPECT_EQ(list["edited"][i], building["edited"]);
    EXPECT_NEAR(list["volumes"][i].get<double>(), building["parts"][0]["volume"].get<double>(), 0.01);
    const auto& shape = list["shapes"][i][0];
    double low = 1e9, high = -1e9, south = 1e9, north = -1e9;
    for (std::size_t k = 2; k < shape.size(); k += 2) {
      low = std::min(low, shape[k].get<double>() / 100), high = std::max(high, shape[k].get<double>() / 100);
      south = std::min(south, shape[k + 1].get<double>() / 100),
      north = std::max(north, shape[k + 1].get<double>() / 100);
    }
    EXPECT_EQ(shape[1], 750) << "half of a roof from 6 to 9 m";
    const double size = list["tile_size"];
    tiles.insert(std::to_string(std::llround(std::floor((low + high) / 2 / size))) + "_" +
                 std::to_string(std::llround(std::floor((south + north) / 2 / size))));
  }
  std::size_t found = 0;
  for (const auto& tile : tiles) {
    const auto there = server.get("/api/runs/run-1/tiles/" + tile).json();
    for (const auto& building : there["buildings"]) {
      EXPECT_EQ(building, by_id[building["id"]]);
      ++found;
    }
  }
  EXPECT_EQ(found, 210U);
  const auto ids = [&](const std::string& words) {
    return server.get("/api/runs/run-1/search?words=" + words).json()["ids"].get<std::vector<std::string>>();
  };
  EXPECT_THAT(ids("b209"), ElementsAre("b209"));
  EXPECT_THAT(ids("year%3E1998"), ElementsAre("b99", "b199"));
  EXPECT_THAT(ids("CANAL%20year%3C1908"), ElementsAre("b0", "b7", "b105", "b203"));
  EXPECT_THAT(ids("street%3Dcanal%20b20"), ElementsAre("b203"));
  EXPECT_TRUE(ids("street%3Dcana").empty());
  const auto columns = server.get("/api/runs/run-1/column?attribute=year").json();
  EXPECT_EQ(columns["attribute"]["source"], true);
  ASSERT_EQ(columns["values"].size(), 210U);
  for (std::size_t i = 0; i < 210; ++i) EXPECT_EQ(columns["values"][i], 1900 + i % 100);
  EXPECT_EQ(server.get("/api/runs/run-1/column?attribute=years").status, 404);
}

TEST(Large, models_that_are_made_when_they_are_asked_for_are_those_of_a_small_run) {
  const Folder folder;
  Json few;
  {
    const Running server(folder / "small");
    import_houses(folder, server, 210, "small");
    few = server.get("/api/runs/run-1/buildings").json()["buildings"];
  }
  const Running server(folder / "large");
  import_houses(folder, server, 5'004, "large");
  EXPECT_EQ(server.get("/api/runs/run-1/list").json()["ids"].size(), 5'004U);
  const auto now = [&](std::size_t i) {
    return server.get("/api/runs/run-1/buildings?building=b" + std::to_string(i)).json()["buildings"][0];
  };
  for (const std::size_t i : {0U, 1U, 50U, 199U}) {
    const auto one = now(i);
    // The frames of the two runs differ by whole metres.
    for (const auto* name : {"triangles", "face_of", "faces"})
      EXPECT_EQ(one["parts"][0]["geometry"][name], few[i]["parts"][0]["geometry"][name]) << i;
    for (const auto* name : {"volume", "outcome", "mse", "diagnostics"})
      EXPECT_EQ(one["parts"][0][name], few[i]["parts"][0][name]) << i;
    for (const auto* name : {"revision", "valid", "mse", "block", "outcome", "reasons", "ground", "edited"})
      EXPECT_EQ(one[name], few[i][name]) << i;
  }

  // An edit of one, its attributes, and the list after it; also after the server has been started again.
  auto part = now(50)["parts"][0];
  part["plan"]["cap"] = 7.0;
  const Json changes = {
      {{"building", "b50"}, {"revision", 0}, {"parts", {{{"id", part["id"]}, {"plan", part["plan"]}}}}}};
  ASSERT_EQ(server.post("/api/runs/run-1/edits", {{"what", "cap"}, {"changes", changes}}).status, 200);
  EXPECT_EQ(server.get("/api/runs/run-1/list").json()["edited"][50], true);
  const auto attributes = server.get("/api/runs/run-1/attributes?building=b50").json()["buildings"];
  ASSERT_EQ(attributes.size(), 1U);
  EXPECT_EQ(attributes[0]["id"], "b50");
  EXPECT_EQ(attributes[0]["values"]["ms_edited"], true);
  EXPECT_EQ(attributes[0]["values"]["year"], 1950);
  // What mansard computed is of the model before the edit; what the source says is not.
  const auto column = [&](const std::string& name) {
    return server.get("/api/runs/run-1/column?attribute=" + name).json()["values"];
  };
  const auto heights = column("ms_h_ridge"), years = column("year");
  EXPECT_EQ(heights.size(), 5'004U);
  EXPECT_TRUE(heights[50].is_null());
  EXPECT_EQ(heights[60],
            server.get("/api/runs/run-1/attributes?building=b60").json()["buildings"][0]["values"]["ms_h_ridge"]);
  EXPECT_EQ(years[50], 1950);
  EXPECT_EQ(server.get("/api/runs/run-1/search?words=year%3D1950%20b50").json()["ids"][0], "b50");
  const auto untouched = server.get("/api/runs/run-1/attributes?building=b60").json()["buildings"][0];
  EXPECT_FALSE(untouched["values"].contains("ms_edited") && untouched["values"]["ms_edited"] == true);
}

/// What a page asks for of a large run.
auto shown(const Running& server) -> std::string {
  std::string all;
  for (const auto* path : {"list", "buildings?building=b7", "attributes?building=b7", "column?attribute=ms_h_ridge",
                           "column?attribute=street", "search?words=canal", "search?words=year%3E1998", "tiles/0_0"})
    all += server.get(std::string("/api/runs/run-1/") + path).text + '\n';
  return all;
}

TEST(Large, is_opened_again_with_its_index_and_shows_the_same) {
  const Folder folder;
  const auto run = folder / "project/runs/run-1";
  std::string first;
  {
    const Running server(folder / "project");
    import_houses(folder, server, 5'004, "large");
    first = shown(server);
  }
  const auto index = read(run / "index.bin");
  ASSERT_GT(index.size(), 100'000U);
  const auto again = [&] {
    const Running server(folder / "project");
    return shown(server);
  };
  const auto written = fs::last_write_time(run / "index.bin");
  EXPECT_EQ(again(), first);
  EXPECT_EQ(fs::last_write_time(run / "index.bin"), written) << "it was used as it is";

  // An index that is damaged, cut, of another version, or missing is made again.
  auto damaged = index;
  damaged[damaged.size() / 2] ^= 1;
  auto older = index;
  older.replace(0, 19, "mansard run index 0");
  for (const auto& bytes : {damaged, index.substr(0, index.size() / 2), older, std::string(), index + "x"}) {
    write(run / "index.bin", bytes);
    EXPECT_EQ(again(), first);
    EXPECT_EQ(read(run / "index.bin"), index);
  }
  fs::remove(run / "index.bin");
  EXPECT_EQ(again(), first);
  EXPECT_EQ(read(run / "index.bin"), index);

  // So is one of other plans or another report.
  auto report = read(run / "report.json");
  report.replace(report.find("\"full\"", report.size() / 2), 6,
                 "\"fell\"");  // as long as before, and in the middle of a large file
  write(run / "report.json", report);
  fs::last_write_time(run / "report.json", fs::last_write_time(run / "report.json") + std::chrono::seconds(2));
  const auto changed = again();
  EXPECT_NE(changed, first);
  EXPECT_NE(changed.find("fell"), std::string::npos);
}

TEST(Large, with_files_that_are_at_fault_says_so_as_a_small_run_does) {
  const Folder folder;
  const auto run = folder / "project/runs/run-1";
  {
    const Running server(folder / "project");
    import_houses(folder, server, 5'004, "large");
  }
  const auto plans = read(run / "plans.json"), report = read(run / "report.json");
  const auto why = [&] {
    const Running server(folder / "project");
    return server.get("/api/runs/run-1/list").json()["error"];
  };
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what, text.size() / 2), what.size(), by);
  };
  write(run / "plans.json", replaced(plans, "\"cap\":", "\"cup\":"));
  EXPECT_EQ(why()["code"], "write-plan-key");
  write(run / "plans.json", replaced(plans, "\"id\":\"b3000\"", "\"id\":\"b2999\""));
  EXPECT_EQ(why()["code"], "write-plan-value");
  write(run / "plans.json", plans.substr(0, plans.size() / 2));
  EXPECT_EQ(why()["code"], "write-plan-json");
  write(run / "plans.json", plans);
  write(run / "report.json", replaced(report, "\"block\"", "\"blick\""));
  EXPECT_EQ(why()["code"], "server-project");
  write(run / "report.json", report.substr(0, report.size() - 9));
  EXPECT_EQ(why()["code"], "server-project");
  write(run / "report.json", report);
  EXPECT_TRUE(why().is_null());
  EXPECT_FALSE(fs::exists(run / "index.bin.part"));
}

TEST(Large, edits_undos_decisions_and_exports_are_those_of_a_small_run) {
  const Folder folder;
  const auto edited = [&](const std::string& name, int houses) {
    std::vector<Json> all;
    const Folder own;
    const auto building = [](const Running& server, const std::string& id) {
      return server.get("/api/runs/run-1/buildings?building=" + id).json()["buildings"][0];
    };
    {
      const Running server(own / "project");
      import_houses(folder, server, houses, name);
      for (const auto* id : {"b50", "b51"})
        EXPECT_EQ(server.post("/api/runs/run-1/edits", lift(building(server, id), 1)).status, 200);
      EXPECT_EQ(server.post("/api/runs/run-1/undo", Json::object()).status, 200);
      EXPECT_EQ(
          server.post("/api/runs/run-1/review", {{"building", "b60"}, {"revision", 0}, {"decision", "right"}}).status,
          200);
    }
    const Running server(own / "project");  // started again
    for (const auto* id : {"b49", "b50", "b51", "b60"}) {
      auto one = building(server, id);
      for (const auto* part : {"volume", "mse", "outcome", "diagnostics"}) all.push_back(one["parts"][0][part]);
      for (const auto* value : {"revision", "edited", "block", "outcome", "confidence"}) all.push_back(one[value]);
      auto values =
          server.get(std::string("/api/runs/run-1/attributes?building=") + id).json()["buildings"][0]["values"];
      values.erase("ms_review_time");
      all.push_back(std::move(values));
    }
    all.push_back(server.get("/api/runs/run-1/unedited").json()["buildings"][0]["parts"][0]["plan"]["cap"]);
    all.push_back(server.get("/api/runs/run-1/list").json()["history"]);
    auto review = server.get("/api/runs/run-1/review").json()["decisions"];
    for (auto& one : review) one.erase("time");
    all.push_back(review);
    auto plans = Json::parse(server.get("/api/runs/run-1/export/plans.json").text)["buildings"];
    for (const auto at : {50, 51, 60}) {
      plans[at]["attributes"].erase("ms_review_time");
      all.push_back(plans[at]["attributes"]);
      all.push_back(plans[at]["parts"][0]["plan"]["profiles"]);
      all.push_back(plans[at]["parts"][0]["plan"]["cap"]);
    }
    EXPECT_EQ(plans.size(), static_cast<std::size_t>(houses));
    return all;
  };
  const auto small = edited("small", 210), large = edited("large", 5'004);
  ASSERT_EQ(small.size(), large.size());
  for (std::size_t i = 0; i < small.size(); ++i) EXPECT_EQ(large[i], small[i]) << i;
}

}  // namespace
}  // namespace mansard::server
