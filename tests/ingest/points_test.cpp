// Points of one class, from all clouds among the inputs.
#include "mansard/ingest/points.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <map>

#include "ingest/workshop.hpp"
#include "mansard/formats/las_points.hpp"

namespace mansard::ingest {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t building = 6;

class ReadPointsOfClass : public test::Workshop {
 protected:
  /// What it says to a user who is not root, whom every folder is open to.
  static auto points_for_others(const fs::path& path) -> base::Result<std::vector<geometry::Point3>> {
    constexpr uid_t nobody = 65534;
    const uid_t user = ::geteuid();
    EXPECT_EQ(::seteuid(user == 0 ? nobody : user), 0);
    auto points = read_points_of_class({path}, building, {}, {});
    EXPECT_EQ(::seteuid(user), 0);
    return points;
  }
};

TEST_F(ReadPointsOfClass, passes_over_other_files) {
  file("folder/inside/ground.obj", "v 0 0 0\n");
  file("folder/.hidden.laz", "");
  const auto points = read_points_of_class({at("folder")}, building, {}, {});
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_TRUE(points->empty());
}

TEST_F(ReadPointsOfClass, fails_where_a_folder_cannot_be_listed) {
  file("folder/closed/a.laz", "");
  fs::permissions(at("folder/closed"), fs::perms::none);
  fs::permissions(at(""), static_cast<fs::perms>(0755));
  const auto points = points_for_others(at("folder"));
  fs::permissions(at("folder/closed"), fs::perms::owner_all);
  ASSERT_FALSE(points);
  EXPECT_EQ(points.error().code, "file-read");
  EXPECT_EQ(points.error().subject, at("folder").string());
}

TEST_F(ReadPointsOfClass, takes_the_classes_that_the_options_name) {
  const auto cloud = file("cloud.xyz", "x y z class\n1 2 3 67\n4 5 6 6\n7 8 9 2\n");
  const auto z_of = [&](const char* buildings) {
    Options options;
    options.cloud.building_classes = buildings;
    std::vector<double> out;
    const auto points = read_points_of_class({cloud}, building, {}, options);
    EXPECT_TRUE(points) << base::to_string(points.error());
    if (points)
      for (const auto& p : *points) out.push_back(p.z);
    return out;
  };
  EXPECT_THAT(z_of("6"), testing::ElementsAre(6));
  EXPECT_THAT(z_of("6,67"), testing::ElementsAre(3, 6));
  EXPECT_THAT(z_of("67"), testing::ElementsAre(3));
  Options wrong;
  wrong.cloud.building_classes = "roofs";
  EXPECT_EQ(read_points_of_class({cloud}, building, {}, wrong).error().code, "option-value");
}

TEST_F(ReadPointsOfClass, has_points_of_clouds_that_overlap_once) {
  const auto west = file("west.xyz", "x y z class\n1 2 3 6\n4 5 6 6\n"),
             east = file("east.xyz", "x y z class\n7 8 9 6\n4 5 6 6\nnan 5 6 6\n");
  const auto points = read_points_of_class({west, east}, building, {}, {});
  ASSERT_TRUE(points) << base::to_string(points.error());
  EXPECT_THAT(*points,
              testing::ElementsAre(geometry::Point3{1, 2, 3}, geometry::Point3{4, 5, 6}, geometry::Point3{7, 8, 9}));
}

/// Points of 16 to a square metre, text PLY.
auto ply_of(const std::vector<geometry::Point3>& points) -> std::string {
  std::string out = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (const auto& p : points) out += base::to_text(p.x) + " " + base::to_text(p.y) + " " + base::to_text(p.z) + "\n";
  return out;
}

class CloudDensity : public test::Workshop {
 protected:
  /// What is said of the surface of a level cloud of 16 points/m² where `has` holds, within 48 m by 48 m.
  template <class Has>
  [[nodiscard]] auto said_of(Has has) const -> std::string {
    std::vector<geometry::Point3> points;
    for (double y = 0.125; y < 48; y += 0.25)
      for (double x = 0.125; x < 48; x += 0.25)
        if (has(x, y)) points.push_back({x, y, 0});
    const auto scene = mesh(file("cloud.ply", ply_of(points)));
    if (!scene) return scene.error().message;
    for (const auto& warning : scene->warnings)
      if (warning.code == "ingest-points-surface") return warning.message;
    return "nothing";
  }
};

TEST_F(CloudDensity, of_a_few_points_is_said_to_be_too_little_for_a_surface) {
  const auto said = said_of([](double x, double y) { return x < 1 && y < 1; });
  EXPECT_THAT(said, testing::HasSubstr("none of its 16 points"));
  EXPECT_THAT(said, testing::HasSubstr("cloud.isolated"));
}

TEST_F(CloudDensity, of_a_square_is_that_of_its_box) {
  EXPECT_THAT(said_of([](double, double) { return true; }), testing::HasSubstr("(16.2 points/m²)"));
}

TEST_F(CloudDensity, of_a_cloud_that_is_cut_out_along_a_street_is_that_of_the_street) {
  // Three quarters of the box have none: over all of it there are 4.4 points/m², too few for cells of 0.5 m.
  const auto said = said_of([](double x, double y) { return std::abs(x - y) < 7; });
  EXPECT_THAT(said, testing::HasSubstr("cells of 0.5 m"));
}

/// Two roofs at 6 m over ground, one of class 6 and one of class 67.
class CloudClasses : public test::Workshop {
 protected:
  struct Read {
    double roof_of_67 = 0;  ///< z, the highest over it
    std::map<std::string, std::string> warnings;
  };
  [[nodiscard]] auto read(const std::string& buildings, const fs::path& footprints = {}) const -> base::Result<Read> {
    std::string body;
    std::size_t count = 0;
    for (double y = 0.25; y < 40; y += 0.5)
      for (double x = 0.25; x < 40; x += 0.5) {
        const bool one = x > 4 && x < 14 && y > 4 && y<14, other = x> 24 && x < 34 && y > 24 && y < 34;
        body += base::to_text(x) + " " + base::to_text(y) + (one || other ? " 6 " : " 0 ") +
                (one     ? "6"
                 : other ? "67"
                         : "2") +
                "\n";
        ++count;
      }
    Options options;
    options.cloud.building_classes = buildings;
    const auto scene =
        read_scene({file("cloud.ply", "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                                          "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar "
                                          "classification\nend_header\n" +
                                          body)},
                   footprints, options);
    if (!scene) return scene.failure();
    Read out;
    const auto at = [&](std::size_t axis) { return static_cast<double>(scene->frame.origin[axis]); };
    for (const auto& v : scene->mesh.vertices) {
      const double x = v.x + at(0), y = v.y + at(1);
      if (x > 26 && x < 32 && y > 26 && y < 32) out.roof_of_67 = std::max(out.roof_of_67, v.z + at(2));
    }
    for (const auto& warning : scene->warnings) out.warnings[warning.code] = warning.message;
    return out;
  }
};

TEST_F(CloudClasses, without_a_meaning_are_told_and_left_out) {
  const auto found = read("6");
  ASSERT_TRUE(found) << base::to_string(found.error());
  EXPECT_LT(found->roof_of_67, 1);
  EXPECT_THAT(found->warnings.at("ingest-points-classes"), testing::HasSubstr("67 (400 points)"));
  EXPECT_THAT(found->warnings.at("ingest-points-surface"), testing::HasSubstr("2 ground 87.5 % (the ground)"));
}

TEST_F(CloudClasses, that_have_roofs_and_are_not_used_are_told_with_the_option) {
  const auto feature = [&](double at) {
    return R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":)" + square(at, at, 10) +
           "}}";
  };
  const auto footprints =
      file("f.geojson", R"({"type":"FeatureCollection","features":[)" + feature(4) + "," + feature(24) + "]}");
  const auto found = read("6", footprints);
  ASSERT_TRUE(found) << base::to_string(found.error());
  ASSERT_TRUE(found->warnings.contains("scan-classes"));
  EXPECT_THAT(found->warnings.at("scan-classes"), testing::HasSubstr("class 67 has 50 % of the points"));
  EXPECT_THAT(found->warnings.at("scan-classes"), testing::HasSubstr("those of 1 of 2 footprints"));
  EXPECT_THAT(found->warnings.at("scan-classes"), testing::HasSubstr("--cloud-building-classes 6,67"));
  const auto used = read("6,67", footprints);
  ASSERT_TRUE(used) << base::to_string(used.error());
  EXPECT_FALSE(used->warnings.contains("scan-classes"));
}

TEST_F(CloudClasses, are_buildings_where_they_are_said_to_be) {
  const auto found = read("6,67");
  ASSERT_TRUE(found) << base::to_string(found.error());
  EXPECT_NEAR(found->roof_of_67, 6, 0.01);
  EXPECT_FALSE(found->warnings.contains("ingest-points-classes"));
  EXPECT_THAT(found->warnings.at("ingest-points-surface"), testing::HasSubstr("67 6.2 % (buildings)"));
  const auto wrong = read("6;67");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, "option-value");
}

