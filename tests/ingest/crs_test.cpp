#include <gmock/gmock.h>
#include <cmath>

#include "ingest/workshop.hpp"
#include "mansard/base/run.hpp"
#include "mansard/crs/utm.hpp"
#include "mansard/formats/geojson/assumed_crs.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/ingest/detail/crs.hpp"

namespace mansard::ingest::test {
namespace {

using ::testing::HasSubstr;

class Frames : public Workshop {
 protected:
  static auto in_file(const model::Scene& scene, geometry::Point2 p) -> geometry::Point2 {
    return {p.x + static_cast<double>(scene.frame.origin[0]), p.y + static_cast<double>(scene.frame.origin[1])};
  }
  static auto corner(const model::Scene& scene) -> geometry::Point2 {
    auto ring = scene.footprints.at(0).polygons.at(0).outer;
    return in_file(scene, *std::ranges::min_element(ring));
  }
  // About 20 m in Delft; in UTM 31N at x 593 km, y 5763 km.
  const std::string delft_ = "[[[4.3571,52.0116],[4.3574,52.0116],[4.3574,52.0118],[4.3571,52.0118],[4.3571,52.0116]]]";
};

TEST_F(Frames, degrees_are_projected_to_their_utm_zone) {
  for (const std::string crs : {"", "urn:ogc:def:crs:OGC:1.3:CRS84"}) {
    const auto scene = read({ground(593000, 5762000, 594000, 5764000)}, polygons({delft_}, crs));
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_EQ(scene->frame.crs, "EPSG:32631");
    // By Krüger's series for the transverse Mercator projection.
    EXPECT_NEAR(corner(*scene).x, 593139.054, 0.01);
    EXPECT_NEAR(corner(*scene).y, 5763220.062, 0.01);
    EXPECT_NEAR(geometry::area(scene->footprints[0].polygons[0]), 20.6 * 22.25, 5);
  }
}

TEST_F(Frames, longitude_comes_first_whatever_the_authority_says) {
  const auto scene = read({ground(593000, 5762000, 594000, 5764000)}, polygons({delft_}, "urn:ogc:def:crs:EPSG::4326"));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_NEAR(corner(*scene).x, 593139.054, 0.01);
}

TEST_F(Frames, degrees_and_metres_go_to_the_crs_asked_for) {
  Options options;
  options.crs = "EPSG:28992";
  const auto scene = read({ground(84000, 446000, 86000, 448000)}, polygons({delft_}), options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  // By the polynomials of Schreutelkamp and Strang van Hees.
  EXPECT_NEAR(corner(*scene).x, 84279, 3);
  EXPECT_NEAR(corner(*scene).y, 447526, 3);
  options.crs = "EPSG:32631";
  const auto moved =
      read({ground(593000, 5762000, 595000, 5764000)}, polygons({square(84910, 447510)}, "EPSG:28992"), options);
  ASSERT_TRUE(moved) << base::to_string(moved.error());
  EXPECT_EQ(moved->frame.crs, "EPSG:32631");
  EXPECT_NEAR(geometry::area(moved->footprints[0].polygons[0]), 400, 1);
}

TEST_F(Frames, utm_zones_follow_their_exceptions_and_datums) {
  EXPECT_EQ(crs::utm_zone(-0.142, 51.5, 4326), 32630);
  EXPECT_EQ(crs::utm_zone(151.2, -33.9, 4326), 32756);
  EXPECT_EQ(crs::utm_zone(180, 10, 4326), 32601);
  EXPECT_EQ(crs::utm_zone(5.3, 60.4, 4326), 32632);
  EXPECT_EQ(crs::utm_zone(15.6, 78.2, 4326), 32633);
  EXPECT_EQ(crs::utm_zone(12.5, 55.7, 4258), 25833);
  EXPECT_EQ(crs::utm_zone(-74, 40.7, 4269), 26918);
  EXPECT_EQ(crs::utm_zone(0, 88, 4326), 0);
}

TEST_F(Frames, geojson_without_crs_that_is_not_degrees_is_local) {
  for (const auto& [x, y] : {std::pair{10., 10.}, std::pair{500., 300.}}) {
    const auto scene = read({ground(0, 0, 1000, 1000)}, polygons({square(x, y)}));
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    EXPECT_EQ(scene->frame.crs, "");
    EXPECT_TRUE(has_warning(*scene, "ingest-crs-local"));
    EXPECT_EQ(corner(*scene), (geometry::Point2{x, y}));
  }
  // Real degrees are not taken for metres because the mesh happens to lie around zero.
  EXPECT_EQ(code(read({ground(0, 0, 100, 100)}, polygons({delft_}))), "ingest-no-overlap");
}

TEST_F(Frames, geojson_without_crs_over_a_raster_without_crs_is_local) {
  std::string heights = "ncols 40\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 2.5\n";
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) heights += "1 ";
    heights += "\n";
  }
  const auto scene = read({file("dsm.asc", heights)}, polygons({square(10, 10)}));
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "");
  EXPECT_TRUE(has_warning(*scene, "ingest-crs-local"));
  EXPECT_EQ(corner(*scene), (geometry::Point2{10, 10}));
}

