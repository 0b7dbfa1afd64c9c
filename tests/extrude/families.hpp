// Seeded families of plans, from tame to hostile: outlines of six kinds, dressed in mixtures of profiles of seven
// kinds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/run.hpp"
#include "plans.hpp"

namespace plans {

/// Rings without profiles: outer first, holes clockwise.
using Outline = std::vector<Ring>;

/// The boundary of a set of cells, walked so that cells that touch in a corner only stay apart. Grid lines are numbers.
/// Empty when the cells are not connected, or touch in a corner.
inline auto boundary_of(const std::set<std::pair<int, int>>& cells) -> std::vector<std::vector<std::pair<int, int>>> {
  std::map<std::pair<int, int>, std::pair<int, int>> next;  // interior on the left
  bool touches = false;
  const auto step = [&](int x, int y, int u, int v) {
    touches = !next.emplace(std::pair(x, y), std::pair(u, v)).second || touches;
  };
  for (const auto& [x, y] : cells) {
    if (!cells.contains({x, y - 1})) step(x, y, x + 1, y);
    if (!cells.contains({x + 1, y})) step(x + 1, y, x + 1, y + 1);
    if (!cells.contains({x, y + 1})) step(x + 1, y + 1, x, y + 1);
    if (!cells.contains({x - 1, y})) step(x, y + 1, x, y);
  }
  if (touches) return {};
  std::vector<std::vector<std::pair<int, int>>> rings;
  while (!next.empty()) {
    rings.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      rings.back().push_back(at->first);
      const auto to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  // The first ring holds the least corner of all, which is on the outside; a second outside means two pieces.
  for (std::size_t r = 0; r < rings.size(); ++r) {
    int area = 0;
    for (std::size_t i = 0; i < rings[r].size(); ++i) {
      const auto [x, y] = rings[r][i];
      const auto [u, v] = rings[r][(i + 1) % rings[r].size()];
      area += x * v - u * y;
    }
    if ((area > 0) != (r == 0)) return {};
  }
  return rings;
}

/// Cells grown one by one from the middle, some of them knocked out again when there may be holes.
inline auto grown_cells(base::Random& random, int side, std::size_t count, bool holes)
    -> std::set<std::pair<int, int>> {
  std::set<std::pair<int, int>> cells{{side / 2, side / 2}};
  count = std::min<std::size_t>(count, static_cast<std::size_t>(side * side));
  for (std::size_t tries = 0; cells.size() < count && tries < 100 * count; ++tries) {
    auto at = cells.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(random.index(cells.size())));
    constexpr std::array<std::pair<int, int>, 4> steps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto [dx, dy] = steps[random.index(4)];
    const std::pair next{at->first + dx, at->second + dy};
    if (next.first >= 0 && next.second >= 0 && next.first < side && next.second < side) cells.insert(next);
  }
  if (!holes) return cells;
  for (std::size_t i = 4 + random.index(8); i > 0; --i) {
    auto at = cells.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(random.index(cells.size())));
    const auto [x, y] = *at;
    if (cells.contains({x - 1, y}) && cells.contains({x + 1, y}) && cells.contains({x, y - 1}) &&
        cells.contains({x, y + 1}))
      cells.erase({x, y});
  }
  return cells;
}

/// Orthogonal on a grid of few different spacings: full of ties.
inline auto grid_outline(base::Random& random, std::size_t size, bool holes) -> Outline {
  const int side = (holes ? 5 : 3) + static_cast<int>(random.index(4 + size / 8));
  std::vector<std::vector<std::pair<int, int>>> rings;
  for (int tries = 0; rings.empty() || (holes && rings.size() < 2 && tries < 20); ++tries)
    rings = boundary_of(grown_cells(random, side, holes ? 16 + random.index(2 * size) : 2 + random.index(size), holes));
  std::vector<double> xs{0}, ys{0};
  for (int i = 0; i < side; ++i) {
    xs.push_back(xs.back() + (random.index(2) == 0 ? 2 : 3));
    ys.push_back(ys.back() + (random.index(2) == 0 ? 2 : 3));
  }
  Outline out;
  for (const auto& ring : rings) {
    out.emplace_back();
    for (const auto& [x, y] : ring)
      out.back().push_back({xs[static_cast<std::size_t>(x)], ys[static_cast<std::size_t>(y)]});
  }
  return out;
}

