#include "mansard/refine/detail/owner.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <ranges>
#include <set>
#include <utility>

#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/work.hpp"

namespace mansard::refine::detail {
namespace {

/// Shares of what a search may take after which joining and cutting anew, then cutting, then the rest end. Chosen by
/// hand, so that a search which ends early has tried something of each.
constexpr double share_of_joining = 0.5, share_of_cutting = 0.8;
/// How many times the work of one roof over a piece, or over each of a pair, a step takes: of 4,000 steps nine in ten
/// take less.
constexpr std::uint64_t roofs_of_union = 7, roofs_of_recut = 40, roofs_of_split = 90;

/// What is known of two pieces. Pieces never change, so that it stays true.
struct Pair {
  bool was_united = false, was_joined = false, was_cut = false;
  std::optional<Union> both;
};

/// The pieces of one owner: joined, cut, and cut again where two meet at the wrong place, as long as that is cheaper.
class Pieces {
 public:
  Pieces(std::vector<Piece> pieces, const Work& work) : work_(work), before_(work.account().spent()) {
    for (auto& piece : pieces) {
      samples_ += samples_of(piece.site);
      corners_ += corners_of(piece.roof.plan);
      pieces_.push_back(numbered(std::move(piece)));
    }
    most_ = most_work_of(samples_, corners_, work.options().search.most_work);
  }

  /// Of the pieces that it began with.
  [[nodiscard]] auto samples() const -> std::uint64_t { return samples_; }
  [[nodiscard]] auto corners() const -> std::uint64_t { return corners_; }
  [[nodiscard]] auto most() const -> std::uint64_t { return most_; }

  /// From now on the search ends where this share of what it may take in all is spent.
  void allow(double share) { allowed_ = static_cast<std::uint64_t>(share * static_cast<double>(most_)); }

  /// Joins two pieces at a time, those that promise most first, until no pair is cheaper as one.
  void join() {
    replace_pairs(
        &Pair::was_joined, United::all, [this](const Piece& a, const Piece& b) { return work_.may_join(a, b); },
        [this](const Piece& a, const Piece& b, const Pair& pair) { return work_.cost_of(a, b) - pair.both->roof.cost; },
        [this](const Piece& a, const Piece& b, const Union& both) {
          std::vector<Piece> out;
          if (auto one = work_.as_one(a, b, both)) out.push_back(std::move(*one));
          return out;
        });
  }

  /// Moves walls between pieces by cutting pairs anew, those with most misfit where they meet first.
  void cut_anew() {
    replace_pairs(
        &Pair::was_cut, United::chosen, [this](const Piece& a, const Piece& b) { return work_.may_cut_anew(a, b); },
        [this](const Piece& a, const Piece& b, const Pair&) { return work_.misfit_between(a, b); },
        [this](const Piece& a, const Piece& b, const Union& both) { return work_.cut_anew(a, b, both); });
  }

  /// Cuts pieces, and the pieces of pieces, as long as that pays.
  void split() {
    const auto most_pieces = static_cast<std::size_t>(work_.options().joins.max_pieces);
    while (pieces_.size() < most_pieces && !work_.cancelled()) {
      std::vector<std::size_t> open;
      for (std::size_t i = 0; i < pieces_.size(); ++i)
        if (!whole_.contains(pieces_[i].number)) open.push_back(i);
      keep_affordable(open, Paid::in_order, [&](std::size_t i) { return roofs_of_split * work_of_one(pieces_[i]); });
      std::vector<std::vector<Piece>> found(pieces_.size());
      base::parallel_for(open.size(), [&](std::size_t k) { found[open[k]] = work_.split(pieces_[open[k]]); });
      std::vector<Piece> next;
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (found[i].empty()) {
          whole_.insert(pieces_[i].number);
          next.push_back(std::move(pieces_[i]));
        }
        for (auto& piece : found[i]) next.push_back(numbered(std::move(piece)));
        // As one they were searched for cuts just now.
        if (found[i].size() == 2)
          pairs_[std::minmax(next[next.size() - 2].number, next[next.size() - 1].number)].was_cut = true;
      }
      const bool done = next.size() == pieces_.size();
      pieces_ = std::move(next);
      if (done) return;
    }
  }

  [[nodiscard]] auto pieces() && -> std::vector<Piece> { return std::move(pieces_); }

 private:
  auto numbered(Piece piece) -> Piece {
    piece.number = next_++;
    return piece;
  }

