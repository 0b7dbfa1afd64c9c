// The program as its users run it: files in a folder of its own, a command line, what it says and how it ends.
#pragma once

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/scratch.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;

struct Outcome {
  int exit = -1;
  std::string out, err;
};

inline auto read(const fs::path& path) -> std::string {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A gabled house on a field as OBJ, and its footprint as GeoJSON.
inline const std::string field =
    "v -20 -20 0\nv 40 -20 0\nv 40 40 0\nv -20 40 0\n"
    "v 0 0 0\nv 12 0 0\nv 12 8 0\nv 0 8 0\nv 0 0 5\nv 12 0 5\nv 12 8 5\nv 0 8 5\nv 0 4 8\nv 12 4 8\n";
inline const std::string house =
    field + "f 1 2 3 4\nf 5 6 10 9\nf 6 7 11 14 10\nf 7 8 12 11\nf 8 5 9 13 12\nf 9 10 14 13\nf 11 12 13 14\n";

inline auto geojson(const std::string& geometry, const std::string& crs = "EPSG::28992") -> std::string {
  const std::string declared =
      crs.empty() ? "" : R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:)" + crs + R"("}},)";
  return R"({"type":"FeatureCollection",)" + declared +
         R"("features":[{"type":"Feature","properties":{"id":"a"},"geometry":)" + geometry + "}]}";
}
inline auto polygon(const std::string& ring) -> std::string {
  return R"({"type":"Polygon","coordinates":[[)" + ring + "]]}";
}
inline const std::string square = "[0,0],[12,0],[12,8],[0,8],[0,0]";

class Command : public testing::Test {
 protected:
  void SetUp() override {
    put("house.obj", house);
    put("house.geojson", geojson(polygon(square)));
  }

  auto put(const std::string& name, const std::string& bytes) -> std::string {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return at(name);
  }
  [[nodiscard]] auto at(const std::string& name) const -> std::string { return (folder_ / name).string(); }

  /// In the folder of the test: commands that messages name have relative paths, and leave files there.
  auto run(const std::string& arguments) const -> Outcome {
    const std::string command = "cd " + at("") + " && " + std::string(MANSARD_BINARY) + " " + arguments + " >" +
                                at("stdout") + " 2>" + at("stderr") + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(at("stdout")), read(at("stderr"))};
  }
  auto reconstruct(const std::string& mesh, const std::string& footprints, const std::string& more = "") const
      -> Outcome {
    return run("reconstruct -q " + mesh + " " + footprints + " -o " + at("out") + " " + more);
  }

  /// One clear line with the code, the exit code, and no result left behind.
  void expect_refusal(const Outcome& outcome, int exit, const std::string& code, const std::string& words = "") const {
    EXPECT_EQ(outcome.exit, exit) << outcome.err;
    EXPECT_THAT(outcome.err, testing::HasSubstr("error[" + code + "]"));
    EXPECT_THAT(outcome.err, testing::HasSubstr(words));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    if (fs::exists(at("out"))) {
      EXPECT_TRUE(fs::is_empty(at("out")));
    }
  }

  test::Scratch folder_;
};

}  // namespace mansard::cli
