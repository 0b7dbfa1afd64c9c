#include "bench/extrude/shapes.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace mansard::bench {
namespace {

using geometry::Point2;
using geometry::Ring;
using model::Plan;
using model::Profile;
using Cell = std::pair<int, int>;
using Cells = std::set<Cell>;

constexpr double cell_size = 3;
/// Counter-clockwise, sides at even places.
constexpr std::array<Cell, 8> around{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

auto taken(const Cells& cells, Cell at, std::size_t i) -> bool {
  return cells.contains({at.first + around[i % 8].first, at.second + around[i % 8].second});
}

/// Whether the cells stay without holes and without contact in a mere point when `at` joins them.
auto stays_simple(const Cells& cells, Cell at) -> bool {
  int runs = 0;  // of sides' neighbours that hang together through the ring around
  for (std::size_t i = 0; i < 8; i += 2) {
    if (!taken(cells, at, i) && taken(cells, at, i + 1) && !taken(cells, at, i + 2)) return false;
    if (taken(cells, at, i) && !(taken(cells, at, i + 1) && taken(cells, at, i + 2))) ++runs;
  }
  return runs == 1;
}

auto sides_taken(const Cells& cells, Cell at) -> int {
  int count = 0;
  for (std::size_t i = 0; i < 8; i += 2) count += taken(cells, at, i) ? 1 : 0;
  return count;
}

/// How many corners the outline has at the four points of this cell.
auto corners_at(const Cells& cells, Cell at) -> int {
  int corners = 0;
  const bool self = cells.contains(at);
  for (std::size_t i = 0; i < 8; i += 2) {
    const int filled = (self ? 1 : 0) + taken(cells, at, i) + taken(cells, at, i + 1) + taken(cells, at, i + 2);
    corners += filled == 1 || filled == 3 ? 1 : 0;
  }
  return corners;
}

auto outline(const Cells& cells) -> Ring {
  std::map<Cell, Cell> next;  // a simple set: one way out of every point
  for (const auto& [x, y] : cells) {
    if (!cells.contains({x, y - 1})) next[{x, y}] = {x + 1, y};
    if (!cells.contains({x + 1, y})) next[{x + 1, y}] = {x + 1, y + 1};
    if (!cells.contains({x, y + 1})) next[{x + 1, y + 1}] = {x, y + 1};
    if (!cells.contains({x - 1, y})) next[{x, y + 1}] = {x, y};
  }
  Ring ring;
  const Cell start = next.begin()->first;
  Cell before = start, at = next[start];
  do {
    const Cell to = next[at];
    const bool straight =
        to.first - at.first == at.first - before.first && to.second - at.second == at.second - before.second;
    if (!straight) ring.push_back({cell_size * at.first, cell_size * at.second});
    before = at;
    at = to;
  } while (before != start);
  return ring;
}

}  // namespace

auto star(base::Random& random, std::size_t corners) -> Ring {
  const double radius = 12 * std::pow(static_cast<double>(corners) / 16, 0.75);
  Ring ring;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(i) + random.uniform(0.1, 0.9)) / static_cast<double>(corners);
    const double r = radius * random.uniform(1.0 / 3, 1);
    ring.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return ring;
}

auto grid(base::Random& random, std::size_t corners) -> Ring {
  Cells cells{{0, 0}};
  std::vector<Cell> order{{0, 0}};
  int count = 4;
  while (count < static_cast<int>(corners)) {
    const Cell from = order[random.index(order.size())];
    const Cell step = around[2 * random.index(4)];
    const Cell at{from.first + step.first, from.second + step.second};
    if (cells.contains(at) || !stays_simple(cells, at)) continue;
    if (sides_taken(cells, at) > 1 && random.index(4) != 0) continue;  // branches rather than blobs
    const int before = corners_at(cells, at);
    cells.insert(at);
    order.push_back(at);
    count += corners_at(cells, at) - before;
  }
  return outline(cells);
}

