#include "apps/server/scene_view.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "apps/server/json.hpp"

namespace mansard::server {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 23;  // bytes that are copied at a time
constexpr std::size_t longest_head = 4096;                 // bytes

template <class T>
void append_all(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

constexpr auto bytes_of(std::size_t vertices, std::size_t triangles) -> std::size_t {
  return 8 + 12 * (vertices + triangles);
}

/// None where fewer bytes are there.
auto read_at(int file, std::uint64_t offset, std::size_t count) -> std::optional<std::string> {
  std::string bytes(count, '\0');
  for (std::size_t done = 0; done < count;) {
    const auto got = ::pread(file, bytes.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return std::nullopt;
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace

auto SceneView::make(std::string scene_json, const std::function<void(const picture::TakeTile&)>& tiles)
    -> base::Result<std::shared_ptr<const SceneView>> {
  static_assert(std::endian::native == std::endian::little);
  const std::shared_ptr<SceneView> view(new SceneView);
  view->scene_json_ = std::move(scene_json);
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  view->spool_ = std::move(*spool);
  Json list = Json::array();
  std::size_t levels = 0;
  tiles([&](picture::Tile tile) {
    list.push_back(json_of(tile));
    levels = std::max(levels, tile.level + 1);
    Place place{{}, view->spool_->size(), tile.positions.size() / 3, tile.triangles.size() / 3};
    std::string bytes;
    append_all(bytes, std::vector<std::uint32_t>{static_cast<std::uint32_t>(place.vertices),
                                                 static_cast<std::uint32_t>(place.triangles)});
    append_all(bytes, tile.positions);
    append_all(bytes, tile.triangles);
    view->spool_->append(bytes);
    // Not `= {}`, which empties a vector and leaves it its memory.
    tile.positions = std::vector<float>();
    tile.triangles = std::vector<std::uint32_t>();
    place.tile = std::move(tile);
    view->tiles_.emplace(id_of(place.tile), std::move(place));
  });
  view->tiles_json_ = text_of({{"levels", levels}, {"tiles", std::move(list)}});
  view->size_ = view->spool_->size();
  return std::shared_ptr<const SceneView>(view);
}

/// A line of JSON with key and lengths, then scene, list of tiles, and tiles.
auto SceneView::keep(const std::filesystem::path& path, const std::string& key) const -> base::Result<void> {
  auto file = Arriving::open(path);
  if (!file) return file.failure();
  const Json head{{"key", key}, {"scene", scene_json_.size()}, {"list", tiles_json_.size()}, {"tiles", size_}};
  for (const auto& text : {text_of(head) + '\n', scene_json_, tiles_json_})
    if (auto added = file->add(text); !added) return added;
  for (std::uint64_t at = 0; at < size_; at += piece_bytes) {
    const auto bytes = bytes_at(at, static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, size_ - at)));
    if (!bytes) return bytes.failure();
    if (auto added = file->add(*bytes); !added) return added;
  }
  return file->finish();
}

auto SceneView::open(const std::filesystem::path& path, const std::string& key) -> std::shared_ptr<const SceneView> {
  const std::shared_ptr<SceneView> view(new SceneView);
  view->file_ = Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!view->file_.is_open()) return nullptr;
  const auto end = ::lseek(view->file_.number(), 0, SEEK_END);
  if (end <= 0) return nullptr;
  const auto length = static_cast<std::uint64_t>(end);
  const auto first =
      read_at(view->file_.number(), 0, static_cast<std::size_t>(std::min<std::uint64_t>(longest_head, length)));
  const auto line = first ? first->find('\n') : std::string::npos;
  if (line == std::string::npos) return nullptr;
  try {
    const auto head = Json::parse(first->substr(0, line));
    if (head.at("key") != key) return nullptr;
    const auto scene = head.at("scene").get<std::size_t>(), list = head.at("list").get<std::size_t>();
    view->size_ = head.at("tiles").get<std::uint64_t>();
    view->begin_ = line + 1 + scene + list;
    if (view->begin_ + view->size_ != length) return nullptr;
    auto scene_json = read_at(view->file_.number(), line + 1, scene);
    auto tiles_json = read_at(view->file_.number(), line + 1 + scene, list);
    if (!scene_json || !tiles_json) return nullptr;
    view->scene_json_ = std::move(*scene_json);
    view->tiles_json_ = std::move(*tiles_json);
    std::uint64_t offset = 0;
    const auto tiles = Json::parse(view->tiles_json_);
    for (const auto& tile : tiles.at("tiles")) {
      const Place place{{}, offset, tile.at("vertices").get<std::size_t>(), tile.at("triangles").get<std::size_t>()};
      offset += bytes_of(place.vertices, place.triangles);
      view->tiles_.emplace(tile.at("id").get<std::string>(), place);
    }
    if (offset != view->size_) return nullptr;
  } catch (const Json::exception&) {
    return nullptr;  // damaged: it is made again from the inputs
  }
  return view;
}

auto SceneView::bytes_at(std::uint64_t offset, std::size_t count) const -> base::Result<std::string> {
  if (spool_) {
    const std::scoped_lock lock(spool_mutex_);
    return spool_->read(offset, count);
  }
  auto bytes = read_at(file_.number(), begin_ + offset, count);
  if (!bytes) return base::error("file-write", "the kept tiles of the mesh cannot be read; read the inputs again");
  return std::move(*bytes);
}

auto SceneView::tile_bytes(const std::string& id) const -> base::Result<std::optional<std::string>> {
  const auto at = tiles_.find(id);
  if (at == tiles_.end()) return std::optional<std::string>();
  auto bytes = bytes_at(at->second.offset, bytes_of(at->second.vertices, at->second.triangles));
  if (!bytes) return bytes.failure();
  return std::optional(std::move(*bytes));
}

auto SceneView::tile(const std::string& id) const -> base::Result<std::optional<picture::Tile>> {
  const auto bytes = tile_bytes(id);
  if (!bytes) return bytes.failure();
  if (!*bytes) return std::optional<picture::Tile>();
  const auto& place = tiles_.find(id)->second;
  auto tile = place.tile;
  tile.positions.resize(3 * place.vertices);
  tile.triangles.resize(3 * place.triangles);
  std::memcpy(tile.positions.data(), (*bytes)->data() + 8, 12 * place.vertices);
  std::memcpy(tile.triangles.data(), (*bytes)->data() + 8 + 12 * place.vertices, 12 * place.triangles);
  return std::optional(std::move(tile));
}

}  // namespace mansard::server
