#include <vector>

#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {
namespace {

__extension__ using Wide = unsigned __int128;

/// FNV-1a of 128 bits (Fowler, Noll, Vo; draft-eastlake-fnv). Two of a billion keys fall together with a probability
/// below 10^-20.
auto hash_of(std::string_view key) -> Wide {
  constexpr Wide prime = (Wide{1} << 88U) + 0x13B, basis = (Wide{0x6c62272e07bb0142} << 64U) + 0x62b821756295c58d;
  Wide hash = basis;
  for (const char c : key) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  return hash;
}

}  // namespace

/// Open addressing; 16 bytes a slot, and up to three slots a key while it grows to twice its size.
struct Gate::Taken {
  std::vector<Wide> slots = std::vector<Wide>(64);  // 0: free
  std::size_t size = 0;

  [[nodiscard]] auto slot_of(Wide hash) const -> std::size_t {
    std::size_t at = static_cast<std::size_t>(hash ^ (hash >> 64U)) & (slots.size() - 1);
    while (slots[at] != 0 && slots[at] != hash) at = (at + 1) & (slots.size() - 1);
    return at;
  }

  /// Whether it was not there.
  auto insert(std::string_view key) -> bool {
    const Wide hash = hash_of(key);
    if (std::size_t at = slot_of(hash); slots[at] != 0) return false;
    if (4 * (size + 1) > 3 * slots.size()) {
      const auto before = std::exchange(slots, std::vector<Wide>(2 * slots.size()));
      for (const Wide other : before)
        if (other != 0) slots[slot_of(other)] = other;
    }
    slots[slot_of(hash)] = hash;
    ++size;
    return true;
  }
};

auto Gate::admit(const model::Building& building) -> base::Result<Keyed> {
  if (!taken_) taken_ = std::make_shared<Taken>();
  if (!taken_->insert(building.id))
    return base::error("write-duplicate-id", "two buildings have this id; name an attribute that tells them apart",
                       building.id);
  if (const auto sound = check_model(building); !sound) return sound.error();
  Keyed keyed{building.id, {}};
  for (const model::Part& part : building.parts) {
    std::string key = part.id;
    while (!taken_->insert(key)) key += "-part";
    keyed.parts.push_back(std::move(key));
  }
  return keyed;
}

}  // namespace mansard::formats::detail
