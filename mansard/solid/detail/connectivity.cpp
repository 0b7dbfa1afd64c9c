#include "mansard/solid/detail/connectivity.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace mansard::solid::detail {

auto connectivity(const model::Solid& solid) -> Connectivity {
  Connectivity result;
  HalfEdges& e = result.half_edges;
  std::size_t size = 0, loops = 0;
  for (const model::Face& face : solid.faces) {
    loops += face.loops.size();
    for (const auto& loop : face.loops) size += loop.size();
  }
  for (auto* list : {&e.origin, &e.face, &e.next}) list->reserve(size);
  e.first_of_loop.reserve(loops + 1);
  e.first_loop_of_face.reserve(solid.faces.size() + 1);
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    e.first_loop_of_face.push_back(static_cast<std::uint32_t>(e.first_of_loop.size()));
    for (const auto& loop : solid.faces[f].loops) {
      const auto first = static_cast<std::uint32_t>(e.origin.size());
      e.first_of_loop.push_back(first);
      for (const std::uint32_t v : loop) {
        e.origin.push_back(v);
        e.face.push_back(f);
        e.next.push_back(static_cast<std::uint32_t>(e.origin.size()));
      }
      e.next.back() = first;
    }
  }
  e.first_loop_of_face.push_back(static_cast<std::uint32_t>(e.first_of_loop.size()));
  e.first_of_loop.push_back(static_cast<std::uint32_t>(size));

  // Half-edges by origin (counted), then by target: a vertex has few, so that looking one up is quick.
  std::vector<std::uint32_t> first(solid.vertices.size() + 1, 0), sorted(size);
  for (const std::uint32_t v : e.origin) ++first[v + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  e.leaving.assign(solid.vertices.size(), HalfEdges::none);
  {
    std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
    for (std::uint32_t h = 0; h < size; ++h) sorted[at[e.origin[h]]++] = h;
  }
  const auto target = [&](std::uint32_t h) { return e.target(h); };
  const auto from = [&](std::uint32_t v) { return std::span(sorted).subspan(first[v], first[v + 1] - first[v]); };
  for (std::uint32_t v = 0; v < solid.vertices.size(); ++v) {
    const auto here = from(v);
    if (here.empty()) continue;
    e.leaving[v] = here.front();
    std::ranges::sort(
        here, [&](std::uint32_t g, std::uint32_t h) { return target(g) != target(h) ? target(g) < target(h) : g < h; });
  }
  e.twin.assign(size, HalfEdges::none);
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint32_t h = sorted[i], to = e.target(h);
    if (i > 0 && e.origin[sorted[i - 1]] == e.origin[h] && target(sorted[i - 1]) == to) continue;  // said already
    const bool alone = i + 1 == size || e.origin[sorted[i + 1]] != e.origin[h] || target(sorted[i + 1]) != to;
    const auto back = std::ranges::equal_range(from(to), e.origin[h], {}, target);
    if (back.empty()) result.open.push_back(h);
    else if (!alone) result.crowded.push_back(h);
    else if (back.size() == 1) e.twin[h] = back.front();
  }
  return result;
}

auto split_vertex(const model::Solid& solid, const HalfEdges& e) -> std::optional<std::uint32_t> {
  std::vector<std::uint32_t> corners(solid.vertices.size(), 0);
  for (const std::uint32_t v : e.origin) ++corners[v];
  std::vector<std::uint32_t> previous(e.size());
  for (std::uint32_t h = 0; h < e.size(); ++h) previous[e.next[h]] = h;
  for (std::uint32_t v = 0; v < corners.size(); ++v) {
    const std::uint32_t start = e.leaving[v];
    if (start == HalfEdges::none) continue;
    std::uint32_t h = start, steps = 0;
    do {
      h = e.twin[previous[h]];
      ++steps;
    } while (h != HalfEdges::none && h != start && steps <= corners[v]);
    if (h == start && steps != corners[v]) return v;
  }
  return std::nullopt;
}

}  // namespace mansard::solid::detail
