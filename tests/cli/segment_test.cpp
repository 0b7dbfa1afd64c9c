// `mansard segment`: layers, programs and a report, and `mansard reconstruct --layers`.
#include <sys/stat.h>

#include <map>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Segment : public Command {
 protected:
  auto segment(const std::string& footprints, const std::string& more = "") const -> Outcome {
    return run("segment " + at("house.obj") + " " + footprints + " -o " + at("out.gpkg") + " " + more);
  }

  /// The gabled house and, apart from it, a flat one: two blocks.
  auto two_blocks() -> std::string {
    put("house.obj", house +
                         "v 25 25 0\nv 33 25 0\nv 33 33 0\nv 25 33 0\nv 25 25 6\nv 33 25 6\nv 33 33 6\nv 25 33 6\n"
                         "f 15 16 20 19\nf 16 17 21 20\nf 17 18 22 21\nf 18 15 19 22\nf 19 20 21 22\n");
    const auto feature = [](const std::string& id, const std::string& ring) {
      return R"({"type":"Feature","properties":{"id":")" + id + R"("},"geometry":)" + polygon(ring) + "}";
    };
    return put("two.geojson",
               R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:28992"}},"features":[)" +
                   feature("a", square) + "," + feature("b", "[25,25],[33,25],[33,33],[25,33],[25,25]") + "]}");
  }

  [[nodiscard]] auto results() const -> std::vector<std::string> {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with("out")) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }
};

TEST_F(Segment, writes_a_geopackage_a_program_and_a_report_and_names_them) {
  const auto outcome = segment(at("house.geojson"), "--export-mps " + at("out.mps") + " --report " + at("out.json"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("out.gpkg") + "\n" + at("out.mps") + "\n");
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1 block: "), HasSubstr(" sweep-edges, "), HasSubstr("objective "),
                                 HasSubstr("1 of 1 blocks proven optimal"), HasSubstr("largest gap")));
  EXPECT_THAT(read(at("out.gpkg")), StartsWith("SQLite format 3"));
  EXPECT_THAT(read(at("out.mps")), AllOf(StartsWith("NAME"), HasSubstr("ENDATA")));
  const auto report = nlohmann::json::parse(read(at("out.json")));
  EXPECT_EQ(report["counts"]["blocks"], 1);
  EXPECT_EQ(report["blocks"][0]["objective"]["status"], "optimal");
}

TEST_F(Segment, has_footprints_that_mansard_itself_can_raise) {
  ASSERT_EQ(segment(at("house.geojson"), "-q").exit, 0);
  const auto raised =
      run("extrude -q " + at("out.gpkg") + " --layer footprints --height-attribute height -o " + at("out"));
  EXPECT_EQ(raised.exit, 0) << raised.err;
  const auto report = nlohmann::json::parse(read(at("out") + "/run.json"));
  EXPECT_EQ(report["crs"], "EPSG:28992");
  ASSERT_EQ(report["buildings"].size(), 1U);
  EXPECT_NEAR(report["buildings"][0]["areas_m2"]["ground"].get<double>(), 96, 3);
  EXPECT_NEAR(report["buildings"][0]["roof_max_m"].get<double>(), 6.5, 0.5);  // half of the roof is higher
}

TEST_F(Segment, gives_every_block_a_program_of_its_own) {
  const auto outcome = segment(two_blocks(), "-q --export-mps " + at("out.mps"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("out.gpkg") + "\n" + at("out-block-a.mps") + "\n" + at("out-block-b.mps") + "\n");
  EXPECT_THAT(results(), testing::ElementsAre("out-block-a.mps", "out-block-b.mps", "out.gpkg"));
}

TEST_F(Segment, overwrites_nothing_silently) {
  const auto footprints = two_blocks();
  put("out-block-b.mps", "mine");
  expect_refusal(segment(footprints, "-q --export-mps " + at("out.mps")), 2, "output-exists", "out-block-b.mps");
  EXPECT_THAT(results(), testing::ElementsAre("out-block-b.mps"));
  EXPECT_EQ(read(at("out-block-b.mps")), "mine");
  EXPECT_EQ(segment(footprints, "-q --overwrite --export-mps " + at("out.mps")).exit, 0);
  EXPECT_THAT(read(at("out-block-b.mps")), StartsWith("NAME"));
  expect_refusal(segment(footprints, "-q"), 2, "output-exists", "out.gpkg");
}

TEST_F(Segment, writes_no_two_results_into_one_file) {
  const auto out = at("out.gpkg"), beside = at(".") + "/out.gpkg";
  for (const auto& more : {"--report " + out, "--export-mps " + out, "--report " + beside,
                           "--export-mps " + at("out.mps") + " --report " + at("out.mps")})
    expect_refusal(segment(at("house.geojson"), "-q --overwrite " + more), 2, "usage", "two outputs");
  // The names that several blocks give their programs are known only when they are.
  expect_refusal(segment(two_blocks(), "-q --export-mps " + at("out.mps") + " --report " + at("out-block-b.mps")), 2,
                 "usage", "out-block-b.mps");
  EXPECT_THAT(results(), testing::IsEmpty());
}

TEST_F(Segment, replaces_nothing_but_ordinary_files) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  expect_refusal(segment(at("house.geojson"), "-q --overwrite --report " + at("pipe")), 2, "output-exists", "regular");
  EXPECT_TRUE(fs::is_fifo(at("pipe")));
}

