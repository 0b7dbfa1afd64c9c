#include "mansard/texture/texture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "mansard/base/run.hpp"
#include "texture/houses.hpp"

namespace mansard::texture {
namespace {

using geometry::Point3;
using testing::HasSubstr;

TEST(Bake, takes_every_texel_from_the_place_where_it_is) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto mesh = houses_with(folder, "houses_xyz.mtl");
  const auto scan = scan_of({mesh}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  EXPECT_GT(baked->known, 0.99);
  std::size_t all = 0, right = 0;
  each_texel(solids, *baked, 0, [&](auto, auto, const auto&, auto, auto, Point3 p, const auto& colour) {
    // 8 bits are 0.2 m in x; the noise of the surface and half a texel come to that.
    const double off =
        std::max({std::abs(colour[0] / 5.0 - p.x), std::abs(colour[1] / 10.0 - p.y), std::abs(colour[2] / 25.0 - p.z)});
    ++all;
    if (off < 0.3) ++right;
  });
  EXPECT_GT(all, 80000U);
  RecordProperty("texels", static_cast<int>(all));
  RecordProperty("elsewhere", static_cast<int>(all - right));
  EXPECT_GE(static_cast<double>(right), 0.99 * static_cast<double>(all)) << right << " of " << all;
}

TEST(Bake, prints_the_grid_of_each_plane_within_one_and_a_half_texels) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  std::ifstream file(houses_folder() / "planes.json");
  const auto planes = nlohmann::json::parse(file).at("planes");
  const auto vector = [](const nlohmann::json& v) { return Point3{v[0], v[1], v[2]}; };
  std::size_t lines = 0, faces = 0;
  double worst = 0;
  for (std::size_t s = 0; s < solids.size(); ++s)
    for (std::size_t f = 0; f < solids[s].solid.faces.size(); ++f) {
      const auto& texture = baked->solids[s].faces[f];
      const auto& face = solids[s].solid.faces[f];
      const nlohmann::json* plane = nullptr;
      for (const auto& one : planes)
        if (dot(vector(one.at("normal")), face.normal) > 0.999 &&
            std::abs(dot(face.normal, vector(one.at("origin")) - solids[s].solid.vertices[face.loops[0][0]])) < 0.01)
          plane = &one;
      if (plane == nullptr || texture.pixels.width == 1) continue;
      ++faces;
      // Lines are 0.06 m wide: the middle of what is darker than the darker chequers, weighted by how much.
      for (int line = 1; line < 14; ++line) {
        double sum = 0, weights = 0;
        for (std::uint32_t y = 0; y < texture.pixels.height; ++y)
          for (std::uint32_t x = 0; x < texture.pixels.width; ++x) {
            const Point3 p = place_of(texture, solids[s], f, x + 0.5, y + 0.5);
            const double along = dot(vector(plane->at("s_axis")), p - vector(plane->at("origin")));
            const double t = dot(vector(plane->at("t_axis")), p - vector(plane->at("origin")));
            // Within three texels, away from the lines across.
            if (std::abs(along - line) > 0.3 || std::abs(t - std::round(t)) < 0.25) continue;
            if (!is_inside(solids[s], f, p, 0.35)) continue;
            const auto [r, g, b] = pixel(texture.pixels, x, y);
            const auto full = plane->at("colour").get<std::array<int, 3>>();
            const double weight = std::max(0.0, 0.7 * (full[0] + full[1] + full[2]) - (r + g + b));
            sum += weight * (along - line);
            weights += weight;
          }
        if (weights < 500) continue;
        ++lines;
        EXPECT_LT(std::abs(sum / weights), 0.15) << plane->at("name") << " line " << line;
        worst = std::max(worst, std::abs(sum / weights));
      }
    }
  RecordProperty("worst_mm", static_cast<int>(1000 * worst));
  EXPECT_EQ(faces, 16U);
  EXPECT_GT(lines, 60U);
}

TEST(Bake, shows_nothing_of_what_is_beside_the_charts_of_the_scan) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  std::size_t magenta = 0;
  for (const auto& solid : baked->solids)
    for (const auto& face : solid.faces)
      for (std::size_t i = 0; i < face.pixels.rgb.size(); i += 3)
        if (face.pixels.rgb[i] > 200 && face.pixels.rgb[i + 1] < 60 && face.pixels.rgb[i + 2] > 200) ++magenta;
  EXPECT_EQ(magenta, 0U);
}

