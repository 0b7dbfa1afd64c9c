#include "mansard/ingest/model.hpp"

#include <gmock/gmock.h>

#include "ingest/workshop.hpp"

namespace mansard::ingest {
namespace {

using geometry::Point3;
using testing::HasSubstr;

/// Surfaces of a box of 10 × 8 × 6 over its eight vertices: base, top, south, east, north, west.
const std::string box_surfaces = "[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";
const std::string box_vertices =
    "[[0,0,0],[10000,0,0],[10000,8000,0],[0,8000,0],[0,0,6000],[10000,0,6000],[10000,8000,6000],[0,8000,6000]]";
const std::string semantics =
    R"({"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}],"values":)";

class Models : public test::Workshop {
 protected:
  static auto document(const std::string& objects, const std::string& crs = "", const std::string& version = "1.1")
      -> std::string {
    const std::string metadata = crs.empty() ? "" : R"("metadata":{"referenceSystem":")" + crs + R"("},)";
    return R"({"type":"CityJSON","version":")" + version + R"(",)" + metadata +
           R"("transform":{"scale":[0.001,0.001,0.001],"translate":[85000,447000,2]},"CityObjects":{)" + objects +
           R"(},"vertices":)" + box_vertices + "}";
  }
  static auto object(const std::string& geometries, const std::string& id = "a", const std::string& type = "Building",
                     const std::string& more = "") -> std::string {
    return "\"" + id + R"(":{"type":")" + type + "\"," + more + R"("geometry":[)" + geometries + "]}";
  }
  static auto geometry(const std::string& type, const std::string& boundaries, const std::string& values = "",
                       const std::string& lod = "\"2.2\"") -> std::string {
    const std::string meaning = values.empty() ? "" : R"(,"semantics":)" + semantics + values + "}";
    return R"({"type":")" + type + R"(","lod":)" + lod + R"(,"boundaries":)" + boundaries + meaning + "}";
  }
  static auto solid(const std::string& lod = "\"2.2\"") -> std::string {
    return geometry("Solid", "[" + box_surfaces + "]", "[[0,1,2,2,2,2]]", lod);
  }
  auto model(const std::string& text, const std::string& name = "m.city.json", const ModelOptions& options = {}) const
      -> base::Result<model::Model> {
    return read_model(file(name, text), options);
  }
  static auto count(const model::Model& model, model::SurfaceClass kind) -> std::size_t {
    std::size_t n = 0;
    for (const auto& building : model.buildings)
      for (const auto& part : building.parts)
        for (const auto& face : part.faces) n += face.kind == kind ? 1 : 0;
    return n;
  }
  static auto warned(const model::Model& model, std::string_view code) -> std::string {
    for (const auto& warning : model.warnings)
      if (warning.code == code) return warning.message;
    return "";
  }
  static void expect_box(const base::Result<model::Model>& read) {
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(count(*read, model::SurfaceClass::wall), 4U);
    EXPECT_EQ(count(*read, model::SurfaceClass::roof), 1U);
    EXPECT_EQ(count(*read, model::SurfaceClass::ground), 1U);
    double area = 0;
    const auto surface = model::surface_of(*read);
    for (const auto& t : surface.mesh.triangles) {
      const auto& v = surface.mesh.vertices;
      area += length(cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]])) / 2;
    }
    EXPECT_NEAR(area, 2 * 80 + 2 * 60 + 2 * 48, 1e-6);
  }
};

TEST_F(Models, are_read_from_every_version_and_kind_of_geometry) {
  expect_box(model(document(object(solid()))));
  expect_box(model(document(object(solid("2")), "", "1.0")));
  expect_box(model(document(object(solid()), "", "2.0")));
  const std::string values = "[0,1,2,2,2,2]";
  for (const auto* type : {"MultiSurface", "CompositeSurface"})
    expect_box(model(document(object(geometry(type, box_surfaces, values)))));
  for (const auto* type : {"MultiSolid", "CompositeSolid"})
    expect_box(model(document(object(geometry(type, "[[" + box_surfaces + "]]", "[[" + values + "]]")))));
}

