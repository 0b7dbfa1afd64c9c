#include <gmock/gmock.h>
#include <bit>
#include <cstring>

#include "ingest/workshop.hpp"

namespace mansard::ingest::test {
namespace {

using geometry::Point3;
using geometry::Triangle;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Obj : public Workshop {};
class Ply : public Workshop {};
class Off : public Workshop {};
class Gltf : public Workshop {};
class Files : public Workshop {};

template <class T>
void put(std::string& bytes, T value, bool big = false) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

auto glb(std::string json, std::string binary) -> std::string {
  while (json.size() % 4 != 0) json += ' ';
  while (binary.size() % 4 != 0) binary += '\0';
  std::string out = "glTF";
  put<std::uint32_t>(out, 2);
  put<std::uint32_t>(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size()));
  put<std::uint32_t>(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put<std::uint32_t>(out, static_cast<std::uint32_t>(binary.size()));
  out += std::string("BIN\0", 4) + binary;
  return out;
}

/// A quad of four corners, three floats each, and indices of 16 bits.
auto quad_bytes() -> std::string {
  std::string bytes;
  for (const float c : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 2.F, 0.F, 0.F, 2.F, 0.F}) put(bytes, c);
  for (const int i : {0, 1, 2, 0, 2, 3}) put(bytes, static_cast<std::uint16_t>(i));
  return bytes;
}

auto quad_json(const std::string& node, const std::string& primitive, const std::string& more = "") -> std::string {
  return R"({"asset":{"version":"2.0"},)" + more + R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + node +
         R"(],"meshes":[{"primitives":[)" + primitive +
         R"(]}],"buffers":[{"byteLength":60}],"bufferViews":[{"buffer":0,"byteLength":48},)"
         R"({"buffer":0,"byteOffset":48,"byteLength":12}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,2,0]},)"
         R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]})";
}
const std::string indexed = R"({"attributes":{"POSITION":0},"indices":1})";

TEST_F(Obj, reads_slashes_colours_and_windows_line_ends) {
  const auto scene = mesh(file("m.obj",
                               "# c\r\nmtllib a.mtl\r\nv 0 0 0 0.5 0.5 0.5\r\nv 1 0 0 1\r\n\tv  0 1 2.5e0\r\n"
                               "vt 0 0\r\nvn 0 0 1\r\nf 1/1/1 2/1 3//1 # end\r\n"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(scene->mesh.vertices, ElementsAre(Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{0, 1, 2.5}));
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST_F(Obj, starts_after_the_mark_that_editors_put_before_utf8) {
  const auto scene = mesh(file("m.obj", "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 2 1\nf 1 2 3\nf 1 2 4\n"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 3}));
  EXPECT_EQ(scene->mesh.vertices.at(0), (Point3{0, 0, 0}));
}

TEST_F(Obj, counts_negative_indices_back_from_where_the_face_stands) {
  const auto scene =
      mesh(file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nv 6 5 5\nv 5 6 5\nf -3 -2 -1\n"));
  ASSERT_TRUE(scene);
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 5}));
}

TEST_F(Obj, cuts_polygons_into_fans_and_joins_continued_lines) {
  const auto scene = mesh(file("m.obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 \\\n4 5\n"));
  ASSERT_TRUE(scene);
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
}

TEST_F(Obj, keeps_the_digits_of_large_coordinates) {
  const auto path =
      file("m.obj", "v 84929.574 447500.491 3.25\nv 84930.574 447500.491 3\nv 84929.574 447501.491 3\nf 1 2 3\n");
  const auto scene = read({path}, polygons({square(84920, 447490, 20)}));
  ASSERT_TRUE(scene);
  const auto& o = scene->frame.origin;
  EXPECT_EQ(o, (std::array<std::int64_t, 3>{84930, 447500, 0}));
  EXPECT_EQ(scene->mesh.vertices[0].x + static_cast<double>(o[0]), 84929.574);
  EXPECT_EQ(scene->mesh.vertices[0].y + static_cast<double>(o[1]), 447500.491);
}

TEST_F(Obj, says_in_which_line_it_stops_making_sense) {
  const auto scene = mesh(file("m.obj", "v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n"));
  ASSERT_EQ(code(scene), "ingest-mesh-format");
  EXPECT_THAT(scene.error().message, HasSubstr("line 2"));
  EXPECT_EQ(code(mesh(file("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2"))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("o.obj", "hello\nworld\n"))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("p.obj", std::string("v 0 0 0\0\1\2", 10)))), "ingest-mesh-format");
}

