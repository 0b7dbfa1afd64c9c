// A mesh of any size, cut into square cells in a file on disk: memory holds no more than what is asked for.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/base/run.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::formats {
struct RawMesh;
}

namespace mansard::ingest {

/// Filled piece by piece with `add`, then settled once, then asked. The files have no name, in the folder for temporary
/// files (TMPDIR): about 50 bytes a triangle while they are filled, and as much again until that is done.
class MeshCells {
 public:
  /// Square cells of `side` metres. Fails with "file-write".
  [[nodiscard]] static auto open(double side) -> base::Result<std::unique_ptr<MeshCells>>;

  /// A piece, in the coordinates that all pieces share. From any thread.
  void add(const formats::RawMesh& raw);
  /// Box of all triangles that can be used so far.
  [[nodiscard]] auto box() const -> const geometry::Box3& { return box_; }

  /// Cleans every cell as ingest::read_scene cleans a mesh: `shift` is added to all coordinates; with `within`,
  /// triangles whose box misses it are left out. What is counted is that of the whole. Fails with "file-write",
  /// "cancelled".
  [[nodiscard]] auto settle(const std::array<double, 3>& shift, const std::optional<geometry::Box2>& within,
                            const base::Run& run) -> base::Result<model::MeshCounts>;

  using Cell = std::pair<std::int32_t, std::int32_t>;
  /// After settle: the cells with a triangle that may reach into the box (of shifted coordinates).
  [[nodiscard]] auto cells_in(const geometry::Box2& box) const -> std::vector<Cell>;
  [[nodiscard]] auto triangles_in(const Cell& cell) const -> std::size_t;
  /// Every triangle that reaches into one of the cells, those that reach into several of them several times; and some
  /// vertices several times. Fails with "file-write". From any thread.
  [[nodiscard]] auto load(const std::set<Cell>& cells) const -> base::Result<geometry::Mesh>;
  /// The triangles whose middle is in the cell, so that those of all cells together are the mesh; only one with its
  /// middle on a border may be in both. Fails as `load`.
  [[nodiscard]] auto load_own(const Cell& cell) const -> base::Result<geometry::Mesh>;

 private:
  struct Chunk {
    std::uint64_t offset = 0;
    std::size_t bytes = 0, triangles = 0;
  };
  explicit MeshCells(double side) : side_(side) {}
  [[nodiscard]] auto clean_cell(const Cell& cell, const std::vector<Chunk>& chunks, const std::array<double, 3>& shift,
                                const std::optional<geometry::Box2>& within, model::MeshCounts& counts)
      -> base::Result<geometry::Mesh>;

  double side_;
  std::unique_ptr<base::Spool> raw_, clean_;
  mutable std::mutex mutex_;
  std::map<Cell, std::vector<Chunk>> chunks_;  ///< of raw_
  std::map<Cell, Chunk> cells_;                ///< of clean_
  std::array<double, 3> shift_{};
  geometry::Box3 box_;
  model::MeshCounts counts_;  ///< of what was left out on the way in
};

}  // namespace mansard::ingest
