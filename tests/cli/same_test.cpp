// The same building, whatever else is in the files, wherever they lie and whoever computes: building by building, by
// the coordinates and attributes in CityJSON.
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using Json = nlohmann::json;

/// A mesh with footprints, and what is asked of it.
struct Place {
  std::string name;
  fs::path mesh, footprints;
  std::array<int, 2> offset;  ///< whole metres from the mesh to the footprints
  std::string id;             ///< the attribute that names a footprint
  std::string box, filter;    ///< some of them
  std::size_t buildings;
  friend void PrintTo(const Place& place, std::ostream* out) { *out << place.name; }
};

/// A mesh simulated from an LoD2 model of Rotterdam with 29 footprints in 5 blocks, and one made of LiDAR with 87
/// official footprints of Delft in 13.
auto places() -> std::vector<Place> {
  const auto shared = fs::path(MANSARD_SHARED_DATA) / "sim_rotterdam", delft = fs::path(MANSARD_DATA) / "delft";
  return {{"block_a",
           shared / "block_A_sim_mesh.ply",
           shared / "block_A_footprints.geojson",
           {0, 0},
           "id",
           "640 330 700 380",
           "zmax > 15",
           29},
          {"delft",
           delft / "mesh.ply",
           delft / "footprints.geojson",
           {84800, 447400},
           "gml_id",
           "84850 447520 84900 447580",
           "gml_id < 'b31bd'",
           87}};
}

class SameBuilding : public Command, public testing::WithParamInterface<Place> {
 protected:
  using Buildings = std::map<std::string, Json>;

  void SetUp() override {
    Command::SetUp();
    if (!fs::exists(GetParam().mesh)) GTEST_SKIP() << "no shared data";
    footprints_ = Json::parse(read(GetParam().footprints));
  }
  static auto mesh() -> std::string { return GetParam().mesh.string(); }
  auto footprints() const -> const Json& { return footprints_; }

  /// Every building of a run, its parts with it: attributes and faces, with coordinates as whole units of the file.
  /// `shift`: whole metres that the input was moved by.
  auto buildings(const std::string& meshes, const Json& gis, const std::string& more = "",
                 const std::array<int, 3>& shift = {}, const std::string& environment = "") -> Buildings {
    put("gis.geojson", gis.dump());
    fs::remove_all(at("out"));
    std::string offset;
    for (const std::size_t k : {0, 1}) offset += std::to_string(shift[k] + GetParam().offset[k]) + " ";
    const auto outcome =
        run_in(environment, "reconstruct -q " + meshes + " " + at("gis.geojson") + " -o " + at("out") +
                                " --formats cityjson --mesh-offset " + offset + std::to_string(shift[2]) + " " + more);
    EXPECT_LE(outcome.exit, 1) << outcome.err;
    const Json city = Json::parse(read(at("out") + "/model.city.json"));
    Buildings out;
    for (const auto& [id, object] : city["CityObjects"].items()) {
      const std::string building = object.contains("parents") ? object["parents"][0].get<std::string>() : id;
      Json attributes = object["attributes"];
      for (auto& [name, value] : attributes.items())
        if (name.starts_with("ms_h_") && !name.ends_with("_se") && value.is_number())
          value = std::floor((value.get<double>() - shift[2]) * 1e4 + 0.5);
      for (const auto* plan : {"+ms_plan", "+ms_footprint"})
        if (attributes.contains(plan)) attributes[plan] = placed(attributes[plan], shift);
      out[building][id] = {std::move(attributes), absolute(object.value("geometry", Json::array()), city, shift)};
    }
    return out;
  }