TEST_F(Models, lie_in_a_frame_of_whole_metres_without_a_vertical_crs) {
  const auto read = model(document(object(solid()), "https://www.opengis.net/def/crs/EPSG/0/7415"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frame.crs, "EPSG:28992");  // 7415 is that with heights
  EXPECT_EQ(read->frame.origin, (std::array<std::int64_t, 3>{85005, 447004, 0}));
  EXPECT_EQ(read->buildings[0].parts[0].faces[0].loops[0][0], (Point3{-5, -4, 2}));
  const auto urn = model(document(object(solid()), "urn:ogc:def:crs:EPSG::28992"));
  ASSERT_TRUE(urn);
  EXPECT_EQ(urn->frame.crs, "EPSG:28992");
}

TEST_F(Models, put_parts_into_their_buildings_and_installations_into_their_parts) {
  const auto read = model(document(object(solid(), "a-1", "BuildingPart", R"("parents":["a"],)") + "," +
                                   object("", "a", "Building", R"("children":["a-1"],)") + "," +
                                   object(solid(), "chimney", "BuildingInstallation", R"("parents":["a-1"],)") + "," +
                                   object(solid(), "b") + R"(,"tree":{"type":"SolitaryVegetationObject"})"));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->buildings.size(), 2U);
  EXPECT_EQ(read->buildings[0].id, "a");
  ASSERT_EQ(read->buildings[0].parts.size(), 1U);
  EXPECT_EQ(read->buildings[0].parts[0].id, "a-1");
  EXPECT_EQ(read->buildings[0].parts[0].faces.size(), 12U);
  EXPECT_EQ(read->buildings[1].parts[0].id, "b");
  EXPECT_THAT(warned(*read, "ingest-model-left-out"), HasSubstr("1 SolitaryVegetationObject"));
}

TEST_F(Models, are_told_by_direction_where_semantics_are_missing_or_null) {
  const auto none = model(document(object(geometry("Solid", "[" + box_surfaces + "]"))));
  expect_box(none);
  EXPECT_THAT(warned(*none, "ingest-model-semantics"), HasSubstr("6 of 6"));
  for (const auto* values : {"[null]", "[[0,null,2]]", "null", "[[0,99,2,2,2,null]]"}) {
    const auto some = model(document(object(geometry("Solid", "[" + box_surfaces + "]", values))));
    expect_box(some);
    EXPECT_NE(warned(*some, "ingest-model-semantics"), "") << values;
  }
  EXPECT_EQ(warned(*model(document(object(solid()))), "ingest-model-semantics"), "");
}

TEST_F(Models, believe_semantics_against_the_direction) {
  const auto read = model(document(object(geometry("Solid", "[" + box_surfaces + "]", "[[2,2,1,1,1,1]]"))));
  ASSERT_TRUE(read);
  EXPECT_EQ(count(*read, model::SurfaceClass::roof), 4U);
  EXPECT_EQ(count(*read, model::SurfaceClass::wall), 2U);
}

TEST_F(Models, are_read_at_the_highest_lod_or_the_one_asked_for) {
  const std::string top = geometry("MultiSurface", "[[[4,5,6,7]]]", "[1]", "\"1.2\"");
  const std::string footprint = geometry("MultiSurface", "[[[0,1,2,3]]]", "", "\"0\"");
  const std::string both = document(object(footprint + "," + top + "," + solid()));
  const auto highest = model(both);
  expect_box(highest);
  EXPECT_EQ(highest->lod, "2.2");
  const auto low = model(both, "m.city.json", {"1", ""});
  ASSERT_TRUE(low);
  EXPECT_EQ(count(*low, model::SurfaceClass::roof), 1U);
  EXPECT_EQ(count(*low, model::SurfaceClass::wall), 0U);
  EXPECT_EQ(low->lod, "1.2");
  const auto missing = model(both, "m.city.json", {"3", ""});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, "ingest-model-lod");
  EXPECT_THAT(missing.error().message, HasSubstr("1.2, 2.2"));
  const auto mixed = model(document(object(solid()) + "," + object(top, "b")));
  ASSERT_TRUE(mixed);
  EXPECT_THAT(warned(*mixed, "ingest-model-lods"), HasSubstr("1 1.2, 1 2.2"));
  const auto twice = model(document(object(solid() + "," + solid())));
  expect_box(twice);
  EXPECT_THAT(warned(*twice, "ingest-model-left-out"), HasSubstr("1 geometries repeat"));
}

