// Edits: previews, many edits, edits from several pages, undo, and durability of every answered edit.
#include <gmock/gmock.h>

#include <mutex>
#include <random>

#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

/// Gables side by side along x, each 8 m wide and 10 m deep, with a wall between; footprints "a", "b", ….
void put_terrace(const Folder& folder, int houses) {
  std::string vertices, faces, features;
  int first = 1;
  const auto quad = [&](std::initializer_list<std::array<double, 3>> corners) {
    faces += "f";
    for (const auto& [x, y, z] : corners) {
      vertices += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
      faces += " " + std::to_string(first++);
    }
    faces += "\n";
  };
  const double width = 8.0 * houses;
  quad({{-20, -20, 0}, {width + 20, -20, 0}, {width + 20, 30, 0}, {-20, 30, 0}});
  quad({{0, 0, 0}, {width, 0, 0}, {width, 0, 6}, {0, 0, 6}});
  quad({{width, 10, 0}, {0, 10, 0}, {0, 10, 6}, {width, 10, 6}});
  quad({{0, 0, 6}, {width, 0, 6}, {width, 5, 10}, {0, 5, 10}});
  quad({{width, 10, 6}, {0, 10, 6}, {0, 5, 10}, {width, 5, 10}});
  for (const double x : {0.0, width}) {
    quad({{x, 0, 0}, {x, 10, 0}, {x, 10, 6}, {x, 0, 6}});
    quad({{x, 0, 6}, {x, 10, 6}, {x, 5, 10}});
  }
  for (int h = 0; h < houses; ++h) {
    const auto from = std::to_string(8 * h), to = std::to_string(8 * h + 8);
    features += std::string(h == 0 ? "" : ",") + R"({"type":"Feature","properties":{"id":")" +
                static_cast<char>('a' + h) + R"("},"geometry":{"type":"Polygon","coordinates":[[[)" + from + ",0],[" +
                to + ",0],[" + to + ",10],[" + from + ",10],[" + from + ",0]]]}}";
  }
  write(folder / "terrace.obj", vertices + faces);
  write(
      folder / "terrace.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}},"features":[)" +
          features + "]}");
}

class Terrace : public testing::Test {
 protected:
  void SetUp() override {
    put_terrace(folder_, 3);
    start();
    ASSERT_EQ(server_
                  ->post("/api/project/inputs", {{"meshes", {(folder_ / "terrace.obj").string()}},
                                                 {"footprints", (folder_ / "terrace.geojson").string()}})
                  .status,
              200);
    server_->settle();
    ASSERT_EQ(server_->reconstruct(), "run-1");
  }
  void start() { server_ = std::make_unique<Running>(folder_ / "project"); }
  [[nodiscard]] auto building(std::size_t number) const -> Json {
    return server_->buildings("run-1")["buildings"][number];
  }
  [[nodiscard]] auto send(const Json& edit) const -> Reply { return server_->post("/api/runs/run-1/edits", edit); }

  Folder folder_;
  std::unique_ptr<Running> server_;
};

TEST_F(Terrace, previews_without_writing) {
  const auto before = building(0);
  ASSERT_EQ(before["parts"].size(), 1U) << before.dump();
  const auto edit = lift(before, 1);
  const auto reply = server_->post("/api/runs/run-1/preview", {{"changes", edit["changes"]}});
  ASSERT_EQ(reply.status, 200) << reply.text;
  const auto raised = reply.json()["buildings"][0];
  EXPECT_TRUE(raised["valid"].get<bool>());
  // One metre higher over a base of 80 m².
  EXPECT_NEAR(raised["parts"][0]["volume"].get<double>() - before["parts"][0]["volume"].get<double>(), 80, 2);
  EXPECT_NEAR(raised["mse"].get<double>(), 1, 0.3);
  EXPECT_EQ(building(0), before);
  EXPECT_EQ(server_->get("/api/project").json()["runs"][0]["edits"], 0);
  EXPECT_EQ(server_
                ->post("/api/runs/run-1/preview",
                       {{"changes", Json::array({{{"building", "z"}, {"revision", 0}, {"parts", Json::array()}}})}})
                .code(),
            "edit-building");
}

TEST_F(Terrace, proposes_roofs_that_suit_the_scan_and_says_what_is_worse) {
  const auto before = building(0);
  const auto part = before["parts"][0];
  const auto ask = [&](const std::string& kind, const std::string& name) {
    return server_->post(
        "/api/runs/run-1/roofs",
        {{"kind", kind}, {"parts", Json::array({{{"building", name}, {"part", part["id"]}, {"plan", part["plan"]}}})}});
  };
  for (const auto* kind :
       {"flat", "shed", "gable", "hip", "half-hip", "gablet", "pyramid", "gambrel", "mansard", "fitted"}) {
    const auto reply = ask(kind, before["id"]);
    ASSERT_EQ(reply.status, 200) << reply.text;
    const auto roof = reply.json()["roofs"][0];
    ASSERT_FALSE(roof["plan"].is_null()) << kind << reply.text;
    EXPECT_EQ(roof["plan"]["outer"]["points"], part["plan"]["outer"]["points"]) << kind;
    if (kind == std::string("gable") || kind == std::string("fitted")) {
      EXPECT_LT(roof["mse"].get<double>(), roof["mse_before"].get<double>() + 0.01) << kind;
    }
  }
  EXPECT_EQ(building(0), before);
  EXPECT_EQ(ask("dome", before["id"]).code(), "server-body");
  EXPECT_EQ(ask("gable", "z").code(), "edit-building");
  const auto told = server_->post("/api/runs/run-1/preview", {{"changes", lift(before, 3)["changes"]}});
  const auto text = told.json()["buildings"][0]["diagnostics"].dump();
  EXPECT_THAT(text, HasSubstr("edit-error"));
  EXPECT_THAT(text, HasSubstr("edit-above"));
  EXPECT_TRUE(told.json()["buildings"][0]["valid"].get<bool>());
}

TEST_F(Terrace, gives_edited_buildings_as_they_were_before_their_edits) {
  const auto unedited = [&] { return server_->get("/api/runs/run-1/unedited").json()["buildings"]; };
  EXPECT_TRUE(unedited().empty());
  const auto before = building(0);
  ASSERT_EQ(send(lift(before, 1)).status, 200);
  ASSERT_EQ(send(lift(building(0), 1)).status, 200);
  ASSERT_NE(building(0)["parts"], before["parts"]);
  const auto given = unedited();
  ASSERT_EQ(given.size(), 1U) << given.dump();
  for (const auto* key : {"id", "revision", "valid"}) EXPECT_EQ(given[0][key], before[key]) << key;
  ASSERT_EQ(given[0]["parts"].size(), before["parts"].size());
  for (const auto* key : {"id", "plan", "geometry", "volume"})
    EXPECT_EQ(given[0]["parts"][0][key], before["parts"][0][key]) << key;
  EXPECT_NEAR(given[0]["mse"].get<double>(), before["mse"].get<double>(), 1e-6);
  EXPECT_GT(building(0)["mse"].get<double>(), 1) << "the edits are still there";
  ASSERT_EQ(server_->post("/api/runs/run-1/undo", Json::object()).status, 200);
  ASSERT_EQ(server_->post("/api/runs/run-1/undo", Json::object()).status, 200);
  EXPECT_TRUE(unedited().empty());
}

TEST_F(Terrace, applies_a_valid_edit_and_refuses_an_invalid_one) {
  const auto before = building(0);
  const auto reply = send(lift(before, 1, "up"));
  ASSERT_EQ(reply.status, 200) << reply.text;
  const auto applied = reply.json();
  EXPECT_EQ(applied["history"]["edits"][0], "up");
  EXPECT_EQ(applied["history"]["done"], 1);
  EXPECT_EQ(applied["buildings"][0]["id"], before["id"]);
  EXPECT_EQ(applied["buildings"][0]["edited"], true);
  EXPECT_EQ(building(0), applied["buildings"][0]);

  auto crossed = lift(building(0), 1);
  auto& points = crossed["changes"][0]["parts"][0]["plan"]["outer"]["points"];
  std::swap(points[0], points[1]);
  const auto refused = send(crossed);
  EXPECT_EQ(refused.status, 422) << refused.text;
  EXPECT_EQ(refused.code(), "edit-invalid");
  EXPECT_EQ(building(0), applied["buildings"][0]);

  auto over = lift(building(0), 1);  // overlaps the neighbour
  for (auto& point : over["changes"][0]["parts"][0]["plan"]["outer"]["points"])
    if (point[0].get<double>() > building(1)["parts"][0]["plan"]["outer"]["points"][0][0].get<double>() - 1)
      point[0] = point[0].get<double>() + 3;
  EXPECT_EQ(send(over).code(), "edit-invalid");
}

TEST_F(Terrace, refuses_the_second_of_two_edits_to_one_revision) {
  const auto seen = building(0);
  ASSERT_EQ(send(lift(seen, 1, "first tab")).status, 200);
  const auto late = send(lift(seen, 2, "second tab"));
  EXPECT_EQ(late.status, 409);
  EXPECT_EQ(late.code(), "edit-stale");
  EXPECT_EQ(send(lift(building(0), 2, "second tab again")).status, 200);
  EXPECT_EQ(send(lift(building(1), 1, "another house")).status, 200) << "buildings have revisions of their own";
}

TEST_F(Terrace, undoes_and_redoes_across_restarts) {
  const auto plans = [&] { return building(0)["parts"][0]["plan"]; };
  const auto first = plans();
  EXPECT_EQ(server_->post("/api/runs/run-1/undo", Json::object()).code(), "edit-nothing");
  ASSERT_EQ(send(lift(building(0), 1, "one")).status, 200);
  const auto second = plans();
  ASSERT_EQ(send(lift(building(0), 1, "two")).status, 200);
  const auto third = plans();
  ASSERT_EQ(server_->post("/api/runs/run-1/undo", Json::object()).status, 200);
  EXPECT_EQ(plans(), second);
  server_->interrupt();
  start();
  EXPECT_EQ(server_->get("/api/project").json()["runs"][0]["edits"], 1);
  EXPECT_EQ(plans(), second);
  ASSERT_EQ(server_->call("POST", "/api/runs/run-1/undo").status, 200);
  EXPECT_EQ(plans(), first);
  EXPECT_EQ(building(0)["edited"], false);
  server_->interrupt();
  start();
  EXPECT_EQ(plans(), first);
  for (const auto& expected : {second, third}) {
    ASSERT_EQ(server_->post("/api/runs/run-1/redo", Json::object()).status, 200);
    EXPECT_EQ(plans(), expected);
  }
  EXPECT_EQ(server_->post("/api/runs/run-1/redo", Json::object()).code(), "edit-nothing");
  const auto history = server_->buildings("run-1")["history"];
  EXPECT_EQ(history["edits"], Json::array({"one", "two"}));
  EXPECT_EQ(history["done"], 2);
}

TEST_F(Terrace, splits_and_merges) {
  const auto before = building(0);
  const auto id = before["id"].get<std::string>();
  // A line through the middle, wherever the origin is.
  auto least = before["parts"][0]["plan"]["outer"]["points"][0], most = least;
  for (const auto& p : before["parts"][0]["plan"]["outer"]["points"])
    for (const std::size_t c : {0U, 1U}) {
      least[c] = std::min(least[c].get<double>(), p[c].get<double>());
      most[c] = std::max(most[c].get<double>(), p[c].get<double>());
    }
  const double middle = (least[1].get<double>() + most[1].get<double>()) / 2;
  const Json across = Json::array(
      {Json::array({least[0].get<double>() - 1, middle}), Json::array({most[0].get<double>() + 1, middle})});
  const auto proposed =
      server_->post("/api/runs/run-1/split", {{"building", id}, {"part", before["parts"][0]["id"]}, {"line", across}});
  ASSERT_EQ(proposed.status, 200) << proposed.text;
  EXPECT_EQ(building(0), before) << "a proposal changes nothing";
  const auto split = send({{"what", "split"}, {"changes", proposed.json()["changes"]}});
  ASSERT_EQ(split.status, 200) << split.text;
  const auto halves = building(0)["parts"];
  ASSERT_EQ(halves.size(), 2U);
  const auto merged =
      server_->post("/api/runs/run-1/merge", {{"parts", Json::array({{{"building", id}, {"part", halves[0]["id"]}},
                                                                     {{"building", id}, {"part", halves[1]["id"]}}})}});
  ASSERT_EQ(merged.status, 200) << merged.text;
  ASSERT_EQ(send({{"what", "merge"}, {"changes", merged.json()["changes"]}}).status, 200);
  EXPECT_EQ(building(0)["parts"].size(), 1U);

  // Two buildings: the second loses its part.
  const auto other = building(1);
  const auto both =
      server_->post("/api/runs/run-1/merge",
                    {{"parts", Json::array({{{"building", id}, {"part", building(0)["parts"][0]["id"]}},
                                            {{"building", other["id"]}, {"part", other["parts"][0]["id"]}}})}});
  ASSERT_EQ(both.status, 200) << both.text;
  EXPECT_EQ(both.json()["changes"].size(), 2U);
  ASSERT_EQ(send({{"what", "merge"}, {"changes", both.json()["changes"]}}).status, 200);
  EXPECT_TRUE(building(1)["parts"].empty());
  ASSERT_EQ(server_->post("/api/runs/run-1/undo", Json::object()).status, 200);
  EXPECT_EQ(building(1)["parts"].size(), 1U);
  EXPECT_EQ(server_->post("/api/runs/run-1/split", {{"building", id}, {"part", "none"}, {"line", across}}).code(),
            "edit-part");
}

TEST_F(Terrace, sends_every_edit_to_every_page_with_the_id_of_its_client) {
  std::string heard;
  std::mutex mutex;
  std::atomic<bool> listening{false}, enough{false};
  std::thread page([&] {
    httplib::Client client("127.0.0.1", server_->port());
    client.set_read_timeout(60);
    (void)client.Get(
        "/api/events", server_->headers(), [&](const httplib::Response&) { return listening = true; },
        [&](const char* data, std::size_t length) {
          const std::scoped_lock lock(mutex);
          heard.append(data, length);
          return !enough;
        });
  });
  while (!listening) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  auto headers = server_->headers();
  headers.emplace("X-Client", "tab-7");
  ASSERT_EQ(server_->call("POST", "/api/runs/run-1/edits", lift(building(0), 1, "told").dump(), headers).status, 200);
  const auto has = [&](const char* text) {
    const std::scoped_lock lock(mutex);
    return heard.find(text) != std::string::npos;
  };
  for (int i = 0; i < 3000 && !has("\"told\""); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(has(R"("type":"buildings")"));
  EXPECT_TRUE(has(R"("client":"tab-7")"));
  EXPECT_TRUE(has("\"told\""));
  enough = true;
  server_->kill();
  page.join();
}

TEST_F(Terrace, applies_a_thousand_edits_from_four_pages_without_losing_one) {
  std::atomic<int> accepted{0}, stale{0}, other{0};
  std::vector<std::thread> pages;
  for (int p = 0; p < 4; ++p)
    pages.emplace_back([&, p] {
      auto seen = building(static_cast<std::size_t>(p % 3));
      for (int i = 0; i < 250;) {
        const auto reply =
            send(lift(seen, i % 2 == 0 ? 0.1 : -0.1, "page " + std::to_string(p) + " edit " + std::to_string(i)));
        if (reply.status == 200) {
          ++accepted;
          ++i;
          const auto answer = reply.json();
          for (const auto& changed : answer["buildings"])
            if (changed["id"] == seen["id"]) seen = changed;
        } else if (reply.code() == "edit-stale") {
          ++stale;
          seen = building(static_cast<std::size_t>(p % 3));
        } else {
          ++other;
          ADD_FAILURE() << reply.text;
          return;
        }
      }
    });
  for (auto& page : pages) page.join();
  EXPECT_EQ(accepted, 1000);
  const auto before = server_->buildings("run-1");
  EXPECT_EQ(before["history"]["done"], 1000);
  EXPECT_EQ(before["history"]["edits"].size(), 1000U);
  server_->kill();
  start();
  server_->settle();
  auto after = server_->buildings("run-1");
  EXPECT_EQ(after["history"], before["history"]);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_EQ(after["buildings"][b]["revision"], before["buildings"][b]["revision"]);
    EXPECT_EQ(after["buildings"][b]["parts"][0]["plan"], before["buildings"][b]["parts"][0]["plan"]);
  }
}

/// Every edit that was answered with 200 before the kill exists afterwards; the journal has no edits that were not
/// sent.
TEST_F(Terrace, keeps_every_acknowledged_edit_however_it_is_killed) {
  const auto seed = static_cast<unsigned>(std::chrono::steady_clock::now().time_since_epoch().count());
  std::mt19937 random(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  int acknowledged = 0;
  Json last = building(0);
  for (int round = 0; round < 8; ++round) {
    const auto delay = std::chrono::microseconds(random() % 150'000);
    std::thread killer([&, process = server_->process()] {
      std::this_thread::sleep_for(delay);
      ::kill(process, SIGKILL);
    });
    for (int i = 0;; ++i) {
      const auto reply = send(lift(last, i % 2 == 0 ? 0.1 : -0.1, "edit " + std::to_string(acknowledged)));
      if (reply.status != 200) break;
      ++acknowledged;
      const auto answer = reply.json();
      for (const auto& changed : answer["buildings"])
        if (changed["id"] == last["id"]) last = changed;
    }
    killer.join();
    server_->wait();
    start();
    const auto now = server_->buildings("run-1");
    const auto done = now["history"]["done"].get<int>();
    EXPECT_GE(done, acknowledged);
    EXPECT_LE(done, acknowledged + 1) << "one may have been written but not answered";
    for (int i = 0; i < acknowledged; ++i)
      EXPECT_EQ(now["history"]["edits"][static_cast<std::size_t>(i)], "edit " + std::to_string(i));
    EXPECT_EQ(now["buildings"][0]["revision"].get<int>(), done);
    if (done == acknowledged) {
      EXPECT_EQ(now["buildings"][0]["parts"][0]["plan"], last["parts"][0]["plan"]);
    }
    acknowledged = done;
    last = now["buildings"][0];
  }
  EXPECT_GT(acknowledged, 0);
}

TEST_F(Terrace, drops_an_incomplete_last_line_of_the_journal) {
  ASSERT_EQ(send(lift(building(0), 1, "whole")).status, 200);
  server_->kill();
  const auto journal = folder_ / "project/runs/run-1/journal.jsonl";
  std::ofstream(journal, std::ios::app) << R"({"what":"torn","chan)";
  start();
  EXPECT_EQ(server_->buildings("run-1")["history"]["edits"], Json::array({"whole"}));
  ASSERT_EQ(send(lift(building(0), 1, "next")).status, 200);
  server_->kill();
  EXPECT_THAT(read(journal), testing::Not(HasSubstr("torn")));
  start();
  EXPECT_EQ(server_->buildings("run-1")["history"]["edits"], Json::array({"whole", "next"}));
}

TEST_F(Terrace, reports_the_line_of_a_broken_journal) {
  ASSERT_EQ(send(lift(building(0), 1)).status, 200);
  server_->kill();
  std::ofstream(folder_ / "project/runs/run-1/journal.jsonl", std::ios::app) << "nonsense\n";
  start();
  const auto reply = server_->get("/api/runs/run-1/buildings");
  EXPECT_EQ(reply.code(), "edit-journal");
  EXPECT_THAT(reply.text, HasSubstr("line 2"));
  EXPECT_EQ(server_->get("/api/status").status, 200);
}

/// The building with its first part scaled about the middle of its plan.
auto shrunk(const Json& building, double by) -> Json {
  Json parts = Json::array();
  for (const auto& part : building["parts"]) parts.push_back({{"id", part["id"]}, {"plan", part["plan"]}});
  auto& points = parts[0]["plan"]["outer"]["points"];
  double x = 0, y = 0;
  for (const auto& p : points) x += p[0].get<double>(), y += p[1].get<double>();
  x /= static_cast<double>(points.size());
  y /= static_cast<double>(points.size());
  for (auto& p : points) p = {x + by * (p[0].get<double>() - x), y + by * (p[1].get<double>() - y)};
  return {
      {"what", "smaller"},
      {"changes", Json::array({{{"building", building["id"]}, {"revision", building["revision"]}, {"parts", parts}}})}};
}

TEST_F(Terrace, errors_are_measured_over_the_footprint_so_that_removing_ground_never_helps) {
  const auto building = server_->buildings("run-1")["buildings"][0];
  const double before = building["mse"];
  const auto preview = server_->post("/api/runs/run-1/preview", {{"changes", shrunk(building, 0.3)["changes"]}});
  ASSERT_EQ(preview.status, 200) << preview.text;
  EXPECT_GT(preview.json()["buildings"][0]["mse"].get<double>(), before + 1) << "metres of roof are missing";
  const auto answer = server_->post("/api/runs/run-1/edits", shrunk(building, 0.3));
  ASSERT_EQ(answer.status, 200) << answer.text;
  EXPECT_GT(answer.json()["buildings"][0]["mse"].get<double>(), before + 1);
}

TEST_F(Terrace, the_scores_and_error_maps_of_a_run_follow_its_edits) {
  const auto map_of = [&] {
    const auto maps = server_->get("/api/runs/run-1/error").json()["maps"];
    return server_->get("/api/runs/run-1/error/" + maps[0]["block"].get<std::string>()).text;
  };
  const auto first = server_->get("/api/project").json()["runs"][0]["scores"];
  const auto map = map_of();
  auto now = server_->get("/api/runs/run-1/scores").json();
  EXPECT_EQ(now["edits"], 0);
  EXPECT_EQ(now["scores"], first);
  const auto building = server_->buildings("run-1")["buildings"][0];
  ASSERT_EQ(server_->post("/api/runs/run-1/edits", lift(building, 2)).status, 200);
  now = server_->get("/api/runs/run-1/scores").json();
  EXPECT_EQ(now["edits"], 1);
  // A third of the ground is 2 m too high: 4 m² there.
  EXPECT_NEAR(now["scores"]["footprint_mse"].get<double>() - first["footprint_mse"].get<double>(), 4.0 / 3, 0.3);
  EXPECT_NE(map_of(), map);
  EXPECT_EQ(map_of().size(), map.size());
  ASSERT_EQ(server_->call("POST", "/api/runs/run-1/undo", "{}").status, 200);
  EXPECT_EQ(server_->get("/api/runs/run-1/scores").json()["scores"], first);
  EXPECT_EQ(map_of(), map);
}

TEST_F(Terrace, edits_are_carried_over_to_another_run_where_they_fit) {
  ASSERT_EQ(server_->reconstruct(), "run-2");
  const auto buildings = server_->buildings("run-1")["buildings"];
  ASSERT_EQ(server_->post("/api/runs/run-1/edits", lift(buildings[1], 1)).status, 200);
  ASSERT_EQ(server_->post("/api/runs/run-1/edits", shrunk(buildings[2], 0.5)).status, 200);
  const auto answer = server_->post("/api/runs/run-2/edits/carry-over", {{"from", "run-1"}});
  ASSERT_EQ(answer.status, 200) << answer.text;
  EXPECT_EQ(answer.json()["carried"].size(), 2U) << answer.text;
  EXPECT_TRUE(answer.json()["refused"].empty()) << answer.text;
  const auto from = server_->buildings("run-1")["buildings"], to = server_->buildings("run-2")["buildings"];
  for (std::size_t b = 0; b < from.size(); ++b)
    for (std::size_t p = 0; p < from[b]["parts"].size(); ++p)
      EXPECT_EQ(from[b]["parts"][p]["plan"], to[b]["parts"][p]["plan"]) << b;
  EXPECT_EQ(server_->post("/api/runs/run-2/edits/carry-over", {{"from", "run-2"}}).status, 400);
  EXPECT_EQ(server_->post("/api/runs/run-2/edits/carry-over", {{"from", "run-9"}}).status, 404);
}

TEST_F(Terrace, edits_that_do_not_fit_another_run_are_named_and_left_out) {
  ASSERT_EQ(server_->reconstruct(), "run-2");
  const auto first = server_->buildings("run-1")["buildings"];
  ASSERT_EQ(server_->post("/api/runs/run-1/edits", shrunk(first[0], 0.5)).status, 200);
  const auto small = server_->buildings("run-1")["buildings"][0];
  ASSERT_EQ(server_->post("/api/runs/run-1/edits", shrunk(small, 1.9)).status, 200) << "almost its old size";
  // In the other run the neighbour has taken the ground.
  const auto second = server_->buildings("run-2")["buildings"];
  ASSERT_EQ(server_->post("/api/runs/run-2/edits", shrunk(second[0], 0.2)).status, 200);
  auto wide = shrunk(second[1], 1.0);
  auto& points = wide["changes"][0]["parts"][0]["plan"]["outer"]["points"];
  double west = points[0][0];
  for (const auto& p : points) west = std::min(west, p[0].get<double>());
  for (auto& p : points)
    if (p[0].get<double>() < west + 1) p[0] = p[0].get<double>() - 2;
  const auto taken = server_->post("/api/runs/run-2/edits", wide);
  ASSERT_EQ(taken.status, 200) << taken.text;
  const auto answer = server_->post("/api/runs/run-2/edits/carry-over", {{"from", "run-1"}});
  ASSERT_EQ(answer.status, 200) << answer.text;
  EXPECT_TRUE(answer.json()["carried"].empty()) << answer.text;
  ASSERT_EQ(answer.json()["refused"].size(), 1U) << answer.text;
  EXPECT_EQ(answer.json()["refused"][0]["subject"], "a");
}

TEST_F(Terrace, files_that_name_each_other_are_downloaded_together_under_their_names) {
  const auto reply = server_->get("/api/runs/run-1/export/model.obj.zip");
  ASSERT_EQ(reply.status, 200) << reply.text;
  write(folder_ / "both.zip", reply.text);
  const auto unpack =
      "/usr/bin/python3 -m zipfile -e '" + (folder_ / "both.zip").string() + "' '" + (folder_ / "both").string() + "'";
  ASSERT_EQ(std::system(unpack.c_str()), 0);
  const auto text = read(folder_ / "both/model.obj");
  const auto at = text.find("mtllib ");
  ASSERT_NE(at, std::string::npos);
  const auto material = text.substr(at + 7, text.find_first_of("\r\n", at) - at - 7);
  EXPECT_TRUE(fs::exists(folder_ / "both" / material)) << material;
}

TEST_F(Terrace, models_that_were_edited_exported_and_opened_again_keep_their_mark) {
  ASSERT_EQ(server_->post("/api/runs/run-1/edits", lift(building(0), 1)).status, 200);
  for (const std::string name : {"model.city.json", "model.glb", "model.gpkg"}) {
    write(folder_ / name, server_->get("/api/runs/run-1/export/" + name).text);
    const auto reply = server_->post("/api/runs/import", {{"path", (folder_ / name).string()}});
    ASSERT_EQ(reply.status, 200) << reply.text;
    server_->settle();
    const auto buildings = server_->buildings(reply.json()["run"])["buildings"];
    ASSERT_EQ(buildings.size(), 3U) << name;
    for (const auto& one : buildings) EXPECT_EQ(one["edited"], one["id"] == "a") << name << " " << one["id"];
  }
}

}  // namespace
}  // namespace mansard::server
