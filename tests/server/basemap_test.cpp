// Basemaps of tiles that a server sends.
#include <gmock/gmock.h>

#include <atomic>
#include <cstring>
#include <mutex>
#include <set>

#include "mansard/formats/image.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

using testing::HasSubstr;

/// Sends grey tiles up to a zoom level, and keeps what it was asked for.
class TileServer {
 public:
  explicit TileServer(int finest, int status = 200) {
    model::Pixels grey;
    grey.width = grey.height = 256;
    grey.rgb.assign(3UL * 256 * 256, 90);
    tile_ = formats::encode_image(grey, formats::ImageCodec::png, 90).value();
    http_.Get(R"(/m/(\d+)/(\d+)/(\d+)\.png)", [this, finest, status](const auto& request, auto& response) {
      const std::scoped_lock lock(mutex_);
      asked_.push_back(request.target);
      agents_.insert(request.get_header_value("User-Agent"));
      if (status != 200) response.status = status;
      else if (std::stoi(request.matches[1]) > finest) response.status = 404;
      else response.set_content(tile_, "image/png");
    });
    port_ = http_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { http_.listen_after_bind(); });
    while (!http_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));  // else it is never stopped
  }
  ~TileServer() {
    http_.stop();
    thread_.join();
  }
  TileServer(const TileServer&) = delete;
  auto operator=(const TileServer&) -> TileServer& = delete;
  [[nodiscard]] auto pattern() const -> std::string {
    return "http://127.0.0.1:" + std::to_string(port_) + "/m/{z}/{x}/{y}.png?key=k";
  }
  [[nodiscard]] auto asked() -> std::vector<std::string> {
    const std::scoped_lock lock(mutex_);
    return asked_;
  }
  [[nodiscard]] auto agents() -> std::set<std::string> {
    const std::scoped_lock lock(mutex_);
    return agents_;
  }

 private:
  httplib::Server http_;
  std::thread thread_;
  std::mutex mutex_;
  std::vector<std::string> asked_;
  std::set<std::string> agents_;
  std::string tile_;
  int port_ = 0;
};

/// A box of 12 by 8 m in Delft.
auto model_in(const Folder& folder, const std::string& crs) -> std::string {
  write(folder / "a.geojson",
        R"({"type":"FeatureCollection",)" +
            (crs.empty() ? "" : R"("crs":{"type":"name","properties":{"name":")" + crs + "\"}},") +
            R"("features":[{"type":"Feature","properties":{"id":"a"},"geometry":{"type":"Polygon","coordinates":
            [[[85000,447000],[85012,447000],[85012,447008],[85000,447008],[85000,447000]]]}}]})");
  const auto out = (folder / "model.json").string();
  const auto command = std::string(MANSARD_BINARY) + " extrude -q " + (folder / "a.geojson").string() +
                       " --profile '0,0 0,6 4,9' -o " + out + " >/dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return out;
}

auto with_model(const Running& server, const std::string& model) -> const Running& {
  EXPECT_EQ(server.post("/api/runs/import", {{"path", model}}).status, 200);
  server.settle();
  return server;
}

TEST(Basemap, of_tiles_is_fetched_when_it_is_asked_for_and_then_kept) {
  const Folder folder;
  TileServer tiles(18);
  const Running server(folder / "project", {"--basemap", tiles.pattern(), "--basemap-attribution", "© Somebody"});
  with_model(server, model_in(folder, "EPSG:28992"));
  const auto project = server.get("/api/project").json();
  EXPECT_EQ(project["basemap_attribution"], "© Somebody");
  EXPECT_EQ(project.dump().find("key=k"), std::string::npos);
  EXPECT_THAT(tiles.asked(), testing::IsEmpty()) << "no network before somebody shows the layer";

  const auto map = server.get("/api/runs/run-1/basemap");
  ASSERT_EQ(map.status, 200) << map.text;
  std::array<double, 4> edges{};
  std::memcpy(edges.data(), map.text.data(), sizeof edges);
  const auto origin =
      server.get("/api/runs/run-1/buildings").json()["buildings"][0]["parts"][0]["plan"]["outer"]["points"];
  for (const auto& p : origin) {
    EXPECT_LE(edges[0] + 50, p[0].get<double>());
    EXPECT_LE(edges[1] + 50, p[1].get<double>());
    EXPECT_GE(edges[2] - 50, p[0].get<double>());
    EXPECT_GE(edges[3] - 50, p[1].get<double>());
  }
  EXPECT_LE(edges[2] - edges[0], 200);
  const auto pixels = formats::decode_image(std::string_view(map.text).substr(sizeof edges), "map");
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->rgb.at(pixels->rgb.size() / 2), 90);
  const auto first = tiles.asked();
  EXPECT_LT(first.size(), 20U);
  EXPECT_THAT(first, testing::Contains(HasSubstr("/m/18/")));
  for (const auto& name : first) EXPECT_THAT(name, testing::EndsWith("?key=k"));
  EXPECT_THAT(tiles.agents(), testing::ElementsAre(HasSubstr("mansard")));
  EXPECT_EQ(server.get("/api/runs/run-1/basemap").text, map.text);
  EXPECT_EQ(tiles.asked(), first);
}

TEST(Basemap, of_tiles_says_what_is_wrong_with_their_server) {
  const Folder folder;
  const auto model = model_in(folder, "EPSG:28992");
  const auto refusal = [&](const std::string& pattern) {
    const Running server(folder / "project", {"--basemap", pattern});
    if (server.get("/api/project").json()["runs"].empty()) with_model(server, model);
    const auto reply = server.get("/api/runs/run-1/basemap");
    EXPECT_EQ(reply.status, 409) << reply.text;
    EXPECT_EQ(reply.code(), "ingest-ground-tiles");
    return reply.text;
  };
  TileServer forbids(18, 403), empty(-1);
  EXPECT_THAT(refusal(forbids.pattern()), HasSubstr("403"));
  EXPECT_THAT(refusal(empty.pattern()), HasSubstr("there are no tiles"));
  std::string gone;
  {
    TileServer ended(18);
    gone = ended.pattern();
  }
  EXPECT_THAT(refusal(gone), HasSubstr("does not send"));
  EXPECT_LT(forbids.asked().size(), 3U) << "the first refusal ends it";
}

TEST(Basemap, of_tiles_needs_a_crs_and_a_pattern) {
  const Folder folder;
  TileServer tiles(18);
  {
    const Running server(folder / "project", {"--basemap", tiles.pattern()});
    with_model(server, model_in(folder, ""));
    EXPECT_THAT(server.get("/api/runs/run-1/basemap").text, HasSubstr("no CRS"));
    EXPECT_THAT(tiles.asked(), testing::IsEmpty());
  }
  Running refused(folder / "other", {"--basemap", "https://example.org/map.png"});
  EXPECT_THAT(refused.complaint(), HasSubstr("{z}"));
  EXPECT_EQ(refused.wait(), 3);
}

}  // namespace
}  // namespace mansard::server
