#include "mansard/formats/mesh/mesh_file.hpp"

#include <algorithm>
#include <exception>
#include <new>

#include "mansard/formats/drivers.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/files/words.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/tiles3d/tile_content.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

/// Whether files with this extension are meshes by themselves; tiles are not.
auto is_single_mesh(const std::string& extension) -> bool {
  return std::ranges::any_of(drivers(), [&](const Driver& driver) {
    return (driver.mesh.parse != nullptr || driver.reads.points) &&
           std::ranges::find(driver.extensions, extension) != driver.extensions.end();
  });
}

auto parse(const MeshBytes& source, MeshPiece& piece) -> base::Result<RawMesh> {
  const std::string name = source.path.string(), extension = extension_of(source.path);
  const auto bytes = source.bytes;
  if (bytes.empty()) return base::error("ingest-mesh-empty", "the file is empty; copy or export it again", name);
  const auto named = [&](const Driver& driver) {
    return std::ranges::find(driver.extensions, extension) != driver.extensions.end();
  };
  for (const auto& driver : drivers())
    if (driver.mesh.parse != nullptr &&
        std::ranges::any_of(driver.mesh.signatures, [&](auto signature) { return bytes.starts_with(signature); }))
      return driver.mesh.parse(source, piece);
  for (const auto& driver : drivers())
    if (driver.mesh.by_extension && named(driver)) return driver.mesh.parse(source, piece);
  if (is_single_mesh(extension))
    return base::error("ingest-mesh-format", "the file is not what its name says (" + extension + "); check what it is",
                       name);
  if (bytes.starts_with("b3dm") || bytes.starts_with("cmpt"))
    return base::error("ingest-mesh-format", "a single tile does not say where it is; give the tileset.json it is of",
                       name);
  if (has_extension(source.path, &Reads::footprints))
    return base::error("ingest-mesh-format",
                       "this is a vector file, and a mesh is expected here; give a mesh, a point cloud or a raster of "
                       "heights, and this file as the footprints",
                       name);
  if (extension == ".csv" || extension == ".txt")
    return base::error("ingest-mesh-format",
                       "the text is not a point cloud: its first line is neither numbers nor a header with the columns "
                       "x, y and z; rename the columns",
                       name);
  return base::error("ingest-mesh-format", "not a mesh that is read here; give " + titles(&Reads::mesh) + " or GeoTIFF",
                     name);
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

auto is_mesh_name(const fs::path& path) -> bool {
  // Hidden files are not the user's: macOS leaves a ._name beside every name it copies.
  return !path.filename().string().starts_with('.') && is_single_mesh(extension_of(path));
}

auto read_mesh_file(const fs::path& path, UpAxis up) -> MeshPiece {
  return guarded(path, &Bytes::of, [&](std::string_view bytes, MeshPiece& piece) -> base::Result<void> {
    auto mesh = parse({without_mark(bytes), path, up}, piece);
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
