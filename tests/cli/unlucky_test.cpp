// Inputs that are unlucky: ids like those of parts, more attributes than columns, names of no CRS, wrong encodings, a
// format that cannot hold a city. Nothing is lost, and every remedy that a message names works.
#include <sys/stat.h>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/command.hpp"
#include "cli/las.hpp"

namespace mansard::cli {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

class Unlucky : public Command {
 protected:
  static auto feature(const std::string& properties, double x = 0) -> std::string {
    const auto p = [&](double dx, double y) { return "[" + std::to_string(x + dx) + "," + std::to_string(y) + "]"; };
    return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":{"type":"Polygon","coordinates":[[)" +
           p(0, 0) + "," + p(6, 0) + "," + p(6, 8) + "," + p(0, 8) + "," + p(0, 0) + "]]}}";
  }
  /// Two halves of the house.
  auto halves(const std::string& first, const std::string& second) -> std::string {
    return put(
        "halves.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}},)"
        R"("features":[)" +
            feature(first) + "," + feature(second, 6) + "]}");
  }
  auto objects(const std::string& file) const -> Json { return Json::parse(read(at(file)))["CityObjects"]; }
  /// The house with other coordinates.
  template <class Change>
  auto moved_house(const std::string& name, Change change) -> std::string {
    std::string out;
    std::istringstream lines(house);
    for (std::string line; std::getline(lines, line);) {
      double x = 0, y = 0, z = 0;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
        change(x, y, z);
        char text[128];
        std::snprintf(text, sizeof text, "v %.4f %.4f %.4f", x, y, z);
        line = text;
      }
      out += line + "\n";
    }
    return put(name, out);
  }
  void clear() const { fs::remove_all(at("out")); }
};

TEST_F(Unlucky, ids_like_those_of_parts_stay_and_the_parts_get_others) {
  const auto outcome = reconstruct(at("house.obj"), halves(R"({"id":"12"})", R"({"id":"12-1"})"),
                                   "--write-solids part "
                                   "--formats cityjson,geopackage,citygml");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto all = objects("out/model.city.json");
  ASSERT_TRUE(all.contains("12") && all.contains("12-1"));
  EXPECT_EQ(all["12"]["type"], "Building");
  EXPECT_EQ(all["12-1"]["type"], "Building");
  EXPECT_TRUE(all.contains("12--1"));
  EXPECT_TRUE(all.contains("12-1-1"));
}

TEST_F(Unlucky, ids_that_formats_cannot_hold_are_changed_and_told) {
  const auto outcome = reconstruct(at("house.obj"),
                                   halves("{\"id\":\"Stra\xdf"
                                          "e\"}",
                                          "{\"id\":\"Stra\xe4"
                                          "e\"}"),
                                   "--formats cityjson,geopackage");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const auto told = run("reconstruct " + at("house.obj") + " " + at("halves.geojson") + " -o " + at("told"));
  EXPECT_THAT(told.err, HasSubstr("warning[ingest-id-characters]"));
  EXPECT_THAT(told.err, HasSubstr("--ingest-encoding"));
  int buildings = 0;
  for (const auto& object : objects("out/model.city.json")) buildings += object["type"] == "Building" ? 1 : 0;
  EXPECT_EQ(buildings, 2);
  // tried: give the encoding of the file with --ingest-encoding
  const auto known = reconstruct(at("house.obj"), at("halves.geojson"), "--overwrite --ingest-encoding ISO-8859-1");
  EXPECT_EQ(known.exit, 0) << known.err;
  EXPECT_TRUE(objects("out/model.city.json").contains("Straße"));
  clear();
  expect_refusal(reconstruct(at("house.obj"), at("halves.geojson"), "--ingest-encoding KLINGON"), 4, "ingest-encoding",
                 "'KLINGON'");
  const auto cut = run("reconstruct " + at("house.obj") + " " + halves(R"({"id":"a\u0000b"})", R"({"id":"a\u0000c"})") +
                       " -o " + at("cut"));
  EXPECT_EQ(cut.exit, 0);
  EXPECT_THAT(cut.err, HasSubstr("warning[ingest-text]"));
  EXPECT_THAT(cut.err, HasSubstr("U+0000"));
}

