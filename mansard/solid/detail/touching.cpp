// What stands how near to what: which buildings are laid over one plan, and which parts share walls exactly already.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <tuple>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/solid/detail/sheets.hpp"

namespace mansard::solid::detail {
namespace {

/// An edge of the ground.
struct SheetEdge {
  Place from{}, to{};
  std::uint32_t owner = 0;

  [[nodiscard]] auto least(int axis) const -> std::int64_t { return std::min(from[axis], to[axis]); }
  [[nodiscard]] auto most(int axis) const -> std::int64_t { return std::max(from[axis], to[axis]); }
};

auto minus(const Place& a, const Place& b) -> std::array<double, 2> {
  return {static_cast<double>(a[0] - b[0]), static_cast<double>(a[1] - b[1])};
}

/// From a point to an edge.
auto distance(const Place& p, const SheetEdge& edge) -> double {
  const auto along = minus(edge.to, edge.from), to = minus(p, edge.from);
  const double length2 = along[0] * along[0] + along[1] * along[1];
  const double t = length2 > 0 ? std::clamp((to[0] * along[0] + to[1] * along[1]) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(to[0] - t * along[0], to[1] - t * along[1]);
}

/// Sign of the area of the triangle from an edge to a point. Places reach 2⁴⁰ quanta, 10⁵ km; their products are
/// compared in long double.
auto side(const SheetEdge& edge, const Place& p) -> int {
  const long double left = static_cast<long double>(edge.to[0] - edge.from[0]) *
                           static_cast<long double>(p[1] - edge.from[1]),
                    right = static_cast<long double>(edge.to[1] - edge.from[1]) *
                            static_cast<long double>(p[0] - edge.from[0]);
  return (left > right) - (left < right);
}

auto meet(const SheetEdge& a, const SheetEdge& b, std::int64_t near) -> bool {
  if (side(a, b.from) * side(a, b.to) < 0 && side(b, a.from) * side(b, a.to) < 0) return true;
  const auto reach = static_cast<double>(near);
  return distance(a.from, b) < reach || distance(a.to, b) < reach || distance(b.from, a) < reach ||
         distance(b.to, a) < reach;
}

auto edges_of(const Sheets& sheets, const std::vector<std::uint32_t>& owner_of_solid) -> std::vector<SheetEdge> {
  std::vector<SheetEdge> edges;
  for (const Sheet& sheet : sheets.sheets) {
    if (sheet.facing != Facing::down) continue;
    for (const Path& path : sheet.paths)
      for (std::size_t i = 0; i < path.size(); ++i)
        edges.push_back(
            {sheets.places[path[i].at], sheets.places[path[(i + 1) % path.size()].at], owner_of_solid[sheet.solid]});
  }
  std::ranges::sort(edges, {}, [](const SheetEdge& e) { return std::tuple(e.least(0), e.from, e.to, e.owner); });
  return edges;
}

}  // namespace

namespace {

/// Whether the grounds on the inner sides of two edges overlap there by more than surveys differ: the edges cross far
/// from their ends, or run along each other in one direction.
auto overlap(const SheetEdge& a, const SheetEdge& b, std::int64_t near) -> bool {
  constexpr double deep = 0.1 * quanta_per_metre;
  const auto along_a = minus(a.to, a.from), along_b = minus(b.to, b.from);
  if (side(a, b.from) * side(a, b.to) < 0 && side(b, a.from) * side(b, a.to) < 0)
    return std::min({distance(a.from, b), distance(a.to, b), distance(b.from, a), distance(b.to, a)}) > deep;
  if (along_a[0] * along_b[0] + along_a[1] * along_b[1] <= 0) return false;
  const double length = std::hypot(along_a[0], along_a[1]);
  double first = length, last = 0;  // of b, along a
  for (const Place& p : {b.from, b.to}) {
    const auto to = minus(p, a.from);
    if (std::abs(along_a[0] * to[1] - along_a[1] * to[0]) > static_cast<double>(near) * length) return false;
    const double at = (along_a[0] * to[0] + along_a[1] * to[1]) / length;
    first = std::min(first, at);
    last = std::max(last, at);
  }
  return std::min(last, length) - std::max(first, 0.0) > deep;
}

/// Calls work(i, k) for edges of different owners whose boxes are near, as long as it is true of i.
template <class Work>
void for_near(const std::vector<SheetEdge>& edges, std::int64_t near, Work work) {
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = i + 1; k < edges.size() && edges[k].least(0) <= edges[i].most(0) + near; ++k) {
      if (edges[k].least(1) > edges[i].most(1) + near || edges[i].least(1) > edges[k].most(1) + near) continue;
      if (edges[i].owner != edges[k].owner && !work(edges[i], edges[k])) break;
    }
}

/// The owners whose ground overlaps that of others at so many edges that it is no survey of a city, but footprints
/// piled up: all their crossings in one plan would cost the square of their number and more. Which edges are counted
/// depends on their order, and so on nothing but the owners that are near.
auto piled_up(const std::vector<SheetEdge>& edges, std::int64_t near, std::uint32_t owners) -> std::vector<bool> {
  constexpr int most = 64;
  std::vector<int> count(owners, 0);
  for_near(edges, near, [&](const SheetEdge& a, const SheetEdge& b) {
    if (count[a.owner] > most) return false;
    if (overlap(a, b, near)) ++count[a.owner], ++count[b.owner];
    return true;
  });
  std::vector<bool> out;
  for (const int number : count) out.push_back(number > most);
  return out;
}

}  // namespace

auto touching(const Sheets& sheets, const std::vector<std::uint32_t>& owner_of_solid, std::uint32_t owners)
    -> std::vector<std::uint32_t> {
  const auto edges = edges_of(sheets, owner_of_solid);
  const auto alone = piled_up(edges, sheets.near, owners);
  base::DisjointSets sets(owners);
  for_near(edges, sheets.near, [&](const SheetEdge& a, const SheetEdge& b) {
    if (alone[a.owner]) return false;
    if (!alone[b.owner] && sets.of(a.owner) != sets.of(b.owner) && meet(a, b, sheets.near)) sets.join(a.owner, b.owner);
    return true;
  });
  std::vector<std::uint32_t> out(owners);
  for (std::uint32_t o = 0; o < owners; ++o) out[o] = sets.of(o);
  return out;
}

namespace {

/// Whether a path is another one with corners put in between, on which other solids lie exactly.
auto only_broken(const Path& before, const Path& after, const Sheets& sheets,
                 const std::function<bool(std::uint32_t)>& is_others) -> bool {
  std::size_t found = 0;
  for (const Node& node : after) {
    if (found < before.size() && node == before[found]) {
      ++found;
      continue;
    }
    if (found == 0) return false;
    const SheetEdge edge{sheets.places[before[found - 1].at], sheets.places[before[found % before.size()].at]};
    if (is_others(node.at) && side(edge, sheets.places[node.at]) != 0) return false;
  }
  return found == before.size();
}

}  // namespace

auto only_broken(const Sheets& before, const Sheets& after) -> bool {
  if (before.sheets.size() != after.sheets.size()) return false;
  std::set<std::pair<std::uint32_t, std::uint32_t>> uses;  // of places by solids
  for (const Sheet& sheet : before.sheets)
    for (const Path& path : sheet.paths)
      for (const Node& node : path) uses.emplace(node.at, sheet.solid);
  for (std::size_t s = 0; s < before.sheets.size(); ++s) {
    const auto &old = before.sheets[s].paths, &now = after.sheets[s].paths;
    if (old.size() != now.size()) return false;
    const auto is_others = [&](std::uint32_t at) {
      const auto first = uses.lower_bound({at, 0}), last = uses.lower_bound({at + 1, 0});
      return std::any_of(first, last, [&](const auto& use) { return use.second != before.sheets[s].solid; });
    };
    for (std::size_t p = 0; p < old.size(); ++p)
      if (!only_broken(old[p], now[p], after, is_others)) return false;
  }
  return true;
}

}  // namespace mansard::solid::detail