  auto run_in(const std::string& environment, const std::string& arguments) const -> Outcome {
    const std::string command = environment + " " + MANSARD_BINARY + " " + arguments + " >" + at("stdout") + " 2>" +
                                at("stderr") + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(at("stdout")), read(at("stderr"))};
  }

  static void expect_same(const Buildings& some, const Buildings& all) {
    EXPECT_FALSE(some.empty());
    for (const auto& [id, building] : some) {
      ASSERT_TRUE(all.contains(id)) << id;
      EXPECT_TRUE(building == all.at(id)) << id << "\n" << Json::diff(building, all.at(id)).dump().substr(0, 600);
    }
  }

  /// GeoJSON's coordinates of any depth.
  static void move(Json& coordinates, const std::array<int, 2>& by) {
    if (coordinates[0].is_array()) {
      for (auto& one : coordinates) move(one, by);
    } else {
      for (std::size_t k = 0; k < 2; ++k) coordinates[k] = coordinates[k].get<double>() + by[k];
    }
  }

  /// The mesh in two files, cut in the middle of its list of triangles; each has all vertices.
  auto halves() -> std::array<std::string, 2> {
    const std::string bytes = read(mesh());
    const std::string end = "end_header\n";
    const std::size_t start = bytes.find(end) + end.size();
    const auto count = [&](const std::string& what) {
      return std::stoul(bytes.substr(bytes.find("element " + what) + what.size() + 9));
    };
    const std::size_t vertices = count("vertex"), faces = count("face");
    constexpr std::size_t vertex_size = 12, face_size = 13;
    EXPECT_EQ(bytes.size(), start + vertices * vertex_size + faces * face_size);
    const auto piece = [&](const std::string& name, std::size_t first, std::size_t last) {
      std::string header = bytes.substr(0, start);
      const std::string old = "element face " + std::to_string(faces);
      header.replace(header.find(old), old.size(), "element face " + std::to_string(last - first));
      return put(name,
                 header + bytes.substr(start, vertices * vertex_size) +
                     bytes.substr(start + vertices * vertex_size + first * face_size, (last - first) * face_size));
    };
    return {piece("first.ply", 0, faces / 2), piece("second.ply", faces / 2, faces)};
  }

 private:
  Json footprints_;

  /// A plan, or a footprint, with absolute coordinates to the micrometre: each counts from an origin of its own.
  static auto placed(Json plan, const std::array<int, 3>& shift) -> Json {
    const auto origin = plan["origin"];
    plan.erase("origin");
    const std::function<void(Json&)> move = [&](Json& points) {
      if (points.is_array() && points.size() == 2 && points[0].is_number()) {
        for (std::size_t k = 0; k < 2; ++k)
          points[k] = std::llround((points[k].get<double>() + origin[k].get<double>() - shift[k]) * 1e6);
      } else if (points.is_object()) {
        for (auto& [key, one] : points.items())
          if (key != "profile_of_edge") move(one);
      } else if (points.is_array()) {
        for (auto& one : points) move(one);
      }
    };
    for (const auto* height : {"base", "ground"})
      if (plan.contains(height))
        plan[height] = std::llround((plan[height].get<double>() + origin[2].get<double>() - shift[2]) * 1e6);
    for (const auto* ring : {"outer", "holes", "polygons"})
      if (plan.contains(ring)) move(plan[ring]);
    return plan;
  }

  /// Indices of vertices become their coordinates.
  static auto absolute(const Json& geometry, const Json& city, const std::array<int, 3>& shift) -> Json {
    const auto& scale = city["transform"]["scale"];
    const auto& translate = city["transform"]["translate"];
    const auto place = [&](std::size_t vertex) {
      Json out = Json::array();
      for (std::size_t k = 0; k < 3; ++k)
        out.push_back(city["vertices"][vertex][k].get<std::int64_t>() +
                      std::llround((translate[k].get<double>() - shift[k]) / scale[k].get<double>()));
      return out;
    };
    const std::function<Json(const Json&)> deep = [&](const Json& nested) -> Json {
      if (nested.is_number()) return place(nested.get<std::size_t>());
      Json out = Json::array();
      for (const auto& one : nested) out.push_back(deep(one));
      return out;
    };
    Json out = Json::array();
    for (const auto& one : geometry) out.push_back({one["type"], one["lod"], deep(one["boundaries"])});
    return out;
  }
};