TEST_F(Unlucky, tables_and_files_in_other_encodings_are_told) {
  put("latin.csv",
      "id,street\na,Stra\xdf"
      "e\n");
  const auto command = "extrude " + at("house.geojson") + " --default-height 6 --join " + at("latin.csv") +
                       " --on id -o " + at("a.city.json") + " --overwrite";
  const auto told = run(command);
  EXPECT_EQ(told.exit, 0) << told.err;
  EXPECT_THAT(told.err, HasSubstr("warning[ingest-text]"));
  EXPECT_THAT(told.err, HasSubstr("'street'"));
  // tried: give their encoding with --ingest-encoding, such as ISO-8859-1
  const auto known = run(command + " --ingest-encoding ISO-8859-1");
  EXPECT_THAT(known.err, Not(HasSubstr("ingest-text")));
  EXPECT_EQ(objects("a.city.json")["a"]["attributes"]["street"], "Straße");
  std::string wide = "\xff\xfe";
  for (const char c : read(at("house.geojson"))) wide += std::string(1, c) + '\0';
  expect_refusal(reconstruct(at("house.obj"), put("wide.geojson", wide)), 3, "file-read", "UTF-16; save it in UTF-8");
}

TEST_F(Unlucky, more_attributes_than_columns_are_kept) {
  std::string properties = R"({"id":"a")";
  for (int i = 0; i < 2500; ++i) properties += ",\"n" + std::to_string(i) + "\":" + std::to_string(i);
  const auto outcome = run("reconstruct " + at("house.obj") + " " + halves(properties + "}", R"({"id":"b"})") + " -o " +
                           at("out") + " --formats cityjson,geopackage,flatgeobuf");
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning[write-columns]"));
  EXPECT_EQ(objects("out/model.city.json")["a"]["attributes"]["n2499"], 2499);
  const auto back = run("convert -q " + at("out/model.gpkg") + " -o " + at("back.city.json"));
  EXPECT_EQ(back.exit, 0) << back.err;
  EXPECT_EQ(objects("back.city.json")["a"]["attributes"]["n2499"], 2499);
}

TEST_F(Unlucky, lists_of_names_that_are_wrong_are_errors_before_any_work) {
  for (const char* wrong : {"--attributes street", "--lod 7"}) {
    SCOPED_TRACE(wrong);
    expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), wrong), 4, "option-value");
    EXPECT_FALSE(fs::exists(at("out/.mansard")));
  }
}

TEST_F(Unlucky, one_formats_limit_is_not_the_others_loss) {
  // No way leads from Mars to WGS 84, which 3D Tiles need.
  put("none.geojson", geojson(polygon(square), ""));
  const auto outcome =
      reconstruct(at("house.obj"), at("none.geojson"), "--crs IAU_2015:49910 --formats cityjson,tiles,obj");
  EXPECT_EQ(outcome.exit, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("error[write-tiles-crs]"));
  EXPECT_THAT(outcome.err, HasSubstr("the other results are complete"));
  EXPECT_TRUE(fs::exists(at("out/model.city.json")));
  EXPECT_TRUE(fs::exists(at("out/model.obj")));
  EXPECT_TRUE(fs::exists(at("out/run.json")));
  EXPECT_FALSE(fs::exists(at("out/model.3dtiles")));
  // tried: ; once this is corrected, run: mansard convert
  std::smatch command;
  ASSERT_TRUE(std::regex_search(outcome.err, command, std::regex("run: mansard (convert .*)\n")));
  const auto again = run(command[1].str());  // Mars is still Mars
  EXPECT_THAT(again.err, HasSubstr("error[write-tiles-crs]"));
  EXPECT_EQ(run(std::regex_replace(command[1].str(), std::regex("model.3dtiles"), "model.glb")).exit, 0);
}