  /// A pair that was not tried yet, by the places of its pieces.
  struct Fresh {
    std::size_t i = 0, j = 0;
    Pair* pair = nullptr;
    double promise = 0;
  };

  /// Which pairs are put under one roof before it is known which are tried: those whose promise depends on it.
  enum class United { all, chosen };

  /// In turns, of which each tries pairs that have no piece in common, the most promising first.
  template <class May, class Promise, class Replace>
  void replace_pairs(bool Pair::*was, United united, May may, Promise promise, Replace replace) {
    while (!work_.cancelled()) {
      auto fresh = fresh_pairs(was, may);
      if (united == United::all) {
        keep_affordable(fresh, Paid::least_work_first, [this](const Fresh& one) { return work_of_union(one); });
        unite(fresh, was);
        std::erase_if(fresh, [](const Fresh& one) { return !one.pair->both; });
      }
      base::parallel_for(fresh.size(), [&](std::size_t k) {
        auto& [i, j, pair, value] = fresh[k];
        value = promise(pieces_[i], pieces_[j], *pair);
      });
      rank(
          fresh, [](const Fresh& one) { return -one.promise; }, work_.options().same_cost);
      fresh = first_of(std::move(fresh), was);
      keep_affordable(fresh, Paid::in_order, [this](const Fresh& one) { return roofs_of_recut * work_of_both(one); });
      if (fresh.empty()) return;
      std::vector<std::vector<Piece>> found(fresh.size());
      base::parallel_for(fresh.size(), [&](std::size_t k) {
        const auto& [i, j, pair, value] = fresh[k];
        found[k] = replace(pieces_[i], pieces_[j], *pair->both);
        pair->*was = true;
      });
      put(fresh, std::move(found));
    }
  }

  [[nodiscard]] auto left() const -> std::uint64_t {
    const std::uint64_t spent = work_.account().spent() - before_;
    return allowed_ > spent ? allowed_ - spent : 0;
  }

  static auto work_of_one(const Piece& piece) -> std::uint64_t {
    return work_of(piece.site, corners_of(piece.roof.plan));
  }
  [[nodiscard]] auto work_of_both(const Fresh& one) const -> std::uint64_t {
    return work_of_one(pieces_[one.i]) + work_of_one(pieces_[one.j]);
  }
  [[nodiscard]] auto work_of_union(const Fresh& one) const -> std::uint64_t {
    return one.pair->was_united ? 0 : roofs_of_union * work_of_both(one);
  }

  /// What cannot be paid for any more is left out; what has the least work, or comes first, is paid for first. The rest
  /// stays in order.
  enum class Paid { least_work_first, in_order };
  template <class Step, class Cost>
  void keep_affordable(std::vector<Step>& steps, Paid paid, Cost cost) {
    std::vector<std::size_t> order(steps.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (paid == Paid::least_work_first)
      std::ranges::stable_sort(order, {}, [&](std::size_t k) { return cost(steps[k]); });
    std::uint64_t rest = left();
    std::vector<bool> dear(steps.size(), false);
    for (const std::size_t k : order) {
      const std::uint64_t needed = cost(steps[k]);
      dear[k] = needed > rest;
      if (!dear[k]) rest -= needed;
    }
    if (std::ranges::find(dear, true) == dear.end()) return;
    work_.account().met_a_bound();
    std::size_t kept = 0;
    for (std::size_t k = 0; k < steps.size(); ++k)
      if (!dear[k]) steps[kept++] = steps[k];
    steps.resize(kept);
  }

  /// Both pieces of each pair under one roof, if that was not tried; those that cannot be are tried no more.
  void unite(const std::vector<Fresh>& pairs, bool Pair::*was) {
    base::parallel_for(pairs.size(), [&](std::size_t k) {
      const auto& [i, j, pair, value] = pairs[k];
      if (!std::exchange(pair->was_united, true)) pair->both = work_.united(pieces_[i], pieces_[j]);
      if (!pair->both) pair->*was = true;
    });
  }

  /// Those that are tried: of pairs that can be put under one roof and have a piece in common, the first.
  auto first_of(std::vector<Fresh> pairs, bool Pair::*was) -> std::vector<Fresh> {
    for (;;) {
      auto chosen = disjoint(pairs);
      unite(chosen, was);
      if (std::ranges::all_of(chosen, [](const Fresh& one) { return one.pair->both.has_value(); })) return chosen;
      std::erase_if(pairs, [](const Fresh& one) { return one.pair->was_united && !one.pair->both; });
    }
  }

  /// The first of those that have a piece in common.
  [[nodiscard]] auto disjoint(std::vector<Fresh> pairs) const -> std::vector<Fresh> {
    std::vector<bool> taken(pieces_.size(), false);
    std::erase_if(pairs, [&](const Fresh& one) {
      if (taken[one.i] || taken[one.j]) return true;
      taken[one.i] = taken[one.j] = true;
      return false;
    });
    return pairs;
  }

  template <class May>
  auto fresh_pairs(bool Pair::*was, May may) -> std::vector<Fresh> {
    std::vector<Fresh> fresh;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (std::size_t j = i + 1; j < pieces_.size(); ++j) {
        if (!work_.touch(pieces_[i], pieces_[j])) continue;
        Pair& pair = pairs_[std::minmax(pieces_[i].number, pieces_[j].number)];
        if (pair.*was) continue;
        if (may(pieces_[i], pieces_[j])) fresh.push_back({i, j, &pair, 0});
        else pair.*was = true;
      }
    return fresh;
  }

  /// What was found instead of pairs, where it was: the first piece in the place of the pair's first.
  void put(const std::vector<Fresh>& pairs, std::vector<std::vector<Piece>> found) {
    std::set<std::size_t> gone, places;
    std::vector<Piece> more;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (found[k].empty()) continue;
      const auto& [i, j, pair, value] = pairs[k];
      gone.insert({pieces_[i].number, pieces_[j].number});
      places.insert(j);
      pieces_[i] = numbered(std::move(found[k].front()));
      for (std::size_t n = 1; n < found[k].size(); ++n) more.push_back(numbered(std::move(found[k][n])));
    }
    std::erase_if(pairs_, [&](const auto& entry) {
      return gone.contains(entry.first.first) || gone.contains(entry.first.second);
    });
    for (const std::size_t j : std::views::reverse(places))
      pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(j));
    std::ranges::move(more, std::back_inserter(pieces_));
  }