auto jittered(base::Random& random, Ring ring) -> Ring {
  constexpr double by = cell_size / 4;
  for (Point2& p : ring) p = p + Point2{random.uniform(-by, by), random.uniform(-by, by)};
  return ring;
}

auto turned(Ring ring, double angle) -> Ring {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Point2& p : ring) p = {c * p.x - s * p.y, s * p.x + c * p.y};
  return ring;
}

auto house(base::Random& random) -> Ring {
  // The body counter-clockwise from its lower left corner; on each side perhaps a wing or a bay, on the whole
  // centimetres that plans have.
  const auto length = [&](double least, double most) { return std::round(100 * random.uniform(least, most)) / 100; };
  const double w = length(10, 18), d = length(8, 12);
  Ring ring;
  const auto side = [&](Point2 from, Point2 along, double size) {
    ring.push_back(from);
    if (random.index(4) == 0) return;
    const Point2 out{along.y, -along.x};
    const double start = length(0.15 * size, 0.35 * size), wide = length(0.25 * size, 0.45 * size), deep = length(1, 5);
    const Point2 a = from + start * along, b = from + (start + wide) * along;
    ring.push_back(a);
    if (deep < 1.6 && wide > 2 * deep) {  // a bay with cut corners
      ring.push_back(a + deep * (along + out));
      ring.push_back(b + deep * (out - along));
    } else {
      ring.push_back(a + deep * out);
      ring.push_back(b + deep * out);
    }
    ring.push_back(b);
  };
  do {
    ring.clear();
    side({0, 0}, {1, 0}, w);
    side({w, 0}, {0, 1}, d);
    side({w, d}, {-1, 0}, w);
    side({0, d}, {0, -1}, d);
  } while (ring.size() < 8);
  return turned(ring, random.uniform(0, 6));
}

auto small_footprint(base::Random& random) -> Ring {
  const double w = random.uniform(7, 14), d = random.uniform(6, 11);
  const double a = random.uniform(0.3, 0.5) * w, b = random.uniform(0.3, 0.6) * d, c = random.uniform(0.7, 0.9) * w;
  Ring ring;
  switch (random.index(4)) {
    case 0: ring = {{0, 0}, {w, 0}, {w, d}, {0, d}}; break;
    case 1: ring = {{0, 0}, {w, 0}, {w, b}, {a, b}, {a, d}, {0, d}}; break;
    case 2: ring = {{0, 0}, {w, 0}, {w, b}, {c, b}, {c, d}, {a, d}, {a, b}, {0, b}}; break;
    default:
      ring = {{0, 0}, {a, 0}, {a, -1.5}, {c, -1.5}, {c, 0}, {w, 0}, {w, b}, {w + 2, b}, {w + 2, d}, {0, d}};
      break;
  }
  for (Point2& p : ring) p = p + Point2{random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03)};
  return turned(ring, random.uniform(0, 6));
}

auto plan_of(Ring ring, Profile profile, double cap) -> Plan {
  Plan plan;
  plan.outer.profile_of_edge.assign(ring.size(), 0);
  plan.outer.points = std::move(ring);
  plan.profiles = {std::move(profile)};
  plan.cap = cap;
  return plan;
}

auto mixed_plan_of(base::Random& random, Ring ring) -> Plan {
  Plan plan = plan_of(std::move(ring), mansard);
  plan.profiles.push_back({{0, 0}, {0, 9}});
  plan.profiles.push_back({{0, 0}, {0, 6}, {2, 7.5}});
  plan.profiles.push_back({{0, 0}, {0, 3.5}, {1.5, 3.5}, {1.5, 6.5}, {3.5, 8}});
  for (auto& k : plan.outer.profile_of_edge) {
    const std::size_t die = random.index(10);
    k = die < 6 ? 0 : die < 7 ? 1 : die < 9 ? 2 : 3;
  }
  plan.cap = 12;
  return plan;
}

}  // namespace mansard::bench
