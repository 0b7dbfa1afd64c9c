// Tiny files for the tests of reading, made in a folder that goes away again.
#pragma once

#include <gtest/gtest.h>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::ingest::test {

namespace fs = std::filesystem;

/// A corner of the mesh in file coordinates.
inline auto in_file(const model::Scene& scene, std::size_t v = 0) -> geometry::Point3 {
  const auto& o = scene.frame.origin;
  return scene.mesh.vertices.at(v) +
         geometry::Point3{static_cast<double>(o[0]), static_cast<double>(o[1]), static_cast<double>(o[2])};
}
inline void expect_near(geometry::Point3 a, geometry::Point3 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

class Workshop : public ::testing::Test {
 protected:
  auto at(const std::string& name) const -> fs::path { return folder_ / name; }

  auto file(const std::string& name, std::string_view bytes) const -> fs::path {
    fs::create_directories(at(name).parent_path());
    EXPECT_TRUE(base::write_file(at(name), bytes));
    return at(name);
  }

  /// A level square of two triangles.
  auto ground(double x0 = 0, double y0 = 0, double x1 = 100, double y1 = 100) const -> fs::path {
    const auto v = [](double x, double y) { return "v " + base::to_text(x) + " " + base::to_text(y) + " 0\n"; };
    return file("ground.obj", v(x0, y0) + v(x1, y0) + v(x1, y1) + v(x0, y1) + "f 1 2 3\nf 1 3 4\n");
  }

  /// GeoJSON of polygons given as JSON coordinates ("[[[0,0],[1,0],…]]"), without a crs member.
  auto polygons(const std::vector<std::string>& coordinates, const std::string& crs = "") const -> fs::path {
    std::string all;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      all += std::string(i > 0 ? "," : "") + R"({"type":"Feature","properties":{"id":"b)" + std::to_string(i) +
             R"("},"geometry":{"type":"Polygon","coordinates":)" + coordinates[i] + "}}";
    const std::string member = crs.empty() ? "" : R"("crs":{"type":"name","properties":{"name":")" + crs + R"("}},)";
    return file("footprints.geojson", R"({"type":"FeatureCollection",)" + member + R"("features":[)" + all + "]}");
  }
  auto square(double x = 10, double y = 10, double side = 20) const -> std::string {
    const auto p = [](double a, double b) { return "[" + base::to_text(a) + "," + base::to_text(b) + "]"; };
    return "[[" + p(x, y) + "," + p(x + side, y) + "," + p(x + side, y + side) + "," + p(x, y + side) + "," + p(x, y) +
           "]]";
  }

  static auto read(const std::vector<fs::path>& meshes, const fs::path& footprints, const Options& options = {})
      -> base::Result<model::Scene> {
    return read_scene(meshes, footprints, options);
  }
  /// The mesh alone, over footprints that lie on it.
  auto mesh(const fs::path& path, Options options = {}) const -> base::Result<model::Scene> {
    const auto big = square(-1e5, -1e5, 2e5);
    options.crs = "local";
    return read({path}, polygons({big}), options);
  }
  /// The code of what went wrong, "" for nothing; checks that it is one line with an exit code of its own.
  static auto code(const base::Result<model::Scene>& result) -> std::string {
    if (result) return "";
    EXPECT_EQ(base::to_string(result.error()).find('\n'), std::string::npos);
    EXPECT_FALSE(result.error().message.empty());
    return result.error().code;
  }
  static auto has_warning(const model::Scene& scene, std::string_view code) -> bool {
    for (const auto& warning : scene.warnings)
      if (warning.code == code) return true;
    return false;
  }

 private:
  mansard::test::Scratch folder_;
};

}  // namespace mansard::ingest::test