TEST_P(SameBuilding, in_any_selection_order_and_division_of_the_files) {
  const Place& place = GetParam();
  const auto all = buildings(mesh(), footprints());
  EXPECT_EQ(all.size(), place.buildings);

  // Some of them, by a box and by a filter: what is around is known all the same.
  for (const std::string& some : {"--bbox " + place.box, "--where \"" + place.filter + "\""}) {
    const auto chosen = buildings(mesh(), footprints(), some);
    EXPECT_GT(chosen.size(), 1U) << some;
    EXPECT_LT(chosen.size(), all.size()) << some;
    expect_same(chosen, all);
  }

  // The footprints in another order, and with as many again far away.
  Json more = footprints();
  std::ranges::reverse(more["features"]);
  for (auto feature : footprints()["features"]) {
    auto& id = feature["properties"][place.id];
    id = "far " + id.get<std::string>();
    move(feature["geometry"]["coordinates"], {-5000, 0});
    more["features"].push_back(feature);
  }
  expect_same(all, buildings(mesh(), more));

  // The mesh as two files, the later half of its triangles first.
  const auto [first, second] = halves();
  expect_same(all, buildings(second + " " + first, footprints()));
  for (const auto* threads : {"-j 1", "-j 2"}) expect_same(all, buildings(mesh(), footprints(), threads));
}

TEST_P(SameBuilding, at_any_place_a_whole_number_of_metres_away) {
  const auto all = buildings(mesh(), footprints());
  for (const std::array<int, 3> by : {std::array{512, 0, 0}, {84813, 447331, 43}, {-3, -100000, -7}}) {
    Json moved = footprints();
    for (auto& feature : moved["features"]) move(feature["geometry"]["coordinates"], {by[0], by[1]});
    expect_same(all, buildings(mesh(), moved, "", by));
  }
}

TEST_P(SameBuilding, on_any_processor) {
  // What glibc, Embree and the BLAS would choose on older processors. Those that this one lacks are not tested.
  const auto all = buildings(mesh(), footprints());
  const std::string sse = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX_Usable,-AVX2_Usable,-FMA_Usable,-AVX,-AVX2,-FMA,-FMA4 ";
  expect_same(all, buildings(mesh(), footprints(), "", {}, sse + "MANSARD_EMBREE=isa=sse2 OPENBLAS_CORETYPE=Prescott"));
  expect_same(all, buildings(mesh(), footprints(), "", {}, "MANSARD_EMBREE=isa=avx2 OPENBLAS_CORETYPE=Haswell"));
  if (__builtin_cpu_supports("avx512f"))
    expect_same(all, buildings(mesh(), footprints(), "", {}, "MANSARD_EMBREE=isa=avx512 OPENBLAS_CORETYPE=SkylakeX"));
}

class SameBuildingOfPoints : public SameBuilding {};

TEST_P(SameBuildingOfPoints, in_any_selection_cells_and_format) {
  const Place& place = GetParam();
  const auto all = buildings(mesh(), footprints());
  EXPECT_EQ(all.size(), place.buildings);
  const auto chosen = buildings(mesh(), footprints(), "--bbox " + place.box);
  EXPECT_GT(chosen.size(), 1U);
  EXPECT_LT(chosen.size(), all.size());
  expect_same(chosen, all);
  expect_same(all, buildings(mesh(), footprints(), "--ingest-cells-from 0 -j 1"));
  // The same points as format 6 in an octree, of which a box reads some nodes.
  const auto copc = fs::path(MANSARD_SHARED_DATA) / "points/delft_west.copc.laz";
  if (!fs::exists(copc)) return;
  expect_same(all, buildings(copc.string(), footprints()));
  expect_same(chosen, buildings(copc.string(), footprints(), "--bbox " + place.box));
}

auto points() -> Place {
  const auto delft = fs::path(MANSARD_DATA) / "delft";
  return {
      "delft", delft / "points.laz", delft / "footprints.geojson", {0, 0}, "gml_id", "84850 447520 84900 447580", "",
      87};
}

INSTANTIATE_TEST_SUITE_P(Points, SameBuildingOfPoints, testing::Values(points()),
                         [](const auto& place) { return place.param.name; });

INSTANTIATE_TEST_SUITE_P(Places, SameBuilding, testing::ValuesIn(places()),
                         [](const auto& place) { return place.param.name; });

}  // namespace
}  // namespace mansard::cli
