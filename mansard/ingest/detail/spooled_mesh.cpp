#include "mansard/ingest/detail/spooled_mesh.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace mansard::ingest::detail {
namespace {

using geometry::Point3;
using geometry::Triangle;

static_assert(std::is_trivially_copyable_v<Point3> && sizeof(Point3) == 24);
static_assert(std::is_trivially_copyable_v<Triangle> && sizeof(Triangle) == 12);

/// Triangles of a piece: about 30 MB with all that is made of them, for each thread.
constexpr std::uint64_t piece_size = std::uint64_t{1} << 18;
/// Vertices that are named are read together while no more than so many between them are not, up to so many.
constexpr std::uint32_t largest_gap = 1024, longest_run = 65'536;

template <class T>
auto bytes_of(const std::vector<T>& values) -> std::string_view {
  return {reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()};
}

}  // namespace

auto SpooledMesh::open() -> base::Result<std::unique_ptr<SpooledMesh>> {
  std::unique_ptr<SpooledMesh> out(new SpooledMesh);
  for (auto* spool : {&out->points_, &out->faces_}) {
    auto opened = base::Spool::open();
    if (!opened) return opened.failure();
    *spool = std::move(*opened);
  }
  return out;
}

void SpooledMesh::add(const formats::RawMesh& piece) {
  points_->append(bytes_of(piece.vertices));
  faces_->append(bytes_of(piece.triangles));
  vertices_ += piece.vertices.size();
  triangles_ += piece.triangles.size();
  short_faces_ += piece.short_faces;
}

auto SpooledMesh::piece(std::uint64_t first, std::uint64_t count) -> base::Result<formats::RawMesh> {
  const auto read = [&](base::Spool& spool, std::uint64_t offset, std::size_t size) {
    const std::scoped_lock lock(mutex_);
    return spool.read(offset, size);
  };
  formats::RawMesh out;
  out.triangles.resize(count);
  {
    const auto bytes = read(*faces_, first * sizeof(Triangle), count * sizeof(Triangle));
    if (!bytes) return bytes.failure();
    std::memcpy(out.triangles.data(), bytes->data(), bytes->size());
  }
  std::vector<std::uint32_t> used;
  used.reserve(3 * count);
  for (const auto& triangle : out.triangles)
    for (const auto v : triangle)
      if (v < vertices_) used.push_back(v);
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  out.vertices.reserve(used.size());
  for (std::size_t i = 0, end = 0; i < used.size(); i = end) {
    for (end = i + 1;
         end < used.size() && used[end] - used[end - 1] <= largest_gap && used[end] - used[i] < longest_run; ++end) {
    }
    const auto bytes =
        read(*points_, used[i] * sizeof(Point3), (std::size_t{used[end - 1] - used[i]} + 1) * sizeof(Point3));
    if (!bytes) return bytes.failure();
    for (std::size_t k = i; k < end; ++k) {
      Point3 point;
      std::memcpy(&point, bytes->data() + std::size_t{used[k] - used[i]} * sizeof(Point3), sizeof(Point3));
      out.vertices.push_back(point);
    }
  }
  for (auto& triangle : out.triangles)
    for (auto& v : triangle)
      v = v < vertices_ ? static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin())
                        : formats::no_vertex;
  return out;
}

auto SpooledMesh::each(const base::Run& run, const std::function<void(formats::RawMesh)>& take) -> base::Result<void> {
  const std::uint64_t count = (triangles_ + piece_size - 1) / piece_size;
  std::vector<std::optional<base::Failure>> failures(count);
  base::parallel_for(count, [&](std::size_t i) {
    if (run.cancelled()) return;
    const std::uint64_t first = i * piece_size;
    auto made = piece(first, std::min(piece_size, triangles_ - first));
    if (made) take(*std::move(made));
    else failures[i] = made.failure();
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  if (run.cancelled()) return base::error("cancelled", "stopped on request; nothing was written");
  return {};
}

}  // namespace mansard::ingest::detail
