#include "mansard/report/detail/why.hpp"

#include <utility>

#include "mansard/base/text.hpp"

namespace mansard::report::detail {
namespace {

using Amounts = std::vector<std::pair<double, std::string>>;

/// Whole from 10 on, where a decimal would be of no interest.
auto rounded(double cost) -> std::string {
  constexpr double least = 0.05;  // less would be written 0.0
  return cost < least ? "under 0.1" : base::to_text(cost, cost < 10 ? 1 : 0);
}

/// "480 for this and 96 for that"; "0" where nothing costs anything.
auto listed(const Amounts& amounts) -> std::string {
  std::string text;
  for (const auto& [cost, reason] : amounts)
    if (cost > 0) text += (text.empty() ? "" : " and ") + rounded(cost) + " for " + reason;
  return text.empty() ? "0" : text;
}

auto paid(const segment::Candidate& c, segment::Paid when) -> Amounts {
  Amounts amounts;
  for (const auto& info : segment::terms())
    if (info.paid == when) amounts.emplace_back(c.costs[info.term], info.reason(c.amounts[info.term]));
  return amounts;
}

auto if_cut(const segment::Candidate& c, std::size_t walls, double phi) -> Amounts {
  auto amounts = paid(c, segment::Paid::cut);
  amounts.emplace_back(
      static_cast<double>(walls) * phi,
      walls == 1 ? "its conflict with another wall" : "its conflicts with " + std::to_string(walls) + " other walls");
  return amounts;
}

}  // namespace

auto walls_in_conflict(const segment::Segmentation& segmentation) -> std::vector<std::size_t> {
  std::vector<std::size_t> walls(segmentation.candidates.size(), 0);
  for (const auto& [first, second] : segmentation.conflicts) {
    if (!second) continue;
    if (segmentation.candidates[first].solved) ++walls[*second];
    if (segmentation.candidates[*second].solved) ++walls[first];
  }
  return walls;
}

auto why(const segment::Candidate& c, std::size_t walls, double phi) -> std::string {
  if (c.solved && !c.chosen)
    return "cut by the program, but one side is too small or narrow for a part: joined or left out";
  if (c.forced) return "cut: between two features";
  const double cut = c.costs.sum(segment::Paid::cut) + static_cast<double>(walls) * phi,
               uncut = c.costs.sum(segment::Paid::uncut);
  const std::string of_cut = listed(if_cut(c, walls, phi)), of_uncut = listed(paid(c, segment::Paid::uncut));
  if (c.solved)
    return cut <= uncut ? "cut: " + of_uncut + " against " + of_cut
                        : "cut though dearer by itself (" + of_cut + " against " + of_uncut + "): its ends need a wall";
  return cut >= uncut ? "not cut: " + of_cut + " against " + of_uncut
                      : "not cut though cheaper by itself (" + of_cut + " against " + of_uncut +
                            "): the walls that its ends need cost more";
}

}  // namespace mansard::report::detail
