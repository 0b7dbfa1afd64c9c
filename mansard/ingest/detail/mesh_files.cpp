#include "mansard/ingest/detail/mesh_files.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <new>

#include "mansard/base/files.hpp"
#include "mansard/ingest/detail/hash.hpp"
#include "mansard/ingest/detail/mesh_formats.hpp"

namespace mansard::ingest::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> mesh_endings{".obj", ".ply", ".off", ".glb", ".gltf"};

auto ending_of(const fs::path& path) -> std::string {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return ending;
}

/// The meshes in a folder and those below it (oblique photogrammetry writes a folder per tile), by their whole path.
auto meshes_in(const fs::path& folder) -> base::Result<std::vector<fs::path>> {
  std::vector<fs::path> found;
  std::error_code failure;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
    // Hidden files are not the user's: macOS leaves a ._name beside every name it copies.
    if (at->is_regular_file(failure) && !at->path().filename().string().starts_with('.') &&
        std::ranges::find(mesh_endings, ending_of(at->path())) != mesh_endings.end())
      found.push_back(at->path());
  if (failure) return base::error("file-read", "cannot list the folder: " + failure.message(), folder.string());
  if (found.empty())
    return base::error("ingest-mesh-empty", "the folder holds no meshes; they end in .obj, .ply, .off, .glb or .gltf",
                       folder.string());
  std::ranges::sort(found, {}, [](const fs::path& path) { return path.generic_string(); });
  return found;
}

struct OneFile {
  RawMesh mesh;
  InputFile input;
  std::optional<base::Diagnostic> failure;
};

/// By what the file starts with, where formats say so themselves, else by its name.
auto parse(std::string_view bytes, const fs::path& path, bool& y_up) -> base::Result<RawMesh> {
  const std::string name = path.string(), ending = ending_of(path);
  if (bytes.empty()) return base::error("ingest-mesh-empty", "the file is empty; copy or export it again", name);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return read_ply(bytes, name);
  y_up = bytes.starts_with("glTF") || ending == ".gltf";
  if (y_up) return read_gltf(bytes, path);
  if (ending == ".obj") return read_obj(bytes, name);
  if (ending == ".off" || bytes.starts_with("OFF")) return read_off(bytes, name);
  if (ending == ".ply" || ending == ".glb")
    return base::error("ingest-mesh-format", "the file is not what its name says (" + ending + "); check what it is",
                       name);
  return base::error("ingest-mesh-format", "not a mesh that is read here; give OBJ, PLY, OFF, GLB or glTF", name);
}

auto read_one(const fs::path& path, UpAxis up) -> OneFile {
  OneFile out;
  const std::string name = path.string();
  try {
    const auto bytes = base::read_file(path);
    if (!bytes) return out.failure = bytes.error(), out;
    out.input = {name, bytes->size(), sha256(*bytes)};
    bool y_up = false;
    auto mesh = parse(*bytes, path, y_up);
    if (!mesh) return out.failure = mesh.error(), out;
    out.mesh = std::move(*mesh);
    if (up == UpAxis::y || (up == UpAxis::automatic && y_up))
      for (auto& v : out.mesh.vertices) v = {v.x, -v.z, v.y};
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

auto read_meshes(const std::vector<fs::path>& paths, UpAxis up, const base::Run& run) -> base::Result<MeshFiles> {
  std::vector<fs::path> files;
  for (const auto& path : paths) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) {
      files.push_back(path);
      continue;
    }
    auto inside = meshes_in(path);
    if (!inside) return inside.error();
    files.insert(files.end(), inside->begin(), inside->end());
  }
  if (files.empty()) return base::error("ingest-mesh-empty", "no mesh was given; name one file or folder at least");

  std::vector<OneFile> read(files.size());
  base::parallel_for(files.size(), [&](std::size_t i) {
    if (!run.cancelled()) read[i] = read_one(files[i], up);
  });
  if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");

  MeshFiles out;
  std::size_t vertices = 0, triangles = 0;
  for (const auto& one : read) {
    if (one.failure) return *one.failure;
    vertices += one.mesh.vertices.size();
    triangles += one.mesh.triangles.size();
  }
  const std::string subject = files.size() == 1 ? files.front().string() : files.front().string() + " and others";
  if (vertices >= no_vertex)
    return base::error("ingest-memory", "more than 4 thousand million vertices; reconstruct part after part", subject);
  if (triangles == 0)
    return base::error("ingest-mesh-unusable",
                       "there are " + std::to_string(vertices) + " vertices but no faces; give a surface, not points",
                       subject);
  if (read.size() == 1) {
    out.mesh = std::move(read.front().mesh);
    out.inputs.push_back(std::move(read.front().input));
    return out;
  }
  out.mesh.vertices.reserve(vertices);
  out.mesh.triangles.reserve(triangles);
  for (auto& one : read) {
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    const auto own = static_cast<std::uint32_t>(one.mesh.vertices.size());
    if (one.mesh.triangles.empty())
      out.warnings.push_back(base::warning("ingest-mesh-no-faces", "the file adds no faces", one.input.path));
    out.mesh.vertices.insert(out.mesh.vertices.end(), one.mesh.vertices.begin(), one.mesh.vertices.end());
    for (const auto& triangle : one.mesh.triangles) {
      auto& moved = out.mesh.triangles.emplace_back(triangle);
      // An index beyond its own file must not come to name a vertex of the next one.
      for (auto& corner : moved) corner = corner < own ? first + corner : no_vertex;
    }
    out.mesh.short_faces += one.mesh.short_faces;
    out.inputs.push_back(std::move(one.input));
    one = {};
  }
  return out;
}

}  // namespace mansard::ingest::detail
