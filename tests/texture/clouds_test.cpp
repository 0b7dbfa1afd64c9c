// Clouds of coloured points on the two synthetic houses, whose colours say where they are.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "mansard/base/files.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/las_points.hpp"
#include "texture/houses.hpp"

namespace mansard::texture {
namespace {

using formats::CloudPoint;
using geometry::Point3;

/// As the images of houses_xyz.mtl: x = red / 5, y = green / 10, z = blue / 25.
auto colour_of(Point3 p) -> std::array<double, 3> {
  return {std::clamp(5 * p.x, 1.0, 255.0), std::clamp(10 * p.y, 1.0, 255.0), std::clamp(25 * p.z, 1.0, 255.0)};
}

/// `density` points a square metre of all surfaces, at random, with 16 bits a colour.
auto cloud_of(double density, std::uint64_t seed = 1) -> std::vector<CloudPoint> {
  const auto read = formats::read_textured_file(houses_folder() / "houses.obj", formats::UpAxis::z);
  EXPECT_TRUE(read);
  const auto& mesh = read->mesh;
  base::Random random(seed);
  std::vector<CloudPoint> out;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Point3 a = mesh.vertices[i], b = mesh.vertices[j], c = mesh.vertices[k];
    const double area = length(cross(b - a, c - a)) / 2;
    for (double left = area * density; left > random.uniform(); left -= 1) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      auto& point = out.emplace_back();
      point.position = a + u * (b - a) + v * (c - a);
      const auto colour = colour_of(point.position);
      for (std::size_t n = 0; n < 3; ++n) point.colour[n] = static_cast<std::uint16_t>(257 * std::lround(colour[n]));
    }
  }
  return out;
}

auto las_file(const std::filesystem::path& path, const std::vector<CloudPoint>& points) -> std::filesystem::path {
  const auto bytes = formats::las(points, {});
  EXPECT_TRUE(bytes);
  EXPECT_TRUE(base::write_file(path, *bytes));
  return path;
}

struct Places {
  std::size_t all = 0, right = 0;
};
/// How many of the texels inside faces have a colour that says that they are within `tolerance` of their place.
auto places_of(const std::vector<model::LabelledSolid>& solids, const model::BuildingTexture& baked, double tolerance)
    -> Places {
  Places out;
  each_texel(solids, baked, 0, [&](auto, auto, const auto&, auto, auto, Point3 p, const auto& colour) {
    const double off =
        std::max({std::abs(colour[0] / 5.0 - p.x), std::abs(colour[1] / 10.0 - p.y), std::abs(colour[2] / 25.0 - p.z)});
    ++out.all;
    out.right += off < tolerance ? 1 : 0;
  });
  return out;
}

TEST(BakeClouds, takes_every_texel_from_the_points_near_it) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto scan = scan_of({las_file(folder / "a.las", cloud_of(40))}, solids);
  EXPECT_THAT(scan->warnings(), testing::IsEmpty());
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  EXPECT_GT(baked->known, 0.98);
  // Points are 0.16 m apart, and at the edges of a face on one side only.
  const auto [all, right] = places_of(solids, *baked, 0.4);
  EXPECT_GT(all, 80000U);
  RecordProperty("per_mille_known", static_cast<int>(1000 * baked->known));
  RecordProperty("per_mille_right", static_cast<int>(1000 * right / all));
  EXPECT_GE(static_cast<double>(right), 0.98 * static_cast<double>(all)) << right << " of " << all;
}

TEST(BakeClouds, covers_faces_at_two_points_per_square_metre) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto scan = scan_of({las_file(folder / "a.las", cloud_of(2))}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  EXPECT_GT(baked->known, 0.85);
  const auto [all, right] = places_of(solids, *baked, 1.5);
  RecordProperty("per_mille_known", static_cast<int>(1000 * baked->known));
  RecordProperty("per_mille_right", static_cast<int>(1000 * right / all));
  EXPECT_GE(static_cast<double>(right), 0.9 * static_cast<double>(all)) << right << " of " << all;
}