TEST_F(Ply, reads_text_with_other_properties_between) {
  const auto scene =
      mesh(file("m.ply",
                "ply\nformat ascii 1.0\ncomment x\nobj_info y\nelement camera 1\nproperty list uchar int a\n"
                "element vertex 4\nproperty uchar red\nproperty double x\nproperty float y\n"
                "property int z\nelement face 1\nproperty int id\nproperty list uchar uint vertex_index\n"
                "end_header\n2 7 8\n255 0 0 0\n255 1 0 0\n255 1.5 1 0\n255 0 1 0\n9 4 0 1 2 3\n"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(scene->mesh.vertices, ElementsAre(Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{1.5, 1, 0}, Point3{0, 1, 0}));
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

class PlyOfEitherByteOrder : public Workshop, public ::testing::WithParamInterface<bool> {};

TEST_P(PlyOfEitherByteOrder, reads_the_same) {
  const bool big = GetParam();
  for (const std::string end : {"\n", "\r\n"}) {
    std::string bytes;
    for (const std::string& line :
         {std::string("ply"), std::string(big ? "format binary_big_endian 1.0" : "format binary_little_endian 1.0"),
          std::string("element vertex 3"), std::string("property float64 x"), std::string("property float32 y"),
          std::string("property int16 z"), std::string("property uchar quality"), std::string("element face 1"),
          std::string("property list uint16 int32 vertex_indices"), std::string("property list uchar float texcoord"),
          std::string("end_header")})
      bytes += line + end;
    for (int i = 0; i < 3; ++i) {
      put(bytes, i == 1 ? 84929.574 : 0.0, big);
      put(bytes, i == 2 ? 0.1F : 0.0F, big);
      put(bytes, static_cast<std::int16_t>(-300 * i), big);
      put(bytes, std::uint8_t{10}, big);  // a line end as data, which must stay data
    }
    put(bytes, std::uint16_t{3}, big);
    for (const std::int32_t i : {2, 1, 0}) put(bytes, i, big);
    put(bytes, std::uint8_t{1}, big);
    put(bytes, 0.5F, big);
    const auto scene = mesh(file("m.ply", bytes));
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    const auto x0 = static_cast<double>(scene->frame.origin[0]);
    ASSERT_EQ(scene->mesh.vertices.size(), 3U);
    EXPECT_EQ(scene->mesh.vertices[1].x + x0, 84929.574);
    EXPECT_EQ(scene->mesh.vertices[2].y, static_cast<double>(0.1F));
    EXPECT_EQ(scene->mesh.vertices[2].z, -600);
    EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{2, 1, 0}));
    EXPECT_EQ(code(mesh(file("short.ply", bytes.substr(0, bytes.size() - 6)))), "ingest-mesh-truncated");
    EXPECT_EQ(code(mesh(file("none.ply", bytes.substr(0, bytes.size() - 24)))), "ingest-mesh-truncated");
  }
}
INSTANTIATE_TEST_SUITE_P(, PlyOfEitherByteOrder, ::testing::Bool(),
                         [](const auto& given) { return given.param ? "big" : "little"; });

TEST_F(Ply, reads_triangle_strips) {
  const auto scene =
      mesh(file("m.ply",
                "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n8 0 1 2 3 -1 2 3 4\n"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}, Triangle{2, 3, 4}));
  EXPECT_EQ(scene->mesh_counts.flipped_edges, 0U);
}

TEST_F(Ply, does_not_believe_a_header_that_promises_more_than_the_file_holds) {
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    const auto scene = mesh(file("m.ply", "ply\nformat " + format + " 1.0\nelement vertex 9000000000000000000\n" +
                                              vertex + "end_header\n0 0 0\n"));
    ASSERT_EQ(code(scene), "ingest-points-truncated");  // without faces, it is a point cloud
    EXPECT_THAT(scene.error().message, HasSubstr("9000000000000000000"));
  }
  // A list that says it is longer than the file.
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + vertex +
                      "element face 1\nproperty list uint int vertex_indices\nend_header\n";
  for (int i = 0; i < 3; ++i) put(bytes, 0.F);
  put(bytes, std::uint32_t{4000000000U});
  put(bytes, std::uint32_t{0});
  EXPECT_NE(code(mesh(file("list.ply", bytes))), "");
}

TEST_F(Ply, refuses_headers_it_cannot_follow) {
  EXPECT_EQ(code(mesh(file("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"))),
            "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("b.ply", "ply\nformat rot13 1.0\nend_header\n"))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("c.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n0\n"))),
            "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("d.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n"))),
            "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("e.ply", "solid not a ply\n"))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("f.ply",
                           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\nend_header\n0 0 0\n0 zero 0\n0 0 0\n"))),
            "ingest-points-format");
}

