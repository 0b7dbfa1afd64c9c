// Meshes in a file without a name, from which they are read when they are needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/base/result.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::server {

/// In the folder for temporary files (TMPDIR). From any thread.
class MeshFile {
 public:
  /// For so many meshes, which are empty until they are put there. Fails with "file-write".
  [[nodiscard]] static auto open(std::size_t count) -> base::Result<std::unique_ptr<MeshFile>>;

  void put(std::size_t number, const geometry::Mesh& mesh);
  /// After the last one. Fails with "file-write" where something could not be put aside.
  [[nodiscard]] auto check() const -> base::Result<void>;

  /// Fails with "file-write" where the file was changed.
  [[nodiscard]] auto read(std::size_t number) const -> base::Result<geometry::Mesh>;
  [[nodiscard]] auto triangles(std::size_t number) const -> std::size_t { return places_[number].triangles; }

 private:
  struct Place {
    std::uint64_t offset = 0;
    std::size_t vertices = 0, triangles = 0;
  };
  MeshFile() = default;
  template <class T>
  [[nodiscard]] auto read_into(std::vector<T>& values, std::uint64_t offset) const -> base::Result<void>;

  mutable std::mutex mutex_;
  std::unique_ptr<base::Spool> spool_;
  std::vector<Place> places_;
};

}  // namespace mansard::server