/// A shape traced from pixels: staircases as they are, or with every second corner cut off, which leaves runs of
/// hardly turning points.
inline auto raster_outline(base::Random& random, std::size_t size) -> Outline {
  const double angle = random.uniform(0, std::numbers::pi), c = std::cos(angle), s = std::sin(angle);
  const double half_length = 1.5 + static_cast<double>(size) / 8, half_depth = 1.5 + random.uniform(0, 2);
  const bool ell = random.index(2) == 0, smooth = random.index(2) == 0;
  constexpr double pixel = 0.5;
  const int reach = static_cast<int>((half_length + half_depth) / pixel) + 2;
  std::set<std::pair<int, int>> cells;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      const double x = (i + 0.5) * pixel, y = (j + 0.5) * pixel, u = c * x + s * y, v = c * y - s * x;
      if (std::abs(u) > half_length || std::abs(v) > half_depth) continue;
      if (!ell || u < 0 || v < 0) cells.insert({i, j});
    }
  const auto rings = boundary_of(cells);
  if (rings.size() != 1) return {};
  Ring ring;
  for (const auto& [x, y] : rings[0]) ring.push_back({pixel * x, pixel * y});
  if (smooth) {
    Ring middles;
    for (std::size_t i = 0; i < ring.size(); ++i) middles.push_back(0.5 * (ring[i] + ring[(i + 1) % ring.size()]));
    ring = std::move(middles);
  }
  return {ring};
}

/// A back with teeth of one kind, or each its own.
inline auto comb_outline(base::Random& random, std::size_t size) -> Outline {
  const std::size_t teeth = 2 + random.index(1 + size / 4);
  const bool alike = random.index(2) == 0;
  Ring ring{{0, 0}};
  Ring top;
  double x = 0;
  for (std::size_t t = 0; t < teeth; ++t) {
    const double length = alike ? 4 : 1 + 0.5 * static_cast<double>(random.index(8)),
                 width = alike ? 2 : 1 + 0.5 * static_cast<double>(random.index(4)),
                 gap = alike ? 2 : 1 + 0.5 * static_cast<double>(random.index(4));
    if (t > 0) top.push_back({x, 3});
    if (t > 0) x += gap;
    if (t > 0) top.push_back({x, 3});
    top.push_back({x, 3 + length});
    x += width;
    top.push_back({x, 3 + length});
  }
  ring.push_back({x, 0});
  std::ranges::reverse(top);
  ring.insert(ring.end(), top.begin(), top.end());
  return {ring};
}

/// Arms around a middle: all vertices of one kind are tied.
inline auto spokes_outline(base::Random& random, std::size_t size) -> Outline {
  const std::size_t arms = 3 + random.index(1 + size / 4);
  const double width = 2, long_arm = 7, short_arm = random.index(2) == 0 ? 7 : 5;
  const double turn = 2 * std::numbers::pi / static_cast<double>(arms);
  const double foot = width / 2 / std::tan(turn / 2) + (arms == 3 ? 1.0 : 0.5);
  Ring ring;
  for (std::size_t i = 0; i < arms; ++i) {
    const double angle = turn * static_cast<double>(i), c = std::cos(angle), s = std::sin(angle);
    const double reach = foot + (i % 2 == 0 ? long_arm : short_arm);
    for (const Point2 p :
         {Point2{foot, -width / 2}, Point2{reach, -width / 2}, Point2{reach, width / 2}, Point2{foot, width / 2}})
      ring.push_back({c * p.x - s * p.y, s * p.x + c * p.y});
  }
  return {ring};
}

enum class Shape { star, grid, courtyards, raster, comb, spokes };
inline constexpr std::size_t shapes = 6;

/// An outline of about `size` corners; simple, and never empty.
inline auto outline(Shape shape, base::Random& random, std::size_t size) -> Outline {
  Outline out;
  while (out.empty() || !geometry::is_simple({out[0], {out.begin() + 1, out.end()}})) {
    switch (shape) {
      case Shape::star: out = {star(random, 3 + random.index(size))}; break;
      case Shape::grid: out = grid_outline(random, size, false); break;
      case Shape::courtyards: out = grid_outline(random, size, true); break;
      case Shape::raster: out = raster_outline(random, size); break;
      case Shape::comb: out = comb_outline(random, size); break;
      case Shape::spokes: out = spokes_outline(random, size); break;
    }
  }
  return out;
}

