// The scene of a project: mesh, footprints and blocks, with cached JSON, tiles and search structures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/server/json.hpp"
#include "apps/server/project.hpp"
#include "apps/server/scene_view.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/block/block.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/profile/raw.hpp"
#include "mansard/rays/rays.hpp"

namespace mansard::server {

/// Immutable once it is read; queries may run on any thread.
class OpenScene {
 public:
  /// Fails as ingest::read_scene does, and with "file-write", "cancelled", "option-…".
  [[nodiscard]] static auto read(const Inputs& inputs, const base::Run& run)
      -> base::Result<std::shared_ptr<const OpenScene>>;

  [[nodiscard]] auto scene() const -> const model::Scene& { return scene_; }
  [[nodiscard]] auto blocks() const -> const std::vector<block::Block>& { return blocks_; }
  [[nodiscard]] auto has_block(std::string_view name) const -> bool;
  [[nodiscard]] auto view() const -> const std::shared_ptr<const SceneView>& { return view_; }

  /// The mesh around a building, prepared for ray casting; null if there is none. Those used last are kept, within a
  /// bound: prepared, a mesh takes several times its own memory.
  [[nodiscard]] auto rays_of(std::string_view building) const -> std::shared_ptr<const rays::Scene>;
  /// A building's place in its block; null for an unknown one.
  [[nodiscard]] auto member_of(std::string_view building) const -> const block::Member*;
  /// The block of that name; null for an unknown one.
  [[nodiscard]] auto block_named(std::string_view name) const -> const block::Block*;
  /// Section of openapi.json: the mesh across an edge of a plan. Without a building, the nearest block is used.
  [[nodiscard]] auto section(const model::Plan& plan, std::size_t ring, std::size_t edge, double share,
                             const std::optional<std::string>& building, const pipeline::Options& options) const
      -> Json;

 private:
  OpenScene() = default;
  struct Prepared {
    std::mutex rays_mutex;
    std::weak_ptr<const rays::Scene> rays;
    std::once_flag once_raw;
    std::unique_ptr<profile::RawProfiles> raw;
  };
  [[nodiscard]] auto block_near(geometry::Point2 at) const -> std::size_t;

  model::Scene scene_;
  std::vector<block::Block> blocks_;
  std::map<std::string, std::size_t, std::less<>> block_of_;  // by building
  std::shared_ptr<const SceneView> view_;
  mutable std::deque<Prepared> prepared_;  // per block
  void keep(std::size_t block, const std::shared_ptr<const rays::Scene>& rays) const;
  mutable std::mutex kept_mutex_;
  mutable std::list<std::pair<std::size_t, std::shared_ptr<const rays::Scene>>> kept_;  // by block, the last one first
};

}  // namespace mansard::server
