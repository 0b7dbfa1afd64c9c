// What pages show of a scene: footprints, blocks and the tiles of the mesh. It is kept in the project, so that a
// project that is opened again can be seen before its inputs have been read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "apps/server/disk.hpp"
#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/picture/tiles.hpp"

namespace mansard::server {

/// Immutable; queries may run on any thread. The bytes of the tiles are in a file: in memory they would be a second
/// mesh.
class SceneView {
 public:
  /// `tiles` gives the tiles, as picture::tiles does. Fails with "file-write".
  [[nodiscard]] static auto make(std::string scene_json, const std::function<void(const picture::TakeTile&)>& tiles)
      -> base::Result<std::shared_ptr<const SceneView>>;
  /// The view that was kept in a file with this key; null if there is none, or it is damaged.
  [[nodiscard]] static auto open(const std::filesystem::path& path, const std::string& key)
      -> std::shared_ptr<const SceneView>;
  /// Fails with "file-write".
  [[nodiscard]] auto keep(const std::filesystem::path& path, const std::string& key) const -> base::Result<void>;

  [[nodiscard]] auto scene_json() const -> const std::string& { return scene_json_; }
  [[nodiscard]] auto tiles_json() const -> const std::string& { return tiles_json_; }
  /// The bytes of a tile as openapi.json describes them; none for an unknown tile. Fails with "file-write" where the
  /// file cannot be read.
  [[nodiscard]] auto tile_bytes(const std::string& id) const -> base::Result<std::optional<std::string>>;
  /// The tile itself; of a view that was kept, with its positions and triangles alone. Fails in the same way.
  [[nodiscard]] auto tile(const std::string& id) const -> base::Result<std::optional<picture::Tile>>;

 private:
  SceneView() = default;
  struct Place {
    picture::Tile tile;  ///< without its arrays
    std::uint64_t offset = 0;
    std::size_t vertices = 0, triangles = 0;
  };
  [[nodiscard]] auto bytes_at(std::uint64_t offset, std::size_t count) const -> base::Result<std::string>;

  std::string scene_json_, tiles_json_;
  std::map<std::string, Place, std::less<>> tiles_;
  std::uint64_t size_ = 0;  ///< of all tiles, bytes
  mutable std::mutex spool_mutex_;
  std::unique_ptr<base::Spool> spool_;  ///< of a view that was made
  Descriptor file_;                     ///< of a view that was kept
  std::uint64_t begin_ = 0;             ///< of the tiles in that file
};

}  // namespace mansard::server
