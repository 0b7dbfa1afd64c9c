// The scene of a project: footprints and blocks, with cached JSON, tiles and search structures. The mesh is in a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/server/json.hpp"
#include "apps/server/mesh_file.hpp"
#include "apps/server/project.hpp"
#include "apps/server/scene_view.hpp"
#include "apps/server/used_last.hpp"
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

  /// Without its mesh.
  [[nodiscard]] auto scene() const -> const model::Scene& { return scene_; }
  /// A copy that has it, for work on all of it. Fails with "file-write" where it cannot be read.
  [[nodiscard]] auto with_mesh() const -> base::Result<model::Scene>;
  [[nodiscard]] auto mesh_box() const -> const geometry::Box3& { return mesh_box_; }
  /// That the mesh could not be read when it was needed: errors are missing then, and sections empty.
  [[nodiscard]] auto failure() const -> std::optional<base::Diagnostic>;
  [[nodiscard]] auto has_block(std::string_view name) const -> bool;
  [[nodiscard]] auto view() const -> const std::shared_ptr<const SceneView>& { return view_; }

  /// The mesh around a building, prepared for ray casting; null if there is none, or it cannot be read (failure). Those
  /// used last are kept, within a bound: prepared, a mesh takes several times its own memory.
  [[nodiscard]] auto rays_of(std::string_view building) const -> std::shared_ptr<const rays::Scene>;
  /// A building's place in its block; null for an unknown one.
  [[nodiscard]] auto member_of(std::string_view building) const -> const block::Member*;
  /// The block of that name, without its mesh; null for an unknown one.
  [[nodiscard]] auto block_named(std::string_view name) const -> const block::Block*;
  /// Section of openapi.json: the mesh across an edge of a plan. Without a building, the nearest block is used.
  [[nodiscard]] auto section(const model::Plan& plan, std::size_t ring, std::size_t edge, double share,
                             const std::optional<std::string>& building, const pipeline::Options& options) const
      -> Json;

 private:
  OpenScene() = default;
  /// A block's piece of the mesh for sections across it.
  struct Sliced {
    geometry::Mesh mesh;
    profile::RawProfiles raw;
    explicit Sliced(geometry::Mesh of) : mesh(std::move(of)), raw(mesh) {}
  };
  [[nodiscard]] auto divide(const block::Options& options, const base::Run& run, std::vector<Json>& shown)
      -> base::Result<void>;
  /// None where the file cannot be read, of which failure() tells from then on.
  [[nodiscard]] auto mesh_of(std::size_t block) const -> std::optional<geometry::Mesh>;
  [[nodiscard]] auto block_near(geometry::Point2 at) const -> std::size_t;

  model::Scene scene_;
  geometry::Box3 mesh_box_;
  std::vector<block::Block> blocks_;                          // without their meshes
  std::unique_ptr<MeshFile> meshes_;                          // theirs, by their numbers, and then that of the scene
  std::map<std::string, std::size_t, std::less<>> block_of_;  // by building
  std::shared_ptr<const SceneView> view_;
  std::unique_ptr<UsedLast<rays::Scene>> rays_;
  std::unique_ptr<UsedLast<Sliced>> sliced_;
  mutable std::mutex failure_mutex_;
  mutable std::optional<base::Diagnostic> failure_;
};

}  // namespace mansard::server