  const Work& work_;
  std::vector<Piece> pieces_;
  std::map<std::pair<std::size_t, std::size_t>, Pair> pairs_;
  std::set<std::size_t> whole_;  // pieces that no cut makes cheaper
  std::size_t next_ = 0;
  std::uint64_t samples_ = 0, corners_ = 0;
  std::uint64_t before_ = 0, most_ = 0, allowed_ = 0;
};

}  // namespace

auto refine_owner(std::span<const Draft> drafts, std::span<const std::size_t> mine, const Work& work) -> Roofed {
  Roofed out;
  const Options& options = work.options();
  std::vector<Site> sites(mine.size());
  base::parallel_for(mine.size(), [&](std::size_t k) {
    const auto& plan = drafts[mine[k]].plan;
    sites[k] = work.look(model::polygon_of(plan), plan.base);
  });
  if (options.effort == Effort::parts) put_on_planes(sites, options);
  std::vector<std::optional<base::Result<Piece>>> roofed(mine.size());
  base::parallel_for(mine.size(),
                     [&](std::size_t k) { roofed[k] = work.roofed(mine[k], std::move(sites[k]), drafts[mine[k]]); });
  auto& pieces = out.pieces;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    const std::size_t i = mine[k];
    const auto& plan = drafts[i].plan;
    auto& made = roofed[k];
    if (!made) continue;  // each was made
    auto& piece = *made;
    if (piece) {
      pieces.push_back(std::move(*piece));
    } else if (auto raised = work.raised(plan)) {  // down the ladder, and no further
      out.rest.parts.push_back({drafts[i].owner, i, plan, std::move(*raised), {}});
    } else {
      out.rest.failed.emplace_back(i, raised.error());
    }
  }
  if (options.effort == Effort::parts) {
    Pieces search(std::move(pieces), work);
    out.search = {search.samples(), search.corners(), 0, search.most(), false};
    search.allow(share_of_joining);
    search.join();
    search.cut_anew();  // a wall between two drafts that is not where the scan has it would be explained by cuts
    search.allow(share_of_cutting);
    search.split();
    search.cut_anew();
    search.allow(1);
    search.join();  // what was cut may fit its neighbours now
    pieces = std::move(search).pieces();
  }
  base::parallel_for(pieces.size(), [&](std::size_t i) { pieces[i] = work.finished(std::move(pieces[i])); });
  out.search.work = work.account().spent();
  out.search.met_bound = work.account().has_met_a_bound();
  return out;
}

}  // namespace mansard::refine::detail