TEST(BakeClouds, takes_colours_of_8_and_of_16_bits_for_the_same) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  auto points = cloud_of(10);
  const auto wide = bake(solids, *scan_of({las_file(folder / "a.las", points)}, solids), {}, side);
  for (auto& p : points)
    for (auto& c : p.colour) c /= 257;
  const auto narrow = bake(solids, *scan_of({las_file(folder / "b.las", points)}, solids), {}, side);
  ASSERT_TRUE(wide && narrow);
  EXPECT_GT(wide->known, 0.9);
  EXPECT_EQ(wide->solids[0].faces[0].pixels.rgb, narrow->solids[0].faces[0].pixels.rgb);
}

TEST(BakeClouds, gives_the_same_pixels_in_any_order_frame_and_number_of_threads) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  auto points = cloud_of(12);
  base::limit_threads(1);
  const auto here = bake(solids, *scan_of({las_file(folder / "a.las", points)}, solids), {}, side);
  base::limit_threads(4);
  std::ranges::reverse(points);
  auto moved = solids;
  for (auto& solid : moved)
    for (auto& v : solid.solid.vertices) v = v + Point3{1234, -567, 89};
  model::Frame frame;
  frame.origin = {-1234, 567, -89};
  const auto there = bake(moved, *scan_of({las_file(folder / "b.las", points)}, moved, nullptr, frame), {}, side);
  base::limit_threads(0);
  ASSERT_TRUE(here && there);
  EXPECT_EQ(here->known, there->known);
  expect_same_pixels(*here, *there);
}

TEST(BakeClouds, makes_a_building_alone_as_among_others) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto cloud = las_file(folder / "a.las", cloud_of(12));
  const std::vector<model::LabelledSolid> first{solids[0]};
  // bake_all expects what points decide by: twice their reach more than the faces do.
  auto larger = first;
  for (auto& v : larger[0].solid.vertices) v = v + Point3{v.x > 10 ? 6.0 : -6.0, v.y > 5 ? 6.0 : -6.0, 0};
  const auto among = bake(first, *scan_of({cloud}, solids), {}, side);
  const auto alone = bake(first, *scan_of({cloud}, larger), {}, side);
  ASSERT_TRUE(among && alone);
  expect_same_pixels(*among, *alone, 1);
}

TEST(BakeClouds, leaves_out_ground_vegetation_noise_and_all_but_last_returns) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto good = cloud_of(12);
  const auto expected = bake(solids, *scan_of({las_file(folder / "a.las", good)}, solids), {}, side);
  auto points = good;
  for (const auto& p : good) {
    auto bad = p;
    bad.colour = {65535, 1, 65535};
    for (const int kind : {2, 5, 7, 9, 18}) {
      bad.classification = static_cast<std::uint8_t>(kind);
      points.push_back(bad);
    }
    bad.classification = 6;
    bad.returns = 2;
    points.push_back(bad);
    bad.returns = 1;
    bad.withheld = true;
    points.push_back(bad);
    bad.withheld = false;
    bad.colour = {};  // black: without a colour
    points.push_back(bad);
  }
  const auto baked = bake(solids, *scan_of({las_file(folder / "b.las", points)}, solids), {}, side);
  ASSERT_TRUE(expected && baked);
  expect_same_pixels(*baked, *expected);
}

TEST(BakeClouds, takes_classes_for_what_the_options_say) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto good = cloud_of(12);
  const auto expected = bake(solids, *scan_of({las_file(folder / "a.las", good)}, solids), {}, side);
  auto points = good;
  for (auto& p : points) p.classification = 67;
  for (const auto& p : good) {
    auto bad = p;
    bad.colour = {65535, 1, 65535};
    for (const int kind : {65, 66}) {
      bad.classification = static_cast<std::uint8_t>(kind);
      points.push_back(bad);
    }
  }
  cloud::Options classes;
  classes.building_classes = "6,67", classes.ground_classes = "2,66", classes.left_out_classes = "65";
  const auto scan = scan_of({las_file(folder / "b.las", points)}, solids, nullptr, {}, classes);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(expected && baked);
  expect_same_pixels(*baked, *expected);
}

