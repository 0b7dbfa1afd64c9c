// Bytes → a file of a tileset; the first says which: the tileset.json, a tile's content, or the subtree of an implicit
// quadtree or octree, the others being sound. Reading must not throw nor go on for ever, and must give an error of the
// module's or a mesh.
#include <array>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include "fuzz/files.hpp"
#include "mansard/base/files.hpp"
#include "mansard/ingest/model.hpp"

namespace {

using namespace mansard;
using fuzz::promise;

/// A triangle. Its one buffer is an address that holds its bytes: three corners, and indices.
constexpr const char* tile = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],"buffers":[{"byteLength":39,
"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/AAEC"}]})";

auto tileset(const std::string& root) -> std::string {
  return R"({"asset":{"version":"1.1"},"geometricError":500,"root":{"geometricError":100,"refine":"ADD","boundingVolume":
{"box":[0,0,0,50,0,0,0,50,0,0,0,50]},)" +
         root + "}}";
}

/// A tree of two levels of subtrees.
struct Implicit {
  std::string scheme, name;
  std::size_t ways = 4, levels = 4;

  [[nodiscard]] auto words() const -> std::string {
    return tileset(R"("content":{"uri":")" + name + R"(.gltf"},"implicitTiling":{"subdivisionScheme":")" + scheme +
                   R"(","subtreeLevels":)" + std::to_string(levels / 2) + R"(,"availableLevels":)" +
                   std::to_string(levels) + R"(,"subtrees":{"uri":")" + name + R"(.subtree"}})");
  }
  /// The names of all tiles of a level.
  [[nodiscard]] auto names(std::size_t level) const -> std::vector<std::string> {
    std::vector<std::string> out;
    const std::size_t side = std::size_t{1} << level, deep = ways == 8 ? side : 1;
    for (std::size_t x = 0; x < side; ++x)
      for (std::size_t y = 0; y < side; ++y)
        for (std::size_t z = 0; z < deep; ++z)
          out.push_back(std::to_string(level) + "-" + std::to_string(x) + "-" + std::to_string(y) +
                        (ways == 8 ? "-" + std::to_string(z) : ""));
    return out;
  }
};

/// The folder, with the changing file under the names that it can have in a tileset.
struct Tilesets {
  fuzz::Folder folder{"tiles"};
  std::filesystem::path own, content, quadtree, octree;

  Tilesets() {
    own = folder.name("own/tileset.json");
    write(own, "tile.gltf", tile);
    write(own, "0-0-0.gltf", tile);
    write(own, "inner.json", tileset(R"("content":{"uri":"tile.gltf"})"));
    write(own, "0-0-0.subtree", R"({"tileAvailability":{"constant":1},"contentAvailability":[{"constant":1}],
"childSubtreeAvailability":{"constant":0}})");
    content = folder.name("content/tile.any").replace_filename("tileset.json");
    write(content, "tileset.json", tileset(R"("content":{"uri":"tile.any"})"));
    quadtree = plant({"QUADTREE", "{level}-{x}-{y}", 4, 4});
    octree = plant({"OCTREE", "{level}-{x}-{y}-{z}", 8, 2});
  }
  static void write(const std::filesystem::path& beside, const std::string& name, const std::string& words) {
    promise(base::write_file(beside.parent_path() / name, words).has_value(), "no folder to work in");
  }
  /// Every subtree is the changing file, every tile a triangle.
  [[nodiscard]] auto plant(const Implicit& tree) const -> std::filesystem::path {
    std::filesystem::path path;
    for (std::size_t level = 0; level < tree.levels; ++level)
      for (const std::string& name : tree.names(level)) {
        if (level % (tree.levels / 2) == 0) path = folder.name(tree.scheme + "/" + name + ".subtree");
        write(path, name + ".gltf", tile);
      }
    write(path, "tileset.json", tree.words());
    return path.replace_filename("tileset.json");
  }
};

auto codes() -> const std::vector<base::Code>& {
  static const auto all = fuzz::with_common(ingest::codes());
  return all;
}

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  static const Tilesets tilesets;
  if (size == 0) return 0;
  const std::array paths{tilesets.own, tilesets.content, tilesets.quadtree, tilesets.octree};
  tilesets.folder.hold({reinterpret_cast<const char*>(bytes) + 1, size - 1});
  ingest::Options options;
  options.tile_error = bytes[0] / 4 % 2 == 0 ? 0 : 10;
  const model::Frame frame{{0, 0, 0}, bytes[0] / 8 % 2 == 0 ? "" : "EPSG:32631"};
  try {
    const auto scan = ingest::read_mesh({paths[bytes[0] % paths.size()]}, frame, options);
    if (!scan) {
      fuzz::check_error(scan.error(), codes());
      return 0;
    }
    for (const auto v : scan->mesh.vertices)
      promise(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "a coordinate that is not finite");
    for (const auto& t : scan->mesh.triangles)
      promise(std::max({t[0], t[1], t[2]}) < scan->mesh.vertices.size(), "a triangle names no vertex");
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what(); });
  }
  return 0;
}