/// A house on ground, whose points are in several files.
class CloudsTwice : public test::Workshop {
 protected:
  using Points = std::vector<formats::CloudPoint>;
  /// 4 points/m² on 40 m by 40 m, at places that are no grid.
  static auto house() -> Points {
    Points out;
    for (int row = 0; row < 80; ++row)
      for (int column = 0; column < 80; ++column) {
        auto& p = out.emplace_back();
        const double x = 0.5 * column + 0.004 * ((7 * row + 3 * column) % 100), y = 0.5 * row + 0.004 * (column % 100);
        const bool roof = x > 10 && x < 30 && y > 10 && y < 25;
        p.position = {x, y, roof ? 6 - 0.1 * std::round(10 * std::abs(y - 17)) / 10 : 0.01 * (row % 3)};  // as LAS has
        p.classification = roof ? 6 : 2;
      }
    return out;
  }
  [[nodiscard]] auto las(const std::string& name, const Points& points) const -> fs::path {
    const auto bytes = formats::las(points, {});
    EXPECT_TRUE(bytes);
    return file(name, *bytes);
  }
  [[nodiscard]] auto xyz(const std::string& name, const Points& points) const -> fs::path {
    std::string out = "x y z class point_source_id\n";
    for (const auto& p : points)
      out += base::to_text(p.position.x) + " " + base::to_text(p.position.y) + " " + base::to_text(p.position.z) + " " +
             std::to_string(p.classification) + " " + std::to_string(p.source) + "\n";
    return file(name, out);
  }
  struct Read {
    model::Scene scene;
    std::map<std::string, std::string> warnings;
  };
  static auto read_clouds(const std::vector<fs::path>& clouds) -> Read {
    Options options;
    options.crs = "local";
    auto scene = read_scene(clouds, {}, options);
    EXPECT_TRUE(scene) << base::to_string(scene.error());
    Read out;
    for (const auto& warning : scene->warnings) out.warnings[warning.code] = warning.message;
    out.scene = std::move(*scene);
    return out;
  }
  static void expect_same(const Read& made, const Read& expected) {
    EXPECT_EQ(made.scene.mesh.vertices, expected.scene.mesh.vertices);
    EXPECT_EQ(made.scene.mesh.triangles, expected.scene.mesh.triangles);
    EXPECT_EQ(made.scene.mesh.points, expected.scene.mesh.points);
    // The cells, and how many points there are.
    const auto until = [](const std::string& text) { return text.substr(0, text.find(" (")); };
    EXPECT_EQ(until(made.warnings.at("ingest-points-surface")), until(expected.warnings.at("ingest-points-surface")));
  }
};

