// Comparisons that rounding and the last digit of the mesh cannot turn.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace mansard::refine::detail {

/// `same`, m²·m²: Options::same_cost. Costs nearer to each other than this count as equal, and what was found first
/// stays.
[[nodiscard]] inline auto cheaper(double cost, double than, double same) -> bool { return cost < than - same; }

/// m. Sides nearer to each other in length count as equally long: opposite sides of a rectangle are, up to rounding. A
/// mesh moved by a micrometre moves a side's ends by as little; the bound has room for a hundred times that.
constexpr double same_length = 1e-4;

/// m². Pieces nearer to each other in area count as equally large: the length above along an edge of 10 m.
constexpr double same_area = 1e-3;

/// m. Places nearer to each other in distance from two sides count as on their bisector. Rounding is 1e-12 m there; ten
/// times what a mesh may move before a sample moves to the other side.
constexpr double same_distance = 1e-5;

/// Sorts by value, ascending; of values that follow each other within `same`, what came first stays first.
template <class T, class Value>
void rank(std::vector<T>& items, Value value, double same) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < items.size(); ++i) order.emplace_back(std::invoke(value, items[i]), i);
  std::ranges::sort(order);
  for (std::size_t from = 0, to = 0; from < order.size(); from = to) {
    for (to = from + 1; to < order.size() && order[to].first - order[to - 1].first <= same;) ++to;
    std::ranges::sort(order.begin() + static_cast<std::ptrdiff_t>(from),
                      order.begin() + static_cast<std::ptrdiff_t>(to), {}, &std::pair<double, std::size_t>::second);
  }
  std::vector<T> sorted;
  sorted.reserve(items.size());
  for (const auto& entry : order) sorted.push_back(std::move(items[entry.second]));
  items = std::move(sorted);
}

}  // namespace mansard::refine::detail