TEST(BakeClouds, colours_no_wall_by_level_ground_that_is_not_classified) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  std::vector<CloudPoint> points;
  for (const auto& p : cloud_of(20))
    if (p.position.z < 0.2) points.push_back(p);  // the ground, and the lowest 0.2 m of walls
  const auto baked = bake(solids, *scan_of({las_file(folder / "a.las", points)}, solids), {}, side);
  ASSERT_TRUE(baked);
  EXPECT_LT(baked->known, 0.05);
}

TEST(BakeClouds, colours_little_by_leaves_around_a_house) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  std::vector<CloudPoint> points;
  base::Random random(3);
  const auto box = box_of(solids);
  for (int i = 0; i < 60000; ++i) {  // 12 a cubic metre, over and beside the houses
    auto& p = points.emplace_back();
    p.position = {random.uniform(box.least.x, box.most.x), random.uniform(box.least.y, box.most.y),
                  random.uniform(0, box.most.z)};
    p.colour = {1000, 60000, 1000};
  }
  const auto baked = bake(solids, *scan_of({las_file(folder / "a.las", points)}, solids), {}, side);
  ASSERT_TRUE(baked);
  RecordProperty("per_mille_known", static_cast<int>(1000 * baked->known));
  EXPECT_LT(baked->known, 0.35);
}

TEST(BakeClouds, says_that_a_cloud_has_no_colours) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  auto points = cloud_of(5);
  for (auto& p : points) p.colour = {};
  points[0].colour = {};
  const auto without = scan_of({las_file(folder / "a.las", points)}, solids);
  ASSERT_EQ(without->warnings().size(), 1U);
  EXPECT_EQ(without->warnings()[0].code, "texture-none");
  // A format with colours, all of them black.
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  ASSERT_TRUE(base::write_file(folder / "a.ply", ply + "5 5 5 0 0 0\n6 6 6 0 0 0\n"));
  const auto black = scan_of({folder / "a.ply"}, solids);
  ASSERT_EQ(black->warnings().size(), 1U);
  EXPECT_EQ(black->warnings()[0].code, "texture-none");
}

TEST(BakeClouds, reads_colours_of_ply_in_bytes_and_in_shares) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto file = [&](const std::string& name, const std::string& type, const std::string& colour) {
    std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    for (const char* channel : {"red", "green", "blue"}) ply += "property " + type + " " + channel + "\n";
    EXPECT_TRUE(base::write_file(folder / name, ply + "end_header\n5 5 5 " + colour + "\n"));
    const auto points = scan_of({folder / name}, solids)->points_near(box_of(solids));
    EXPECT_TRUE(points && points->size() == 1);
    return points && points->size() == 1 ? (*points)[0].colour : formats::LinearColour{};
  };
  const formats::LinearColour expected{formats::linear_of(255), formats::linear_of(102), formats::linear_of(0)};
  EXPECT_EQ(file("bytes.ply", "uchar", "255 102 0"), expected);
  EXPECT_EQ(file("shares.ply", "float", "1 0.4 0"), expected);
  EXPECT_EQ(file("words.ply", "ushort", "65535 26214 0"), expected);
}

TEST(PointTree, finds_what_a_comparison_with_all_points_finds) {
  base::Random random(11);
  std::vector<ScanPoint> points(500);
  for (auto& p : points)
    p.position = {std::round(random.uniform(0, 20)), std::round(random.uniform(0, 20)), random.uniform(0, 3)};
  const PointTree tree(points);
  for (int i = 0; i < 200; ++i) {
    const Point3 at{random.uniform(-2, 22), random.uniform(-2, 22), random.uniform(-1, 4)};
    std::vector<double> all;
    for (const auto& p : points) {
      const auto d = p.position - at;
      if (dot(d, d) <= 4) all.push_back(dot(d, d));
    }
    std::ranges::sort(all);
    if (all.size() > 9) all.resize(9);
    std::vector<double> found;
    for (const auto& near : tree.nearest(at, 9, 2)) found.push_back(near.squared);
    EXPECT_EQ(found, all);
  }
  EXPECT_TRUE(PointTree().nearest({}, 9, 2).empty());
}

}  // namespace
}  // namespace mansard::texture
