#include "mansard/segment/detail/local_search.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "mansard/segment/detail/contraction.hpp"

namespace mansard::segment::detail {
namespace {

constexpr std::int64_t forbidden = std::numeric_limits<std::int64_t>::max() / 4;

class Search {
 public:
  Search(const Multicut& problem, Labels labels, const SearchLimits& limits = {})
      : problem_(problem),
        limits_(limits),
        labels_(std::move(labels)),
        edges_of_(problem.nodes),
        pairs_of_(problem.edges.size()) {
    for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
      edges_of_[problem.edges[e].a].push_back(e);
      edges_of_[problem.edges[e].b].push_back(e);
    }
    for (std::uint32_t p = 0; p < problem.pairs.size(); ++p) {
      pairs_of_[problem.pairs[p].first].push_back(p);
      if (problem.pairs[p].second != problem.pairs[p].first) pairs_of_[problem.pairs[p].second].push_back(p);
    }
    for (const std::uint32_t label : labels_) fresh_ = std::max(fresh_, label + 1);
    grow(fresh_);
    for (std::uint32_t v = 0; v < problem.nodes; ++v) members_[labels_[v]].push_back(v);
  }

  [[nodiscard]] auto labels() const -> const Labels& { return labels_; }

  /// Joins what gains, or with `free` what costs nothing too.
  auto join(bool free) -> bool {
    Contraction contraction(problem_, pairs_of_, labels_, fresh_);
    const bool any = contraction.run(free);
    for (std::uint32_t v = 0; v < problem_.nodes; ++v) give(v, contraction.label_of(labels_[v]));
    return any;
  }

  /// Moves single nodes and sequences of nodes between neighbouring pieces, or out of one, as long as that gains.
  auto move() -> bool {
    bool any = false;
    for (std::uint32_t v = 0; v < problem_.nodes; ++v) any = move_one(v) || any;
    std::set<std::pair<std::uint32_t, std::uint32_t>> neighbours;
    for (std::uint32_t e = 0; e < problem_.edges.size(); ++e)
      if (cut(e)) neighbours.insert(std::minmax(labels_[problem_.edges[e].a], labels_[problem_.edges[e].b]));
    for (const auto& [a, b] : neighbours) any = sequence(a, b) || any;
    Labels present = labels_;
    std::ranges::sort(present);
    present.erase(std::ranges::unique(present).begin(), present.end());
    for (const std::uint32_t label : present) any = sequence(label, fresh_) || any;
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
    give(v, to);
    return true;
  }

  /// Kernighan and Lin: moves nodes between two pieces, or into a new one, the best first and each once, and keeps the
  /// moves up to the best sum. Pieces that are as they were when that gained nothing are passed over.
  auto sequence(std::uint32_t one, std::uint32_t other) -> bool {
    const auto stamp = std::pair(stamp_[one], other < fresh_ ? stamp_[other] : 0);
    auto& tried = tried_[other < fresh_ ? std::pair(one, other) : std::pair(one, one)];
    if (tried == stamp) return false;
    tried = stamp;
    std::vector<std::uint32_t> nodes = members_[one];
    if (other < fresh_) nodes.insert(nodes.end(), members_[other].begin(), members_[other].end());
    if (nodes.size() < 2 || nodes.size() > limits_.piece) return false;
    std::ranges::sort(nodes);
    std::vector<std::uint32_t> moved;
    std::int64_t sum = 0, best = 0;
    std::size_t keep = 0;
    while (!nodes.empty() && moved.size() < limits_.sequence) {
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
    for (const std::uint32_t v : moved) labels_[v] = labels_[v] == one ? other : one;
    for (std::size_t i = 0; i < keep; ++i) give(moved[i], labels_[moved[i]] == one ? other : one);
    return keep > 0;
  }

  void give(std::uint32_t v, std::uint32_t label) {
    if (labels_[v] == label) return;
    if (label == fresh_) grow(fresh_ + 1);
    std::erase(members_[labels_[v]], v);
    members_[label].push_back(v);
    stamp_[labels_[v]] = stamp_[label] = ++changes_;
    labels_[v] = label;
  }

  void grow(std::uint32_t labels) {
    fresh_ = labels;
    members_.resize(labels);
    stamp_.resize(labels, ++changes_);
  }

  const Multicut& problem_;
  SearchLimits limits_;
  Labels labels_;
  std::vector<std::vector<std::uint32_t>> edges_of_, pairs_of_;
  std::uint32_t fresh_ = 0;                          ///< the lowest label not used yet
  std::vector<std::vector<std::uint32_t>> members_;  ///< by label
  std::vector<std::uint64_t> stamp_;                 ///< by label: when it last changed
  std::uint64_t changes_ = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint64_t, std::uint64_t>> tried_;
};

}  // namespace

auto greedy(const Multicut& problem) -> Labels {
  Labels apart(problem.nodes);
  for (std::uint32_t v = 0; v < problem.nodes; ++v) apart[v] = v;
  Search search(problem, std::move(apart));
  search.join(false);
  return search.labels();
}

auto improved(const Multicut& problem, const Labels& labels, const SearchLimits& limits) -> Labels {
  // Pieces, not labels, are what is joined and moved: one label on unconnected pieces would tie them together.
  Search search(problem, canonical(problem, labels), limits);
  for (std::size_t pass = 0; pass < limits.passes; ++pass) {
    const bool moved = search.move();
    const bool joined = search.join(false);
    if (!moved && !joined) break;
  }
  return canonical(problem, search.labels());
}

auto joined_where_free(const Multicut& problem, const Labels& labels) -> Labels {
  Search search(problem, canonical(problem, labels));
  search.join(true);
  return canonical(problem, search.labels());
}

}  // namespace mansard::segment::detail
