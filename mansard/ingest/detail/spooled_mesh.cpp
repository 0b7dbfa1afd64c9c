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

/// Which vertices some triangles name, ascending, and the place of each among them.
struct Numbering {
  std::vector<std::uint32_t> used;

  Numbering(const std::vector<Triangle>& triangles, std::uint64_t vertices) {
    std::uint32_t least = ~0U, most = 0;
    std::size_t named = 0;
    each_of(triangles, vertices, [&](std::uint32_t v) {
      least = std::min(least, v);
      most = std::max(most, v);
      ++named;
    });
    if (named == 0) return;
    // In most files neighbours have near numbers: a table of the range is quicker than to sort, until it is mostly
    // empty.
    constexpr std::size_t emptiest = 8;
    if (most - least < emptiest * named) {
      first_ = least;
      table_.resize(std::size_t{most - least} + 1);
      each_of(triangles, vertices, [&](std::uint32_t v) { table_[v - first_] = 1; });
      for (std::size_t i = 0; i < table_.size(); ++i)
        if (table_[i] != 0) {
          table_[i] = static_cast<std::uint32_t>(used.size());
          used.push_back(first_ + static_cast<std::uint32_t>(i));
        }
      return;
    }
    used.reserve(named);
    each_of(triangles, vertices, [&](std::uint32_t v) { used.push_back(v); });
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
  }

  [[nodiscard]] auto place(std::uint32_t v) const -> std::uint32_t {
    if (!table_.empty()) return table_[v - first_];
    return static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin());
  }

 private:
  template <class Work>
  static void each_of(const std::vector<Triangle>& triangles, std::uint64_t vertices, Work work) {
    for (const auto& triangle : triangles)
      for (const auto v : triangle)
        if (v < vertices) work(v);
  }

  std::vector<std::uint32_t> table_;  ///< from first_ on; empty where the range is too large
  std::uint32_t first_ = 0;
};

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
  const Numbering numbering(out.triangles, vertices_);
  const auto& used = numbering.used;
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
    for (auto& v : triangle) v = v < vertices_ ? numbering.place(v) : formats::no_vertex;
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