TEST_F(Models, leave_out_inner_shells_templates_and_faces_without_area_and_say_so) {
  const std::string shells = "[" + box_surfaces + "," + box_surfaces + "]";
  const auto read = model(document(object(geometry("Solid", shells, "[[0,1,2,2,2,2],[0,0,0,0,0,0]]") +
                                          R"(,{"type":"GeometryInstance","template":0,"boundaries":[0]})")));
  expect_box(read);
  EXPECT_THAT(warned(*read, "ingest-model-left-out"), HasSubstr("1 GeometryInstance"));
  const auto flat = model(document(object(geometry("MultiSurface", "[[[0,1]],[[0,1,0]],[[0,1,2,3]]]", "[0,0,0]"))));
  ASSERT_TRUE(flat);
  EXPECT_EQ(count(*flat, model::SurfaceClass::ground), 1U);
  EXPECT_THAT(warned(*flat, "ingest-model-face"), HasSubstr("2 faces"));
}

TEST_F(Models, keep_the_holes_of_a_face) {
  const auto read = model(R"({"type":"CityJSON","version":"2.0","CityObjects":{"a":{"type":"Building","geometry":[
    {"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2,3],[4,5,6,7]]]}]}},
    "vertices":[[0,0,5],[10,0,5],[10,10,5],[0,10,5],[4,4,5],[4,6,5],[6,6,5],[6,4,5]]})");
  ASSERT_TRUE(read) << read.error().message;
  const auto surface = model::surface_of(*read);
  double area = 0;
  for (const auto& t : surface.mesh.triangles) {
    const auto& v = surface.mesh.vertices;
    const auto n = cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]);
    EXPECT_GT(n.z, 0);
    area += n.z / 2;
  }
  EXPECT_NEAR(area, 96, 1e-9);
}

TEST_F(Models, are_read_from_a_line_per_feature_with_vertices_of_its_own) {
  const std::string head =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.001,0.001,0.001],"translate":[0,0,0]},"CityObjects":{},"vertices":[]})";
  const auto feature = [](const std::string& id) {
    return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{)" + object(solid(), id) +
           R"(},"vertices":)" + box_vertices + "}";
  };
  const auto read = model(head + "\n" + feature("a") + "\n" + feature("b") + "\n", "m.city.jsonl");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->buildings.size(), 2U);
  EXPECT_EQ(read->buildings[1].parts[0].faces.size(), 6U);
  const auto cut = model(head + "\n" + feature("a").substr(0, 60), "m.city.jsonl");
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().message, HasSubstr("line 2"));
}

