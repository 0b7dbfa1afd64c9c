// The pictures of a scan on its tiles and on models, and the terrain around models.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include "mansard/formats/image.hpp"
#include "server/running.hpp"

namespace mansard::server {
namespace {

/// Numbers of that type in the bytes of an answer, one after the other.
template <class T>
auto numbers(const std::string& bytes, std::size_t from, std::size_t count) -> std::vector<T> {
  std::vector<T> out(count);
  if (from + count * sizeof(T) <= bytes.size()) std::memcpy(out.data(), bytes.data() + from, count * sizeof(T));
  return out;
}

/// The colour at a place of an image, nearest pixel: houses_xyz.glb has the position as colour.
auto place_shown(const model::Pixels& image, double u, double v) -> std::array<double, 3> {
  const auto at = [](double share, std::uint32_t size) {
    return static_cast<std::size_t>(std::clamp(share * size, 0.0, size - 1.0));
  };
  const auto* rgb = &image.rgb[3 * (at(v, image.height) * image.width + at(u, image.width))];
  return {rgb[0] / 5.0, rgb[1] / 10.0, rgb[2] / 25.0};
}

auto away(const std::array<double, 3>& a, const std::array<double, 3>& b) -> double {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

const std::string houses = std::string(MANSARD_DATA) + "/textured/";

class Textures : public testing::Test {
 protected:
  void SetUp() override {
    const Json inputs{{"meshes", {houses + "houses_xyz.glb"}}, {"footprints", houses + "houses_footprints.geojson"}};
    ASSERT_EQ(server_.post("/api/project/inputs", inputs).status, 200);
    server_.settle();
    const auto scene = server_.get("/api/scene").json();
    for (std::size_t i = 0; i < 3; ++i) origin_[i] = scene["origin"][i];
  }
  void read() {
    ASSERT_EQ(server_.post("/api/scene/textures", Json::object()).status, 200);
    server_.settle();
  }
  Folder folder_;
  Running server_{folder_ / "project"};
  std::array<double, 3> origin_{};
};

TEST_F(Textures, of_tiles_show_every_corner_where_it_is) {
  const auto tile = server_.get("/api/scene/tiles").json()["tiles"][0];
  const auto path = "/api/scene/tiles/" + tile["id"].get<std::string>();
  EXPECT_EQ(server_.get(path + "/texture").code(), "server-no-textures") << "they were not asked for";
  read();
  const auto mesh = server_.get(path).text, texture = server_.get(path + "/texture").text;
  const auto counts = numbers<std::uint32_t>(mesh, 0, 2);
  const auto positions = numbers<float>(mesh, 8, std::size_t{3} * counts[0]);
  const auto corners = numbers<std::uint32_t>(mesh, 8 + std::size_t{12} * counts[0], std::size_t{3} * counts[1]);
  ASSERT_EQ(numbers<std::uint32_t>(texture, 0, 1)[0], counts[1]);
  const auto uv = numbers<std::uint16_t>(texture, 4, std::size_t{6} * counts[1]);
  const auto image = formats::decode_image(std::string_view(texture).substr(4 + std::size_t{12} * counts[1]), "tile");
  ASSERT_TRUE(image);
  std::size_t right = 0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    std::array<double, 3> place{};
    for (std::size_t i = 0; i < 3; ++i)
      place[i] = positions[3 * corners[c] + i] + tile["centre"][i].get<double>() + origin_[i];
    // 8 bits are 0.2 m in x.
    if (away(place_shown(*image, uv[2 * c] / 65535.0, uv[2 * c + 1] / 65535.0), place) < 0.3) ++right;
  }
  EXPECT_GE(static_cast<double>(right), 0.97 * static_cast<double>(corners.size()))
      << right << " of " << corners.size();
  EXPECT_EQ(server_.get("/api/scene/tiles/9-9-9/texture").code(), "server-unknown");
}

TEST_F(Textures, of_buildings_follow_edits) {
  ASSERT_EQ(server_.post("/api/runs", Json::object()).status, 200);
  read();
  const auto check = [&](const Json& building) {
    const auto bytes = server_.get("/api/runs/run-1/textures/" + building["id"].get<std::string>()).text;
    const auto head = numbers<std::uint32_t>(bytes, 0, 2);
    EXPECT_EQ(head[0], building["revision"]);
    const auto image = formats::decode_image(std::string_view(bytes).substr(8 + std::size_t{64} * head[1]), "building");
    ASSERT_TRUE(image);
    std::size_t first = 0, all = 0, right = 0;
    for (const auto& part : building["parts"]) {
      const auto& geometry = part["geometry"];
      for (std::size_t t = 0; t < geometry["face_of"].size(); ++t) {
        const std::size_t face = geometry["face_of"][t];
        const auto kind = geometry["faces"][face]["class"];
        if (kind != "roof" && kind != "wall") continue;
        std::array<double, 3> middle{};
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t i = 0; i < 3; ++i)
            middle[i] +=
                geometry["positions"][3 * geometry["triangles"][3 * t + c].get<std::size_t>() + i].get<double>() / 3;
        const auto frame = numbers<double>(bytes, 8 + 64 * (first + face), 8);
        std::array<double, 2> uv{};
        for (std::size_t a = 0; a < 2; ++a)
          uv[a] =
              frame[4 * a] * middle[0] + frame[4 * a + 1] * middle[1] + frame[4 * a + 2] * middle[2] + frame[4 * a + 3];
        for (std::size_t i = 0; i < 3; ++i) middle[i] += origin_[i];
        ++all;
        if (away(place_shown(*image, uv[0], uv[1]), middle) < 0.6) ++right;
      }
      first += geometry["faces"].size();
    }
    EXPECT_EQ(first, head[1]);
    EXPECT_GT(all, 5U);
    EXPECT_GE(10 * right, 9 * all) << right << " of " << all;
  };
  const auto before = server_.buildings("run-1")["buildings"];
  for (const auto& building : before) check(building);
  ASSERT_EQ(server_.post("/api/runs/run-1/edits", lift(before[0], 0.2)).status, 200);
  check(server_.buildings("run-1")["buildings"][0]);
  EXPECT_EQ(server_.get("/api/runs/run-1/textures/none").code(), "edit-building");
}

TEST_F(Textures, are_missing_where_the_scan_has_none) {
  Running server(folder_ / "plain");
  const std::string hall = std::string(MANSARD_DATA) + "/hall/";
  const Json inputs{{"meshes", {hall + "mesh.off"}}, {"footprints", hall + "footprints.geojson"}};
  ASSERT_EQ(server.post("/api/project/inputs", inputs).status, 200);
  server.settle();
  ASSERT_EQ(server.post("/api/scene/textures", Json::object()).status, 200);
  server.settle();
  const auto job = server.get("/api/jobs").json()["jobs"].back();
  EXPECT_EQ(job["state"], "failed");
  EXPECT_EQ(job["failure"]["code"], "server-no-textures");
}

TEST_F(Textures, of_tiles_have_the_colours_of_the_points_of_a_cloud) {
  std::string points;
  std::size_t count = 0;
  for (double y = 0.125; y < 30; y += 0.25)
    for (double x = 0.125; x < 30; x += 0.25, ++count) {
      const double z = x > 10 && x < 20 && y > 10 && y < 20 ? 5 : 0;
      points += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
                (x < 15 ? " 255 10 10\n" : " 10 255 10\n");
    }
  std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count);
  for (const char* name : {"double x", "double y", "double z", "uchar red", "uchar green", "uchar blue"})
    ply += std::string("\nproperty ") + name;
  std::ofstream(folder_ / "cloud.ply") << ply << "\nend_header\n" << points;
  std::ofstream(folder_ / "one.geojson")
      << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"id":"a"},"geometry":)"
      << R"({"type":"Polygon","coordinates":[[[10,10],[20,10],[20,20],[10,20],[10,10]]]}}]})";
  Running server(folder_ / "cloud");
  const Json inputs{{"meshes", {(folder_ / "cloud.ply").string()}},
                    {"footprints", (folder_ / "one.geojson").string()},
                    {"reading", {{"ingest.crs", "local"}}}};
  ASSERT_EQ(server.post("/api/project/inputs", inputs).status, 200);
  server.settle();
  const auto origin = server.get("/api/scene").json()["origin"];
  ASSERT_EQ(server.post("/api/scene/textures", Json::object()).status, 200);
  server.settle();
  const auto tile = server.get("/api/scene/tiles").json()["tiles"][0];
  const auto path = "/api/scene/tiles/" + tile["id"].get<std::string>();
  const auto mesh = server.get(path).text, texture = server.get(path + "/texture").text;
  const auto counts = numbers<std::uint32_t>(mesh, 0, 2);
  const auto positions = numbers<float>(mesh, 8, std::size_t{3} * counts[0]);
  const auto corners = numbers<std::uint32_t>(mesh, 8 + std::size_t{12} * counts[0], std::size_t{3} * counts[1]);
  ASSERT_GT(corners.size(), 100U);
  ASSERT_EQ(numbers<std::uint32_t>(texture, 0, 1)[0], counts[1]);
  const auto uv = numbers<std::uint16_t>(texture, 4, std::size_t{6} * counts[1]);
  const auto image = formats::decode_image(std::string_view(texture).substr(4 + std::size_t{12} * counts[1]), "tile");
  ASSERT_TRUE(image);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const double x = positions[3 * corners[c]] + tile["centre"][0].get<double>() + origin[0].get<double>();
    if (std::abs(x - 15) < 1) continue;
    const auto shown = place_shown(*image, uv[2 * c] / 65535.0, uv[2 * c + 1] / 65535.0);
    EXPECT_EQ(x<15, shown[0] * 5> shown[1] * 10) << x;
  }
}

