#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/scratch.hpp"
#include "formats/painted.hpp"
#include "mansard/formats/atlas/atlas.hpp"
#include "mansard/formats/image.hpp"
#include "mansard/formats/results.hpp"
#include "mansard/formats/textured_mesh.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using cities::colour_of;
using cities::painted_street;
using cities::plain;
using model::Pixels;
using testing::HasSubstr;
using Json = nlohmann::json;

auto bytes_in(const fs::path& path) -> std::string {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

auto write(const model::City& city, Format format, const fs::path& path, const WriteOptions& options = {})
    -> base::Result<void> {
  base::Outputs outputs;
  auto writer = open_writer(format, path, {city.frame, city.made_by}, options, outputs);
  if (!writer) return writer.failure();
  if (auto written = write_city(city, **writer); !written) return written;
  return outputs.commit();
}

/// The colour in the middle of every triangle is that of some face: how many of them are.
void expect_colours(const TexturedMesh& mesh, const model::City& city) {
  ASSERT_TRUE(mesh.has_colour());
  std::set<std::array<int, 3>> wanted;
  for (std::size_t b = 0; b < city.buildings.size(); ++b)
    for (const auto& solid : city.buildings[b].texture->solids)
      for (std::size_t f = 0; f < solid.faces.size(); ++f) {
        const auto c = colour_of(b, f);
        wanted.insert({c[0], c[1], c[2]});
      }
  std::map<std::uint32_t, Pixels> images;
  std::set<std::array<int, 3>> found;
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    const auto material = mesh.material_of[t];
    ASSERT_LT(material, mesh.materials.size());
    if (!images.contains(material)) {
      const auto& image = *mesh.materials[material].image;
      const auto pixels = decode_image(image.bytes ? *image.bytes : bytes_in(image.path), image.name);
      ASSERT_TRUE(pixels) << base::to_string(pixels.error());
      images[material] = *pixels;
    }
    const Pixels& image = images[material];
    double u = 0, v = 0;
    for (const auto& corner : mesh.corners[t].uv)
      u += static_cast<double>(corner[0]) / 3, v += static_cast<double>(corner[1]) / 3;
    const auto x = static_cast<std::size_t>(u * image.width), y = static_cast<std::size_t>(v * image.height);
    const auto* rgb = &image.rgb[3 * (y * image.width + x)];
    const auto near = std::ranges::find_if(wanted, [&](const auto& c) {
      return std::abs(c[0] - rgb[0]) < 8 && std::abs(c[1] - rgb[1]) < 8 && std::abs(c[2] - rgb[2]) < 8;
    });
    EXPECT_NE(near, wanted.end()) << int{rgb[0]} << " " << int{rgb[1]} << " " << int{rgb[2]};
    if (near != wanted.end()) found.insert(*near);
  }
  EXPECT_EQ(found.size(), wanted.size());
}

