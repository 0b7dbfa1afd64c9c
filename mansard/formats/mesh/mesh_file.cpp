#include "mansard/formats/mesh/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <new>

#include "mansard/formats/files/hash.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/tiles3d/tile_content.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/files/words.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
using geometry::Point3;

constexpr std::array<std::string_view, 5> mesh_endings{".obj", ".ply", ".off", ".glb", ".gltf"};

auto take_gltf(std::string_view bytes, const fs::path& path, UpAxis up, MeshPiece& piece) -> base::Result<RawMesh> {
  auto read = read_gltf(bytes, path);
  if (!read) return read.error();
  piece.inputs.insert(piece.inputs.end(), read->buffers.begin(), read->buffers.end());
  const Point3 centre = read->centre.value_or(Point3{});
  if (up != UpAxis::z)
    for (auto& v : read->mesh.vertices) v = {v.x, -v.z, v.y};
  if (read->centre)
    for (auto& v : read->mesh.vertices) v = v + centre;
  return std::move(read->mesh);
}

auto parse(std::string_view bytes, const fs::path& path, UpAxis up, MeshPiece& piece) -> base::Result<RawMesh> {
  const std::string name = path.string(), ending = ending_of(path);
  bytes = without_mark(bytes);
  if (bytes.empty()) return base::error("ingest-mesh-empty", "the file is empty; copy or export it again", name);
  const auto turned = [up](base::Result<RawMesh> mesh) {
    if (mesh && up == UpAxis::y)
      for (auto& v : mesh->vertices) v = {v.x, -v.z, v.y};
    return mesh;
  };
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return turned(read_ply(bytes, name));
  if (bytes.starts_with("glTF") || ending == ".gltf") return take_gltf(bytes, path, up, piece);
  if (ending == ".obj") return turned(read_obj(bytes, name));
  if (ending == ".off" || bytes.starts_with("OFF")) return turned(read_off(bytes, name));
  if (ending == ".ply" || ending == ".glb")
    return base::error("ingest-mesh-format", "the file is not what its name says (" + ending + "); check what it is",
                       name);
  if (bytes.starts_with("b3dm") || bytes.starts_with("cmpt"))
    return base::error("ingest-mesh-format", "a single tile does not say where it is; give the tileset.json it is of",
                       name);
  return base::error("ingest-mesh-format",
                     "not a mesh that is read here; give OBJ, PLY, OFF, GLB, glTF, a tileset.json or a GeoTIFF", name);
}

/// Reads the bytes and has them taken; whatever goes wrong is the file's.
template <class Open, class Take>
auto guarded(const fs::path& path, Open open, Take take) -> MeshPiece {
  MeshPiece out;
  const std::string name = path.string();
  try {
    const auto bytes = open(path);
    if (!bytes) return out.failure = bytes.error(), out;
    out.inputs.push_back({name, bytes->view().size(), {}});
    base::Result<void> done;
    out.inputs.front().sha256 = sha256_beside(bytes->view(), [&] { done = take(bytes->view(), out); });
    if (!done) out.failure = done.error();
  } catch (const std::bad_alloc&) {
    out.mesh = {};
    out.failure = base::error("ingest-memory", "the mesh does not fit into memory; cut it into tiles", name);
  } catch (const std::exception& e) {
    out.failure =
        base::error("ingest-mesh-format", std::string("cannot be read (") + e.what() + "); check what it is", name);
  }
  return out;
}

}  // namespace

auto ending_of(const fs::path& path) -> std::string {
  std::string ending = plain_name(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return ending;
}

auto is_mesh_name(const fs::path& path) -> bool {
  // Hidden files are not the user's: macOS leaves a ._name beside every name it copies.
  return !path.filename().string().starts_with('.') &&
         std::ranges::find(mesh_endings, ending_of(path)) != mesh_endings.end();
}

auto read_mesh_file(const fs::path& path, UpAxis up) -> MeshPiece {
  return guarded(path, &Bytes::of, [&](std::string_view bytes, MeshPiece& piece) -> base::Result<void> {
    auto mesh = parse(bytes, path, up, piece);
    if (!mesh) return mesh.error();
    piece.mesh = std::move(*mesh);
    return {};
  });
}

auto read_tile_file(const TileFile& tile) -> MeshPiece {
  return guarded(tile.path, &bytes_of_named, [&](std::string_view bytes, MeshPiece& piece) -> base::Result<void> {
    auto content = read_tile_content(bytes, tile.path, tile.turn, tile.place);
    if (!content) return content.error();
    piece.mesh = std::move(content->mesh);
    piece.skipped = std::move(content->skipped);
    piece.inputs.insert(piece.inputs.end(), content->buffers.begin(), content->buffers.end());
    return {};
  });
}

}  // namespace mansard::formats
