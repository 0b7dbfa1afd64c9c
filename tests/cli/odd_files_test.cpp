// What messages about odd files say to do: files of other programs, and files of mansard that were changed by hand.
#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "cli/las.hpp"
#include "cli/remedies.hpp"

namespace mansard::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class OddFiles : public RemedyTest {
 protected:
  /// A house of 12 by 8 m with its corner at (`x`, `y`).
  static auto box_at(int x, int y) -> std::string {
    const auto corner = [&](int dx, int dy) {
      return "[" + std::to_string(x + dx) + "," + std::to_string(y + dy) + "]";
    };
    return polygon(corner(0, 0) + "," + corner(12, 0) + "," + corner(12, 8) + "," + corner(0, 8) + "," + corner(0, 0));
  }
  /// The house with other coordinates.
  template <class Change>
  static auto changed(Change change) -> std::string {
    std::string out;
    std::istringstream lines(house);
    for (std::string line; std::getline(lines, line);) {
      double x = 0, y = 0, z = 0;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
        change(x, y, z);
        line = "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z);
      }
      out += line + "\n";
    }
    return out;
  }
  /// A mesh of squares of `side`, with heights of a function, without those where it is not a number.
  template <class Height>
  static auto surface(double from, double to, double side, Height height) -> std::string {
    std::string vertices, faces;
    int corners = 0;
    for (double x = from; x < to; x += side)
      for (double y = from; y < to; y += side) {
        const double z = height(x + side / 2, y + side / 2);
        if (std::isnan(z)) continue;
        for (const auto& [dx, dy] : {std::pair(0.0, 0.0), {side, 0.0}, {side, side}, {0.0, side}})
          vertices += "v " + std::to_string(x + dx) + " " + std::to_string(y + dy) + " " + std::to_string(z) + "\n";
        faces += "f";
        for (int k = 0; k < 4; ++k) faces += " " + std::to_string(++corners);
        faces += "\n";
      }
    return vertices + faces;
  }
  /// A slope of 72° with a flat roof in it.
  static auto hill() -> std::string {
    std::string vertices, faces;
    constexpr int from = -20, to = 40, side = to - from;
    for (int x = from; x <= to; ++x)
      for (int y = from; y <= to; ++y)
        vertices += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
                    (x >= 0 && x <= 12 && y >= 0 && y <= 8 ? "60" : std::to_string(3 * x)) + "\n";
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const int first = i * (side + 1) + j + 1;
        faces += "f";
        for (const int corner : {first, first + side + 1, first + side + 2, first + 1})
          faces += " " + std::to_string(corner);
        faces += "\n";
      }
    return vertices + faces;
  }
  static auto is_house(double x, double y) -> bool { return x > 0 && x < 12 && y > 0 && y < 8; }
  static auto collada(const std::string& mesh, const std::string& up) -> std::string {
    std::string places, corners;
    std::size_t vertices = 0, triangles = 0;
    std::istringstream lines(mesh);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line.substr(2));
      if (line[0] == 'v') places += line.substr(2) + " ", ++vertices;
      std::vector<int> face;
      for (int i = 0; line[0] == 'f' && words >> i;) face.push_back(i - 1);
      for (std::size_t k = 2; k < face.size(); ++k, ++triangles)
        for (const int i : {face[0], face[k - 1], face[k]}) corners += std::to_string(i) + " ";
    }
    const auto count = [](std::size_t n) { return "\"" + std::to_string(n) + "\""; };
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)"
           R"(<unit name="meter" meter="1"/><up_axis>)" +
           up +
           R"(</up_axis></asset><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count=)" +
           count(3 * vertices) + ">" + places + R"(</float_array><technique_common><accessor source="#a" count=)" +
           count(vertices) +
           R"( stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>)"
           R"(</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)"
           R"(<triangles count=)" +
           count(triangles) + R"(><input semantic="VERTEX" source="#v" offset="0"/><p>)" + corners +
           R"(</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">)"
           R"(<node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>)"
           R"(<instance_visual_scene url="#s"/></scene></COLLADA>)";
  }
  static auto metadata(const std::string& crs) -> std::string {
    return R"(<?xml version="1.0"?><ModelMetadata version="1"><SRS>)" + crs +
           "</SRS><SRSOrigin>85000,447000,0</SRSOrigin></ModelMetadata>";
  }
  /// A solid of eight vertices.
  static auto cube(const std::string& lod) -> std::string {
    return R"({"type":"Solid","lod":")" + lod +
           R"(","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]})";
  }
  auto replaced(const std::string& from, const std::string& to, const std::string& words, const std::string& by)
      -> std::string {
    auto bytes = read(at(from));
    const auto before = bytes;
    for (std::size_t i = 0; (i = bytes.find(words, i)) != bytes.npos; i += by.size())
      bytes.replace(i, words.size(), by);
    EXPECT_NE(bytes, before) << words;
    return put(to, bytes);
  }
};

