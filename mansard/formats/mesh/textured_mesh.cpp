#include "mansard/formats/textured_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/mesh/mesh_file.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/textured_formats.hpp"
#include "mansard/formats/osgb/osgb_file.hpp"
#include "mansard/formats/tiles3d/tile_content.hpp"
#include "mansard/formats/tiles3d/tileset.hpp"

namespace mansard::formats {
namespace {

using Table = std::array<std::uint16_t, 256>;

/// Rounded to integers that no rounding of pow can turn: none of the 256 values is within 1e-4 of a half.
auto linear_table() -> const Table& {
  static const Table table = [] {
    Table out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double c = static_cast<double>(i) / 255;
      const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
      out[i] = static_cast<std::uint16_t>(std::floor(linear * 65535 + 0.5));
    }
    return out;
  }();
  return table;
}

template <class Open, class Read>
auto read_guarded(const std::filesystem::path& path, Open open, Read read) -> base::Result<TexturedMesh> {
  const std::string name = path.string();
  try {
    const auto bytes = open(path);
    if (!bytes) return bytes.error();
    return read(bytes->view());
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "the mesh does not fit into memory; cut it into tiles", name);
  } catch (const std::exception& e) {
    return base::error("ingest-mesh-format", std::string("cannot be read (") + e.what() + "); check what it is", name);
  }
}

}  // namespace

auto linear_of(std::uint8_t srgb) -> std::uint16_t { return linear_table()[srgb]; }

auto srgb_of(std::uint16_t linear) -> std::uint8_t {
  const Table& table = linear_table();
  const auto above = std::ranges::lower_bound(table, linear);
  if (above == table.begin()) return 0;
  if (above == table.end()) return 255;
  const auto index = static_cast<std::uint8_t>(above - table.begin());
  const bool lower = linear - *(above - 1) < *above - linear;
  return lower ? static_cast<std::uint8_t>(index - 1) : index;
}

auto ImageSource::beside(const std::filesystem::path& given, const std::filesystem::path& from, const std::string& name)
    -> ImageSource {
  auto path = named_beside(given, from, name);
  if (!path) return {name, {}, base::on_one_line(name), path.error()};
  return {*path, {}, path->string()};
}

void append(TexturedMesh& all, TexturedMesh more) {
  const auto first = static_cast<std::uint32_t>(all.mesh.vertices.size());
  const auto own = static_cast<std::uint32_t>(more.mesh.vertices.size());
  const bool coloured = more.has_colour();
  all.corners.resize(all.mesh.triangles.size());
  all.material_of.resize(all.mesh.triangles.size(), no_material);
  all.mesh.vertices.insert(all.mesh.vertices.end(), more.mesh.vertices.begin(), more.mesh.vertices.end());
  const auto materials = static_cast<std::uint32_t>(all.materials.size());
  for (std::size_t t = 0; t < more.mesh.triangles.size(); ++t) {
    auto& moved = all.mesh.triangles.emplace_back(more.mesh.triangles[t]);
    for (auto& corner : moved) corner = corner < own ? first + corner : no_vertex;
    all.corners.push_back(coloured ? more.corners[t] : TexturedCorners{});
    const auto material = coloured ? more.material_of[t] : no_material;
    all.material_of.push_back(material == no_material ? no_material : materials + material);
  }
  for (auto& material : more.materials) all.materials.push_back(std::move(material));
  for (auto& warning : more.warnings) all.warnings.push_back(std::move(warning));
}

auto read_textured_file(const std::filesystem::path& path, UpAxis up) -> base::Result<TexturedMesh> {
  const auto extension = extension_of(path);
  const bool obj = extension == ".obj", ply = extension == ".ply", gltf = extension == ".glb" || extension == ".gltf";
  if (extension == ".osgb")
    return read_guarded(path, &Bytes::of, [&](std::string_view bytes) -> base::Result<TexturedMesh> {
      auto read = read_osgb(bytes, path, true);
      if (!read) return read.failure();
      if (up == UpAxis::y)
        for (auto& v : read->mesh.mesh.vertices) v = {v.x, -v.z, v.y};
      return std::move(read->mesh);
    });
  if (!obj && !ply && !gltf) {
    auto piece = read_mesh_file(path, up);
    if (piece.failure) return *piece.failure;
    TexturedMesh out;
    out.mesh = {std::move(piece.mesh.vertices), std::move(piece.mesh.triangles)};
    return out;
  }
  return read_guarded(path, &Bytes::of, [&](std::string_view bytes) -> base::Result<TexturedMesh> {
    if ((obj || ply) && !bytes.starts_with("glTF")) {
      const auto text = without_mark(bytes);
      auto read = ply ? read_textured_ply(text, path) : read_textured_obj(text, path);
      if (read && up == UpAxis::y)
        for (auto& v : read->mesh.vertices) v = {v.x, -v.z, v.y};
      return read;
    }
    auto read = read_textured_gltf(without_mark(bytes), path);
    if (!read) return read.failure();
    for (auto& v : read->mesh.mesh.vertices) {
      if (up != UpAxis::z) v = {v.x, -v.z, v.y};
      if (read->centre) v = v + *read->centre;
    }
    return std::move(read->mesh);
  });
}

auto read_textured_tile(const TileFile& tile) -> base::Result<TexturedMesh> {
  return read_guarded(tile.path, &bytes_of_named, [&](std::string_view bytes) {
    return read_textured_content(bytes, tile.path, tile.turn, tile.place);
  });
}

}  // namespace mansard::formats
