#include "mansard/segment/detail/contraction.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace mansard::segment::detail {

Contraction::Contraction(const Multicut& problem, const std::vector<std::vector<std::uint32_t>>& pairs_of,
                         const Labels& labels, std::uint32_t count)
    : problem_(problem), pairs_of_(pairs_of), labels_(labels), pieces_(count), bundles_(count), below_(count) {
  for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
    if (!is_cut(e)) continue;
    const auto [low, high] = key_of(e);
    Bundle& bundle = bundles_[low][high];
    if (bundle.edges.empty()) below_[high].push_back(low);
    bundle.edges.push_back(e);
    bundle.forced = bundle.forced || problem.edges[e].forced;
  }
  for (std::uint32_t low = 0; low < count; ++low)
    for (auto& [high, bundle] : bundles_[low]) weigh({low, high}, bundle);
}

auto Contraction::key_of(std::uint32_t edge) -> Key {
  return std::minmax(label_of(labels_[problem_.edges[edge].a]), label_of(labels_[problem_.edges[edge].b]));
}

auto Contraction::is_cut(std::uint32_t edge) -> bool {
  const auto [low, high] = key_of(edge);
  return low != high;
}

void Contraction::weigh(const Key& key, Bundle& bundle) {
  if (bundle.forced) return;
  bundle.change = 0;
  for (const std::uint32_t e : bundle.edges) {
    bundle.change -= problem_.edges[e].cost;
    for (const std::uint32_t p : pairs_of_[e]) {
      const MulticutPair& pair = problem_.pairs[p];
      const std::uint32_t f = pair.first == e ? pair.second : pair.first;
      // Of a pair within the bundle the lower edge counts.
      if (is_cut(f) && (key_of(f) != key || e <= f)) bundle.change -= pair.penalty;
    }
  }
  open_.emplace(bundle.change, key);
}

void Contraction::join(const Key& key) {
  const auto [low, high] = key;
  const std::vector<std::uint32_t> healed = std::move(bundles_[low][high].edges);
  bundles_[low].erase(high);
  // What was between `high` and others is now between `low` and them.
  std::vector<std::pair<std::uint32_t, Bundle>> moved;
  for (auto& [other, bundle] : bundles_[high]) moved.emplace_back(other, std::move(bundle));
  bundles_[high].clear();
  for (const std::uint32_t other : below_[high]) {
    const auto found = bundles_[other].find(high);
    if (found == bundles_[other].end()) continue;
    moved.emplace_back(other, std::move(found->second));
    bundles_[other].erase(found);
  }
  below_[high].clear();
  pieces_.join(low, high);
  std::set<Key> changed;
  for (auto& [other, bundle] : moved) {
    const Key to = std::minmax(low, other);
    Bundle& into = bundles_[to.first][to.second];
    if (into.edges.empty()) below_[to.second].push_back(to.first);
    into.edges.insert(into.edges.end(), bundle.edges.begin(), bundle.edges.end());
    into.forced = into.forced || bundle.forced;
    changed.insert(to);
  }
  for (const std::uint32_t e : healed)
    for (const std::uint32_t p : pairs_of_[e]) {
      const std::uint32_t f = problem_.pairs[p].first == e ? problem_.pairs[p].second : problem_.pairs[p].first;
      if (is_cut(f)) changed.insert(key_of(f));
    }
  for (const Key& k : changed) weigh(k, bundles_[k.first].at(k.second));
}

auto Contraction::run(bool free) -> bool {
  bool any = false;
  while (!open_.empty()) {
    const auto [change, key] = open_.top();
    if (change > 0 || (change == 0 && !free)) break;
    open_.pop();
    const auto found = bundles_[key.first].find(key.second);
    if (found == bundles_[key.first].end() || found->second.forced || found->second.change != change) continue;
    join(key);
    any = true;
  }
  return any;
}

}  // namespace mansard::segment::detail