TEST_F(OddFiles, remedies_of_point_clouds_work) {
  put("rd.las", las_of(house_points(85000, 447000), 28992));
  put("rd.geojson", geojson(box_at(85000, 447000)));
  put("plants.las", las_of(house_points(85000, 447000, 5, 5), 28992));
  // Two clouds far from each other: one CRS and another, or none.
  put("none.geojson", geojson(box_at(85000, 447000), ""));
  for (const char* name : {"crss", "places"}) fs::create_directories(at(name));
  put("crss/a.las", las_of(house_points(85000, 447000), 28992));
  put("crss/b.las", las_of(house_points(500000, 5760000), 32631));
  put("places/a.las", las_of(house_points(85000, 447000)));
  put("places/b.las", las_of(house_points(500000, 5760000)));
  // Three houses, with nothing between them.
  auto three = house_points(85000, 447000);
  for (const auto& [x, y] : {std::pair(85600, 447000), {85000, 447600}})
    std::ranges::copy(house_points(x, y), std::back_inserter(three));
  put("three.las", las_of(three, 28992));
  const auto feature = [](const std::string& of) {
    return R"({"type":"Feature","properties":{},"geometry":)" + of + "}";
  };
  put("two.geojson", std::regex_replace(read(at("rd.geojson")), std::regex("\"features\":.*"),
                                        "\"features\":[" + feature(box_at(85300, 447300)) + "," +
                                            feature(box_at(85600, 447000)) + "]}"));
  try_all({
      {"reconstruct @HERE/rd.las @HERE/rd.geojson -o @OUT", "scan-offset", "corrects it, and so does --align",
       "--align"},
      {"reconstruct -q @HERE/plants.las @HERE/rd.geojson -o @OUT", "ingest-points-empty", "or --cloud-buildings top",
       "--cloud-buildings top"},
      {"reconstruct -q @HERE/crss @HERE/none.geojson -o @OUT", "ingest-memory",
       "give --crs where the clouds name different CRSs", "--crs EPSG:28992"},
      {"reconstruct -q @HERE/places @HERE/rd.geojson -o @OUT", "ingest-memory", "the part of them to read with --bbox",
       "--bbox 84990 446990 85020 447020"},
      {"reconstruct -q @HERE/places --derive-footprints -o @OUT", "ingest-memory", "leave out files that are elsewhere",
       "reconstruct -q @HERE/places/a.las --derive-footprints -o @OUT"},
      {"reconstruct -q @HERE/three.las @TWO -o @OUT --bbox 85290 447290 85320 447320", "ingest-points-empty",
       "no point is in the box of the footprints or of --bbox; check --bbox",
       "reconstruct -q @HERE/three.las @TWO -o @OUT --bbox 85590 446990 85620 447020"},
  });
  // The offset that is named is the other remedy.
  const auto told = run(filled("reconstruct @HERE/rd.las @HERE/rd.geojson -o @OUT"));
  std::smatch offset;
  ASSERT_TRUE(std::regex_search(told.err, offset, std::regex("--mesh-offset \\S+ \\S+ \\S+"))) << told.err;
  const auto corrected =
      run(filled("reconstruct @HERE/rd.las @HERE/rd.geojson -o @OUT --overwrite " + offset[0].str()));
  EXPECT_EQ(corrected.exit, 0);
  EXPECT_THAT(corrected.err, Not(HasSubstr("scan-offset")));
}

