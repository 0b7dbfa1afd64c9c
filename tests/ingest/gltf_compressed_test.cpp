// Compressed glTF: compressed here by the libraries' own encoders, read back through the public function.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <meshoptimizer.h>

#include "ingest/gltf_workshop.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

auto packed_with_draco(const Surface& surface, int method) -> std::string {
  draco::TriangleSoupMeshBuilder builder;
  const auto faces = static_cast<int>(surface.corners.size() / 3);
  builder.Start(faces);
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (int f = 0; f < faces; ++f) {
    const auto corner = [&](int k) {
      return surface.points[surface.corners[static_cast<std::size_t>(3 * f + k)]].data();
    };
    builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(f)), corner(0), corner(1),
                                      corner(2));
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

auto draco_glb(const Surface& surface, std::string packed) -> std::string {
  auto json = plain_gltf(surface.points.size(), surface.corners.size());
  json["extensionsUsed"] = json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  json["meshes"][0]["primitives"][0]["extensions"] = {
      {"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}};
  json["accessors"][0].erase("bufferView");
  json["accessors"][1].erase("bufferView");
  json["bufferViews"] = {{{"buffer", 0}, {"byteLength", packed.size()}}};
  json["buffers"] = {{{"byteLength", packed.size()}}};
  return glb(json, std::move(packed));
}

/// Area in plan, positive where triangles face up, and the highest corner: the same for the same surface in any order.
struct Shape {
  double area = 0, high = -1e9;
};
auto shape_of(const model::Scene& scene) -> Shape {
  Shape out;
  for (const auto& t : scene.mesh.triangles) {
    const auto a = scene.mesh.vertices[t[0]], b = scene.mesh.vertices[t[1]], c = scene.mesh.vertices[t[2]];
    out.area += cross(xy(b) - xy(a), xy(c) - xy(a)) / 2;
    out.high = std::max({out.high, a.z, b.z, c.z});
  }
  return out;
}

class CompressedGltf : public Workshop {};

TEST_F(CompressedGltf, draco_gives_what_was_packed_by_either_of_its_methods) {
  const auto surface = grid(12);
  for (const int method : {int{draco::MESH_SEQUENTIAL_ENCODING}, int{draco::MESH_EDGEBREAKER_ENCODING}}) {
    const auto scene = mesh(file("d.glb", draco_glb(surface, packed_with_draco(surface, method))));
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_EQ(scene->mesh_counts.triangles, 288U);
    EXPECT_EQ(scene->mesh_counts.vertices, 169U);
    EXPECT_NEAR(shape_of(*scene).area, 144, 0.01);
    EXPECT_NEAR(shape_of(*scene).high, 1, 1e-3);
  }
}

TEST_F(CompressedGltf, damaged_draco_is_an_error_that_says_so) {
  const auto surface = grid(4);
  auto packed = packed_with_draco(surface, draco::MESH_EDGEBREAKER_ENCODING);
  packed.resize(packed.size() / 2);
  const auto scene = mesh(file("d.glb", draco_glb(surface, packed)));
  ASSERT_EQ(code(scene), "ingest-mesh-format");
  EXPECT_THAT(scene.error().message, HasSubstr("Draco"));
  auto other = draco_glb(surface, packed_with_draco(surface, draco::MESH_EDGEBREAKER_ENCODING));
  const auto at = other.find("\"POSITION\":0},\"bufferView\":0");
  ASSERT_NE(at, other.npos);
  other[at + 11] = '7';
  EXPECT_EQ(code(mesh(file("a.glb", other))), "ingest-mesh-format");
}

/// Views 0 (positions) and 1 (indices) unpacked into a buffer that is in no file, as gltfpack writes them.
struct MeshoptFile {
  Json json;
  std::string packed;
};
auto meshopt_file(const Surface& surface, bool exponential) -> MeshoptFile {
  auto points = surface.points;
  const std::size_t count = points.size();
  if (exponential) meshopt_encodeFilterExp(points.data(), count, 12, 20, surface.points[0].data());
  std::string positions(meshopt_encodeVertexBufferBound(count, 12), '\0');
  positions.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(positions.data()), positions.size(),
                                              points.data(), count, 12));
  std::string indices(meshopt_encodeIndexBufferBound(surface.corners.size(), count), '\0');
  indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()), indices.size(),
                                           surface.corners.data(), surface.corners.size()));
  MeshoptFile out{plain_gltf(count, surface.corners.size()), positions + indices};
  auto& json = out.json;
  json["extensionsUsed"] = json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const auto all = json["buffers"][0]["byteLength"];
  json["buffers"] = {{{"byteLength", out.packed.size()}},
                     {{"byteLength", all}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  for (auto& view : json["bufferViews"]) view["buffer"] = 1;
  json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0},      {"byteLength", positions.size()},
      {"byteStride", 12}, {"mode", "ATTRIBUTES"},
      {"count", count},   {"filter", exponential ? "EXPONENTIAL" : "NONE"}};
  json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0},         {"byteOffset", positions.size()}, {"byteLength", indices.size()}, {"byteStride", 4},
      {"mode", "TRIANGLES"}, {"count", surface.corners.size()}};
  return out;
}

