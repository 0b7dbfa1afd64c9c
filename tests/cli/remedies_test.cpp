// What messages say to do is done here, as a user would: a command fails or warns and names what to do, and with that
// it works. That every option that is named at all exists is tested by tests/house/named_options.mjs.
#include <regex>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class Remedies : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    put("two.geojson", with_ids(R"({"id":"a","other":"p"})", R"({"id":"b","other":"q"})"));
    put("table.csv", "key,colour\np,red\nq,blue\n");
  }

  static auto with_ids(const std::string& first, const std::string& second) -> std::string {
    const auto feature = [](const std::string& properties, const std::string& ring) {
      return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":)" + polygon(ring) + "}";
    };
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}},)"
           R"("features":[)" +
           feature(first, square) + "," + feature(second, "[20,0],[30,0],[30,8],[20,8],[20,0]") + "]}";
  }

  /// In commands, words with an @ are files.
  auto filled(std::string arguments) const -> std::string {
    const std::pair<const char*, std::string> places[] = {
        {"@MESH", at("house.obj")},  {"@PRINTS", at("house.geojson")}, {"@TWO", at("two.geojson")},
        {"@TABLE", at("table.csv")}, {"@MODEL", at("m.city.json")},    {"@OUT", at("out")},
        {"@HERE/", at("")}};
    for (const auto& [word, place] : places) arguments = std::regex_replace(arguments, std::regex(word), place);
    return arguments;
  }

  struct Case {
    std::string command;  ///< says `code`, and `words`
    std::string code, words;
    std::string instead;  ///< a whole command, or what is added to it where it begins with "-": does not say `code`
  };
  void try_all(const std::vector<Case>& cases) const {
    ASSERT_EQ(run(filled("extrude -q @PRINTS --default-height 6 -o @MODEL")).exit, 0);
    for (const auto& [command, code, words, instead] : cases) {
      SCOPED_TRACE(command);
      const auto without = run(filled(command));
      EXPECT_THAT(without.err, HasSubstr("[" + code + "]"));
      EXPECT_THAT(without.err, HasSubstr(words));
      fs::remove_all(at("out"));
      const auto remedied = run(filled(instead.starts_with("-") ? command + " " + instead : instead));
      EXPECT_TRUE(remedied.exit == 0 || remedied.exit == 1) << instead << ": " << remedied.exit << " " << remedied.err;
      EXPECT_THAT(remedied.err, Not(HasSubstr("[" + code + "]")));
      fs::remove_all(at("out"));
    }
  }
};

TEST_F(Remedies, of_command_lines_work) {
  try_all({
      {"extrude -q @PRINTS -o @MODEL", "output-exists", "add --overwrite", "--overwrite"},
      {"convert -q @MODEL -o @HERE/m.dat", "usage", "unknown file extension", "--to obj"},
      {"convert -q @MODEL -o @HERE/m.unknown", "usage", "expected .city.json",
       "convert -q @MODEL -o @HERE/m.city.jsonl"},
      {"extrude -q @PRINTS -o @HERE/a.obj --formats obj", "usage", "give an output folder instead",
       "extrude -q @PRINTS -o @OUT --formats obj"},
      {"extrude -q @PRINTS -o @HERE/b.obj --ovrewrite", "option-unknown", "did you mean '--overwrite'",
       "extrude -q @PRINTS -o @HERE/b.obj --overwrite"},
      {"convert -q @MODEL -o @HERE/c.obj --join @TABLE", "option-verb", "verbs that do: reconstruct, extrude",
       "extrude -q @TWO -o @HERE/c.obj --ingest-id-attribute other --join @TABLE --on key"},
      {"extrude -q @MODEL -o @HERE/d.obj --report @HERE/r.json", "usage", "leave it out",
       "extrude -q @MODEL -o @HERE/d.obj"},
      {"extrude -q @MODEL -o @HERE/e.obj --attributes nothing", "option-value", "'none'",
       "extrude -q @MODEL -o @HERE/e.obj --attributes none"},
      {"simulate -q -o @OUT", "usage", "--block", "--block terrace --resolution 2"},
      {"simulate -q --block terace -o @OUT --resolution 2", "option-value", "expected terrace",
       "simulate -q --block terrace -o @OUT --resolution 2"},
      {"evaluate -q @MODEL @MESH -o @HERE/r1.json --plane-plans 3", "usage", "name it with --truth",
       "evaluate -q @MODEL @MESH -o @OUT --plane-plans 3 --truth @MODEL"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --share 1", "usage", "--share 1 --shares 8", "--shares 8"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --preset slow", "option-value", "expected paper",
       "reconstruct -q @MESH @PRINTS -o @OUT --preset paper"},
      {"explain write-tiles-hight", "code-unknown", "did you mean 'write-tiles-height'", "explain write-tiles-height"},
      {"label -q @MESH @MODEL -o @HERE/l.xyz", "usage", "must be .ply or .glb", "label -q @MESH @MODEL -o @HERE/l.ply"},
      {"segment -q @MESH @PRINTS -o @HERE/s.json", "usage", "must be .gpkg",
       "segment -q @MESH @PRINTS -o @HERE/s.gpkg"},
  });
}

