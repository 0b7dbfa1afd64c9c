// The pictures of a textured scan for the view: on tiles of the scan, and on the models as they are now.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "apps/server/project.hpp"
#include "apps/server/scene.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/model/solid.hpp"
#include "mansard/picture/tiles.hpp"
#include "mansard/texture/texture.hpp"

namespace mansard::server {

/// Memory: what lists the cells of the scan, decoded images up to a bound, and one tile or building at a time; the
/// triangles are in a file without a name. Immutable once it is read; queries may run on any thread, and wait for each
/// other.
class Textures {
 public:
  /// Reads the meshes of the scene once more, with what colours them. Fails with "server-no-textures" where nothing
  /// does, as texture::read does, and with "cancelled".
  [[nodiscard]] static auto read(const Inputs& inputs, const OpenScene& scene, const base::Run& run)
      -> base::Result<std::shared_ptr<const Textures>>;

  /// As openapi.json describes it: where the corners of each triangle of a tile are in a picture, and the picture. No
  /// triangles where the scan has no colours there. Fails as texture::Scan::near, and with "texture-encode".
  [[nodiscard]] auto of_tile(const picture::Tile& tile) const -> base::Result<std::string>;
  /// As openapi.json describes it: where the faces of these solids are in a picture, and the picture. Fails as
  /// texture::bake, and with "texture-encode".
  [[nodiscard]] auto of_building(const std::vector<model::LabelledSolid>& solids, std::uint64_t revision) const
      -> base::Result<std::string>;

 private:
  explicit Textures(std::unique_ptr<texture::Scan> scan) : scan_(std::move(scan)) {}
  std::unique_ptr<texture::Scan> scan_;
  mutable std::mutex mutex_;  // the scan is read from one thread at a time
};

}  // namespace mansard::server