TEST_F(Segment, writes_nothing_into_a_folder_of_meshes_by_whatever_name) {
  fs::create_directories(at("tiles"));
  fs::copy(at("house.obj"), at("tiles/house.obj"));
  for (const std::string out : {"why.gpkg", "./why.gpkg"}) {
    const std::string inside = "cd " + at("tiles") + " && " + MANSARD_BINARY;
    const int status =
        std::system((inside + " segment -q . " + at("house.geojson") + " -o " + out + " 2>/dev/null").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << out;
  }
  EXPECT_FALSE(fs::exists(at("tiles/why.gpkg")));
}

TEST_F(Segment, gives_the_same_bytes_at_any_number_of_threads) {
  const auto footprints = two_blocks();
  ASSERT_EQ(segment(footprints, "-q -j 1").exit, 0);
  const auto one = read(at("out.gpkg"));
  ASSERT_EQ(segment(footprints, "-q -j 2 --overwrite").exit, 0);
  EXPECT_TRUE(read(at("out.gpkg")) == one);
}

TEST_F(Segment, counts_footprints_without_a_part) {
  const auto footprints = put("bad.geojson", geojson(polygon("[0,0],[12,8],[12,0],[0,8],[0,0]")));
  expect_refusal(segment(footprints, "-q"), 5, "pipeline-nothing");
  const auto meadow = put("meadow.geojson", geojson(polygon("[22,-18],[30,-18],[30,-10],[22,-10],[22,-18]")));
  const auto outcome = segment(meadow, "--export-mps " + at("out.mps"));
  EXPECT_EQ(outcome.exit, 1) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1 of 1 footprints have no part"), HasSubstr("1 empty"),
                                 HasSubstr("there is no integer program to export")));
  EXPECT_THAT(results(), testing::ElementsAre("out.gpkg"));
}

TEST_F(Segment, refuses_what_reconstruct_refuses) {
  expect_refusal(segment(at("house.geojson"), "-q --sweep-gama 5"), 4, "option-unknown", "--sweep-gamma");
  expect_refusal(segment(at("none.geojson"), "-q"), 3, "file-missing");
  expect_refusal(run("segment -q " + at("house.obj") + " -o " + at("out.gpkg")), 2, "usage");
  expect_refusal(run("segment -q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out.json")), 2, "usage",
                 ".gpkg");
  expect_refusal(segment(at("house.geojson"), "-q --export-mps " + at("house.obj") + " --overwrite"), 2,
                 "output-input");
  EXPECT_THAT(results(), testing::IsEmpty());
}

TEST_F(Segment, has_its_layers_in_what_reconstruct_writes_with_layers) {
  ASSERT_EQ(segment(at("house.geojson"), "-q").exit, 0);
  const auto outcome = reconstruct(at("house.obj"), at("house.geojson"), "--layers --formats cityjson");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, at("out") + "/model.city.json\n" + at("out") + "/model.gpkg\n");
  const auto layers_of = [&](const std::string& file) {
    std::map<std::string, nlohmann::json> layers;
    const auto told = nlohmann::json::parse(run("info --json " + file).out);
    for (const auto& layer : told[0]["layers"]) layers[layer["name"]] = layer;
    return layers;
  };
  const auto own = layers_of(at("out.gpkg")), both = layers_of(at("out") + "/model.gpkg");
  for (const auto* name : {"sweep_edges", "faces", "conflicts"}) {
    ASSERT_TRUE(both.contains(name)) << name;
    EXPECT_EQ(both.at(name), own.at(name)) << name;
  }
}

}  // namespace
}  // namespace mansard::cli
