// The two synthetic houses of data/textured, whose textures say where they are.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/scratch.hpp"
#include "mansard/ingest/model.hpp"
#include "mansard/texture/texture.hpp"

namespace mansard::texture {

inline auto houses_folder() -> std::filesystem::path { return std::filesystem::path(MANSARD_DATA) / "textured"; }

/// The exact models; corners at one place are one.
inline auto exact_solids() -> std::vector<model::LabelledSolid> {
  const auto model = ingest::read_model(houses_folder() / "houses_truth.obj");
  EXPECT_TRUE(model);
  std::vector<model::LabelledSolid> out;
  for (const auto& building : model->buildings) {
    auto& solid = out.emplace_back();
    std::map<geometry::Point3, std::uint32_t> number;
    for (const auto& part : building.parts)
      for (const auto& given : part.faces) {
        model::Face face;
        for (const auto& loop : given.loops) {
          auto& corners = face.loops.emplace_back();
          for (const auto& p : loop) {
            const auto [entry, added] = number.try_emplace(p, static_cast<std::uint32_t>(number.size()));
            if (added) solid.solid.vertices.push_back(p);
            corners.push_back(entry->second);
          }
        }
        face.normal = geometry::normalised(model::area_vector(given.loops[0]));
        solid.classes.push_back(face.normal.z > 0.2    ? model::FaceClass::roof
                                : face.normal.z < -0.2 ? model::FaceClass::ground
                                                       : model::FaceClass::wall);
        solid.solid.faces.push_back(std::move(face));
      }
  }
  return out;
}

inline auto box_of(const std::vector<model::LabelledSolid>& solids) -> geometry::Box3 {
  geometry::Box3 box;
  for (const auto& solid : solids)
    for (const auto& v : solid.solid.vertices) box.add(v);
  return {box.least - geometry::Point3{2, 2, 2}, box.most + geometry::Point3{2, 2, 2}};
}

/// A scan from files, around the solids. `told` are the warnings of reading.
inline auto scan_of(const std::vector<std::filesystem::path>& meshes, const std::vector<model::LabelledSolid>& solids,
                    std::vector<base::Diagnostic>* told = nullptr, const model::Frame& frame = {},
                    const cloud::Options& cloud = {}) -> std::unique_ptr<Scan> {
  auto scan = Scan::open(64);
  EXPECT_TRUE(scan);
  (*scan)->expect(box_of(solids));
  ingest::Options options;
  options.crs = "local";
  options.cloud = cloud;
  const auto read = texture::read(**scan, meshes, options, frame);
  EXPECT_TRUE(read) << (read ? "" : base::to_string(read.error()));
  if (told != nullptr && read) *told = *read;
  return std::move(*scan);
}

inline constexpr std::uint32_t side = 4092;

/// A copy of the OBJ that names another library.
inline auto houses_with(const std::filesystem::path& folder, const std::string& library) -> std::filesystem::path {
  std::filesystem::create_directories(folder);
  for (const auto& entry : std::filesystem::directory_iterator(houses_folder()))
    std::filesystem::copy(entry.path(), folder / entry.path().filename(),
                          std::filesystem::copy_options::overwrite_existing);
  std::ifstream in(houses_folder() / "houses.obj", std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string usual = "houses.mtl";
  text.replace(text.find(usual), usual.size(), library);
  const auto path = folder / "renamed.obj";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// The middle of a pixel of a face's picture, in space: the frame is an affine map of the plane, which is inverted.
inline auto place_of(const model::FaceTexture& texture, const model::LabelledSolid& solid, std::size_t face, double x,
                     double y) -> geometry::Point3 {
  const auto& frame = texture.frame;
  const double per_metre2 = dot(frame.right, frame.right);
  const auto anchor = solid.solid.vertices[solid.solid.faces[face].loops[0][0]];
  const auto [ax, ay] = frame.at(anchor);
  return anchor + ((x - ax) / per_metre2) * frame.right + ((y - ay) / per_metre2) * frame.below;
}

/// Whether a point of the plane of a face is inside it, by the sum of the angles; `margin` in metres from its edges.
inline auto is_inside(const model::LabelledSolid& solid, std::size_t face, geometry::Point3 p, double margin) -> bool {
  const auto& given = solid.solid.faces[face];
  bool inside = false;
  const auto& loop = given.loops[0];
  const auto n = given.normal;
  const auto u = geometry::normalised(solid.solid.vertices[loop[1]] - solid.solid.vertices[loop[0]]), v = cross(n, u);
  const auto flat = [&](geometry::Point3 q) { return geometry::Point2{dot(u, q - p), dot(v, q - p)}; };
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto a = flat(solid.solid.vertices[loop[i]]), b = flat(solid.solid.vertices[loop[(i + 1) % loop.size()]]);
    const auto ab = b - a;
    const double t = std::clamp(-dot(a, ab) / dot(ab, ab), 0.0, 1.0);
    if (length(a + t * ab) < margin) return false;
    if ((a.y > 0) == (b.y > 0)) continue;
    if (a.x - a.y / (b.y - a.y) * (b.x - a.x) > 0) inside = !inside;
  }
  return inside;
}

/// Of the first `solids` of what was baked, by default all.
template <class Baked>
void expect_same_pixels(const Baked& one, const Baked& other, std::size_t solids = ~std::size_t{0}) {
  const std::size_t count = std::min({solids, one.solids.size(), other.solids.size()});
  ASSERT_GT(count, 0U);
  for (std::size_t s = 0; s < count; ++s) {
    ASSERT_EQ(one.solids[s].faces.size(), other.solids[s].faces.size());
    for (std::size_t f = 0; f < one.solids[s].faces.size(); ++f)
      EXPECT_EQ(one.solids[s].faces[f].pixels.rgb, other.solids[s].faces[f].pixels.rgb) << s << ' ' << f;
  }
}

inline auto pixel(const model::Pixels& pixels, std::size_t x, std::size_t y) -> std::array<int, 3> {
  const auto* p = &pixels.rgb[3 * (y * pixels.width + x)];
  return {p[0], p[1], p[2]};
}

/// visit(solid, face, texture, x, y, place, colour) for every texel whose middle is inside its face by `margin`.
template <class Visit>
void each_texel(const std::vector<model::LabelledSolid>& solids, const model::BuildingTexture& baked, double margin,
                Visit visit) {
  for (std::size_t s = 0; s < solids.size(); ++s)
    for (std::size_t f = 0; f < solids[s].solid.faces.size(); ++f) {
      const auto& texture = baked.solids[s].faces[f];
      if (texture.pixels.width == 1 && texture.pixels.height == 1) continue;
      for (std::uint32_t y = 0; y < texture.pixels.height; ++y)
        for (std::uint32_t x = 0; x < texture.pixels.width; ++x) {
          const geometry::Point3 p = place_of(texture, solids[s], f, x + 0.5, y + 0.5);
          if (is_inside(solids[s], f, p, margin)) visit(s, f, texture, x, y, p, pixel(texture.pixels, x, y));
        }
    }
}

}  // namespace mansard::texture
