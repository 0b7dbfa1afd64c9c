// OSGB with its trees of levels, written by OpenSceneGraph itself.
#include "mansard/formats/osgb/osgb_file.hpp"

#include <gmock/gmock.h>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/image.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using geometry::Point3;
using testing::ElementsAre;
using testing::IsEmpty;

/// A strip of `triangles` triangles from (x, 0, 5) on.
auto strip(float x, int triangles) -> osg::ref_ptr<osg::Geometry> {
  osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
  osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
  for (int i = 0; i < triangles + 2; ++i)
    vertices->push_back(osg::Vec3(x + static_cast<float>(i / 2), static_cast<float>(i % 2), 5));
  geometry->setVertexArray(vertices.get());
  geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, triangles + 2));
  return geometry;
}
auto leaf(float x, int triangles) -> osg::ref_ptr<osg::Geode> {
  osg::ref_ptr<osg::Geode> geode = new osg::Geode;
  geode->addDrawable(strip(x, triangles).get());
  return geode;
}

class OsgbFile : public testing::Test {
 protected:
  void write(const osg::Node& node, const std::string& name, const char* options = "") const {
    fs::create_directories((folder_ / name).parent_path());
    const osg::ref_ptr<osgDB::Options> how = new osgDB::Options(options);
    ASSERT_TRUE(osgDB::writeNodeFile(node, (folder_ / name).string(), how.get())) << name;
  }
  /// One triangle, with a finer level of two in the file that is named.
  void write_paged(const std::string& name, const std::string& finer) const {
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
    lod->addChild(leaf(0, 1).get(), 0, 500);
    lod->setFileName(1, finer);
    lod->setRange(1, 500, 1e30F);
    write(*lod, name);
  }
  [[nodiscard]] auto mesh(const std::string& name, UpAxis up = UpAxis::automatic) const -> MeshPiece {
    return read_mesh_file(folder_ / name, up);
  }
  const mansard::test::Scratch folder_;
};

TEST_F(OsgbFile, has_its_triangles_where_its_transforms_place_them) {
  osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(osg::Matrixd::translate(84800.0625, 447400, 1));
  place->addChild(leaf(0, 2).get());
  write(*place, "a.osgb");
  const auto piece = mesh("a.osgb");
  ASSERT_FALSE(piece.failure) << to_string(*piece.failure);
  EXPECT_THAT(piece.mesh.vertices, ElementsAre(Point3{84800.0625, 447400, 6}, Point3{84800.0625, 447401, 6},
                                               Point3{84801.0625, 447400, 6}, Point3{84801.0625, 447401, 6}));
  EXPECT_THAT(piece.mesh.triangles, ElementsAre(geometry::Triangle{0, 1, 2}, geometry::Triangle{1, 3, 2}));
  EXPECT_EQ(mesh("a.osgb", UpAxis::y).mesh.vertices[0], (Point3{84800.0625, -6, 447400}));
}

TEST_F(OsgbFile, gives_the_finest_level_of_a_tree) {
  write(*leaf(20, 4), "Tile/Tile_L16_0.osgb");
  write_paged("Tile/Tile_L15_0.osgb", "Tile_L16_0.osgb");
  write_paged("Tile/Tile.osgb", "Tile_L15_0.osgb");
  const auto piece = mesh("Tile/Tile.osgb");
  ASSERT_FALSE(piece.failure) << to_string(*piece.failure);
  EXPECT_EQ(piece.mesh.triangles.size(), 4U);
  EXPECT_THAT(piece.warnings, IsEmpty());
  ASSERT_EQ(piece.inputs.size(), 3U);
  EXPECT_EQ(fs::path(piece.inputs[1].path).filename(), "Tile_L15_0.osgb");
  EXPECT_EQ(piece.inputs[2].bytes, fs::file_size(folder_ / "Tile/Tile_L16_0.osgb"));
}

TEST_F(OsgbFile, takes_the_nearest_range_where_levels_go_by_distance) {
  osg::ref_ptr<osg::LOD> lod = new osg::LOD;
  lod->addChild(leaf(0, 1).get(), 100, 1000);
  lod->addChild(leaf(0, 3).get(), 0, 100);
  write(*lod, "a.osgb");
  EXPECT_EQ(mesh("a.osgb").mesh.triangles.size(), 3U);
}

TEST_F(OsgbFile, takes_the_coarser_level_where_a_file_is_missing_and_says_so) {
  write_paged("Tile.osgb", "Tile_L15_0.osgb");
  const auto piece = mesh("Tile.osgb");
  ASSERT_FALSE(piece.failure) << to_string(*piece.failure);
  EXPECT_EQ(piece.mesh.triangles.size(), 1U);
  ASSERT_EQ(piece.warnings.size(), 1U);
  EXPECT_EQ(piece.warnings[0].code, "ingest-mesh-level");
  EXPECT_EQ(piece.warnings[0].subject, (folder_ / "Tile_L15_0.osgb").string());
}