TEST_F(CompressedGltf, meshopt_gives_what_was_packed_bit_for_bit) {
  const auto surface = grid(12);
  const auto plain = mesh(file("p.glb", plain_glb(surface)));
  ASSERT_TRUE(plain) << base::to_string(plain.error());
  const auto [json, packed] = meshopt_file(surface, false);
  const auto scene = mesh(file("m.glb", glb(json, packed)));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->mesh.vertices, plain->mesh.vertices);
  EXPECT_EQ(scene->mesh.triangles.size(), plain->mesh.triangles.size());
  EXPECT_EQ(shape_of(*scene).area, shape_of(*plain).area);
}

TEST_F(CompressedGltf, meshopt_filters_are_undone) {
  const auto surface = grid(12);
  const auto [json, packed] = meshopt_file(surface, true);
  const auto scene = mesh(file("m.glb", glb(json, packed)));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_NEAR(shape_of(*scene).area, 144, 1e-3);
  EXPECT_NEAR(shape_of(*scene).high, 1, 1e-4);
}

TEST_F(CompressedGltf, meshopt_in_a_file_beside_is_found_and_recorded) {
  const auto surface = grid(3);
  auto [json, packed] = meshopt_file(surface, false);
  json["buffers"][0]["uri"] = "the%20mesh.bin";
  const auto bin = file("the mesh.bin", packed);
  const auto scene = mesh(file("m.gltf", json.dump()));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->mesh_counts.triangles, 18U);
  ASSERT_EQ(scene->inputs.size(), 3U);
  EXPECT_EQ(scene->inputs[1].path, bin.string());
  EXPECT_EQ(scene->inputs[1].bytes, packed.size());
  fs::remove(bin);
  const auto none = mesh(at("m.gltf"));
  EXPECT_EQ(code(none), "file-missing");
}

TEST_F(CompressedGltf, damaged_meshopt_is_an_error_that_says_so) {
  const auto surface = grid(3);
  auto [json, packed] = meshopt_file(surface, false);
  const auto read_with = [&](auto change) {
    Json changed = json;
    std::string bytes = packed;
    change(changed["bufferViews"], bytes);
    return mesh(file("m.glb", glb(changed, bytes)));
  };
  const auto packing = [](Json& views) -> Json& { return views[0]["extensions"]["EXT_meshopt_compression"]; };
  EXPECT_EQ(code(read_with([](Json&, std::string&) {})), "");
  const auto bad = read_with([](Json&, std::string& bytes) { bytes[0] = 'x'; });
  ASSERT_EQ(code(bad), "ingest-mesh-format");
  EXPECT_THAT(bad.error().message, HasSubstr("meshopt"));
  EXPECT_EQ(code(read_with([&](Json& v, std::string&) { packing(v)["count"] = 100000; })), "ingest-mesh-format");
  EXPECT_EQ(code(read_with([&](Json& v, std::string&) { packing(v)["byteStride"] = 3; })), "ingest-mesh-format");
  EXPECT_EQ(code(read_with([&](Json& v, std::string&) { packing(v)["buffer"] = 9; })), "ingest-mesh-format");
  EXPECT_EQ(code(read_with([&](Json& v, std::string&) { packing(v)["filter"] = "NEW"; })), "ingest-mesh-format");
  EXPECT_EQ(code(read_with([&](Json& v, std::string&) { packing(v)["byteLength"] = 1 << 30; })), "ingest-mesh-format");
}

TEST_F(CompressedGltf, only_extensions_that_change_no_geometry_may_be_required_unknown) {
  const auto requiring = [&](const char* extension) {
    return mesh(file("r.glb", plain_glb(grid(2), {{"extensionsRequired", {extension}}})));
  };
  for (const char* harmless : {"KHR_texture_transform", "KHR_texture_basisu", "KHR_materials_unlit"})
    EXPECT_EQ(code(requiring(harmless)), "") << harmless;
  const auto unknown = requiring("EXT_mesh_gpu_instancing");
  ASSERT_EQ(code(unknown), "ingest-mesh-format");
  EXPECT_THAT(unknown.error().message, HasSubstr("EXT_mesh_gpu_instancing"));
}

TEST_F(CompressedGltf, a_centre_beside_the_file_is_added_with_z_up) {
  const Json more = {{"extensions", {{"CESIUM_RTC", {{"center", {1000.5, 2000.25, 30}}}}}}};
  const auto scene = mesh(file("c.glb", plain_glb(triangle_at(1, 2, 3), more)));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  const auto& o = scene->frame.origin;
  EXPECT_EQ(scene->mesh.vertices[0].x + static_cast<double>(o[0]), 1001.5);
  EXPECT_EQ(scene->mesh.vertices[0].y + static_cast<double>(o[1]), 2002.25);
  EXPECT_EQ(scene->mesh.vertices[0].z + static_cast<double>(o[2]), 33);
}

}  // namespace
}  // namespace mansard::ingest::test
