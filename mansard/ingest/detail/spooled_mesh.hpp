// A mesh of any size as its file has it, in files on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "mansard/base/outputs.hpp"
#include "mansard/base/run.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"

namespace mansard::ingest::detail {

/// Filled in the order of its file, then asked for as pieces that are meshes for themselves. A triangle can name
/// vertices that come later, so that pieces can be made only when all is known. The files have no name, in the folder
/// for temporary files (TMPDIR): 24 bytes a vertex and 12 bytes a triangle.
class SpooledMesh {
 public:
  /// Fails with "file-write".
  [[nodiscard]] static auto open() -> base::Result<std::unique_ptr<SpooledMesh>>;

  /// What comes next in the file; indices count the vertices of the whole file.
  void add(const formats::RawMesh& piece);

  /// Every triangle once, in pieces of some hundred thousand with the vertices that they name, each once in a
  /// piece; indices that name no vertex stay such. From several threads at once. Fails with "file-write",
  /// "cancelled". Cost: linear where triangles that follow each other are near each other, as in files of scans;
  /// triangles in random order read all vertices again for every piece.
  [[nodiscard]] auto each(const base::Run& run, const std::function<void(formats::RawMesh)>& take)
      -> base::Result<void>;

  [[nodiscard]] auto short_faces() const -> std::uint64_t { return short_faces_; }

 private:
  SpooledMesh() = default;
  [[nodiscard]] auto piece(std::uint64_t first, std::uint64_t count) -> base::Result<formats::RawMesh>;

  std::unique_ptr<base::Spool> points_, faces_;
  std::uint64_t vertices_ = 0, triangles_ = 0, short_faces_ = 0;
  std::mutex mutex_;
};

}  // namespace mansard::ingest::detail