TEST(Bake, stands_pictures_upright_with_right_on_the_right) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  for (std::size_t s = 0; s < solids.size(); ++s)
    for (std::size_t f = 0; f < solids[s].solid.faces.size(); ++f) {
      const auto& frame = baked->solids[s].faces[f].frame;
      if (baked->solids[s].faces[f].pixels.width == 1) continue;
      const Point3 n = solids[s].solid.faces[f].normal;
      EXPECT_GT(dot(cross(frame.right, -1.0 * frame.below), n), 0) << "mirrored";
      EXPECT_NEAR(frame.right.z, 0, 1e-9) << "not along the eave";
      EXPECT_LT(frame.below.z, 0) << "upside down";
      EXPECT_NEAR(length(frame.right), 10, 0.5) << "texels of 0.1 m";
    }
}

TEST(Bake, gives_a_face_that_the_scan_does_not_show_one_pixel) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  std::size_t grounds = 0;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    ASSERT_EQ(baked->solids[s].faces.size(), solids[s].solid.faces.size());
    for (std::size_t f = 0; f < solids[s].classes.size(); ++f) {
      if (solids[s].classes[f] != model::FaceClass::ground) continue;
      ++grounds;
      EXPECT_EQ(baked->solids[s].faces[f].pixels.rgb.size(), 3U);
    }
  }
  EXPECT_EQ(grounds, 2U);
}

TEST(Bake, gives_the_same_pixels_at_any_number_of_threads) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  base::limit_threads(1);
  const auto one = bake(solids, *scan, {}, side);
  base::limit_threads(4);
  const auto four = bake(solids, *scan, {}, side);
  base::limit_threads(0);
  ASSERT_TRUE(one && four);
  expect_same_pixels(*one, *four);
}

TEST(Bake, gives_the_same_pixels_wherever_the_origin_of_the_frame_is) {
  const auto solids = exact_solids();
  const auto here = bake(solids, *scan_of({houses_folder() / "houses.obj"}, solids), {}, side);
  auto moved = solids;
  for (auto& solid : moved)
    for (auto& v : solid.solid.vertices) v = v + Point3{1234, -567, 89};
  model::Frame frame;
  frame.origin = {-1234, 567, -89};
  const auto there = bake(moved, *scan_of({houses_folder() / "houses.obj"}, moved, nullptr, frame), {}, side);
  ASSERT_TRUE(here && there);
  EXPECT_EQ(here->known, there->known);
  expect_same_pixels(*here, *there);
}

TEST(Bake, makes_a_building_alone_as_among_others) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  const std::vector<model::LabelledSolid> first{solids[0]};
  const auto among = bake(first, *scan, {}, side);
  const auto alone = bake(first, *scan_of({houses_folder() / "houses.obj"}, first), {}, side);
  ASSERT_TRUE(among && alone);
  expect_same_pixels(*among, *alone, 1);
}

TEST(Bake, keeps_pictures_within_the_side_that_is_asked_for) {
  const auto solids = exact_solids();
  const auto scan = scan_of({houses_folder() / "houses.obj"}, solids);
  const auto baked = bake(solids, *scan, {}, 60);
  ASSERT_TRUE(baked);
  for (const auto& solid : baked->solids)
    for (const auto& face : solid.faces) {
      EXPECT_LE(face.pixels.width, 60U);
      EXPECT_LE(face.pixels.height, 60U);
    }
}

