// STL, COLLADA and FBX as meshes.
#include <gmock/gmock.h>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;
using testing::ElementsAre;
using testing::HasSubstr;

class Assimp : public testing::Test {
 protected:
  auto read(const std::string& name, std::string_view bytes, UpAxis up = UpAxis::automatic) -> MeshPiece {
    EXPECT_TRUE(base::write_file(folder_ / name, bytes));
    return read_mesh_file(folder_ / name, up);
  }
  const mansard::test::Scratch folder_;
};

auto near(double x, double y, double z) {
  return testing::Truly([=](const Point3& p) { return length(p - Point3{x, y, z}) < 1e-5; });
}

const std::string stl_text =
    "solid house\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1.5\nvertex 4 0 1.5\nvertex 0 3 1.5\n"
    "endloop\nendfacet\nendsolid house\n";

/// A quad with a corner at (0, 2, 3), moved by (10, 20, 30).
auto fbx(int up_axis, double unit) -> std::string {
  return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7300\n}\n"
         "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\"," +
         std::to_string(up_axis) + "\n\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," +
         std::to_string(unit) +
         "\n\t}\n}\nObjects:  {\n\tGeometry: 1, \"Geometry::quad\", \"Mesh\" {\n\t\tVertices: *12 {\n\t\t\ta: "
         "0,0,0,1,0,0,1,2,0,0,2,3\n\t\t}\n\t\tPolygonVertexIndex: *4 {\n\t\t\ta: 0,1,2,-4\n\t\t}\n\t}\n"
         "\tModel: 2, \"Model::quad\", \"Mesh\" {\n\t\tVersion: 232\n\t\tProperties70:  {\n\t\t\tP: "
         "\"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",10,20,30\n\t\t}\n\t}\n}\nConnections:  {\n"
         "\tC: \"OO\",2,0\n\tC: \"OO\",1,2\n}\n";
}

/// The same in centimetres, with z up.
const std::string collada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
 <library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 100 200 0 0 200 300</float_array>
   <technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y"
   type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s"><node id="n"><translate>1000 2000 3000</translate>
  <instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";

TEST_F(Assimp, reads_stl_as_text_and_binary) {
  const auto text = read("a.stl", stl_text);
  ASSERT_FALSE(text.failure) << to_string(*text.failure);
  EXPECT_THAT(text.mesh.vertices, ElementsAre(near(0, 0, 1.5), near(4, 0, 1.5), near(0, 3, 1.5)));
  EXPECT_THAT(text.mesh.triangles, ElementsAre(geometry::Triangle{0, 1, 2}));

  std::string bytes(80, ' ');
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(std::uint32_t{1});
  for (const float c : {0.F, 0.F, 1.F, 0.F, 0.F, 1.5F, 4.F, 0.F, 1.5F, 0.F, 3.F, 1.5F}) put(c);
  put(std::uint16_t{0});
  const auto binary = read("b.stl", bytes);
  ASSERT_FALSE(binary.failure) << to_string(*binary.failure);
  EXPECT_THAT(binary.mesh.vertices, ElementsAre(near(0, 0, 1.5), near(4, 0, 1.5), near(0, 3, 1.5)));
  EXPECT_THAT(read("c.stl", bytes, UpAxis::y).mesh.vertices,
              ElementsAre(near(0, -1.5, 0), near(4, -1.5, 0), near(0, -1.5, 3)));
}

TEST_F(Assimp, takes_unit_and_axis_of_fbx_from_the_file) {
  const auto metres = read("z.fbx", fbx(2, 100));
  ASSERT_FALSE(metres.failure) << to_string(*metres.failure);
  EXPECT_THAT(metres.mesh.vertices,
              ElementsAre(near(10, 20, 30), near(11, 20, 30), near(11, 22, 30), near(10, 22, 33)));
  EXPECT_EQ(metres.mesh.triangles.size(), 2U);
  EXPECT_THAT(read("y.fbx", fbx(1, 1)).mesh.vertices,
              ElementsAre(near(.1, -.3, .2), near(.11, -.3, .2), near(.11, -.3, .22), near(.1, -.33, .22)));
  EXPECT_THAT(read("z2.fbx", fbx(1, 100), UpAxis::z).mesh.vertices.back(), near(10, 22, 33));
}

TEST_F(Assimp, takes_unit_and_axis_of_collada_from_the_file) {
  const auto mesh = read("z.dae", collada);
  ASSERT_FALSE(mesh.failure) << to_string(*mesh.failure);
  EXPECT_THAT(mesh.mesh.vertices, ElementsAre(near(10, 20, 30), near(11, 20, 30), near(11, 22, 30), near(10, 22, 33)));
}

TEST_F(Assimp, says_where_single_precision_is_coarse) {
  EXPECT_THAT(read("near.stl", stl_text).warnings, testing::IsEmpty());
  std::string far = stl_text;
  far.replace(far.find("vertex 4"), 8, "vertex 84800");
  const auto mesh = read("far.stl", far);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_EQ(mesh.warnings[0].code, "ingest-mesh-precision");
  EXPECT_THAT(mesh.warnings[0].message, HasSubstr("84800 m"));
}

TEST_F(Assimp, refuses_what_is_not_the_format) {
  for (const auto* name : {"x.stl", "x.fbx", "x.dae"}) {
    const auto mesh = read(name, "these are no triangles");
    ASSERT_TRUE(mesh.failure) << name;
    EXPECT_EQ(mesh.failure->code, "ingest-mesh-format") << name;
    EXPECT_EQ(read(name, "").failure->code, "ingest-mesh-empty");
  }
  // Whole files of each, cut anywhere, end with an error or with what is there; none takes the program along.
  for (const auto& [name, bytes] : {std::pair{"t.stl", stl_text}, {"t.fbx", fbx(2, 100)}, {"t.dae", collada}})
    for (std::size_t size = 1; size < bytes.size(); size += 37) {
      const auto mesh = read(name, std::string_view(bytes).substr(0, size));
      EXPECT_LE(mesh.mesh.triangles.size(), 2U);
    }
}

TEST_F(Assimp, opens_no_file_that_is_named_in_the_bytes) {
  ASSERT_TRUE(base::write_file(folder_ / "secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  std::string named = collada;
  named.replace(named.find("url=\"#g\""), 8, "url=\"secret.obj#g\"");
  EXPECT_TRUE(read("named.dae", named).mesh.triangles.empty());
}

}  // namespace
}  // namespace mansard::formats
