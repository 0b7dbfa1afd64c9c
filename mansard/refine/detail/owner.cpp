#include "mansard/refine/detail/owner.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "mansard/refine/detail/work.hpp"

namespace mansard::refine::detail {
namespace {

/// Two pieces as one, by the numbers of both.
struct Saving {
  double saved = 0;
  std::optional<Piece> piece;
};
using Savings = std::map<std::pair<std::size_t, std::size_t>, Saving>;

/// Looks at all pairs that were not looked at yet.
void look_at_pairs(const std::vector<Piece>& pieces, const std::vector<std::size_t>& number, const Work& work,
                   Savings& savings) {
  struct Pair {
    const Piece *a, *b;
    Saving* saving;
  };
  std::vector<Pair> fresh;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t j = i + 1; j < pieces.size(); ++j)
      if (auto [at, is_new] = savings.try_emplace(std::minmax(number[i], number[j])); is_new)
        fresh.push_back({&pieces[i], &pieces[j], &at->second});
  base::parallel_for(fresh.size(), [&](std::size_t k) {
    const auto& [a, b, saving] = fresh[k];
    saving->piece = work.as_one(*a, *b);
    if (saving->piece)
      saving->saved = a->roof.cost + b->roof.cost + work.options().part_price - saving->piece->roof.cost;
  });
}

/// Joins two pieces at a time, those that save most first, until no pair saves anything.
void join(std::vector<Piece>& pieces, const Work& work) {
  Savings savings;
  std::vector<std::size_t> number(pieces.size());  // pieces keep theirs; joined ones get a new one
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = i;
  std::size_t next = pieces.size();
  while (!work.cancelled()) {
    look_at_pairs(pieces, number, work, savings);
    std::pair<std::size_t, std::size_t> best{};
    double most = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = i + 1; j < pieces.size(); ++j) {
        const double saved = savings.at(std::minmax(number[i], number[j])).saved;
        if (saved <= most) continue;
        most = saved;
        best = {i, j};
      }
    }
    if (!(most > 0)) return;
    const auto [i, j] = best;
    pieces[i] = std::move(*savings.at(std::minmax(number[i], number[j])).piece);
    number[i] = next++;
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
    number.erase(number.begin() + static_cast<std::ptrdiff_t>(j));
  }
}

/// Cuts pieces, and the pieces of pieces, as long as that pays.
auto all_split(std::vector<Piece> open, const Work& work) -> std::vector<Piece> {
  const auto most_pieces = static_cast<std::size_t>(work.options().joins.max_pieces);
  std::vector<Piece> done;
  while (!open.empty()) {
    Piece piece = std::move(open.front());
    open.erase(open.begin());
    std::vector<Piece> pieces;
    if (done.size() + open.size() < most_pieces) pieces = work.split(piece);
    if (pieces.empty()) done.push_back(std::move(piece));
    else open.insert(open.begin(), std::make_move_iterator(pieces.begin()), std::make_move_iterator(pieces.end()));
  }
  return done;
}

/// Moves walls between pieces by cutting pairs anew.
void cut_all_anew(std::vector<Piece>& pieces, const Work& work) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j) {
      auto anew = work.cut_anew(pieces[i], pieces[j]);
      if (anew.empty()) continue;
      pieces[i] = std::move(anew.front());
      pieces[j] = std::move(anew[1]);
      pieces.insert(pieces.end(), std::make_move_iterator(anew.begin() + 2), std::make_move_iterator(anew.end()));
    }
  }
}

auto cost_of(const std::vector<Piece>& pieces, const Options& options) -> double {
  double cost = 0;
  for (const auto& piece : pieces) cost += piece.roof.cost + options.part_price;
  return cost;
}

}  // namespace

auto refine_owner(std::span<const Draft> drafts, std::span<const std::size_t> mine, const rays::Scene& mesh,
                  const Options& options, const extrude::Options& raising, const base::Run& run) -> Refined {
  Refined out;
  const Work work(mesh, options, raising, run);
  std::vector<std::optional<base::Result<Piece>>> roofed(mine.size());
  base::parallel_for(mine.size(), [&](std::size_t k) {
    const auto& plan = drafts[mine[k]].plan;
    roofed[k] = work.roofed(mine[k], work.look(model::polygon_of(plan), plan.base), drafts[mine[k]]);
  });
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    const std::size_t i = mine[k];
    const auto& plan = drafts[i].plan;
    auto& piece = *roofed[k];
    if (piece) {
      pieces.push_back(std::move(*piece));
    } else if (auto raised = extrude::raise(plan, raising, run)) {  // down the ladder, and no further
      out.parts.push_back({drafts[i].owner, i, plan, std::move(*raised), {}});
    } else {
      out.failed.emplace_back(i, raised.error());
    }
  }
  if (options.effort == Effort::parts) {
    for (std::int64_t round = 0; round < options.joins.rounds; ++round) {
      const double before = cost_of(pieces, options);
      join(pieces, work);
      pieces = all_split(std::move(pieces), work);
      cut_all_anew(pieces, work);
      if (cost_of(pieces, options) > options.joins.round_gain * before) break;
    }
  }
  base::parallel_for(pieces.size(), [&](std::size_t i) { pieces[i] = work.finished(std::move(pieces[i])); });
  for (auto& piece : pieces)
    out.parts.push_back({piece.draft.owner, piece.draft_index, std::move(piece.roof.plan), std::move(*piece.raised),
                         std::move(piece.changes)});
  return out;
}

}  // namespace mansard::refine::detail