TEST_F(Off, reads_comments_colours_and_counts_beside_the_keyword) {
  for (const std::string head :
       {"OFF\n4 1 0\n", "OFF 4 1 0\n", "COFF\n# c\n\n4 1 0 # counts\n", "4 1\n", "STCNOFF\r\n4 1 0\r\n"}) {
    const auto scene = mesh(
        file("m.off", head + "0 0 0 255 0 0 255\n# between\n1 0 0\n1 1 0\n\n0 1 0 # last\n4 0 1 2 3 0.5 0.5 0.5\n"));
    ASSERT_TRUE(scene) << head << base::to_string(scene.error());
    EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  }
}

TEST_F(Off, refuses_what_is_short_binary_or_has_other_dimensions) {
  EXPECT_EQ(code(mesh(file("a.off", "OFF\n"))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1"))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("d.off", "OFF\n900000000000 900000000000 0\n0 0 0\n"))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("e.off", "OFF BINARY\n\1\2\3\n"))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("f.off", "4OFF\n1 1 0\n0 0 0 0\n"))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("g.off", "OFF\nthree 1 0\n"))), "ingest-mesh-format");
}

TEST_F(Gltf, turns_y_up_to_z_up) {
  const auto scene = mesh(file("m.glb", glb(quad_json(R"({"mesh":0})", indexed), quad_bytes())));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(scene->mesh.vertices, ElementsAre(Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{1, 0, 2}, Point3{0, 0, 2}));
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  Options options;
  options.up = formats::UpAxis::z;
  const auto lying = mesh(at("m.glb"), options);
  ASSERT_TRUE(lying);
  EXPECT_EQ(lying->mesh.vertices[2], (Point3{1, 2, 0}));
}

TEST_F(Gltf, follows_the_transforms_of_nested_nodes_in_double_precision) {
  const std::string nodes = R"({"children":[1],"translation":[500000.125,10,-4000000.25]},)"
                            R"({"mesh":0,"rotation":[0,0.7071067811865476,0,0.7071067811865476],"scale":[2,1,1]})";
  Options options;
  options.crs = "local";
  const auto scene = read({file("m.glb", glb(quad_json(nodes, indexed), quad_bytes()))},
                          polygons({square(499990, 3999990, 20)}), options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  // Scaled (2, 2, 0), turned by 90° about y: (0, 2, −2), moved, and up made z.
  const auto& p = scene->mesh.vertices[2];
  EXPECT_NEAR(p.x + static_cast<double>(scene->frame.origin[0]), 500000.125, 1e-9);
  EXPECT_NEAR(p.y + static_cast<double>(scene->frame.origin[1]), 4000002.25, 1e-9);
  EXPECT_NEAR(p.z, 12, 1e-12);
}

TEST_F(Gltf, keeps_the_outside_outside_under_a_mirroring_matrix) {
  const std::string node = R"({"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]})";
  const auto scene = mesh(file("m.glb", glb(quad_json(node, indexed), quad_bytes())));
  ASSERT_TRUE(scene);
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 2, 1}, Triangle{0, 3, 2}));
}

TEST_F(Gltf, reads_strips_fans_and_primitives_without_indices) {
  const std::string strip = R"({"attributes":{"POSITION":0},"mode":5})",
                    fan = R"({"attributes":{"POSITION":0},"mode":6})";
  const std::string lines = R"({"attributes":{"POSITION":0},"mode":1})";
  const auto one = mesh(file("s.glb", glb(quad_json(R"({"mesh":0})", strip), quad_bytes())));
  ASSERT_TRUE(one);
  EXPECT_THAT(one->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
  const auto two = mesh(file("f.glb", glb(quad_json(R"({"mesh":0})", fan + "," + lines), quad_bytes())));
  ASSERT_TRUE(two);
  EXPECT_THAT(two->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST_F(Gltf, reads_interleaved_and_quantised_positions) {
  std::string bytes;
  for (const auto& p : {std::array{0, 0, 0}, std::array{32767, 0, 0}, std::array{0, 32767, -32767}}) {
    for (const int c : p) put(bytes, static_cast<std::int16_t>(c));
    put(bytes, std::uint16_t{77});
  }
  const std::string json =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)"
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":24}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":24,"byteStride":8}],)"
      R"("accessors":[{"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"}]})";
  const auto scene = mesh(file("q.glb", glb(json, bytes)));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_THAT(scene->mesh.vertices, ElementsAre(Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{0, 1, 1}));
}

