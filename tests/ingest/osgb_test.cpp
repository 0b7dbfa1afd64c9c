// A folder of tiles in OSGB, as photogrammetry programs write it.
#include <gmock/gmock.h>
#include <osg/Geometry>
#include <osg/PagedLOD>
#include <osgDB/WriteFile>

#include "ingest/workshop.hpp"

namespace mansard::ingest::test {
namespace {

class OsgbFolder : public Workshop {
 protected:
  /// A level square, divided into cells.
  static auto square(float x, int cells) -> osg::ref_ptr<osg::Geometry> {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const float side = 40.F / static_cast<float>(cells);
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j)
        for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
          vertices->push_back(osg::Vec3(x + side * static_cast<float>(i + a), side * static_cast<float>(j + b), 0));
    geometry->setVertexArray(vertices.get());
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(vertices->size())));
    return geometry;
  }
  void tile(const std::string& name, float x) const {
    const auto folder = at("Data/" + name);
    fs::create_directories(folder);
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
    lod->addChild(square(x, 1).get(), 0, 500);
    lod->setFileName(1, name + "_L15_0.osgb");
    lod->setRange(1, 500, 1e30F);
    ASSERT_TRUE(osgDB::writeNodeFile(*lod, (folder / (name + ".osgb")).string()));
    ASSERT_TRUE(osgDB::writeNodeFile(*square(x, 3), (folder / (name + "_L15_0.osgb")).string()));
  }
};

TEST_F(OsgbFolder, gives_every_tile_once_at_its_finest_level) {
  tile("Tile_+000_+000", 0);
  tile("Tile_+001_+000", 40);
  const auto scene = read_scene({at("Data")}, {}, {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->mesh.triangles.size(), 2U * 2 * 3 * 3);
  EXPECT_EQ(scene->inputs.size(), 4U);
}

}  // namespace
}  // namespace mansard::ingest::test