TEST_F(Models, are_refused_by_what_is_wrong_with_them) {
  const auto code = [&](const std::string& text) {
    const auto read = model(text);
    return read ? std::string() : read.error().code;
  };
  EXPECT_EQ(code(""), "ingest-model-format");
  EXPECT_EQ(code("ply\n"), "ingest-model-format");
  EXPECT_EQ(code("{}"), "ingest-model-format");
  EXPECT_EQ(code(R"({"type":"FeatureCollection","features":[]})"), "ingest-model-format");
  EXPECT_EQ(code(document(object(solid()), "", "3.0")), "ingest-model-format");
  EXPECT_EQ(code(document(object(geometry("MultiSurface", "[[[0,1,99]]]")))), "ingest-model-format");
  EXPECT_EQ(code(document(object(geometry("MultiSurface", "[[[0,1,-1]]]")))), "ingest-model-format");
  EXPECT_EQ(code(document(object(geometry("MultiSurface", "7")))), "ingest-model-format");
  EXPECT_EQ(code(document(R"("t":{"type":"TINRelief"})")), "ingest-model-empty");
  EXPECT_EQ(code(document(object(solid()), "https://www.opengis.net/def/crs/EPSG/0/4326")), "ingest-model-crs");
  EXPECT_EQ(code(document(object(solid()), "https://www.opengis.net/def/crs/EPSG/0/2263")),
            "ingest-model-crs");  // feet
  EXPECT_EQ(code(document(object(solid()), "nowhere")), "ingest-model-crs");
  EXPECT_EQ(read_model(at("missing.json")).error().code, "file-missing");
}

TEST_F(Models, are_never_projected) {
  const std::string dutch = document(object(solid()), "urn:ogc:def:crs:EPSG::28992");
  const auto other = model(dutch, "m.city.json", {"", "EPSG:25831"});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, "ingest-model-crs");
  EXPECT_THAT(other.error().message, testing::AllOf(HasSubstr("EPSG:28992"), HasSubstr("EPSG:25831")));
  EXPECT_EQ(model(dutch, "m.city.json", {"", "local"})->frame.crs, "");
  EXPECT_EQ(model(dutch, "m.city.json", {"", "EPSG:7415"})->frame.crs, "EPSG:28992");
  EXPECT_EQ(model(document(object(solid())), "m.city.json", {"", "EPSG:25831"})->frame.crs, "EPSG:25831");
  const auto apart = in_frame(*model(dutch), {{0, 0, 0}, "EPSG:25831"});
  ASSERT_FALSE(apart);
  EXPECT_THAT(apart.error().message, testing::AllOf(HasSubstr("EPSG:28992"), HasSubstr("EPSG:25831")));
  const auto moved = in_frame(*model(dutch), {{85000, 447000, 2}, ""});
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->buildings[0].parts[0].faces[0].loops[0][0], (Point3{0, 0, 0}));
}

TEST_F(Models, are_read_from_obj_by_objects_groups_and_materials) {
  const std::string vertices =
      "# crs EPSG:28992\nv 0 0 0\nv 10 0 0\nv 10 8 0\nv 0 8 0\nv 0 0 6\nv 10 0 6\nv 10 8 6\nv 0 8 6\n";
  const std::string by_group = "o house 1\ng ROOF\nf 5 6 7 8\ng wall_south\nf 1/1 2/1 6/1 5/1\nf 2 3 7 6\n";
  const auto grouped = model(vertices + by_group + "f 3 4 8 7\nf 4 1 5 8\ng Ground\nf -8 -5 -6 -7\n", "m.obj");
  expect_box(grouped);
  EXPECT_EQ(grouped->frame.crs, "EPSG:28992");
  ASSERT_EQ(grouped->buildings.size(), 1U);
  EXPECT_EQ(grouped->buildings[0].id, "house 1");
  // Our own: an object per building, a group per part, a material per class; as they were, without objects.
  const auto whole = model(vertices + "o a\ng a-1\nusemtl party_wall\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n" +
                               "usemtl roof\nf 5 6 7 8\ng a-2\nusemtl ground\nf 1 4 3 2\n",
                           "m.obj");
  expect_box(whole);
  ASSERT_EQ(whole->buildings.size(), 1U);
  ASSERT_EQ(whole->buildings[0].parts.size(), 2U);
  EXPECT_EQ(whole->buildings[0].parts[1].id, "a-2");
  const auto ours = model(vertices + "g a-1\nusemtl party_wall\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n" +
                              "usemtl roof\nf 5 6 7 8\ng a-2\nusemtl ground\nf 1 4 3 2\n",
                          "m.obj");
  expect_box(ours);
  EXPECT_EQ(ours->buildings.size(), 2U);
  const auto bare = model(vertices + "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\nf 1 4 3 2\n", "m.obj");
  expect_box(bare);
  EXPECT_THAT(warned(*bare, "ingest-model-semantics"), HasSubstr("6 of 6"));
  const auto broken = model(vertices + "f 1 2 9\n", "m.obj");
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, HasSubstr("line 10"));
  EXPECT_EQ(model("nothing\n", "m.obj").error().code, "ingest-model-format");
}