TEST_F(CloudsTwice, are_one_cloud_and_both_files_are_named) {
  const auto points = house();
  const auto once = read_clouds({las("a.las", points)});
  EXPECT_FALSE(once.warnings.contains("ingest-points-twice"));
  auto turned = points;
  std::ranges::reverse(turned);
  const auto twice = read_clouds({at("a.las"), las("b.las", turned)});
  expect_same(twice, once);
  EXPECT_THAT(twice.warnings.at("ingest-points-twice"),
              testing::HasSubstr(at("a.las").string() + " and " + at("b.las").string() +
                                 " have the same points; 6400 of 12800 points (50.0 %)"));
  const auto thrice = read_clouds({at("a.las"), at("b.las"), xyz("c.xyz", points)});
  expect_same(thrice, once);
  EXPECT_THAT(thrice.warnings.at("ingest-points-twice"), testing::HasSubstr(at("c.xyz").string() + " have the same"));
  const auto same_file = read_clouds({at("a.las"), at("a.las")});
  expect_same(same_file, once);
  EXPECT_TRUE(same_file.warnings.contains("ingest-points-twice"));
}

TEST_F(CloudsTwice, that_overlap_have_each_point_once_and_the_share_is_said) {
  const auto points = house();
  const auto once = read_clouds({las("a.las", points)});
  Points west, east;
  for (const auto& p : points) {
    if (p.position.x < 25) west.push_back(p);
    if (p.position.x > 20) east.push_back(p);
  }
  const auto both = read_clouds({las("west.las", west), las("east.las", east)});
  expect_same(both, once);
  const auto& said = both.warnings.at("ingest-points-twice");
  EXPECT_THAT(said, testing::HasSubstr(std::to_string(west.size() + east.size() - points.size()) + " of " +
                                       std::to_string(west.size() + east.size()) + " points (11.1 %)"));
  EXPECT_THAT(said, testing::HasSubstr("clouds overlap, or a file has points twice"));
}