TEST(Image, comes_back_from_png_as_it_was_and_from_jpeg_and_webp_nearly) {
  Pixels ramp{64, 32, {}};
  for (std::uint32_t y = 0; y < 32; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      for (const auto c : {4 * x, 8 * y, 100U}) ramp.rgb.push_back(static_cast<std::uint8_t>(c));
  for (const auto codec : {ImageCodec::png, ImageCodec::jpeg, ImageCodec::webp}) {
    const auto bytes = encode_image(ramp, codec, 90);
    ASSERT_TRUE(bytes) << base::to_string(bytes.error());
    EXPECT_EQ(*bytes, *encode_image(ramp, codec, 90)) << "not the same bytes twice";
    const auto back = decode_image(*bytes, "ramp");
    ASSERT_TRUE(back) << base::to_string(back.error());
    ASSERT_EQ(back->rgb.size(), ramp.rgb.size());
    for (std::size_t i = 0; i < ramp.rgb.size(); ++i)
      ASSERT_NEAR(back->rgb[i], ramp.rgb[i], codec == ImageCodec::png ? 0 : 16) << i;
  }
}

TEST(Image, is_refused_with_what_it_is) {
  using std::string_view_literals::operator""sv;
  const auto refused = [](std::string_view bytes) {
    const auto image = decode_image(bytes, "x.jpg");
    EXPECT_FALSE(image);
    EXPECT_EQ(image.error().code, "texture-image");
    EXPECT_EQ(image.error().subject, "x.jpg");
    return image.error().message;
  };
  EXPECT_THAT(refused("\xABKTX 20\xBB\r\n\x1A\n........"sv), HasSubstr("KTX2"));
  EXPECT_THAT(refused(""sv), HasSubstr("empty"));
  EXPECT_THAT(refused("<html>not found</html>"sv), HasSubstr("JPEG, PNG"));
  // A PNG of 60000 × 60000 pixels by its header.
  EXPECT_THAT(
      refused(
          "\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR\0\0\xEA\x60\0\0\xEA\x60\x08\x02\0\0\0\xB6\x3E\x1C\x7C\0\0\0\0IEND\xAE\x42\x60\x82"sv),
      testing::Not(testing::IsEmpty()));
}

TEST(Image, light_and_srgb_are_inverse) {
  for (int c = 0; c < 256; ++c) EXPECT_EQ(srgb_of(linear_of(static_cast<std::uint8_t>(c))), c);
  EXPECT_EQ(linear_of(255), 65535);
}

TEST(Atlas, keeps_pictures_apart_and_repeats_their_borders) {
  std::vector<Pixels> pictures;
  for (std::uint32_t i = 0; i < 60; ++i)
    pictures.push_back(plain(3 + 7 * (i % 11), 2 + 13 * (i % 7), {static_cast<std::uint8_t>(4 * i), 7, 9}));
  detail::Atlas atlas(256);
  for (const auto& picture : pictures) (void)atlas.add(picture);
  atlas.settle();
  ASSERT_GT(atlas.pages(), 1U);
  std::vector<Pixels> pages;
  for (std::size_t p = 0; p < atlas.pages(); ++p) {
    pages.push_back(atlas.page(p));
    EXPECT_LE(pages.back().width, 256U);
    EXPECT_LE(pages.back().height, 256U);
  }
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto& place = atlas.place(i);
    const auto& page = pages[place.page];
    EXPECT_EQ((place.x - detail::atlas_gutter) % detail::atlas_cell, 0U);
    for (std::uint32_t y = place.y - 2; y < place.y + pictures[i].height + 2; ++y)
      for (std::uint32_t x = place.x - 2; x < place.x + pictures[i].width + 2; ++x)
        ASSERT_EQ(page.rgb[3 * (std::size_t{y} * page.width + x)], pictures[i].rgb[0]) << i;
    const auto [u, v] = atlas.uv(i, {0, 0});
    EXPECT_DOUBLE_EQ(u * page.width, place.x);
    EXPECT_DOUBLE_EQ(v * page.height, place.y);
  }
}

TEST(Atlas, has_one_place_for_all_pictures_of_one_pixel_of_a_colour) {
  const auto red = plain(1, 1, {255, 0, 0}), again = red, blue = plain(1, 1, {0, 0, 255});
  detail::Atlas atlas(256);
  EXPECT_EQ(atlas.add(red), 0U);
  EXPECT_EQ(atlas.add(blue), 1U);
  EXPECT_EQ(atlas.add(again), 0U);
  atlas.settle();
  EXPECT_EQ(atlas.page(0).width, 32U);
}

TEST(Textures, are_in_a_folder_beside_an_obj_and_come_back) {
  const test::Scratch folder;
  const auto city = painted_street();
  ASSERT_TRUE(write(city, Format::obj, folder / "my model.obj"));
  EXPECT_TRUE(fs::exists(folder / "my_model_obj_textures" / "0000.jpg"));
  const auto library = bytes_in(folder / "my model.mtl");
  EXPECT_THAT(library, HasSubstr("newmtl roof_0\n"));
  EXPECT_THAT(library, HasSubstr("map_Kd my_model_obj_textures/0000.jpg\n"));
  EXPECT_THAT(bytes_in(folder / "my model.obj"), HasSubstr("usemtl wall_0\n"));
  const auto mesh = read_textured_file(folder / "my model.obj", UpAxis::automatic);
  ASSERT_TRUE(mesh) << base::to_string(mesh.error());
  EXPECT_THAT(mesh->warnings, testing::IsEmpty());
  expect_colours(*mesh, city);
}