TEST_F(Unlucky, one_formats_limit_is_not_the_others_loss_where_models_are_written_again) {
  put("none.geojson", geojson(polygon(square), ""));
  ASSERT_EQ(run("extrude -q " + at("none.geojson") + " --crs IAU_2015:49910 -o " + at("mars.city.json")).exit, 0);
  const auto the_rest_is_there = [&](const Outcome& outcome, const std::string& rest) {
    EXPECT_EQ(outcome.exit, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error[write-tiles-crs]"));
    EXPECT_THAT(outcome.err, HasSubstr("there is no " + rest + ".3dtiles, and the other results are complete"));
    std::smatch command;
    ASSERT_TRUE(std::regex_search(outcome.err, command, std::regex("run: mansard (convert .*)\n")));
    EXPECT_EQ(run(std::regex_replace(command[1].str(), std::regex("[.]3dtiles"), ".again.glb")).exit, 0);
  };
  const auto both = run("convert -q " + at("mars.city.json") + " -o " + at("a.obj") + " -o " + at("a.3dtiles") +
                        " -o " + at("a.gpkg"));
  the_rest_is_there(both, "a");
  EXPECT_THAT(both.out, HasSubstr("a.obj"));
  EXPECT_THAT(both.out, Not(HasSubstr("a.3dtiles")));
  EXPECT_TRUE(fs::exists(at("a.obj")) && fs::exists(at("a.gpkg")));
  EXPECT_FALSE(fs::exists(at("a.3dtiles")));
  EXPECT_EQ(run("convert -q " + at("a.gpkg") + " -o " + at("back.city.json")).exit, 0);
  // With other options the solids are made again, which is another way through.
  the_rest_is_there(run("convert -q --extrude-overhang 0.3 " + at("mars.city.json") + " -o " + at("b.3dtiles") +
                        " -o " + at("b.obj")),
                    "b");
  EXPECT_TRUE(fs::exists(at("b.obj")));
  the_rest_is_there(run("extrude -q " + at("mars.city.json") + " --formats tiles,obj,cityjson -o " + at("out")),
                    "model");
  EXPECT_TRUE(fs::exists(at("out/model.obj")) && fs::exists(at("out/model.city.json")));
  // One that is asked for alone is all there is.
  const auto alone = run("convert -q " + at("mars.city.json") + " -o " + at("c.3dtiles"));
  EXPECT_EQ(alone.exit, 3);
  EXPECT_THAT(alone.err, Not(HasSubstr("other results")));
}

TEST_F(Unlucky, a_pipe_is_an_error_at_once_wherever_it_is_given) {
  ASSERT_EQ(::mkfifo(at("pipe.json").c_str(), 0600), 0);
  const std::string commands[] = {
      "convert @ -o " + at("x.obj"),
      "extrude " + at("house.geojson") + " --dtm=@ -o " + at("x.obj"),
      "extrude @ -o " + at("x.obj"),
      "reconstruct " + at("house.obj") + " " + at("house.geojson") + " --join @ -o " + at("p"),
      "reconstruct @ " + at("house.geojson") + " -o " + at("p"),
      "info @",
      "doctor @ " + at("house.geojson"),
      "evaluate @ " + at("house.obj")};
  // Nobody has it open, or somebody does and writes nothing, or all that he has, and stays or goes.
  for (const char* writer : {"", "sleep 60 >", "cat house.geojson >", "(cat house.geojson; sleep 60) >"}) {
    SCOPED_TRACE(writer);
    for (const auto& command : commands) {
      SCOPED_TRACE(command);
      const std::string aside =
          writer[0] == '\0' ? "" : "cd " + at("") + " && (" + writer + at("pipe.json") + ") & echo $! >" + at("writer");
      if (!aside.empty()) {
        ASSERT_EQ(std::system(("setsid sh -c '" + aside + "' >/dev/null 2>&1").c_str()), 0);
      }
      const auto outcome = run(std::regex_replace(command, std::regex("@"), at("pipe.json")));
      if (!aside.empty()) (void)std::system(("kill $(cat " + at("writer") + ") 2>/dev/null").c_str());
      EXPECT_EQ(outcome.exit, 3) << outcome.err;
      EXPECT_THAT(outcome.err, HasSubstr("error[file-read]"));
      EXPECT_THAT(outcome.err, HasSubstr("write what comes out of it to a file, and give that file"));
    }
  }
  // The same words where a shell makes the pipe, and what they say to do.
  const auto shell = [&](const std::string& words) {
    const std::string command = "bash -c '" + words + "' 2>" + at("said");
    return WEXITSTATUS(std::system(command.c_str()));
  };
  const std::string extrude = std::string(MANSARD_BINARY) + " extrude -q ", cat = "cat " + at("house.geojson");
  EXPECT_EQ(shell(extrude + "<(" + cat + ") -o " + at("x.obj")), 3);
  EXPECT_THAT(read(at("said")), HasSubstr("to a file, and give that file"));
  EXPECT_EQ(shell(cat + " >" + at("copy.geojson") + " && " + extrude + at("copy.geojson") + " -o " + at("x.obj")), 0)
      << read(at("said"));
}

TEST_F(Unlucky, a_link_in_place_of_what_a_run_keeps_is_not_followed) {
  fs::create_directories(at("out"));
  fs::create_directories(at("elsewhere/blocks"));
  put("elsewhere/blocks/precious", "x");
  fs::create_directory_symlink(at("elsewhere"), at("out/.mansard"));
  const auto outcome = reconstruct(at("house.obj"), at("house.geojson"));
  EXPECT_EQ(outcome.exit, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("this is a link"));
  EXPECT_TRUE(fs::exists(at("elsewhere/blocks/precious")));
  EXPECT_FALSE(fs::exists(at("elsewhere/status.json")));
}

TEST_F(Unlucky, names_of_no_crs_are_errors_that_say_what_to_give) {
  const auto named = [&](const std::string& name) {
    return put("named.geojson", R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + name +
                                    R"("}},"features":[)" + feature(R"({"id":"a"})") + "]}");
  };
  expect_refusal(reconstruct(at("house.obj"), named("Amersfoort / RD New")), 3, "ingest-crs-unknown",
                 "'Amersfoort / RD New'; EPSG:28992 has this name");
  EXPECT_EQ(reconstruct(at("house.obj"), at("named.geojson"), "--crs EPSG:28992").exit, 0);
  clear();
  EXPECT_EQ(reconstruct(at("house.obj"), at("named.geojson"), "--crs local").exit, 0);
  clear();
  expect_refusal(reconstruct(at("house.obj"), named("nonsense")), 3, "ingest-crs-unknown", "'nonsense'");
  expect_refusal(reconstruct(at("house.obj"), at("house.geojson"), "--crs 'Amersfoort / RD New'"), 4,
                 "ingest-crs-option", "EPSG:28992 has this name");
  expect_refusal(reconstruct(at("house.obj"), named("+proj=utm +zone=31 +nadgrids=https://127.0.0.1:9/x.gsb +units=m")),
                 3, "ingest-crs-unknown", "");
  put("link.geojson", R"({"type":"FeatureCollection","crs":{"type":"link","properties":{"href":"http://127.0.0.1:9/c",)"
                      R"("type":"proj4"}},"features":[)" +
                          feature(R"({"id":"a"})") + "]}");
  expect_refusal(reconstruct(at("house.obj"), at("link.geojson")), 3, "ingest-outside", "MANSARD_OUTSIDE=yes");
}

