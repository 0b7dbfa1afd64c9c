#include "apps/server/mesh_file.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace mansard::server {
namespace {

template <class T>
auto as_bytes(const std::vector<T>& values) -> std::string_view {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};  // NOLINT: for this process alone
}

}  // namespace

auto MeshFile::open(std::size_t count) -> base::Result<std::unique_ptr<MeshFile>> {
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  std::unique_ptr<MeshFile> out(new MeshFile);
  out->spool_ = std::move(*spool);
  out->places_.resize(count);
  return out;
}

void MeshFile::put(std::size_t number, const geometry::Mesh& mesh) {
  const std::scoped_lock lock(mutex_);
  places_[number] = {spool_->size(), mesh.vertices.size(), mesh.triangles.size()};
  spool_->append(as_bytes(mesh.vertices));
  spool_->append(as_bytes(mesh.triangles));
}

auto MeshFile::check() const -> base::Result<void> {
  const std::scoped_lock lock(mutex_);
  if (const auto bytes = spool_->read(0, 0); !bytes) return bytes.failure();
  return {};
}

/// In pieces, so that a large mesh is not in memory twice.
template <class T>
auto MeshFile::read_into(std::vector<T>& values, std::uint64_t offset) const -> base::Result<void> {
  constexpr std::size_t piece = 1 << 20;
  auto* const to = reinterpret_cast<char*>(values.data());  // NOLINT: as they were written
  const std::size_t size = values.size() * sizeof(T);
  for (std::size_t done = 0; done < size; done += piece) {
    const auto count = std::min(piece, size - done);
    const std::scoped_lock lock(mutex_);
    const auto bytes = spool_->read(offset + done, count);
    if (!bytes) return bytes.failure();
    std::memcpy(to + done, bytes->data(), count);
  }
  return {};
}

auto MeshFile::read(std::size_t number) const -> base::Result<geometry::Mesh> {
  const auto& [offset, vertices, triangles] = places_[number];
  geometry::Mesh mesh;
  mesh.vertices.resize(vertices);
  mesh.triangles.resize(triangles);
  if (auto got = read_into(mesh.vertices, offset); !got) return got.failure();
  if (auto got = read_into(mesh.triangles, offset + vertices * sizeof(geometry::Point3)); !got) return got.failure();
  return mesh;
}

}  // namespace mansard::server