TEST_F(Textures, and_the_terrain_is_around_the_models_as_they_are) {
  EXPECT_EQ(server_.get("/api/runs/run-1/terrain").code(), "server-unknown");
  ASSERT_EQ(server_.post("/api/runs", Json::object()).status, 200);
  server_.settle();
  const auto bytes = server_.get("/api/runs/run-1/terrain").text;
  const auto counts = numbers<std::uint32_t>(bytes, 24, 2);
  ASSERT_EQ(bytes.size(), 32 + std::size_t{12} * (counts[0] + counts[1]));
  EXPECT_GT(counts[1], 10U);
  // The ground of the houses is at 0.
  const auto centre = numbers<double>(bytes, 0, 3);
  const auto positions = numbers<float>(bytes, 32, std::size_t{3} * counts[0]);
  for (std::size_t v = 0; v < counts[0]; ++v) EXPECT_NEAR(positions[3 * v + 2] + centre[2] + origin_[2], 0, 0.3);
  for (const std::string file : {"terrain.city.json", "terrain.glb", "terrain.stl"})
    EXPECT_EQ(server_.get("/api/runs/run-1/export/" + file).status, 200) << file;
  EXPECT_THAT(server_.get("/api/runs/run-1/export/terrain.city.json").text, testing::HasSubstr("TINRelief"));
  EXPECT_EQ(server_.get("/api/runs/run-1/export/terrain.obj").code(), "server-unknown");
}

}  // namespace
}  // namespace mansard::server