TEST_F(OddFiles, remedies_of_meshes_in_another_frame_work) {
  put("far.geojson", geojson(box_at(84800, 447400)));
  put("near.geojson", geojson(box_at(5000, 5000)));
  const auto there = changed([](double& x, double& y, double&) { x += 84800, y += 447400; });
  put("there.obj", there);
  put("there.dae", collada(there, "Z_UP"));
  put("near.dae", collada(house, "Z_UP"));
  // It says that y is up, and z is.
  put("wrong.dae", collada(changed([](double& x, double& y, double&) { x += 5000, y += 5000; }), "Y_UP"));
  put("down.obj", changed([](double& x, double& y, double& z) { x += 5000, y = -y - 5000, z = -z; }));
  put("over.obj", changed([](double&, double& y, double& z) { y = -y, z = -z; }));
  put("up.obj", changed([](double& x, double& y, double& z) { x += 5000, y += 5000, std::swap(y, z); }));
  put("turned.obj", changed([](double& x, double& y, double& z) { x += 5000, y += 5000, std::swap(y, z), z = -z; }));
  put("plain.obj", changed([](double& x, double& y, double&) { x += 5000, y += 5000; }));
  put("mirrored.obj", changed([](double&, double& y, double& z) { std::swap(y, z); }));
  put("right.obj", changed([](double&, double& y, double& z) { std::swap(y, z), z = -z; }));
  fs::create_directories(at("made/Data"));
  put("made/Data/house.obj", house);
  put("made/metadata.xml", metadata("somewhere"));
  fs::create_directories(at("mended/Data"));
  put("mended/Data/house.obj", house);
  put("mended/metadata.xml", metadata("EPSG:28992"));
  put("rd.geojson", geojson(box_at(85000, 447000)));
  put("geocentric.geojson", geojson(polygon(square), "EPSG::4978"));
  try_all({
      {"reconstruct @HERE/there.dae @HERE/far.geojson -o @OUT", "ingest-mesh-precision",
       "export it with an origin near the mesh, and give that as --mesh-offset",
       "reconstruct @HERE/near.dae @HERE/far.geojson -o @OUT --mesh-offset 84800 447400 0"},
      {"reconstruct -q @HERE/wrong.dae @HERE/near.geojson -o @OUT", "ingest-no-overlap",
       "with z up they do: give --up z", "--up z"},
      {"reconstruct -q @HERE/there.obj @HERE/far.geojson -o @OUT --up y", "ingest-no-overlap",
       "with z up they do: give --up z", "reconstruct -q @HERE/there.obj @HERE/far.geojson -o @OUT --up z"},
      {"reconstruct -q @HERE/down.obj @HERE/near.geojson -o @OUT --up y", "ingest-no-overlap",
       "with its z axis down they do: turn it by 180° about its x axis and give --up z",
       "reconstruct -q @HERE/plain.obj @HERE/near.geojson -o @OUT --up z"},
      {"reconstruct -q @HERE/up.obj @HERE/near.geojson -o @OUT", "ingest-no-overlap",
       "with y up and mirrored they do: multiply its z by -1 and give --up y",
       "reconstruct -q @HERE/turned.obj @HERE/near.geojson -o @OUT --up y"},
      {"reconstruct -q @HERE/mirrored.obj @PRINTS -o @OUT", "scan-axis",
       "it is y up and mirrored; multiply its z by -1 and give --up y",
       "reconstruct -q @HERE/right.obj @PRINTS -o @OUT --up y"},
      {"reconstruct -q @HERE/over.obj @PRINTS -o @OUT --up y", "scan-axis",
       "its z axis is down; turn it by 180° about its x axis and give --up z",
       "reconstruct -q @MESH @PRINTS -o @OUT --up z"},
      {"reconstruct -q @HERE/made/Data/house.obj @PRINTS -o @OUT", "ingest-mesh-metadata",
       "correct the file, or say --crs local to take the mesh's coordinates as they are", "--crs local"},
      {"reconstruct -q @HERE/made/Data/house.obj @HERE/rd.geojson -o @OUT", "ingest-mesh-metadata",
       "correct the file, or say --crs local", "reconstruct -q @HERE/mended/Data/house.obj @HERE/rd.geojson -o @OUT"},
      {"reconstruct -q @MESH @HERE/geocentric.geojson -o @OUT", "ingest-crs-unknown",
       "reproject them, or say --crs local if they are metres in the mesh's frame", "--crs local"},
  });
}

