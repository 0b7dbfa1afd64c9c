#include "mansard/ingest/detail/same_clouds.hpp"

#include <cmath>
#include <map>

#include "mansard/base/text.hpp"

namespace mansard::ingest::detail {
namespace {

/// Units of the fingerprint, as of the surface: a quarter of a millimetre.
constexpr double per_metre = 4096, most_units = 1e12;

/// SplitMix64's output function (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014).
auto mixed(std::uint64_t z) -> std::uint64_t {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

auto list_in_words(const std::vector<std::string>& names) -> std::string {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

/// "a.laz and b.las have the same points; c.laz and 3 other groups …"
auto same_in_words(const std::vector<NamedFingerprint>& clouds) -> std::string {
  std::map<Fingerprint, std::vector<std::string>> groups;
  for (const auto& [name, of] : clouds)
    if (of.points > 0) groups[of].push_back(name);
  std::erase_if(groups, [](const auto& group) { return group.second.size() < 2; });
  constexpr std::size_t most = 3;
  std::string out;
  std::size_t count = 0;
  for (const auto& cloud : clouds) {  // in the order in which they were given
    const auto group = groups.find(cloud.of);
    if (group == groups.end() || group->second.front() != cloud.name) continue;
    if (++count <= most) out += (count > 1 ? "; " : "") + list_in_words(group->second) + " have the same points";
    group->second.front().clear();  // the same name again is in the same group
  }
  if (count > most) out += "; so have " + std::to_string(count - most) + " other groups of clouds";
  return out;
}

}  // namespace

auto hash_of(geometry::Point3 p, std::uint8_t classification) -> std::optional<std::uint64_t> {
  std::uint64_t hash = classification;
  for (const double c : {p.x, p.y, p.z}) {
    const double units = std::floor(c * per_metre + 0.5);
    if (!(std::abs(units) < most_units)) return std::nullopt;
    hash = mixed(hash + 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(static_cast<std::int64_t>(units)));
  }
  return hash;
}

void Fingerprint::add(geometry::Point3 p, std::uint8_t classification) {
  const auto hash = hash_of(p, classification);
  if (!hash) return;
  ++points;
  sum += *hash;
}

void Fingerprint::include(const Fingerprint& other) {
  points += other.points;
  sum += other.sum;
}

auto repeated_in_words(const std::vector<NamedFingerprint>& clouds, const cloud::Counts& counts) -> std::string {
  const auto all = counts.points + counts.repeated;
  const double share = all == 0 ? 0 : static_cast<double>(counts.repeated) / static_cast<double>(all);
  const std::string same = same_in_words(clouds);
  if (same.empty() && share < noticeable_share) return {};
  const std::string how_many = std::to_string(counts.repeated) + " of " + std::to_string(all) + " points (" +
                               base::to_text(100 * share, 1) + " %) are repetitions of others and count once";
  if (same.empty()) return how_many + ": clouds overlap, or a file has points twice";
  return same + "; " + how_many + ". Leave all but one of each out to save time";
}

}  // namespace mansard::ingest::detail