/// Ways to dress an outline in profiles.
enum class Dress { hipped, gabled, mansard, eaves, setbacks, walls, anything };
inline constexpr std::size_t dresses = 7;
inline constexpr std::array<const char*, dresses> dress_names{"hipped",   "gabled", "mansard", "eaves",
                                                              "setbacks", "walls",  "anything"};

/// The profiles of one way to dress; lengths in metres, multiples of 1/4.
inline auto profiles_of(Dress dress, base::Random& random) -> std::vector<Profile> {
  const auto quarter = [&](std::size_t most) { return 0.25 * static_cast<double>(random.index(most)); };
  const double foot = 2 + quarter(8);
  switch (dress) {
    case Dress::hipped: return {{{0, 0}, {0, foot}, {1, foot + 0.5 + quarter(4)}}};
    case Dress::gabled:
      return {{{0, 0}, {0, foot}},
              {{0, 0}, {0, foot}, {1, foot + 1}},
              {{0, 0}, {0, foot}, {1, foot + 0.5}},
              {{0, 0}, {0, foot}, {2, foot + 3}}};
    case Dress::mansard:
      return {{{0, 0}, {0, foot}, {0.5, foot + 1.5}, {2, foot + 2.25}},
              {{0, 0}, {0, foot}, {0.5, foot + 1.5}, {1.5, foot + 2}, {3, foot + 2.25}}};
    case Dress::eaves:
      return {{{0, 0}, {0, foot}, {1, foot + 1}},
              {{0, 0}, {0, foot + 1}, {1, foot + 2}},
              {{0, 0}, {0, foot + 0.25 + quarter(8)}, {1, foot + 3}},
              {{0, 0}, {1, 1.5}}};
    case Dress::setbacks:
      return {{{0, 0}, {0, foot}, {1 + quarter(4), foot}, {1 + quarter(4) + 1, foot + 2}},
              {{0, 0}, {0, foot}, {0.75, foot}, {0.75, foot + 1.5}, {1.75, foot + 1.5}, {1.75, foot + 3}},
              {{0, 0}, {0, foot + 1}, {1, foot + 1}},
              {{0, 0}, {0, foot}, {1, foot + 1}, {2, foot + 1}, {3, foot + 2}}};
    case Dress::walls: return {{{0, 0}, {0, foot}}, {{0, 0}, {0, foot}, {1, foot + 1}}, {{0, 0}, {0, foot}, {1, foot}}};
    case Dress::anything: break;
  }
  std::vector<Profile> profiles{hip};
  for (int i = 0; i < 4; ++i) profiles.push_back(random_profile(random));
  return profiles;
}

inline auto dressed(const Outline& outline, Dress dress, base::Random& random) -> Plan {
  Plan p = plan(outline[0], profiles_of(dress, random), {}, 100, {outline.begin() + 1, outline.end()});
  const auto choose = [&](std::vector<std::uint32_t>& of_edge) {
    for (std::uint32_t& k : of_edge) k = static_cast<std::uint32_t>(random.index(p.profiles.size()));
  };
  choose(p.outer.profile_of_edge);
  for (auto& hole : p.holes) choose(hole.profile_of_edge);
  // Walls rise to the cap; roofs are sometimes cut off, too.
  const bool endless = dress == Dress::hipped || dress == Dress::mansard;
  p.cap = endless && random.index(2) == 0 ? 100 : 4 + 0.25 * static_cast<double>(random.index(40));
  return p;
}

/// The plan of a seed: shape, dress, size and turn come from it. `size` is about the most corners of a ring.
inline auto family_plan(std::uint64_t seed, std::size_t size) -> Plan {
  base::Random random(seed, 7);
  const auto shape = static_cast<Shape>(random.index(shapes));
  const auto dress = static_cast<Dress>(random.index(dresses));
  Plan p = dressed(outline(shape, random, size), dress, random);
  if (random.index(3) == 0) p = turned(p, random.uniform(0, 2 * std::numbers::pi));
  return p;
}

}  // namespace plans