TEST_F(Frames, local_is_local_when_asked_for) {
  Options options;
  options.crs = "local";
  const auto scene = read({ground()}, polygons({square()}, "EPSG:28992"), options);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->frame.crs, "");
  EXPECT_FALSE(has_warning(*scene, "ingest-crs-local"));
}

TEST_F(Frames, numbers_without_crs_are_taken_to_be_in_the_one_asked_for) {
  Options options;
  options.crs = "EPSG:28992";
  const auto scene = read({ground(84900, 447500, 85000, 447600)}, polygons({square(84910, 447510)}), options);
  ASSERT_TRUE(scene) << base::to_string(scene.error());
  EXPECT_EQ(scene->frame.crs, "EPSG:28992");
  EXPECT_EQ(corner(*scene), (geometry::Point2{84910, 447510}));
}

TEST_F(Frames, a_crs_that_is_unknown_or_not_metric_is_refused_with_a_way_out) {
  const auto read_with = [&](const std::string& crs) {
    Options options;
    options.crs = crs;
    return read({ground()}, polygons({square()}), options);
  };
  EXPECT_EQ(code(read_with("EPSG:999999")), "ingest-crs-option");
  EXPECT_EQ(code(read_with("somewhere")), "ingest-crs-option");
  EXPECT_EQ(code(read_with("EPSG:4326")), "ingest-crs-option");
  EXPECT_EQ(code(read_with("EPSG:2263")), "ingest-crs-option");
  // New York in feet.
  const auto feet = read({ground(980000, 200000, 990000, 210000)}, polygons({square(985000, 205000, 60)}, "EPSG:2263"));
  ASSERT_EQ(code(feet), "ingest-crs-unit");
  EXPECT_THAT(feet.error().message, HasSubstr("--crs"));
  Options options;
  options.crs = "EPSG:32618";
  const auto metres =
      read({ground(500000, 4400000, 700000, 4600000)}, polygons({square(985000, 205000, 60)}, "EPSG:2263"), options);
  ASSERT_TRUE(metres) << base::to_string(metres.error());
  EXPECT_NEAR(geometry::area(metres->footprints[0].polygons[0]), 18.29 * 18.29, 1);
  // A source whose own CRS makes no sense.
  const auto unknown = read({ground()}, polygons({square()}, "EPSG:999999"));
  if (unknown) {
    EXPECT_EQ(unknown->frame.crs, "");
  }
}

TEST_F(Frames, metres_that_are_none_on_the_ground_are_reported) {
  const auto warning_of = [&](const std::string& crs, double x, double y, const Options& options = {}) -> std::string {
    const auto scene = read_footprints(polygons({square(x, y)}, crs), options);
    EXPECT_TRUE(scene) << base::to_string(scene.error());
    if (!scene) return {};
    for (const auto& warning : scene->warnings)
      if (warning.code == "ingest-crs-scale") return warning.message;
    return {};
  };
  // cos 52.01° times what Mercator on a sphere leaves out; and the same place in systems made for it.
  EXPECT_THAT(warning_of("EPSG:3857", 485030, 6802600), HasSubstr("is 0.62 m on the ground"));
  EXPECT_THAT(warning_of("EPSG:3857", 485030, 6802600), HasSubstr("EPSG:32631"));
  EXPECT_EQ(warning_of("EPSG:28992", 84910, 447510), "");
  EXPECT_EQ(warning_of("EPSG:32631", 593139, 5763220), "");
  EXPECT_EQ(warning_of("EPSG:25832", 181000, 5772500), "");  // the next zone still serves
  EXPECT_EQ(warning_of("EPSG:27700", 529015, 181455), "");
  EXPECT_EQ(warning_of("EPSG:2154", 652000, 6862000), "");
  EXPECT_EQ(warning_of("EPSG:3857", 10, 10), "");  // on the equator
  Options options;
  options.crs = "EPSG:28992";
  EXPECT_EQ(warning_of("EPSG:3857", 485030, 6802600, options), "");
  options.crs = "EPSG:3857";
  EXPECT_THAT(warning_of("EPSG:28992", 84910, 447510, options), HasSubstr("is 0.62 m on the ground"));
  options.crs = "EPSG:32635";  // four zones off
  EXPECT_NE(warning_of("EPSG:28992", 84910, 447510, options), "");
}

TEST_F(Frames, swapped_axes_are_recognised) {
  const auto scene = read({ground(84900, 447500, 85000, 447600)}, polygons({square(447510, 84910)}, "EPSG:28992"));
  ASSERT_EQ(code(scene), "ingest-no-overlap");
  EXPECT_THAT(scene.error().message, HasSubstr("axis order"));
}