TEST_F(Unlucky, a_cloud_whose_header_has_no_box_is_local_like_a_mesh) {
  put("a.las", las_of(house_points(0, 0), 0, false));
  put("none.geojson", geojson(polygon(square), ""));
  const auto outcome = reconstruct(at("a.las"), at("none.geojson"));
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
}

/// Meshes that are beside their footprints for one reason each, with what the message names for it.
TEST_F(Unlucky, remedies_for_what_does_not_overlap_work) {
  const auto told = [&](const std::string& mesh, const std::string& footprints) {
    clear();
    const auto outcome = reconstruct(mesh, footprints);
    EXPECT_EQ(outcome.exit, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error[ingest-no-overlap]"));
    clear();
    return outcome.err;
  };
  const auto works = [&](const Outcome& outcome) {
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    clear();
  };
  const std::string far = polygon("[84800,447400],[84812,447400],[84812,447408],[84800,447408],[84800,447400]");
  put("far.geojson", geojson(far));
  // The command that is named, as it is.
  // tried: ; give --mesh-offset or --crs
  const auto named = [&](const std::string& words) {
    std::smatch command;
    ASSERT_TRUE(std::regex_search(words, command, std::regex("run: mansard (.*)\n"))) << words;
    works(run(command[1].str()));
  };
  named(told(at("house.obj"), at("far.geojson")));
  const auto there = moved_house("there.obj", [](double& x, double& y, double&) { x += 84800, y += 447400; });
  EXPECT_EQ(reconstruct(there, at("far.geojson")).exit, 0);

  auto words = told(moved_house("up.obj",
                                [](double& x, double& y, double& z) {
                                  x += 84800, y += 447400;
                                  const double up = z;
                                  z = -y, y = up;
                                }),
                    at("far.geojson"));
  EXPECT_THAT(words, HasSubstr("give --up y"));
  // tried: with y up they do: give --up y
  works(reconstruct(at("up.obj"), at("far.geojson"), "--up y"));

  const struct {
    double factor;
    const char* words;
  } units[] = {{1 / 0.3048, "multiply its coordinates by 0.3048"},
               {100, "multiply its coordinates by 0.01"},
               {0.001, "multiply its coordinates by 1000"}};
  for (const auto& [factor, remedy] : units) {
    words =
        told(moved_house("unit.obj", [&, f = factor](double& x, double& y,
                                                     double& z) { x = (x + 84800) * f, y = (y + 447400) * f, z *= f; }),
             at("far.geojson"));
    EXPECT_THAT(words, HasSubstr(remedy));
  }
  works(reconstruct(there, at("far.geojson")));  // which is the mesh with its coordinates multiplied
  // In millimetres, coordinates of a country are farther from zero than those of any country.
  moved_house("unit.obj",
              [](double& x, double& y, double& z) { x = (x + 84800) * 1e3, y = (y + 447400) * 1e3, z *= 1e3; });
  expect_refusal(reconstruct(at("unit.obj"), at("far.geojson")), 3, "ingest-mesh-unusable", "multiplied by 0.001");

  // A house about the origin is in no other unit, although it would reach anywhere if it were.
  put("nowhere.geojson", geojson(polygon("[9000,9000],[9003,9000],[9003,9003],[9000,9003],[9000,9000]")));
  EXPECT_THAT(told(at("house.obj"), at("nowhere.geojson")), Not(HasSubstr("multiply")));

  words =
      told(moved_house("swapped.obj", [](double& x, double& y, double&) { x += 84800, y += 447400, std::swap(x, y); }),
           at("far.geojson"));
  EXPECT_THAT(words, HasSubstr("correct its axis order"));
}

}  // namespace
}  // namespace mansard::cli