TEST(Textures, are_embedded_in_glb_as_jpeg_and_webp_compressed_or_not) {
  const test::Scratch folder;
  const auto city = painted_street();
  for (const bool compress : {false, true})
    for (const auto codec : {TextureFormat::jpeg, TextureFormat::webp}) {
      WriteOptions options;
      options.compress = compress;
      options.texture_format = codec;
      options.unlit = compress;
      ASSERT_TRUE(write(city, Format::glb, folder / "model.glb", options));
      const auto mesh = read_textured_file(folder / "model.glb", UpAxis::automatic);
      ASSERT_TRUE(mesh) << base::to_string(mesh.error());
      expect_colours(*mesh, city);
    }
}

TEST(Textures, of_a_tileset_are_in_its_leaves_and_colours_above_them) {
  const test::Scratch folder;
  auto city = painted_street();
  city.frame.crs.clear();
  WriteOptions options;
  options.tile_triangles = 100;
  ASSERT_TRUE(write(city, Format::tiles, folder / "model.3dtiles", options));
  std::size_t tiles = 0;
  for (const auto& entry : fs::directory_iterator(folder / "model.3dtiles" / "tiles")) {
    const auto mesh = read_textured_file(entry.path(), UpAxis::automatic);
    ASSERT_TRUE(mesh) << base::to_string(mesh.error());
    EXPECT_TRUE(mesh->has_colour());
    for (const auto material : mesh->material_of) EXPECT_NE(material, no_material);
    ++tiles;
  }
  EXPECT_GE(tiles, 1U);
}

TEST(Textures, are_the_appearance_of_cityjson_with_a_coordinate_for_every_corner) {
  const test::Scratch folder;
  const auto city = painted_street();
  ASSERT_TRUE(write(city, Format::cityjson, folder / "model.city.json"));
  ASSERT_TRUE(write(city, Format::cityjsonseq, folder / "model.city.jsonl"));
  std::vector<Json> files{Json::parse(bytes_in(folder / "model.city.json"))};
  std::ifstream lines(folder / "model.city.jsonl");
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) files.push_back(Json::parse(line));
  EXPECT_EQ(files.size(), 1 + city.buildings.size());
  for (const auto& file : files) {
    const auto& appearance = file.at("appearance");
    const auto& uv = appearance.at("vertices-texture");
    std::size_t used = 0;
    for (const auto& texture : appearance.at("textures")) {
      EXPECT_EQ(texture.at("type"), "JPG");
      EXPECT_TRUE(fs::exists(folder / texture.at("image").get<std::string>()));
    }
    for (const auto& [id, object] : file.at("CityObjects").items())
      for (const auto& geometry : object.value("geometry", Json::array())) {
        if (geometry.at("lod") != "2.2") {
          EXPECT_FALSE(geometry.contains("texture"));
          continue;
        }
        const auto& values = geometry.at("texture").at("visual").at("values");
        ASSERT_EQ(values.size(), geometry.at("boundaries").size());
        for (std::size_t shell = 0; shell < values.size(); ++shell) {
          ASSERT_EQ(values[shell].size(), geometry.at("boundaries")[shell].size());
          for (std::size_t s = 0; s < values[shell].size(); ++s)
            for (std::size_t r = 0; r < values[shell][s].size(); ++r) {
              const auto& ring = values[shell][s][r];
              ASSERT_EQ(ring.size(), 1 + geometry.at("boundaries")[shell][s][r].size());
              EXPECT_LT(ring[0].get<std::size_t>(), appearance.at("textures").size());
              for (std::size_t i = 1; i < ring.size(); ++i, ++used) {
                const auto& pair = uv.at(ring[i].get<std::size_t>());
                EXPECT_TRUE(pair[0] >= 0.0 && pair[0] <= 1.0 && pair[1] >= 0.0 && pair[1] <= 1.0);
              }
            }
        }
      }
    EXPECT_EQ(used, uv.size());
    EXPECT_GT(used, 0U);
  }
}