TEST_F(OddFiles, remedies_of_tilesets_work) {
  put("rd.geojson", geojson(box_at(85000, 447000)));
  const auto feature = [](const std::string& of) {
    return R"({"type":"Feature","properties":{},"geometry":)" + of + "}";
  };
  put("both.geojson", std::regex_replace(read(at("rd.geojson")), std::regex("\"features\":.*"),
                                         "\"features\":[" + feature(box_at(85000, 447000)) + "," +
                                             feature(box_at(85600, 447000)) + "]}"));
  ASSERT_EQ(run(filled("extrude -q @HERE/rd.geojson --default-height 6 -o @HERE/t.3dtiles")).exit, 0);
  try_all({
      {"reconstruct -q @HERE/t.3dtiles/tileset.json @HERE/both.geojson -o @OUT --bbox 85590 446990 85620 447020",
       "ingest-no-overlap", "no tile of the tileset reaches into the box asked for; check --bbox",
       "reconstruct -q @HERE/t.3dtiles/tileset.json @HERE/both.geojson -o @OUT --bbox 84990 446990 85020 447020"},
      {"reconstruct -q @HERE/t.3dtiles/tileset.json @HERE/both.geojson -o @OUT --bbox 85590 446990 85620 447020",
       "ingest-no-overlap",
       "no tile of the tileset reaches into the box asked for; check --bbox, --crs and --mesh-offset",
       "--mesh-offset 600 0 0"},
  });
}

TEST_F(OddFiles, remedies_of_scans_without_ground_work) {
  const double none = std::nan("");
  put("roof.obj", surface(0, 12, 1, [&](double x, double y) { return is_house(x, y) ? 6 : none; }));
  put("steep.obj", hill());
  put("island.obj", surface(-60, 80, 1, [&](double x, double y) {
        return is_house(x, y) ? 6 : std::abs(x - 6) < 20 && std::abs(y - 4) < 20 ? none : 0;
      }));
  put("dtm.asc", grid("-100"));
  try_all({
      {"reconstruct -q @HERE/roof.obj @PRINTS -o @OUT --terrain-out @HERE/a.glb", "terrain-no-ground",
       "give a terrain model that covers them with --dtm", "--dtm @HERE/dtm.asc"},
      {"reconstruct @HERE/island.obj @PRINTS -o @OUT --terrain-out @HERE/b.glb", "terrain-filled",
       "% of the terrain are not known and are continued from around them", "--dtm @HERE/dtm.asc --overwrite"},
  });
  // A terrain model is known beside the mesh too.
  const auto around =
      run(filled("reconstruct @HERE/roof.obj @PRINTS -o @OUT --terrain-out @HERE/c.glb --dtm @HERE/dtm.asc"));
  EXPECT_THAT(around.err, Not(HasSubstr("terrain-filled")));
  fs::remove_all(at("out"));
  // Where single buildings have no ground, the report of the run says so.
  const auto reasons = [&](const std::string& mesh, const std::string& more) {
    EXPECT_EQ(run(filled("reconstruct -q @HERE/" + mesh + " @PRINTS -o @OUT --overwrite " + more)).exit, 0);
    return read(at("out/run.json"));
  };
  // tried: nothing shows the ground here
  EXPECT_THAT(reasons("roof.obj", ""),
              HasSubstr("Give a terrain model (--dtm), --ground-attribute or --ground-height"));
  for (const char* remedy : {"--dtm @HERE/dtm.asc", "--ground-height 0"})
    EXPECT_THAT(reasons("roof.obj", remedy), Not(HasSubstr("block-ground"))) << remedy;
  // tried: the scan shows no level ground
  EXPECT_THAT(reasons("steep.obj", ""), HasSubstr("Give a terrain model (--dtm) or --ground-height"));
  for (const char* remedy : {"--dtm @HERE/dtm.asc", "--ground-height 0"})
    EXPECT_THAT(reasons("steep.obj", remedy), Not(HasSubstr("block-ground"))) << remedy;
}