TEST_F(Remedies, of_inputs_work) {
  put("none.geojson", geojson(polygon(square), ""));
  put("feet.geojson", geojson(polygon(square), "EPSG::2263"));
  put("degrees.geojson", geojson(polygon(square), "EPSG::4326"));
  try_all({
      {"reconstruct -q @MESH -o @OUT", "usage", "--derive-footprints", "--derive-footprints"},
      {"reconstruct -q @MESH @MESH -o @OUT", "ingest-footprints-format", "--derive-footprints",
       "reconstruct -q @MESH --derive-footprints -o @OUT"},
      {"extrude -q @TWO -o @HERE/a.obj --ingest-where \"id='z'\"", "ingest-footprints-none", "id='z'",
       "extrude -q @TWO -o @HERE/a.obj --ingest-where \"id='a'\""},
      {"extrude -q @TWO -o @HERE/b.obj --join @TABLE", "usage", "--on", "--on key --ingest-id-attribute other"},
      {"extrude -q @TWO -o @HERE/c.obj --on key", "usage", "--join", "--join @TABLE --ingest-id-attribute other"},
      {"extrude -q @TWO -o @HERE/d.obj --join @TABLE --on kye", "ingest-join-key", "its columns are key, colour",
       "extrude -q @TWO -o @HERE/d.obj --join @TABLE --on key --ingest-id-attribute other"},
      {"extrude -q @TWO -o @HERE/e.obj --join @TABLE --on key", "ingest-join-none", "--ingest-id-attribute",
       "--ingest-id-attribute other"},
      {"extrude @TWO -o @HERE/f.3dtiles", "write-tiles-height", "--tiles-height-offset",
       "--tiles-height-offset 43 --overwrite"},
      {"reconstruct -q @MESH @HERE/none.geojson -o @OUT --crs EPSG:4326", "ingest-crs-option",
       "not a projected CRS in metres", "reconstruct -q @MESH @HERE/none.geojson -o @OUT --crs EPSG:28992"},
      {"reconstruct -q @MESH @HERE/feet.geojson -o @OUT", "ingest-crs-unit", "say --crs EPSG:n", "--crs local"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --ground-attribute base", "pipeline-ground-attribute", "check its name",
       "reconstruct -q @MESH @PRINTS -o @OUT"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --bbox 1000 1000 1010 1010", "ingest-footprints-none",
       "they lie in x 0.0 to 12.0", "reconstruct -q @MESH @PRINTS -o @OUT --bbox 0 0 12 8"},
      {"convert -q @MESH -o @HERE/g.city.json", "write-read-plans", "'mansard evaluate' measures",
       "evaluate -q @MESH @MESH -o @HERE/g.json"},
      {"extrude -q @PRINTS -o @HERE/h.obj --terrain-out @HERE/t.ply", "terrain-format", "expected .city.json",
       "reconstruct -q @MESH @PRINTS -o @OUT --terrain-out @HERE/t.glb"},
      {"info @HERE/nothing.obj", "file-missing", "check the path", "info @MESH"},
  });
}

/// A scan that shows roofs only, and one that says nothing of its classes.
TEST_F(Remedies, of_scans_work) {
  std::string roofs = "x y z class\n", unclassified = "x y z class\n";
  for (int x = -8; x < 20; ++x)
    for (int y = -8; y < 16; ++y)
      for (const double half : {0.25, 0.75}) {
        const bool inside = x >= 0 && x < 12 && y >= 0 && y < 8;
        const auto point = std::to_string(x + half) + " " + std::to_string(y + 1 - half) + (inside ? " 6 " : " 0 ");
        if (inside) roofs += point + "6\n";
        unclassified += point + (inside ? "67\n" : "2\n");
      }
  put("roofs.xyz", roofs);
  put("classes.xyz", unclassified);
  try_all({
      {"reconstruct @HERE/roofs.xyz @PRINTS -o @OUT", "scan-ground", "--ground-height Z", "--ground-height 0"},
      {"reconstruct @HERE/classes.xyz @PRINTS -o @OUT", "ingest-points-classes", "--cloud-building-classes",
       "--cloud-building-classes 67"},
  });
}

}  // namespace
}  // namespace mansard::cli