/// What is between `from` and `to` in a text, every time.
auto all_between(const std::string& text, const std::string& from, const std::string& to) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
    const auto start = at + from.size(), end = text.find(to, start);
    if (end == std::string::npos) break;
    out.push_back(text.substr(start, end - start));
  }
  return out;
}

auto numbers_in(const std::string& text) -> std::vector<double> {
  std::istringstream in(text);
  return {std::istream_iterator<double>(in), {}};
}

/// The colours that the rings of a CityGML file have in its images, at the middle of their corners; and that each ring
/// has as many places as corners.
auto colours_of_rings(const std::string& text, const fs::path& folder, bool v3) -> std::set<std::array<int, 3>> {
  std::map<std::string, std::size_t> corners;  // by the id of the ring
  for (const auto& ring : all_between(text, "<gml:LinearRing gml:id=\"", "</gml:LinearRing>")) {
    const auto id = ring.substr(0, ring.find('"'));
    EXPECT_FALSE(corners.contains(id)) << id;
    corners[id] = numbers_in(all_between(ring, "srsDimension=\"3\">", "<").at(0)).size() / 3;
  }
  std::set<std::array<int, 3>> found;
  std::size_t rings = 0;
  for (const auto& texture : all_between(text, "<app:ParameterizedTexture ", "</app:ParameterizedTexture>")) {
    const auto image = decode_image(bytes_in(folder / all_between(texture, "<app:imageURI>", "<").at(0)), "image");
    EXPECT_TRUE(image);
    if (!image) return found;
    for (const auto& list : all_between(texture, "<app:TexCoordList>", "</app:TexCoordList>")) {
      const auto ids = v3 ? all_between(list, "<app:ring>#", "<") : all_between(list, "ring=\"#", "\"");
      const auto places = all_between(list, v3 ? "<app:textureCoordinates>" : "\">", "<");
      EXPECT_EQ(ids.size(), places.size());
      for (std::size_t i = 0; i < std::min(ids.size(), places.size()); ++i, ++rings) {
        const auto uv = numbers_in(places[i]);
        EXPECT_EQ(uv.size(), 2 * corners[ids[i]]) << ids[i];
        if (i > 0) continue;  // a hole
        EXPECT_EQ(uv[0], uv[uv.size() - 2]);
        double u = 0, v = 0;
        const auto count = static_cast<double>(uv.size() / 2 - 1);
        for (std::size_t k = 0; k + 3 < uv.size(); k += 2) u += uv[k] / count, v += uv[k + 1] / count;
        const auto x = static_cast<std::size_t>(u * image->width),
                   y = static_cast<std::size_t>((1 - v) * image->height);  // v rises, rows go down
        const auto* rgb = &image->rgb[3 * (y * image->width + x)];
        found.insert({rgb[0], rgb[1], rgb[2]});
      }
    }
  }
  EXPECT_EQ(rings, corners.size()) << "rings with an id have places";
  return found;
}

