// What a tileset says of itself, for `mansard info`.
#include <algorithm>
#include <set>

#include "mansard/base/files.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/formats/tiles3d/tileset.hpp"
#include "mansard/formats/tiles3d/tileset_json.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;

/// Counts tiles by their distance from the root. A tile whose content is a tileset is followed by that tileset's root;
/// one that was opened already, or is missing, is not.
class SourceWalk {
 public:
  explicit SourceWalk(TilesetSource& out) : out_(out) {}

  void take(const TileJson& tile, const fs::path& file, std::size_t depth) {
    if (!tile.is_object()) return;
    if (out_.levels.size() <= depth) out_.levels.resize(depth + 1);
    ++out_.levels[depth].tiles;
    if (const auto error = tile.stated_error()) {
      auto& level = out_.levels[depth];
      level.minimum_error = std::min(level.minimum_error.value_or(*error), *error);
      level.maximum_error = std::max(level.maximum_error.value_or(*error), *error);
    }
    for (const auto& content : tile.contents()) {
      const fs::path path = address_beside(file, content.uri);
      // The extension is maybe that of a server's address, with "?key=…".
      if (check_reach(file, path) && path.extension().string().starts_with(".json")) open(path, depth + 1);
      else ++out_.levels[depth].contents;
    }
    for (const auto& child : tile.children()) take(child, file, depth + 1);
  }

 private:
  void open(const fs::path& path, std::size_t depth) {
    constexpr std::size_t most = 100'000, deepest = 256;  // of tilesets that name others
    std::error_code status;
    if (depth > deepest || opened_.size() >= most || !opened_.insert(fs::weakly_canonical(path, status)).second) return;
    const auto bytes = bytes_of_named(path);
    if (!bytes) return;
    const TilesetJson tileset(bytes->view());
    if (tileset.fault() != TilesetJson::Fault::none) return;
    ++out_.tilesets;
    take(tileset.root(), path, depth);
  }

  TilesetSource& out_;
  std::set<fs::path> opened_;
};

auto text_of(const nlohmann::ordered_json& from, const char* key) -> std::string {
  const auto found = from.find(key);
  return found == from.end() ? std::string() : found->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

auto tileset_source(const std::filesystem::path& path) -> std::optional<TilesetSource> {
  std::error_code status;
  const auto file = std::filesystem::is_directory(path, status) ? path / "tileset.json" : path;
  const auto bytes = base::read_file(file);
  if (!bytes) return std::nullopt;
  const TilesetJson tileset(*bytes);
  if (tileset.fault() != TilesetJson::Fault::none || tileset.asset().empty()) return std::nullopt;
  const auto& root = tileset.json()["root"];
  TilesetSource out;
  out.version = text_in(tileset.asset(), "version");
  out.geometric_error = text_of(tileset.json(), "geometricError");
  out.placed_on_the_earth = root.contains("transform");
  out.bounding_volume = text_of(root, "boundingVolume");
  SourceWalk(out).take(tileset.root(), file, 0);
  return out;
}

}  // namespace mansard::formats