TEST_F(Frames, mesh_and_footprints_far_apart_are_reported_with_both_extents) {
  const auto scene = read({ground()}, polygons({square(84910, 447510)}, "EPSG:28992"));
  ASSERT_EQ(code(scene), "ingest-no-overlap");
  EXPECT_THAT(scene.error().message, HasSubstr("x 0.0 to 100.0, y 0.0 to 100.0"));
  EXPECT_THAT(scene.error().message, HasSubstr("x 84910.0 to 84930.0, y 447510.0 to 447530.0"));
  EXPECT_THAT(scene.error().message, HasSubstr("EPSG:28992"));
  Options options;
  options.mesh_offset = {84900, 447500, 7};
  const auto shifted = read({ground()}, polygons({square(84910, 447510)}, "EPSG:28992"), options);
  ASSERT_TRUE(shifted) << base::to_string(shifted.error());
  EXPECT_EQ(shifted->mesh.vertices[0].z, 7);
}

TEST_F(Frames, coordinates_come_back_bit_for_bit) {
  base::Random random(11);
  for (int round = 0; round < 20; ++round) {
    const double x0 = std::floor(random.uniform(-9e5, 9e5)), y0 = std::floor(random.uniform(-6e6, 6e6));
    std::string obj;
    std::vector<geometry::Point3> points;
    for (int i = 0; i < 30; ++i) {
      // Multiples of 2^-20 anywhere; the rest of the digits where numbers are large.
      const auto on_grid = [&](double from) { return from + std::ldexp(std::floor(random.uniform(0, 1e9)), -20); };
      const bool far = std::abs(x0) > 4000 && std::abs(y0) > 4000;
      points.push_back({far && i % 2 == 0 ? x0 + random.uniform(0, 900) : on_grid(x0),
                        far && i % 2 == 0 ? y0 + random.uniform(0, 900) : on_grid(y0), on_grid(-3)});
      obj += "v " + base::to_text(points.back().x) + " " + base::to_text(points.back().y) + " " +
             base::to_text(points.back().z) + "\n";
    }
    for (int i = 1; i + 2 <= 30; ++i)
      obj += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
    Options options;
    options.crs = "local";
    const auto scene = read({file("m.obj", obj)}, polygons({square(x0, y0, 500)}), options);
    ASSERT_TRUE(scene) << base::to_string(scene.error());
    ASSERT_EQ(scene->mesh.vertices.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& v = scene->mesh.vertices[i];
      const auto& o = scene->frame.origin;
      EXPECT_EQ(v.x + static_cast<double>(o[0]), points[i].x) << "round " << round;
      EXPECT_EQ(v.y + static_cast<double>(o[1]), points[i].y) << "round " << round;
      EXPECT_EQ(v.z + static_cast<double>(o[2]), points[i].z) << "round " << round;
      EXPECT_LT(std::abs(v.x), 2048);
    }
  }
}

TEST(Geojson, finds_the_crs_member_only_at_the_top) {
  EXPECT_TRUE(formats::top_level_member(R"({ "type" : "x", "crs" : {"a":1} })", "crs"));
  EXPECT_FALSE(formats::top_level_member(R"({"type":"x","crs": null})", "crs"));
  EXPECT_FALSE(formats::top_level_member(R"({"name":"crs","features":[{"crs":{}}]})", "crs"));
  EXPECT_FALSE(formats::top_level_member(R"({"a":"\",\"crs\":{}"})", "crs"));
  EXPECT_FALSE(formats::top_level_member(R"({"crs)", "crs"));
}

TEST_F(Frames, options_are_set_by_name) {
  Options options;
  auto list = option_list(options);
  ASSERT_NE(list.find("mesh_offset"), nullptr);
  EXPECT_EQ(list.find("mesh_offset")->get(), "0 0 0");
  EXPECT_TRUE(list.find("mesh_offset")->set("84800  447400 -0.5"));
  EXPECT_EQ(options.mesh_offset, (std::array<double, 3>{84800, 447400, -0.5}));
  for (const std::string wrong : {"1 2", "1 2 3 4", "1 2 x", "", "1 2 1e9"})
    EXPECT_EQ(list.find("mesh_offset")->set(wrong).error().code, "option-value") << wrong;
  EXPECT_EQ(options.mesh_offset[0], 84800);
  EXPECT_TRUE(list.find("bbox")->set("0 0 10 10"));
  EXPECT_TRUE(list.find("up")->set("y"));
  EXPECT_EQ(options.up, formats::UpAxis::y);
}

TEST_F(Frames, every_code_a_diagnostic_uses_is_listed_once) {
  std::vector<std::string> all;
  for (const auto& entry : codes()) {
    all.push_back(entry.code);
    EXPECT_THAT(entry.code, ::testing::AnyOf(::testing::StartsWith("ingest-"), ::testing::Eq("scan-classes")));
    EXPECT_FALSE(entry.cause.empty() || entry.remedy.empty());
  }
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

}  // namespace
}  // namespace mansard::ingest::test
