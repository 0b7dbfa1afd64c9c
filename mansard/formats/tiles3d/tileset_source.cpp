// What a tileset says of itself, for `mansard info`.
#include <algorithm>

#include "mansard/base/files.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/formats/tiles3d/tileset_json.hpp"

namespace mansard::formats {
namespace {

void walk(const TileJson& tile, std::size_t depth, std::vector<TilesetSource::Level>& levels) {
  if (!tile.is_object()) return;
  if (levels.size() <= depth) levels.resize(depth + 1);
  auto& level = levels[depth];
  ++level.tiles;
  level.contents += tile.contents().size();
  if (const auto error = tile.stated_error()) {
    level.minimum_error = std::min(level.minimum_error.value_or(*error), *error);
    level.maximum_error = std::max(level.maximum_error.value_or(*error), *error);
  }
  for (const auto& child : tile.children()) walk(child, depth + 1, levels);
}

auto text_of(const nlohmann::ordered_json& from, const char* key) -> std::string {
  const auto found = from.find(key);
  return found == from.end() ? std::string() : found->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

auto tileset_source(const std::filesystem::path& path) -> std::optional<TilesetSource> {
  std::error_code status;
  const auto bytes = base::read_file(std::filesystem::is_directory(path, status) ? path / "tileset.json" : path);
  if (!bytes) return std::nullopt;
  const TilesetJson tileset(*bytes);
  if (tileset.fault() != TilesetJson::Fault::none || tileset.asset().empty()) return std::nullopt;
  const auto& root = tileset.json()["root"];
  TilesetSource out;
  out.version = text_in(tileset.asset(), "version");
  out.geometric_error = text_of(tileset.json(), "geometricError");
  out.placed_on_the_earth = root.contains("transform");
  out.bounding_volume = text_of(root, "boundingVolume");
  walk(tileset.root(), 0, out.levels);
  return out;
}

}  // namespace mansard::formats