TEST_F(OddFiles, remedies_of_results_that_were_changed_by_hand_work) {
  ASSERT_EQ(run(filled("extrude -q @PRINTS --default-height 6 -o @HERE/m.geojson")).exit, 0);
  ASSERT_EQ(run(filled("convert -q @HERE/m.geojson -o @HERE/m.gpkg")).exit, 0);
  replaced("m.geojson", "spaced.geojson", "{\"type\":\"Feature\",", "{ \"type\":\"Feature\",");
  const auto whole = read(at("m.geojson"));
  put("cut.geojson", whole.substr(0, whole.size() - 4));
  put("bare.geojson",
      std::regex_replace(read(at("spaced.geojson")), std::regex("\"mansard\":.*\"features\""), "\"features\""));
  // Tables of another name, of the same length: what another program leaves of a GeoPackage.
  replaced("m.gpkg", "others.gpkg", "mansard_records", "manufac_records");
  replaced("m.gpkg", "headless.gpkg", "header{", "heater{");
  ASSERT_EQ(run(filled("reconstruct -q @MESH @PRINTS -o @HERE/old")).exit, 0);
  ASSERT_EQ(run(filled("reconstruct -q @MESH @PRINTS -o @HERE/changed")).exit, 0);
  put("changed/run.json", "[]");
  try_all({
      {"convert -q @HERE/spaced.geojson -o @HERE/a.city.json", "write-read-plans",
       "give the file as mansard wrote it, or take out its member 'mansard'",
       "convert -q @HERE/m.geojson -o @HERE/a.city.json"},
      {"extrude -q @HERE/spaced.geojson -o @HERE/b.city.json", "write-read-plans",
       "and 'mansard extrude' reads the footprints that are left",
       "extrude -q @HERE/bare.geojson -o @HERE/b.city.json"},
      {"convert -q @HERE/cut.geojson -o @HERE/c.city.json", "write-read-plans", "it is cut short; copy it again",
       "convert -q @HERE/m.geojson -o @HERE/c.city.json"},
      {"convert -q @HERE/others.gpkg -o @HERE/d.city.json", "write-read-plans", "this GeoPackage has no plans in it",
       "extrude -q @HERE/others.gpkg -o @HERE/d.city.json"},
      {"convert -q @HERE/headless.gpkg -o @HERE/e.city.json", "write-read-plans",
       "its table mansard_records does not begin with a header; give the file as mansard wrote it",
       "convert -q @HERE/m.gpkg -o @HERE/e.city.json"},
      {"convert -q @HERE/headless.gpkg -o @HERE/f.city.json", "write-read-plans",
       "or its footprints to 'mansard extrude' or 'mansard reconstruct'",
       "extrude -q @HERE/headless.gpkg -o @HERE/f.city.json"},
      {"report -q @HERE/changed -o @HERE/r.html", "report-run",
       "is not the report of a run; run 'mansard reconstruct' again",
       "reconstruct -q @MESH @PRINTS -o @HERE/changed --overwrite"},
      {"compare -q @MODEL @MESH -o @OUT --formats cityjson", "usage",
       "models of this format cannot be written again; leave --formats out", "compare -q @MODEL @MESH -o @OUT"},
  });
  EXPECT_EQ(run(filled("report -q @HERE/changed -o @HERE/r.html")).exit, 0);
}

TEST_F(OddFiles, remedies_of_other_producers_models_work) {
  ASSERT_EQ(run(filled("extrude -q @PRINTS --default-height 6 -o @HERE/n.city.json")).exit, 0);
  replaced("n.city.json", "nowhere.city.json", "EPSG/0/28992", "EPSG/0/999999");
  put("rd.geojson", geojson(box_at(85000, 447000)));
  // A building of LoD 1.3 alone beside the other.
  put("levels.city.json",
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},"CityObjects":{)"
      R"("a":{"type":"Building","geometry":[)" +
          cube("1.3") + "," + cube("2.2") + R"(]},"b":{"type":"Building","geometry":[)" + cube("1.3") +
          R"(]}},"vertices":[[0,0,0],[12,0,0],[12,8,0],[0,8,0],[0,0,6],[12,0,6],[12,8,6],[0,8,6]]})");
  try_all({
      {"evaluate -q @HERE/nowhere.city.json @MESH -o @HERE/a.json", "ingest-model-crs",
       "is not known; correct it, or say --crs local", "--crs local"},
      {"evaluate @HERE/levels.city.json @MESH -o @HERE/b.json", "ingest-model-lods", "--lod reads one of them",
       "--lod 1.3 --overwrite"},
      {"evaluate -q @MODEL @MESH -o @HERE/c.json --footprints @HERE/rd.geojson", "ingest-model-overlap",
       "; check both, and --crs", "evaluate -q @MODEL @MESH -o @HERE/c.json --footprints @PRINTS"},
  });
  // To describe a model, its CRS need not be known.
  const auto info = run(filled("info @HERE/nowhere.city.json"));
  EXPECT_EQ(info.exit, 0) << info.err;
}

}  // namespace
}  // namespace mansard::cli
