// metadata.xml beside meshes, as photogrammetry programs write it.
#include <gmock/gmock.h>

#include "ingest/gltf_workshop.hpp"
#include "mansard/formats/context_capture/context_capture.hpp"
#include "mansard/ingest/model.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

class ContextCapture : public Workshop {
 protected:
  void metadata(const std::string& name, const std::string& srs, const std::string& origin) const {
    file(name,
         "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<ModelMetadata version=\"1\">\n  <!--Spatial Reference "
         "System-->\n  <SRS>" +
             srs + "</SRS>\n  <SRSOrigin>" + origin + "</SRSOrigin>\n</ModelMetadata>\n");
  }
  auto tile(const std::string& name) const -> fs::path {
    return file(name, "v 0 0 0\nv 100 0 1\nv 0 100 2\nf 1 2 3\n");
  }
};

TEST_F(ContextCapture, the_origin_is_added_and_the_crs_known) {
  metadata("Production/metadata.xml", "EPSG:32631", "593139,5763220,-1.5");
  tile("Production/Data/Tile_1/Tile_1.obj");
  const auto folder = at("Production/Data");
  const auto scene = read_scene({folder}, {}, {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:32631");
  EXPECT_EQ(in_file(*scene), (Point3{593139, 5763220, -1.5}));
  ASSERT_EQ(scene->inputs.size(), 2U);
  EXPECT_THAT(scene->inputs[1].path, HasSubstr("metadata.xml"));
  // A single file of it too, and footprints in degrees come to the mesh rather than to another zone.
  const auto far = read({at("Production/Data/Tile_1/Tile_1.obj")},
                        polygons({"[[[4.3571,52.0116],[4.3574,52.0116],[4.3574,52.0118],[4.3571,52.0116]]]"}));
  ASSERT_TRUE(far) << base::to_string(far.error());
  EXPECT_EQ(far->frame.crs, "EPSG:32631");
  EXPECT_EQ(in_file(*far), (Point3{593139, 5763220, -1.5}));
}

TEST_F(ContextCapture, the_mesh_is_projected_to_the_footprints_crs_and_keeps_its_heights) {
  metadata("metadata.xml", "EPSG:32631+5773", "593139.054,5763220.062,10");
  const auto scene = read({tile("a.obj")}, polygons({square(84270, 447540)}, "EPSG:28992"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  expect_near(in_file(*scene), {84279.5, 447548, 10}, 3);  // by the polynomials of Schreutelkamp and Strang van Hees
  EXPECT_EQ(in_file(*scene, 1).z, 11);
}

TEST_F(ContextCapture, a_tangent_plane_touches_the_ellipsoid) {
  metadata("metadata.xml", "ENU:52.0118,4.3571", "0,0,0");
  const auto scene = read_scene({tile("a.obj")}, {}, {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:32631");
  expect_near(in_file(*scene), {593139.054, 5763220.062, 0}, 2e-3);  // by Krüger's series
  const auto along = in_file(*scene, 1) - in_file(*scene, 0);
  EXPECT_NEAR(std::hypot(along.x, along.y), 99.970, 0.01);
  // 100 m away the ellipsoid is 100² / 2R = 0.8 mm below the plane.
  EXPECT_NEAR(in_file(*scene, 1).z, 1.0008, 1e-4);
}

TEST_F(ContextCapture, an_altered_projection_is_not_taken_for_the_number_left_on_it) {
  const std::string altered =
      R"(PROJCS["LOCAL",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],)"
      R"(UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
      R"(PARAMETER["central_meridian",3],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],)"
      R"(PARAMETER["false_northing",@],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AUTHORITY["EPSG","32631"]])";
  const auto with = [&](const std::string& northing) {
    std::string srs = altered;
    metadata("metadata.xml", srs.replace(srs.find('@'), 1, northing), "593139.054,5763310.062,0");
    return read({tile("a.obj")}, polygons({square(593100, 5763200, 200)}, "EPSG:32631"));
  };
  const auto scene = with("90");
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  expect_near(in_file(*scene), {593139.054, 5763220.062, 0}, 1e-6);
  const auto alone = read_scene({at("a.obj")}, {}, {});
  ASSERT_TRUE(alone);
  EXPECT_THAT(alone->frame.crs, HasSubstr("LOCAL"));
  EXPECT_EQ(alone->frame.crs.find("32631"), std::string::npos);
  EXPECT_EQ(in_file(*alone), (Point3{593139.054, 5763310.062, 0}));
  ASSERT_EQ(code(with("0")), "");
  EXPECT_EQ(read_scene({at("a.obj")}, {}, {})->frame.crs, "EPSG:32631");
}

TEST_F(ContextCapture, local_footprints_an_offset_in_plan_or_local_leave_the_mesh_as_it_is) {
  metadata("metadata.xml", "EPSG:32631", "593139,5763220,0");
  const auto mesh = tile("a.obj");
  const auto local = read({mesh}, polygons({square()}));
  ASSERT_TRUE(local) << base::to_string(local.error());
  EXPECT_EQ(local->frame.crs, "");
  EXPECT_EQ(in_file(*local, 1), (Point3{100, 0, 1}));
  EXPECT_EQ(local->inputs.size(), 2U);
  Options options;
  options.mesh_offset = {593000, 5763000, 0};
  const auto moved = read({mesh}, polygons({square(593000, 5763000)}, "EPSG:32631"), options);
  ASSERT_TRUE(moved) << base::to_string(moved.error());
  EXPECT_EQ(in_file(*moved), (Point3{593000, 5763000, 0}));
  // An offset in height is added to what the mesh says.
  options.mesh_offset = {0, 0, -43};
  const auto lowered = read({mesh}, polygons({square(593139, 5763220)}, "EPSG:32631"), options);
  ASSERT_TRUE(lowered) << base::to_string(lowered.error());
  EXPECT_EQ(in_file(*lowered), (Point3{593139, 5763220, -43}));
  Options as_is;
  as_is.crs = "local";
  EXPECT_EQ(in_file(*read({mesh}, polygons({square()}), as_is), 1), (Point3{100, 0, 1}));
  EXPECT_EQ(read_mesh({mesh}, {}, {})->mesh.vertices[1], (Point3{100, 0, 1}));
  EXPECT_EQ(read_mesh({mesh}, {{593139, 5763220, 0}, "EPSG:32631"}, {})->mesh.vertices[1], (Point3{100, 0, 1}));
}

TEST_F(ContextCapture, a_tileset_of_its_local_frame_is_placed_too) {
  metadata("metadata.xml", "EPSG:32631", "593139,5763220,0");
  const Json root = {{"boundingVolume", box(0, 0, 10, 10)}, {"geometricError", 0}, {"content", {{"uri", "a.glb"}}}};
  file("a.glb", plain_glb(triangle_at(1, 2, 3)));
  const auto scene = read_scene({file("tileset.json", tileset(root))}, {}, {});
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(in_file(*scene), (Point3{593140, 5763222, 3}));
}

TEST_F(ContextCapture, what_is_not_understood_is_an_error_and_what_is_not_meant_nothing) {
  const auto mesh = tile("a.obj");
  const auto with = [&](const std::string& srs, const std::string& origin) {
    metadata("metadata.xml", srs, origin);
    return code(read({mesh}, polygons({square()})));
  };
  EXPECT_EQ(with("EPSG:999999", "0,0,0"), "ingest-mesh-metadata");
  EXPECT_EQ(with("EPSG:4326", "0,0,0"), "ingest-mesh-metadata");
  EXPECT_EQ(with("ENU:52", "0,0,0"), "ingest-mesh-metadata");
  EXPECT_EQ(with("EPSG:32631", "0,0"), "ingest-mesh-metadata");
  EXPECT_EQ(with("EPSG:32631", "0,0,x"), "ingest-mesh-metadata");
  EXPECT_EQ(with("", ""), "");
  EXPECT_EQ(with("EPSG:32631</SRS>", "0,0,0"), "ingest-mesh-metadata");
  file("metadata.xml", "<gmd:MD_Metadata>");
  EXPECT_EQ(code(read({mesh}, polygons({square()}))), "");
}

}  // namespace
}  // namespace mansard::ingest::test