TEST(Textures, are_the_appearance_of_citygml_with_a_place_for_every_corner) {
  const test::Scratch folder;
  auto city = painted_street();
  // Nothing is known of one face: it has a colour, and no place in an image.
  auto& unknown = city.buildings[0].texture->solids[0].faces[0];
  unknown.pixels = plain(1, 1, {51, 102, 255});
  unknown.frame = {{}, {}, {0.5, 0.5}};
  for (const auto version : {CityGml::v2, CityGml::v3}) {
    const bool v3 = version == CityGml::v3;
    WriteOptions options;
    options.citygml = version;
    options.atlas_size = 256;  // several images
    ASSERT_TRUE(write(city, Format::citygml, folder / "my model.gml", options));
    const auto text = bytes_in(folder / "my model.gml");
    EXPECT_TRUE(fs::exists(folder / "my_model_gml_textures" / "0000.jpg"));
    EXPECT_TRUE(text.find("<app:diffuseColor>0.2000 0.4000 1.0000</app:diffuseColor>") != std::string::npos);
    EXPECT_TRUE(text.find("xmlns:app=\"http://www.opengis.net/citygml/appearance/") != std::string::npos);
    for (const auto& target : all_between(text, "<app:target>#", "<"))
      EXPECT_TRUE(text.find("<gml:Polygon gml:id=\"" + target + "\"") != std::string::npos);
    for (const auto& target : all_between(text, "<app:target uri=\"#", "\""))
      EXPECT_TRUE(text.find("<gml:Polygon gml:id=\"" + target + "\"") != std::string::npos);
    std::size_t wanted = 0;
    const auto found = colours_of_rings(text, folder / "", v3);
    for (std::size_t b = 0; b < city.buildings.size(); ++b)
      for (const auto& solid : city.buildings[b].texture->solids)
        for (std::size_t f = 0; f < solid.faces.size(); ++f) {
          if (solid.faces[f].pixels.width == 1) continue;
          ++wanted;
          const auto c = colour_of(b, f);
          EXPECT_TRUE(std::ranges::any_of(found,
                                          [&](const auto& one) {
                                            return std::abs(c[0] - one[0]) < 8 && std::abs(c[1] - one[1]) < 8 &&
                                                   std::abs(c[2] - one[2]) < 8;
                                          }))
              << "building " << b << ", face " << f;
        }
    EXPECT_GT(wanted, 10U);
    // Simpler levels have the mean colours.
    options.lod = "1.2,2.0";
    ASSERT_TRUE(write(city, Format::citygml, folder / "simple.gml", options));
    const auto simple = bytes_in(folder / "simple.gml");
    EXPECT_TRUE(simple.find("<app:diffuseColor>0.7843 0.0392 0.0392</app:diffuseColor>") != std::string::npos);
    EXPECT_TRUE(simple.find("ParameterizedTexture") == std::string::npos);
    // Without textures there is nothing of them.
    ASSERT_TRUE(write(cities::street(), Format::citygml, folder / "plain.gml", options));
    EXPECT_TRUE(bytes_in(folder / "plain.gml").find("app") == std::string::npos);
    EXPECT_FALSE(fs::exists(folder / "plain_gml_textures"));
  }
}

auto ply_of(const std::string& format, const std::string& header, const std::string& body) -> std::string {
  return "ply\nformat " + format + " 1.0\n" + header + "end_header\n" + body;
}