TEST_F(OsgbFile, reads_nothing_outside_its_folder) {
  write(*leaf(0, 2), "secret.osgb");
  for (const std::string& name : {std::string("../secret.osgb"), (folder_ / "secret.osgb").string(),
                                  std::string("..\\secret.osgb"), std::string("x/../../secret.osgb")}) {
    write_paged("tile/Tile.osgb", name);
    const auto piece = mesh("tile/Tile.osgb");
    ASSERT_FALSE(piece.failure) << name;
    EXPECT_EQ(piece.mesh.triangles.size(), 1U) << name;
    EXPECT_EQ(piece.warnings.size(), 1U) << name;
  }
}

TEST_F(OsgbFile, that_refers_to_itself_is_refused) {
  write_paged("a.osgb", "b.osgb");
  write_paged("b.osgb", "a.osgb");
  const auto piece = mesh("a.osgb");
  ASSERT_TRUE(piece.failure);
  EXPECT_EQ(piece.failure->code, "ingest-mesh-format");
}

TEST_F(OsgbFile, cut_anywhere_ends_with_an_error) {
  write(*leaf(0, 40), "a.osgb");
  const auto whole = base::read_file(folder_ / "a.osgb");
  ASSERT_TRUE(whole);
  for (std::size_t size = 8; size < whole->size(); size += 11) {
    ASSERT_TRUE(base::write_file(folder_ / "cut.osgb", std::string_view(*whole).substr(0, size)));
    const auto piece = mesh("cut.osgb");
    EXPECT_TRUE(piece.failure || piece.mesh.triangles.size() <= 40) << size;
  }
  ASSERT_TRUE(base::write_file(folder_ / "named.osgb", "an OSGB in name only"));
  EXPECT_EQ(mesh("named.osgb").failure->code, "ingest-mesh-format");
}

TEST_F(OsgbFile, that_is_damaged_anywhere_takes_nothing_along) {
  write(*leaf(0, 10), "a.osgb");
  const auto whole = base::read_file(folder_ / "a.osgb");
  ASSERT_TRUE(whole);
  std::size_t failed = 0;
  for (std::size_t i = 0; i < whole->size(); i += 3)
    for (const char value : {'\0', '\xff'}) {
      std::string bytes = *whole;
      bytes[i] = value;
      ASSERT_TRUE(base::write_file(folder_ / "damaged.osgb", bytes));
      const auto piece = mesh("damaged.osgb");
      failed += piece.failure ? 1 : 0;
      if (piece.failure) {
        EXPECT_THAT(piece.failure->code, testing::StartsWith("ingest-mesh-"));
      }
    }
  EXPECT_GT(failed, 10U);
  EXPECT_EQ(mesh("a.osgb").mesh.triangles.size(), 10U);
}

TEST_F(OsgbFile, has_its_picture_as_the_file_has_it) {
  model::Pixels pixels;
  pixels.width = 2, pixels.height = 2;
  pixels.rgb.assign(12, 200);
  const auto jpeg = encode_image(pixels, ImageCodec::jpeg, 90);
  ASSERT_TRUE(jpeg);
  ASSERT_TRUE(base::write_file(folder_ / "wall.jpg", *jpeg));
  auto geometry = strip(0, 2);
  osg::ref_ptr<osg::Vec2Array> uv = new osg::Vec2Array;
  for (const float u : {0.F, 0.25F, 0.5F, 1.F}) uv->push_back(osg::Vec2(u, 0.25F));
  geometry->setTexCoordArray(0, uv.get());
  osg::ref_ptr<osg::Image> image = new osg::Image;
  image->setFileName((folder_ / "wall.jpg").string());
  image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
  osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image.get());
  texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
  geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture.get());
  osg::ref_ptr<osg::Geode> geode = new osg::Geode;
  geode->addDrawable(geometry.get());
  write(*geode, "a.osgb", "WriteImageHint=IncludeFile");

  const auto read = read_textured_file(folder_ / "a.osgb", UpAxis::automatic);
  ASSERT_TRUE(read) << to_string(read.error());
  ASSERT_TRUE(read->has_colour());
  ASSERT_EQ(read->materials.size(), 1U);
  ASSERT_TRUE(read->materials[0].image && read->materials[0].image->bytes);
  EXPECT_EQ(*read->materials[0].image->bytes, *jpeg);
  EXPECT_EQ(read->materials[0].wrap[0], Wrap::repeat);
  EXPECT_THAT(read->material_of, ElementsAre(0U, 0U));
  EXPECT_EQ(read->corners[0].uv[1], (std::array<float, 2>{0.25F, 0.75F}));
  EXPECT_EQ(mesh("a.osgb").mesh.triangles.size(), 2U);
}

TEST(OsgbNames, of_levels_lead_to_their_tile) {
  EXPECT_EQ(tile_of_level("d/Tile_+001_+002_L20_00130.osgb"), fs::path("d/Tile_+001_+002.osgb"));
  EXPECT_EQ(tile_of_level("Tile_L15_0.osgb"), fs::path("Tile.osgb"));
  for (const auto* name : {"Tile.osgb", "North_Lawn.osgb", "_L1_0.osgb", "Tile_L.osgb", "House_L2x.osgb"})
    EXPECT_EQ(tile_of_level(name), fs::path()) << name;
}

}  // namespace
}  // namespace mansard::formats
