// Vertices of a CityJSON file by their integer coordinates: only those that some surface names, each once.
#pragma once

#include <optional>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/cityjson/quantised.hpp"

namespace mansard::formats::detail {

/// Where vertices stand in the file, by their coordinates, for up to `most` of them: open addressing, 32 bytes a slot.
class VertexTable {
 public:
  explicit VertexTable(std::size_t most) : most_(most) {}
  [[nodiscard]] auto find(const Vertex& v) const -> std::optional<std::uint64_t>;
  /// The vertex must not be there yet.
  void insert(const Vertex& v, std::uint64_t index);
  [[nodiscard]] auto full() const -> bool { return size_ == most_; }
  void clear();

 private:
  struct Slot {
    Vertex vertex;
    std::uint64_t index = none;
  };
  static constexpr std::uint64_t none = ~std::uint64_t{0};
  [[nodiscard]] auto slot_of(const Vertex& v) const -> std::size_t;
  void grow();

  std::size_t most_, size_ = 0;
  std::vector<Slot> slots_;
};

/// Numbers vertices as they are first named, and writes them as "[x,y,z],[…". Memory stays bounded: the vertices of two
/// generations are known, and one that was not named for a whole generation is written again when it comes back. A
/// generation is longer than any building, so that surfaces of one always share their vertices.
class VertexPool {
 public:
  static constexpr std::size_t generation = std::size_t{1} << 17U;

  explicit VertexPool(base::Sink& sink) : young_(generation), old_(generation), sink_(sink) {}
  auto index_of(const Vertex& v) -> std::uint64_t;
  [[nodiscard]] auto extent() const -> const Extent& { return extent_; }

 private:
  void write(const Vertex& v);

  VertexTable young_, old_;
  base::Sink& sink_;
  std::uint64_t count_ = 0;
  Extent extent_;
};

}  // namespace mansard::formats::detail