TEST(Bake, continues_a_face_of_which_most_is_known_and_colours_the_rest_with_the_mean) {
  const auto solids = exact_solids();
  // Half a metre off, the scan is out of reach of the walls on that side.
  auto off = solids;
  for (auto& v : off[0].solid.vertices) v.y += 1.2;
  const std::vector<model::LabelledSolid> one{off[0]};
  const auto scan = scan_of({houses_folder() / "houses.obj"}, one);
  const auto baked = bake(one, *scan, {}, side);
  ASSERT_TRUE(baked);
  EXPECT_LT(baked->known, 0.9);
  EXPECT_GT(baked->known, 0.3);
  for (std::size_t f = 0; f < one[0].solid.faces.size(); ++f) {
    const auto& face = baked->solids[0].faces[f];
    ASSERT_FALSE(face.pixels.rgb.empty());
    if (one[0].solid.faces[f].normal.y < -0.9) {  // its surface is 1.2 m in front
      EXPECT_EQ(face.pixels.rgb, std::vector<std::uint8_t>(baked->solids[0].wall.begin(), baked->solids[0].wall.end()));
    }
  }
}

TEST(Scan, tells_of_pictures_that_are_missing_or_are_not_pictures_and_goes_on) {
  const test::Scratch folder;
  const auto mesh = houses_with(folder, "houses.mtl");
  std::filesystem::remove(folder / "gable.png");
  std::ofstream(folder / "l.png", std::ios::binary) << "\xABKTX 20\xBB\r\n\x1A\n and more";
  const auto solids = exact_solids();
  const auto scan = scan_of({mesh}, solids);
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->known, 0);
  const auto told = scan->warnings();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].code, "texture-missing");
  EXPECT_THAT(told[0].subject, HasSubstr("gable.png"));
  EXPECT_EQ(told[1].code, "texture-image");
  EXPECT_THAT(told[1].message, HasSubstr("KTX2"));
}

TEST(Scan, tells_of_a_missing_library_and_of_meshes_without_colours) {
  const test::Scratch folder;
  const auto mesh = houses_with(folder, "nothing.mtl");
  const auto solids = exact_solids();
  std::vector<base::Diagnostic> told;
  const auto scan = scan_of({mesh}, solids, &told);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].code, "texture-missing");
  EXPECT_THAT(told[0].message, HasSubstr("nothing.mtl"));
  ASSERT_EQ(scan->warnings().size(), 1U);
  EXPECT_EQ(scan->warnings()[0].code, "texture-none");
  const auto baked = bake(solids, *scan, {}, side);
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->known, 0);
}

TEST(Scan, decodes_a_picture_again_where_memory_is_short) {
  const auto solids = exact_solids();
  auto scan = Scan::open(1);  // MB: no picture of the set fits beside another one
  ASSERT_TRUE(scan);
  (*scan)->expect(box_of(solids));
  ingest::Options options;
  options.crs = "local";
  ASSERT_TRUE(texture::read(**scan, {houses_folder() / "houses.obj"}, options, {}));
  const auto small = bake(solids, **scan, {}, side);
  const auto large = bake(solids, *scan_of({houses_folder() / "houses.obj"}, solids), {}, side);
  ASSERT_TRUE(small && large);
  expect_same_pixels(*small, *large);
}

TEST(Scan, reads_the_same_picture_from_obj_and_glb) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto obj = bake(solids, *scan_of({houses_with(folder, "houses_xyz.mtl")}, solids), {}, side);
  const auto glb = bake(solids, *scan_of({houses_folder() / "houses_xyz.glb"}, solids), {}, side);
  ASSERT_TRUE(obj && glb);
  std::size_t all = 0, same = 0;
  for (std::size_t s = 0; s < solids.size(); ++s)
    for (std::size_t f = 0; f < solids[s].solid.faces.size(); ++f) {
      const auto &a = obj->solids[s].faces[f].pixels, &b = glb->solids[s].faces[f].pixels;
      ASSERT_EQ(a.rgb.size(), b.rgb.size());
      for (std::size_t i = 0; i < a.rgb.size(); ++i, ++all)
        if (std::abs(int{a.rgb[i]} - int{b.rgb[i]}) <= 2) ++same;
    }
  EXPECT_GT(static_cast<double>(same), 0.999 * static_cast<double>(all));
}