TEST(TexturedPly, has_the_colours_of_vertices_and_of_faces) {
  const test::Scratch folder;
  const auto read = [&](const std::string& bytes) {
    std::ofstream(folder / "a.ply", std::ios::binary) << bytes;
    auto mesh = read_textured_file(folder / "a.ply", UpAxis::automatic);
    EXPECT_TRUE(mesh);
    return mesh ? *std::move(mesh) : TexturedMesh();
  };
  const std::string places = "property float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const auto of_bytes = read(
      ply_of("ascii",
             "element vertex 3\n" + places + "property uchar red\nproperty uchar green\nproperty uchar blue\n" + faces,
             "0 0 0 255 0 51\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n"));
  ASSERT_TRUE(of_bytes.has_colour());
  EXPECT_EQ(of_bytes.corners[0].colour[0], (LinearColour{65535, 0, linear_of(51)}));
  EXPECT_EQ(of_bytes.corners[0].colour[2], (LinearColour{0, 0, 65535}));
  EXPECT_EQ(of_bytes.material_of[0], no_material);
  const auto of_shares = read(ply_of("ascii",
                                     "element vertex 3\n" + places +
                                         "property float diffuse_red\nproperty float diffuse_green\n"
                                         "property float diffuse_blue\n" +
                                         faces,
                                     "0 0 0 1 0 0.2\n1 0 0 nan 1 0\n0 1 0 0 -3 1\n3 0 1 2\n"));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(of_shares.corners[0].colour[c], of_bytes.corners[0].colour[c]) << c;
  const auto of_faces = read(
      ply_of("ascii",
             "element vertex 4\n" + places + faces + "property uchar red\nproperty uchar green\nproperty uchar blue\n",
             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n"));
  ASSERT_EQ(of_faces.mesh.triangles.size(), 2U);
  EXPECT_EQ(of_faces.corners[1].colour[2], (LinearColour{65535, 0, 0}));
  const auto plain = read(ply_of("ascii", "element vertex 3\n" + places + faces, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_FALSE(plain.has_colour());
  EXPECT_EQ(plain.mesh.triangles.size(), 1U);
}

TEST(TexturedPly, has_its_pictures_by_places_of_vertices_and_of_faces_in_any_order_of_bytes) {
  const test::Scratch folder;
  for (const bool big : {false, true})
    for (const bool wedges : {false, true}) {
      std::string body;
      const auto append = [&](auto value) {
        std::array<char, sizeof(value)> bytes{};
        std::memcpy(bytes.data(), &value, sizeof(value));
        if (big) std::ranges::reverse(bytes);
        body.append(bytes.data(), bytes.size());
      };
      const std::vector<std::array<float, 5>> corners{
          {0, 0, 0, 0.25F, 0.75F}, {1, 0, 0, 0.5F, 1}, {0, 1, 0, 1, 0.125F}};
      for (const auto& [x, y, z, u, v] : corners) {
        for (const float c : {x, y, z}) append(c);
        if (!wedges)
          for (const float c : {u, v}) append(c);
      }
      append(std::uint8_t{3});
      for (const std::int32_t i : {0, 1, 2}) append(i);
      if (wedges) {
        append(std::uint8_t{6});
        for (const auto& [x, y, z, u, v] : corners)
          for (const float c : {u, v}) append(c);
        append(std::int32_t{1});  // the second picture
      }
      const std::string header =
          "comment TextureFile other.png\ncomment TextureFile C:\\scans\\my picture.png\nelement vertex 3\n"
          "property float x\nproperty float y\nproperty float z\n" +
          std::string(wedges ? "" : "property float s\nproperty float t\n") +
          "element face 1\nproperty list uchar int vertex_indices\n" +
          (wedges ? "property list uchar float texcoord\nproperty int texnumber\n" : "");
      std::ofstream(folder / "my picture.png") << "";
      const auto bytes = ply_of(big ? "binary_big_endian" : "binary_little_endian", header, body);
      std::ofstream(folder / "a.ply", std::ios::binary) << bytes;
      const auto mesh = read_textured_file(folder / "a.ply", UpAxis::automatic);
      ASSERT_TRUE(mesh) << base::to_string(mesh.error());
      ASSERT_TRUE(mesh->has_colour());
      EXPECT_EQ(mesh->corners[0].uv[0], (std::array<float, 2>{0.25F, 0.25F})) << "v counts upwards in the file";
      EXPECT_EQ(mesh->corners[0].uv[2], (std::array<float, 2>{1, 0.875F}));
      ASSERT_EQ(mesh->materials.size(), 2U);
      EXPECT_EQ(mesh->material_of[0], wedges ? 1U : 0U);
      EXPECT_EQ(mesh->materials[1].image->path, folder / "my picture.png")
          << "beside the mesh, not on another computer";
      // Cut short anywhere, it is refused.
      for (std::size_t size = bytes.size() - body.size(); size < bytes.size(); ++size) {
        std::ofstream(folder / "cut.ply", std::ios::binary) << bytes.substr(0, size);
        const auto cut = read_textured_file(folder / "cut.ply", UpAxis::automatic);
        ASSERT_FALSE(cut) << size;
        EXPECT_EQ(cut.error().code, "ingest-mesh-truncated");
      }
    }
}

TEST(Textures, do_not_appear_without_their_file) {
  const test::Scratch folder;
  const auto city = painted_street();
  {
    base::Outputs outputs;
    auto writer = open_writer(Format::obj, folder / "model.obj", {city.frame, city.made_by}, {}, outputs);
    ASSERT_TRUE(writer && write_city(city, **writer));
    EXPECT_FALSE(fs::exists(folder / "model_obj_textures"));
  }
  EXPECT_TRUE(fs::is_empty(folder / ""));
}

TEST(Textures, fill_several_images_where_one_is_too_small) {
  const test::Scratch folder;
  const auto city = painted_street();
  WriteOptions options;
  options.atlas_size = 256;
  for (const auto& [format, name] : {std::pair{Format::obj, "model.obj"}, std::pair{Format::glb, "model.glb"}}) {
    ASSERT_TRUE(write(city, format, folder / name, options));
    const auto mesh = read_textured_file(folder / name, UpAxis::automatic);
    ASSERT_TRUE(mesh);
    expect_colours(*mesh, city);
  }
}

}  // namespace
}  // namespace mansard::formats
