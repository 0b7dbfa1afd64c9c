// What messages say to do is done here, as a user would: a command fails or warns and names what to do, and with that
// it works. That every option that is named at all exists is tested by tests/house/named_options.mjs.
#include <regex>
#include <sstream>

#include "cli/remedies.hpp"

namespace mansard::cli {
namespace {

class Remedies : public RemedyTest {
 protected:
  static auto folder(const std::string& name) -> std::string {
    return "<Folder><name>" + name +
           "</name><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>4,52 4.0002,52 4.0002,52.0001 "
           "4,52.0001 4,52</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Folder>";
  }
  static auto osm(const std::string& key, const std::string& value) -> std::string {
    std::string out = R"(<?xml version="1.0"?><osm version="0.6"><node id="1" lat="52" lon="4"/>)"
                      R"(<node id="2" lat="52" lon="4.0002"/><node id="3" lat="52.0001" lon="4.0002"/>)"
                      R"(<node id="4" lat="52.0001" lon="4"/><way id="9">)";
    for (const char* id : {"1", "2", "3", "4", "1"}) out += R"(<nd ref=")" + std::string(id) + R"("/>)";
    return out + R"(<tag k=")" + key + R"(" v=")" + value + R"("/></way></osm>)";
  }
  /// The house with its y axis up.
  static auto turned_up() -> std::string {
    std::string out;
    std::istringstream lines(house);
    for (std::string line; std::getline(lines, line);) {
      std::smatch at;
      if (std::regex_match(line, at, std::regex("v (\\S+) (\\S+) (\\S+)"))) {
        const std::string y = at[2];
        line = "v " + at[1].str() + " " + at[3].str() + " " + (y == "0" ? y : y[0] == '-' ? y.substr(1) : "-" + y);
      }
      out += line + "\n";
    }
    return out;
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
      {"extrude -q @TWO -o @HERE/b.obj --join @TABLE", "usage", "has the ids of the buildings with --on",
       "--on key --ingest-id-attribute other"},
      {"extrude -q @TWO -o @HERE/c.obj --on key", "usage", "there is no table to join",
       "--join @TABLE --ingest-id-attribute other"},
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

TEST_F(Remedies, of_words_that_do_not_go_together_work) {
  put("dtm.asc", grid("-100"));
  put("list.toml", "");
  put("bad.toml", "[sweep]\ngamma = { a = 1 }\n");
  put("good.toml", "[sweep]\ngamma = 12\n");
  ASSERT_EQ(run(filled("reconstruct -q @MESH @PRINTS -o @HERE/old")).exit, 0);
  put("w-block-a.mps", "");
  ASSERT_EQ(run(filled("extrude -q @PRINTS --default-height 6 -o @HERE/t0.3dtiles")).exit, 0);
  fs::create_directories(at("empty"));
  try_all({
      {"convert -q @MODEL -o @HERE/a1.obj -o @HERE/a1.glb --to obj", "usage", "--to is for one output",
       "convert -q @MODEL -o @HERE/a1.obj -o @HERE/a1.glb"},
      {"convert -q @MODEL -o @HERE/t0.3dtiles", "output-exists", "the folder is not empty; choose another, or add",
       "--overwrite"},
      {"extrude -q @MODEL -o @HERE/a2.obj --terrain-out @HERE/t2.glb", "usage",
       "extrude the footprints with --dtm instead",
       "extrude -q @PRINTS --default-height 6 -o @HERE/a2.obj --terrain-out @HERE/t2.glb --dtm @HERE/dtm.asc"},
      {"explore grid @MESH @PRINTS --datasets @HERE/list.toml -o @OUT", "usage", "expected either --datasets or",
       "explore grid -q @MESH @PRINTS --grid gamma=10 -o @OUT"},
      {"explore grid @MESH -o @OUT --grid gamma=10", "usage", "then the footprints; or --datasets LIST",
       "explore grid -q @MESH @PRINTS --grid gamma=10 -o @OUT"},
      {"explore sensitivity @MESH @PRINTS --grid gamma=10 -o @OUT", "usage", "takes --parameters, not --grid",
       "explore sensitivity -q @MESH @PRINTS --parameters sweep.gamma -o @OUT"},
      {"explore grid @MESH @PRINTS --parameters sweep.gamma -o @OUT", "usage", "is for the experiment 'sensitivity'",
       "explore grid -q @MESH @PRINTS --grid gamma=10 -o @OUT"},
      {"explore grid -q @MESH @PRINTS -o @OUT", "explore-axis", "say --grid key=a,b,c", "--grid gamma=10"},
      {"explore grid -q @MESH @PRINTS -o @OUT --grid gamma=10 --grid gamma=20", "explore-axis",
       "put all its values into one --grid", "explore grid -q @MESH @PRINTS -o @OUT --grid gamma=10,20"},
      {"explore grid -q @MESH @PRINTS -o @OUT --grid gamma=10,20 --most-runs 1", "explore-runs",
       "or allow more with --most-runs", "explore grid -q @MESH @PRINTS -o @OUT --grid gamma=10,20 --most-runs 2"},
      {"explore grid -q @MESH @PRINTS -o @OUT --grid gama=5", "option-unknown", "see 'mansard options'", "options"},
      {"new @HERE/p1 @PRINTS", "new-inputs", "and a project needs a mesh or a point cloud", said},
      {"new @HERE/p2", "usage", "expected a mesh or a point cloud, and footprints", "new -q @HERE/p2 @MESH @PRINTS"},
      {"new @HERE/p2 @MESH @PRINTS", "output-exists", "this is a project already", "new -q @HERE/p3 @MESH @PRINTS"},
      {"new @MESH @PRINTS", "output-exists", "give the name of a new folder before the inputs",
       "new -q @HERE/p4 @MESH @PRINTS"},
      {"reconstruct -q @PRINTS @MESH -o @OUT", "usage", "the footprints are given before a mesh", said},
      {"reconstruct -q @MESH @PRINTS -o @OUT --shares 2 --share 1 --no-resume", "usage", "leave --no-resume out",
       "reconstruct -q @MESH @PRINTS -o @OUT --shares 2 --share 1"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --shares 2 --share 1 --since @HERE/old", "usage", "leave --shares out",
       "reconstruct -q @MESH @PRINTS -o @OUT --since @HERE/old"},
      {"reconstruct -q @MESH @PRINTS -o @HERE/old", "output-exists", "the folder is not empty; choose another, or add",
       "--overwrite"},
      {"reconstruct -q @MESH @PRINTS --derive-footprints -o @OUT", "usage", "leave out the file or the option",
       "reconstruct -q @MESH --derive-footprints -o @OUT"},
      {"report @HERE/old --scan @MESH --no-scan", "usage", "leave one of --scan and --no-scan out",
       "report @HERE/old --no-scan -o @HERE/r1.html"},
      {"report @HERE/empty", "report-run", "give the output folder of 'mansard reconstruct'",
       "report -q @HERE/old -o @HERE/r2.html"},
      {"status @HERE/empty", "status-none", "give what 'mansard reconstruct'", "status @HERE/old"},
      {"segment -q @MESH @PRINTS -o @HERE/s1.gpkg --export-mps @HERE/w.mps", "output-exists",
       "an integer program of an earlier run is there", "--overwrite"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --config @HERE/bad.toml", "config",
       "has a value of the wrong type; see 'mansard options'",
       "reconstruct -q @MESH @PRINTS -o @OUT --config @HERE/good.toml"},
      {"simulate -q --block terrace --bbox 0 0 1 1 -o @OUT", "usage", "the size of a --block is --simulate-size",
       "simulate -q --block terrace --simulate-size 20 --resolution 2 -o @OUT"},
      {"simulate -q @MODEL --block terrace -o @OUT", "usage", "expected exactly one of MODEL, --block and --footprints",
       "simulate -q @MODEL --resolution 2 -o @OUT"},
      {"extrude @MODEL -o @HERE/f.obj --attributes ms_nothing", "write-attribute-missing",
       "lists those that there may be", "options --attributes"},
      {"explain one two", "usage", "unexpected argument; see", "explain --help"},
      {"--frobnicate", "usage", "see 'mansard --help'", "--help"},
      {"reconstruct -q @MESH @PRINTS", "usage", "--output is required", "-o @OUT"},
      {"explain nothing-known", "code-unknown", "unknown code; see 'mansard explain'", "explain"},
      {"serve --sample @HERE/nowhere", "server-sample", "check --sample", "serve --help"},
  });
}

TEST_F(Remedies, of_places_and_names_work) {
  const auto box = [](const std::string& x, const std::string& y, const std::string& right, const std::string& top) {
    return polygon("[" + x + "," + y + "],[" + right + "," + y + "],[" + right + "," + top + "],[" + x + "," + top +
                   "],[" + x + "," + y + "]");
  };
  put("none.geojson", geojson(polygon(square), ""));
  put("pole.geojson", geojson(box("5", "88", "5.0002", "88.0002"), "EPSG::4326"));
  put("mercator.geojson", geojson(box("500000", "6800000", "500012", "6800008"), "EPSG::3857"));
  put("same.geojson", with_ids(R"({"id":"a","other":"p"})", R"({"id":"a","other":"q"})"));
  put("far.geojson", geojson(box("9000", "9000", "9003", "9003")));
  put("beyond.geojson", std::regex_replace(read(at("two.geojson")), std::regex("\\[([23])0,"), "[10$010,"));
  put("folders.kml", R"(<kml xmlns="http://www.opengis.net/kml/2.2"><Document>)" + folder("houses") + folder("sheds") +
                         "</Document></kml>");
  put("land.osm", osm("landuse", "grass"));
  put("house.osm", osm("building", "yes"));
  put("up.obj", turned_up());
  put("far.asc", grid("9000"));
  put("near.asc", grid("-100"));
  try_all({
      {"extrude -q @HERE/pole.geojson -o @HERE/a.city.json", "ingest-crs-unknown", "where there is no UTM zone",
       "--crs EPSG:32661"},
      {"extrude @HERE/mercator.geojson -o @HERE/b.city.json", "ingest-crs-scale",
       "say --crs with a system made for the place", "--crs EPSG:32631 --overwrite"},
      {"reconstruct @MESH @HERE/none.geojson -o @OUT", "ingest-crs-local", "Give --crs EPSG:n if they have a CRS",
       "--crs EPSG:28992"},
      {"extrude @HERE/same.geojson -o @HERE/c.city.json --ingest-id-attribute id", "ingest-id-duplicate",
       "--ingest-id-attribute chooses another attribute",
       "extrude @HERE/same.geojson -o @HERE/c.city.json --ingest-id-attribute other --overwrite"},
      {"extrude @HERE/folders.kml -o @HERE/d.city.json", "ingest-layers", "; --ingest-layer chooses",
       "--ingest-layer sheds --overwrite"},
      {"extrude -q @HERE/land.osm -o @HERE/e.city.json", "ingest-footprints-none", "is tagged as a building; give",
       "extrude -q @HERE/house.osm -o @HERE/e.city.json"},
      {"convert -q @PRINTS -o @HERE/f.city.json", "write-read-plans", "this GeoJSON carries no plans",
       "extrude -q @PRINTS --default-height 6 -o @HERE/f.city.json"},
      {"reconstruct @MESH @PRINTS -o @OUT --texture", "texture-none", "or leave --texture out",
       "reconstruct @MESH @PRINTS -o @OUT"},
      {"new @HERE/p @MESH @HERE/far.geojson", "new-match", "project as it is with --no-check", "--no-check"},
      {"reconstruct @MESH @HERE/beyond.geojson -o @OUT", "scan-coverage", "or choose footprints with --bbox",
       "--bbox 0 0 12 8"},
      {"reconstruct @MESH @HERE/beyond.geojson -o @OUT", "ingest-footprint-outside", "or choose others with --bbox",
       "--bbox 0 0 12 8"},
      {"reconstruct -q @HERE/up.obj @PRINTS -o @OUT", "scan-axis", "its y axis is up; give --up y", "--up y"},
      {"reconstruct -q @HERE/up.obj @PRINTS -o @OUT", "scan-axis", "--pipeline-scan-checks warn goes on nevertheless",
       "--pipeline-scan-checks warn"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --up y", "scan-axis", "its z axis is up; give --up z",
       "reconstruct -q @MESH @PRINTS -o @OUT --up z"},
      {"extrude -q @PRINTS -o @HERE/g.city.json --terrain-out @HERE/g.glb --dtm @HERE/far.asc", "ingest-raster",
       "; check its CRS, and --crs",
       "extrude -q @PRINTS -o @HERE/g.city.json --terrain-out @HERE/g.glb --dtm @HERE/near.asc"},
      {"convert -q @MODEL -o @HERE/h.city.json --attributes a=b=c", "option-value",
       "'mansard options --attributes' lists the names", "options --attributes"},
  });
}

TEST_F(Remedies, of_models_and_runs_work) {
  ASSERT_EQ(run(filled("extrude -q @PRINTS --default-height 6 -o @MODEL")).exit, 0);
  put("other.city.json", std::regex_replace(read(at("m.city.json")), std::regex("28992"), "32631"));
  ASSERT_EQ(run(filled("convert -q @MODEL -o @HERE/m.gml")).exit, 0);
  ASSERT_EQ(run(filled("reconstruct -q @MESH @PRINTS -o @HERE/old")).exit, 0);
  ASSERT_EQ(run(filled("reconstruct -q @MESH @PRINTS -o @HERE/closed --formats stl")).exit, 0);
  ASSERT_EQ(run(filled("compare -q @HERE/old @HERE/old -o @HERE/changes")).exit, 0);
  fs::remove(at("m.city.json"));
  try_all({
      {"report -q @HERE/closed", "report-models", "add cityjson or plans to --formats of the run",
       "reconstruct -q @MESH @PRINTS -o @HERE/closed --formats stl,cityjson --overwrite"},
      {"compare -q @HERE/old @HERE/other.city.json -o @OUT", "compare-crs", "transform one of them",
       "compare -q @HERE/old @MODEL -o @OUT"},
      {"report -q @HERE/old --changes @HERE/old/run.json -o @HERE/a.html", "report-changes",
       "is not the report of 'mansard compare'", "report -q @HERE/old --changes @HERE/changes -o @HERE/a.html"},
      {"evaluate -q @HERE/other.city.json @MESH --crs EPSG:28992 -o @HERE/b.json", "ingest-model-crs",
       "a model is never projected", "evaluate -q @HERE/other.city.json @MESH --crs local -o @HERE/b.json"},
      {"evaluate -q @MODEL @MESH --mesh-offset 900 900 0 -o @HERE/c.json", "ingest-model-overlap",
       "; check both, and --mesh-offset", "evaluate -q @MODEL @MESH -o @HERE/c.json"},
      {"reconstruct -q @MESH @PRINTS -o @OUT --since @HERE/m.gml", "since-models",
       "these models have no plans, so that they cannot be taken over",
       "reconstruct -q @MESH @PRINTS -o @OUT --since @HERE/old"},
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