TEST_F(CloudsTwice, in_one_file_have_the_density_of_one) {
  // 1.3 points/m²: twice as many would make cells of 1 m instead of 2 m.
  auto points = house();
  std::erase_if(points, [i = 0](const auto&) mutable { return i++ % 3 != 0; });
  const auto once = read_clouds({las("a.las", points)});
  auto twice = points;
  twice.insert(twice.end(), points.begin(), points.end());
  expect_same(read_clouds({las("b.las", twice)}), once);
}

TEST_F(CloudsTwice, in_one_file_of_many_pieces_have_the_density_of_one) {
  // 1.3 points/m², for which cells are 2 m, and eleven pieces of 65,536 points where each point is there twice.
  Points once;
  for (int row = 0; row < 600; ++row)
    for (int column = 0; column < 600; ++column) {
      auto& p = once.emplace_back();
      p.position = {0.877 * column + 0.004 * (row % 50), 0.877 * row + 0.004 * (column % 50), 0.01 * (row % 3)};
      p.classification = 2;
    }
  const auto expected = read_clouds({las("a.las", once)});
  EXPECT_THAT(expected.warnings.at("ingest-points-surface"), testing::HasSubstr("in cells of 2 m"));
  auto twice = once;
  twice.insert(twice.end(), once.begin(), once.end());
  const auto made = read_clouds({las("b.las", twice)});
  expect_same(made, expected);
  EXPECT_THAT(made.warnings.at("ingest-points-twice"), testing::HasSubstr("360000 of 720000 points (50.0 %)"));
}

TEST_F(CloudsTwice, are_not_found_where_a_few_points_are_at_one_place_by_accident) {
  auto points = house();
  points.insert(points.end(), points.begin(), points.begin() + 60);
  EXPECT_FALSE(read_clouds({las("a.las", points)}).warnings.contains("ingest-points-twice"));
}

TEST_F(CloudsTwice, of_strips_that_differ_in_height_are_told) {
  // Two strips of 4 points/m² each, the second 0.1 m higher.
  auto first = house(), second = house();
  for (auto& p : first) p.source = 11;
  for (auto& p : second) {
    p.source = 12;
    p.position = p.position + geometry::Point3{0.11, 0.07, 0.1};
  }
  const auto told = read_clouds({las("a.las", first), xyz("b.xyz", second)});
  EXPECT_THAT(told.warnings.at("ingest-points-strips"),
              testing::ContainsRegex("height: strip 12 is 0.(09[5-9]|10[0-5]) ± 0.00[1-9] m above strip 11, over "));
  EXPECT_THAT(told.warnings.at("ingest-points-strips"), testing::EndsWith("; heights of models are between them"));
  EXPECT_FALSE(read_clouds({at("a.las")}).warnings.contains("ingest-points-strips"));
}

