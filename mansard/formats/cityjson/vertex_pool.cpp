#include "mansard/formats/cityjson/vertex_pool.hpp"

#include <algorithm>
#include <utility>

namespace mansard::formats::detail {

auto VertexTable::slot_of(const Vertex& v) const -> std::size_t {
  std::uint64_t h = 0;
  for (const auto c : v) h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29U;
  std::size_t at = h & (slots_.size() - 1);
  while (slots_[at].index != none && slots_[at].vertex != v) at = (at + 1) & (slots_.size() - 1);
  return at;
}

auto VertexTable::find(const Vertex& v) const -> std::optional<std::uint64_t> {
  if (slots_.empty()) return std::nullopt;
  const Slot& slot = slots_[slot_of(v)];
  return slot.index == none ? std::nullopt : std::optional(slot.index);
}

void VertexTable::insert(const Vertex& v, std::uint64_t index) {
  if (2 * (size_ + 1) > slots_.size()) grow();
  slots_[slot_of(v)] = {v, index};
  ++size_;
}

void VertexTable::grow() {
  const auto before = std::exchange(slots_, std::vector<Slot>(std::max<std::size_t>(64, 2 * slots_.size())));
  for (const Slot& slot : before)
    if (slot.index != none) slots_[slot_of(slot.vertex)] = slot;
}

void VertexTable::clear() {
  std::ranges::fill(slots_, Slot{});
  size_ = 0;
}

auto VertexPool::index_of(const Vertex& v) -> std::uint64_t {
  if (const auto index = young_.find(v)) return *index;
  const auto older = old_.find(v);
  const std::uint64_t index = older ? *older : count_++;
  if (!older) write(v);
  if (young_.full()) {
    std::swap(young_, old_);
    young_.clear();
  }
  young_.insert(v, index);
  return index;
}

void VertexPool::write(const Vertex& v) {
  sink_.append((count_ == 1 ? "[" : ",[") + std::to_string(v[0]) + "," + std::to_string(v[1]) + "," +
               std::to_string(v[2]) + "]");
  widen(extent_, v);
}

}  // namespace mansard::formats::detail