/// The houses as PLY, with a list of places in each face as MeshLab and OpenMVS write it.
void write_ply(const std::filesystem::path& obj, const std::filesystem::path& path) {
  std::ifstream in(obj);
  std::string vertices, faces, line, word;
  std::vector<std::array<std::string, 2>> uv;
  std::map<std::string, int> images;
  std::string comments;
  std::size_t vertex_count = 0, face_count = 0;
  int image = 0;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    words >> word;
    if (word == "v") vertices += line.substr(2) + "\n", ++vertex_count;
    if (word == "vt") words >> uv.emplace_back()[0] >> uv.back()[1];
    if (word == "usemtl") {
      words >> word;
      const auto [at, added] = images.try_emplace(word, static_cast<int>(images.size()));
      image = at->second;
      if (added) comments += "comment TextureFile " + word + ".png\n";
    }
    if (word != "f") continue;
    std::string corners, places;
    std::size_t count = 0;
    while (words >> word) {
      const auto slash = word.find('/');
      corners += " " + std::to_string(std::stoul(word) - 1);
      const auto& [u, v] = uv.at(std::stoul(word.substr(slash + 1)) - 1);
      places += " " + u + " " + v;
      ++count;
    }
    faces +=
        std::to_string(count) + corners + " " + std::to_string(2 * count) + places + " " + std::to_string(image) + "\n";
    ++face_count;
  }
  std::ofstream(path, std::ios::binary)
      << "ply\nformat ascii 1.0\ncomment made by hand\n"
      << comments << "element vertex " << vertex_count
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << face_count
      << "\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int texnumber\n"
         "end_header\n"
      << vertices << faces;
}

TEST(Scan, reads_the_same_picture_from_obj_and_ply) {
  const auto solids = exact_solids();
  const test::Scratch folder;
  const auto obj = houses_with(folder, "houses.mtl");
  write_ply(obj, folder / "houses.ply");
  const auto from_obj = bake(solids, *scan_of({obj}, solids), {}, side);
  const auto from_ply = bake(solids, *scan_of({folder / "houses.ply"}, solids), {}, side);
  ASSERT_TRUE(from_obj && from_ply);
  EXPECT_GT(from_ply->known, 0.9);
  for (std::size_t s = 0; s < solids.size(); ++s)
    for (std::size_t f = 0; f < solids[s].solid.faces.size(); ++f)
      EXPECT_EQ(from_obj->solids[s].faces[f].pixels.rgb, from_ply->solids[s].faces[f].pixels.rgb) << s << " " << f;
}

TEST(Scan, reads_tilesets_and_materials_by_shaders) {
  const auto shared = std::filesystem::path(MANSARD_SHARED_DATA) / "textured";
  if (!std::filesystem::exists(shared)) GTEST_SKIP() << "no shared data";
  for (const char* name : {"campus", "campus_original"}) {
    const auto tileset = shared / name / "tileset.json";
    model::LabelledSolid box;  // a flat roof over everything, at any height: only reading is of interest
    box.solid.vertices = {{-660, -440, 30}, {-600, -440, 30}, {-600, -300, 30}};
    box.solid.faces = {{{{0, 1, 2}}, model::FaceKind::cap, {}, {0, 0, 1}}};
    box.classes = {model::FaceClass::roof};
    Options options;
    options.outward = 40;
    options.size = 1;
    const auto scan = scan_of({tileset}, {box});
    const auto baked = bake({box}, *scan, options, side);
    ASSERT_TRUE(baked);
    EXPECT_GT(baked->known, 0.35) << name;  // the tiles do not fill the triangle
    EXPECT_THAT(scan->warnings(), testing::IsEmpty());
  }
}

}  // namespace
}  // namespace mansard::texture