/// Why a cloud is none that can be used.
class CloudWithoutSurface : public test::Workshop {
 protected:
  struct Point {
    geometry::Point3 position;
    int classification = 0;
  };
  /// Points on 20 m by 20 m in rows 0.5 m apart, all of one class.
  static auto square(int classification) -> std::vector<Point> {
    std::vector<Point> out;
    for (double y = 0; y < 20; y += 0.5)
      for (double x = 0; x < 20; x += 0.5) out.push_back({{x, y, 3}, classification});
    return out;
  }
  [[nodiscard]] auto said_of(const std::vector<Point>& points, const Options& options = {}) const -> std::string {
    std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nproperty uchar classification\n"
                      "end_header\n";
    for (const auto& [p, classification] : points)
      ply += base::to_text(p.x) + " " + base::to_text(p.y) + " " + base::to_text(p.z) + " " +
             std::to_string(classification) + "\n";
    const auto scene = read_scene({file("cloud.ply", ply)}, {}, options);
    if (scene) return "a surface";
    EXPECT_EQ(scene.error().code, "ingest-points-empty");
    EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
    return scene.error().message;
  }
};

TEST_F(CloudWithoutSurface, of_noise_alone_is_said_to_be_noise_with_and_without_a_box) {
  for (const int noise : {7, 18})
    EXPECT_THAT(said_of(square(noise)), testing::HasSubstr("1600 are noise (class 7 or 18)"));
  Options boxed;
  boxed.crs = "local";
  boxed.bbox = {5, 5, 15, 15};
  EXPECT_THAT(said_of(square(7), boxed), testing::HasSubstr("1600 are noise (class 7 or 18)"));
}

TEST_F(CloudWithoutSurface, of_vegetation_alone_is_said_to_be_vegetation) {
  auto points = square(5);
  for (std::size_t i = 0; i < 100; ++i) points[i].classification = 14;
  const auto said = said_of(points);
  EXPECT_THAT(said, testing::HasSubstr("vegetation (classes 3 to 5: 1500)"));
  EXPECT_THAT(said, testing::HasSubstr("wires and masts (classes 13 to 16: 100)"));
}

TEST_F(CloudWithoutSurface, at_one_place_or_on_a_line_is_not_said_to_be_without_points) {
  EXPECT_THAT(said_of(std::vector<Point>(500, Point{{5, 5, 3}, 6})),
              testing::HasSubstr("its 500 points are at one place"));
  std::vector<Point> line, upright;
  for (int i = 0; i < 500; ++i) {
    line.push_back({{0.1 * i, 5, 3}, 6});
    upright.push_back({{5, 5, 0.1 * i}, 6});
  }
  EXPECT_THAT(said_of(line), testing::HasSubstr("on one line"));
  EXPECT_THAT(said_of(upright), testing::HasSubstr("at one place"));
}

TEST_F(CloudWithoutSurface, of_coordinates_that_are_no_numbers_is_said_to_be_so) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\nnan nan nan\nnan nan nan\n";
  const auto scene = read_scene({file("nan.ply", ply)}, {}, {});
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, testing::HasSubstr("none of its 2 points has coordinates that are finite"));
}

TEST_F(CloudWithoutSurface, beside_the_box_is_said_to_be_beside_it) {
  Options boxed;
  boxed.crs = "local";
  boxed.bbox = {5000, 5000, 5100, 5100};
  auto points = square(6);
  points[0].classification = 7;
  const auto said = said_of(points, boxed);
  EXPECT_THAT(said, testing::HasSubstr("no point is in the box"));
  EXPECT_THAT(said, testing::HasSubstr("1 are noise"));
}

TEST_F(CloudWithoutSurface, of_ground_alone_is_a_surface) { EXPECT_EQ(said_of(square(2)), "a surface"); }

}  // namespace
}  // namespace mansard::ingest
