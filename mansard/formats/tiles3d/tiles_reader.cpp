#include <algorithm>
#include <set>

#include "mansard/base/files.hpp"
#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/detail/writers.hpp"
#include "mansard/formats/gltf/glb_reader.hpp"
#include "mansard/formats/tiles3d/tileset_json.hpp"

namespace mansard::formats::detail {
namespace {

struct TileRecord {
  std::uint32_t file = 0;
  RecordPlace place;
};

/// The contents of leaves, in the order of the tileset. Only these carry records.
void append_leaves(const TileJson& tile, std::vector<std::string>& uris) {
  if (!tile.is_object()) return;
  const auto children = tile.children();
  for (const TileJson& child : children) append_leaves(child, uris);
  if (!children.empty()) return;
  for (auto& content : tile.contents()) uris.push_back(std::move(content.uri));
}

/// Whether a name stays within the folder of its tileset.
auto is_within(const Path& uri) -> bool {
  return uri.is_relative() && std::ranges::find(uri, Path("..")) == uri.end() &&
         uri.string().find(':') == std::string::npos;
}

class TilesReader : public CityReader {
 public:
  TilesReader(Header header, std::vector<Path> files, std::vector<TileRecord> records)
      : header_(std::move(header)), files_(std::move(files)), records_(std::move(records)) {}

  auto header() const -> const Header& override { return header_; }
  auto has_models() const -> bool override { return false; }
  auto next() -> base::Result<std::optional<model::Building>> override {
    if (at_ == records_.size()) return std::optional<model::Building>();
    const auto& [file, place] = records_[at_++];
    const auto text = read_piece(files_[file], place.offset, place.bytes);
    if (!text) return text.error();
    auto building = read_building_record(*text, files_[file].string());
    if (!building) return building.error();
    return std::optional<model::Building>(std::move(*building));
  }

 private:
  Header header_;
  std::vector<Path> files_;
  std::vector<TileRecord> records_;
  std::size_t at_ = 0;
};

auto leaf_records(const std::vector<Path>& files) -> base::Result<std::vector<TileRecord>> {
  std::vector<TileRecord> records;
  for (std::uint32_t f = 0; f < files.size(); ++f) {
    const auto found = glb_records(files[f]);
    if (!found) return found.error();
    for (const RecordPlace& place : found->records) records.push_back({f, place});
  }
  std::ranges::stable_sort(records, {}, [](const TileRecord& r) { return r.place.order; });
  const auto twice = std::ranges::unique(records, {}, [](const TileRecord& r) { return r.place.order; });
  records.erase(twice.begin(), twice.end());
  return records;
}

}  // namespace

auto tiles_reader(const Path& folder) -> ReaderResult {
  std::error_code failure;
  const Path path = std::filesystem::is_directory(folder, failure) ? folder / "tileset.json" : folder;
  const auto text = base::read_file(path);
  if (!text) return text.error();
  const TilesetJson tileset(*text);
  if (tileset.fault() != TilesetJson::Fault::none)
    return base::error("write-read-format", "this is no tileset.json; give a folder of 3D Tiles", path.string());
  const nlohmann::ordered_json::json_pointer to_header("/asset/extras/header");
  if (!tileset.json().contains(to_header) || !tileset.json()[to_header].is_object())
    return base::error("write-read-plans", "these tiles carry no plans; give some that mansard wrote", path.string());
  auto header = read_header_record(tileset.json()[to_header].dump(), path.string());
  if (!header) return header.error();
  std::vector<std::string> uris;
  append_leaves(tileset.root(), uris);
  std::vector<Path> files;
  std::set<std::string> named;  // a tile has its content for itself: what is named again has been read
  for (const auto& uri : uris) {
    if (!named.insert(uri).second) continue;
    if (!is_within(uri))
      return base::error("write-read-format",
                         "a tile lies outside of the folder of its tileset; give one that mansard wrote",
                         path.string());
    files.push_back(path.parent_path() / uri);
  }
  auto records = leaf_records(files);
  if (!records) return records.error();
  return std::unique_ptr<CityReader>(
      std::make_unique<TilesReader>(std::move(*header), std::move(files), std::move(*records)));
}

}  // namespace mansard::formats::detail
