#include "mansard/segment/detail/local_search.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace mansard::segment::detail {
namespace {

constexpr std::int64_t forbidden = std::numeric_limits<std::int64_t>::max() / 4;
/// Sequences between larger pieces cost more than they find.
constexpr std::size_t largest_for_sequences = 400, longest_sequence = 60;
constexpr int passes = 20;

class Search {
 public:
  Search(const Multicut& problem, Labels labels)
      : problem_(problem), labels_(std::move(labels)), edges_of_(problem.nodes), pairs_of_(problem.edges.size()) {
    for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
      edges_of_[problem.edges[e].a].push_back(e);
      edges_of_[problem.edges[e].b].push_back(e);
    }
    for (std::uint32_t p = 0; p < problem.pairs.size(); ++p) {
      pairs_of_[problem.pairs[p].first].push_back(p);
      if (problem.pairs[p].second != problem.pairs[p].first) pairs_of_[problem.pairs[p].second].push_back(p);
    }
    for (const std::uint32_t label : labels_) fresh_ = std::max(fresh_, label + 1);
  }

  [[nodiscard]] auto labels() const -> const Labels& { return labels_; }

  /// What joining neighbouring pieces would change, by label pair.
  [[nodiscard]] auto joins() const -> std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> change;
    const auto key = [&](std::uint32_t e) {
      return std::minmax(labels_[problem_.edges[e].a], labels_[problem_.edges[e].b]);
    };
    for (std::uint32_t e = 0; e < problem_.edges.size(); ++e) {
      if (!cut(e)) continue;
      auto& sum = change[key(e)];
      sum = problem_.edges[e].forced || sum == forbidden ? forbidden : sum - problem_.edges[e].cost;
    }
    const auto relieve = [&](std::uint32_t e, std::int64_t penalty) {
      auto& sum = change[key(e)];
      if (sum != forbidden) sum -= penalty;
    };
    for (const MulticutPair& pair : problem_.pairs) {
      if (!cut(pair.first) || !cut(pair.second)) continue;
      relieve(pair.first, pair.penalty);
      if (key(pair.first) != key(pair.second)) relieve(pair.second, pair.penalty);
    }
    return change;
  }

  /// Joins what gains (or, with `free`, what costs nothing), several pairs a round where they do not touch.
  auto join(bool free) -> bool {
    bool any = false;
    for (;;) {
      std::vector<std::pair<std::int64_t, std::pair<std::uint32_t, std::uint32_t>>> wanted;
      for (const auto& [pieces, change] : joins())
        if (change < 0 || (free && change == 0)) wanted.emplace_back(change, pieces);
      if (wanted.empty()) return any;
      std::ranges::sort(wanted);
      std::vector<std::uint32_t> becomes(fresh_);
      for (std::uint32_t l = 0; l < fresh_; ++l) becomes[l] = l;
      std::vector<bool> touched(fresh_, false);
      const std::int64_t best = wanted.front().first;
      // Joins tied by a pair penalty may gain only once, so they are made one at a time where that is affordable, and
      // never together with one that gains less than half of the best. Free joins too may be free only singly.
      const bool singly = best == 0 || (!problem_.pairs.empty() && wanted.size() < 200);
      for (const auto& [change, pieces] : wanted) {
        if (change > best / 2 || touched[pieces.first] || touched[pieces.second]) continue;
        touched[pieces.first] = touched[pieces.second] = true;
        becomes[pieces.second] = pieces.first;
        if (singly) break;
      }
      for (auto& label : labels_) label = becomes[label];
      any = true;
    }
  }

  /// Moves single nodes and sequences of nodes between neighbouring pieces, or out of one, as long as that gains.
  auto move() -> bool {
    bool any = false;
    for (std::uint32_t v = 0; v < problem_.nodes; ++v) any = move_one(v) || any;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;
    for (const auto& [pieces, change] : joins()) neighbours.push_back(pieces);
    for (const auto& [a, b] : neighbours) any = sequence(a, b) || any;
    Labels present = labels_;
    std::ranges::sort(present);
    present.erase(std::ranges::unique(present).begin(), present.end());
    for (const std::uint32_t label : present)
      if (sequence(label, fresh_)) ++fresh_, any = true;
    return any;
  }

 private:
  [[nodiscard]] auto cut(std::uint32_t e) const -> bool {
    return labels_[problem_.edges[e].a] != labels_[problem_.edges[e].b];
  }
  /// Whether e is cut once v has that label.
  [[nodiscard]] auto cut_after(std::uint32_t e, std::uint32_t v, std::uint32_t label) const -> bool {
    const MulticutEdge& edge = problem_.edges[e];
    if (edge.a == v) return labels_[edge.b] != label;
    if (edge.b == v) return labels_[edge.a] != label;
    return cut(e);
  }

  [[nodiscard]] auto change(std::uint32_t v, std::uint32_t label) const -> std::int64_t {
    std::int64_t sum = 0;
    for (const std::uint32_t e : edges_of_[v]) {
      const bool before = cut(e), after = cut_after(e, v, label);
      if (before == after) continue;
      if (!after && problem_.edges[e].forced) return forbidden;
      sum += after ? problem_.edges[e].cost : -problem_.edges[e].cost;
      for (const std::uint32_t p : pairs_of_[e]) {
        const std::uint32_t f = problem_.pairs[p].first == e ? problem_.pairs[p].second : problem_.pairs[p].first;
        const bool f_before = cut(f), f_after = cut_after(f, v, label);
        if (f != e && f_before != f_after && f < e) continue;  // counted at f
        sum += problem_.pairs[p].penalty * ((after && f_after ? 1 : 0) - (before && f_before ? 1 : 0));
      }
    }
    return sum;
  }

  auto move_one(std::uint32_t v) -> bool {
    std::int64_t best = 0;
    std::uint32_t to = labels_[v];
    const auto look = [&](std::uint32_t label) {
      if (label == labels_[v]) return;
      if (const std::int64_t c = change(v, label); c < best) best = c, to = label;
    };
    for (const std::uint32_t e : edges_of_[v])
      look(labels_[problem_.edges[e].a == v ? problem_.edges[e].b : problem_.edges[e].a]);
    look(fresh_);
    if (best == 0) return false;
    if (to == fresh_) ++fresh_;
    labels_[v] = to;
    return true;
  }

  auto sequence(std::uint32_t one, std::uint32_t other) -> bool {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t v = 0; v < problem_.nodes; ++v)
      if (labels_[v] == one || labels_[v] == other) nodes.push_back(v);
    if (nodes.size() < 2 || nodes.size() > largest_for_sequences) return false;
    std::vector<std::uint32_t> moved;
    std::int64_t sum = 0, best = 0;
    std::size_t keep = 0;
    while (!nodes.empty() && moved.size() < longest_sequence) {
      std::size_t pick = nodes.size();
      std::int64_t least = forbidden;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::int64_t c = change(nodes[i], labels_[nodes[i]] == one ? other : one);
        if (c < least) least = c, pick = i;
      }
      if (pick == nodes.size()) break;
      const std::uint32_t v = nodes[pick];
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(pick));
      labels_[v] = labels_[v] == one ? other : one;
      moved.push_back(v);
      sum += least;
      if (sum < best) best = sum, keep = moved.size();
    }
    for (std::size_t i = keep; i < moved.size(); ++i) labels_[moved[i]] = labels_[moved[i]] == one ? other : one;
    return keep > 0;
  }

  const Multicut& problem_;
  Labels labels_;
  std::vector<std::vector<std::uint32_t>> edges_of_, pairs_of_;
  std::uint32_t fresh_ = 0;
};

}  // namespace

auto greedy(const Multicut& problem) -> Labels {
  Labels apart(problem.nodes);
  for (std::uint32_t v = 0; v < problem.nodes; ++v) apart[v] = v;
  Search search(problem, std::move(apart));
  search.join(false);
  return search.labels();
}

auto improved(const Multicut& problem, Labels labels) -> Labels {
  // Pieces, not labels, are what is joined and moved: one label on unconnected pieces would tie them together.
  Search search(problem, canonical(problem, labels));
  for (int pass = 0; pass < passes; ++pass) {
    const bool moved = search.move();
    const bool joined = search.join(false);
    if (!moved && !joined) break;
  }
  return canonical(problem, search.labels());
}

auto joined_where_free(const Multicut& problem, Labels labels) -> Labels {
  Search search(problem, canonical(problem, labels));
  search.join(true);
  return canonical(problem, search.labels());
}

}  // namespace mansard::segment::detail