TEST_F(Models, of_other_producers_are_read) {
  const test::fs::path shared = MANSARD_SHARED_DATA;
  if (!test::fs::exists(shared)) GTEST_SKIP() << "no shared data";
  const auto zurich = read_model(shared / "zurich/zurich_subset_lod2.json");
  ASSERT_TRUE(zurich) << zurich.error().message;
  EXPECT_EQ(zurich->buildings.size(), 49U);
  EXPECT_EQ(zurich->frame.crs, "EPSG:2056");
  EXPECT_EQ(model::surface_of(*zurich).lost, 0U);
  const auto rotterdam = read_model(shared / "sim_rotterdam/block_A_truth.obj");
  ASSERT_TRUE(rotterdam) << rotterdam.error().message;
  EXPECT_EQ(rotterdam->buildings.size(), 29U);
  EXPECT_EQ(warned(*rotterdam, "ingest-model-semantics"), "");
}

TEST_F(Models, and_meshes_far_apart_are_named_with_both_extents) {
  const geometry::Mesh here{{{0, 0, 0}, {10, 0, 0}, {0, 10, 5}}, {{0, 1, 2}}};
  const auto shifted = [&](Point3 by) {
    auto mesh = here;
    for (auto& v : mesh.vertices) v = v + by;
    return mesh;
  };
  const model::Frame frame{{1000, 2000, 0}, "EPSG:28992"};
  EXPECT_TRUE(check_overlap(here, shifted({5, 5, 2}), {"model", "mesh"}, frame, "m"));
  for (const Point3 by : {Point3{11, 0, 0}, {0, -11, 0}, {0, 0, 6}}) {
    const auto apart = check_overlap(here, shifted(by), {"model", "mesh"}, frame, "m");
    ASSERT_FALSE(apart);
    EXPECT_EQ(apart.error().code, "ingest-model-overlap");
    EXPECT_THAT(apart.error().message,
                testing::AllOf(HasSubstr("the model lies in x 1000.0 to 1010.0"), HasSubstr("the mesh in x "),
                               HasSubstr("z 0.0 to 5.0"), HasSubstr("EPSG:28992")));
  }
}

TEST_F(Models, stand_on_meshes_in_their_frame_with_the_classes_that_a_ply_has) {
  const auto ply = file("m.ply",
                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                        "property double z\nelement face 4\nproperty list uchar int vertex_indices\n"
                        "property uchar class\nend_header\n0 0 0\n10 0 0\n10 10 0\n0 10 0\n"
                        "3 0 1 2 1\n3 0 0 1 2\n3 0 2 3 0\n3 0 2 1 9\n");
  Options options;
  options.mesh_offset = {1000, 0, 0};
  const auto mesh = read_mesh({ply}, {{1005, 0, 0}, ""}, options);
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->mesh.triangles.size(), 2U);  // one had no area, one repeats the first
  EXPECT_EQ(mesh->classes, (std::vector{model::SurfaceClass::roof, model::SurfaceClass::wall}));
  EXPECT_EQ(mesh->mesh.vertices[0], (Point3{-5, 0, 0}));
  EXPECT_TRUE(read_mesh({ground()}, {}, {})->classes.empty());
  EXPECT_EQ(read_mesh({at("none.ply")}, {}, {}).error().code, "file-missing");
}

}  // namespace
}  // namespace mansard::ingest