TEST_F(Gltf, reads_data_uris_whatever_type_they_say) {
  const std::string base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAAEAAAAAAAAAAAAAAAEAAAAAAAAABAAIAAAACAAMA";
  std::string escaped;
  for (const char c : quad_bytes()) {
    constexpr const char* digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    escaped += std::string("%") + digits[byte >> 4] + digits[byte & 15];
  }
  const auto glb_mesh = mesh(file("q.glb", glb(quad_json(R"({"mesh":0})", indexed), quad_bytes())));
  ASSERT_TRUE(glb_mesh);
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + base64, "data:;base64," + base64, "data:model/x;a=b;base64," + base64,
        R"(data:application\/gltf-buffer;base64,)" + base64, "data:," + escaped}) {
    auto json = quad_json(R"({"mesh":0})", indexed);
    const std::string buffer = R"({"byteLength":60)";
    json.replace(json.find(buffer), buffer.size(), buffer + R"(,"uri":")" + uri + "\"");
    const auto scene = mesh(file("u.gltf", json));
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_EQ(scene->mesh.vertices, glb_mesh->mesh.vertices) << uri;
    EXPECT_EQ(scene->mesh.triangles, glb_mesh->mesh.triangles) << uri;
    // A picture of no type, which no mesh needs, is no reason to refuse one.
    json.insert(json.size() - 1, R"(,"images":[{"uri":"data:;base64,QUJD"}])");
    EXPECT_TRUE(mesh(file("i.gltf", json))) << uri;
  }
}

TEST_F(Gltf, refuses_truncated_and_impossible_files) {
  const auto bytes = glb(quad_json(R"({"mesh":0})", indexed), quad_bytes());
  EXPECT_EQ(code(mesh(file("t.glb", bytes.substr(0, bytes.size() - 20)))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("h.glb", "glTF"))), "ingest-mesh-truncated");
  EXPECT_EQ(code(mesh(file("n.gltf", "{\"asset\":"))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("w.glb", "not a glb at all"))), "ingest-mesh-format");
  const auto one = std::string("glTF") + std::string("\1\0\0\0", 4) + bytes.substr(8);
  EXPECT_THAT(mesh(file("1.glb", one)).error().message, HasSubstr("glTF 1.0"));
  // More corners than the buffer has, and a node that is its own parent.
  auto far = quad_json(R"({"mesh":0})", indexed);
  far.replace(far.find("\"count\":4"), 9, "\"count\":9");
  EXPECT_EQ(code(mesh(file("c.glb", glb(far, quad_bytes())))), "ingest-mesh-format");
  EXPECT_EQ(code(mesh(file("l.glb", glb(quad_json(R"({"mesh":0,"children":[0]})", indexed), quad_bytes())))),
            "ingest-mesh-format");
}

TEST_F(Files, several_are_one_mesh_whose_indices_do_not_mix) {
  const auto a = file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
  const auto b = file("b.off", "3 1 0\n5 0 0\n6 0 0\n5 1 0\n3 0 1 2\n");
  const auto scene = read({a, b}, polygons({square(0, 0)}));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->mesh.vertices.size(), 6U);
  EXPECT_THAT(scene->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 5}));
  EXPECT_EQ(scene->mesh_counts.out_of_range, 1U);
}

TEST_F(Files, a_folder_is_all_meshes_in_it_by_name) {
  file("tiles/b/t.obj", "v 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\n");
  file("tiles/a/t.OBJ", "v 1 0 0\nv 2 0 0\nv 1 1 0\nf 1 2 3\n");
  file("tiles/readme.txt", "nothing");
  const auto scene = read({at("tiles")}, polygons({square(0, 0)}));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  ASSERT_EQ(scene->mesh.vertices.size(), 6U);
  EXPECT_EQ(scene->mesh.vertices[0].x, 1);
  EXPECT_EQ(scene->mesh.vertices[3].x, 5);
  ASSERT_EQ(scene->inputs.size(), 3U);
  EXPECT_THAT(scene->inputs[0].path, HasSubstr("t.OBJ"));
  fs::create_directories(at("empty"));
  EXPECT_EQ(code(mesh(at("empty"))), "ingest-mesh-empty");
}

TEST_F(Files, are_known_by_their_size_and_hash) {
  const auto scene = read({file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}, polygons({square(0, 0)}));
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->inputs[0].bytes, 32U);
  // printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' | sha256sum
  EXPECT_EQ(scene->inputs[0].sha256, "697b00ab13410c52a542d2e9c63711fcc04e9cbf6c0d3439a9b43cc812e6e713");
  EXPECT_EQ(scene->inputs[1].sha256.size(), 64U);
}

TEST_F(Files, that_are_missing_empty_or_something_else_are_named) {
  const auto missing = mesh(at("nowhere.ply"));
  ASSERT_EQ(code(missing), "file-missing");
  EXPECT_THAT(missing.error().subject, HasSubstr("nowhere.ply"));
  EXPECT_EQ(code(mesh(file("empty.ply", ""))), "ingest-mesh-empty");
  EXPECT_EQ(code(mesh(file("m.dae", "<COLLADA/>"))), "ingest-mesh-format");
  EXPECT_EQ(code(read({}, polygons({square()}))), "ingest-mesh-empty");
}

}  // namespace
}  // namespace mansard::ingest::test
