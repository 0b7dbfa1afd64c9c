#include "mansard/sweep/detail/steps_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/edges.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// All in cells. The melted flank of a step lies within step_near of it; the slopes beside it are taken beyond.
/// Cells from the middle of a step to the ends of its flank, and to the ends of the slopes beside it.
struct Window {
  std::size_t near, far;
  explicit Window(const Options& o) : near(o.step_near), far(o.step_near + o.step_side) {}
  [[nodiscard]] auto size() const -> std::size_t { return 2 * far + 1; }
};

struct Edge {
  double angle = 0, length = 0;  // rad in [0, π/2), m
  std::size_t member = 0;
};

auto quarter_turned(double a, double b) -> double { return std::remainder(a - b, std::numbers::pi / 2); }

auto edges_of(const block::Block& block, const Options& o) -> std::vector<Edge> {
  std::vector<Edge> edges;
  for (std::size_t m = 0; m < block.members.size(); ++m) {
    for (const auto& polygon : block.members[m].polygons)
      geometry::each_edge(polygon, [&](Point2 from, Point2 to) {
        const Point2 d = to - from;
        const double size = length(d);
        if (size < o.step_grain_edge) return;
        const double turned = std::fmod(geometry::arc_tangent(d.y, d.x) + 2 * std::numbers::pi, std::numbers::pi / 2);
        edges.push_back({turned, size, m});
      });
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    if (a.length != b.length) return a.length > b.length;
    return a.angle != b.angle ? a.angle < b.angle : a.member < b.member;
  });
  return edges;
}

/// Raises `box` about the polygons, in the axes.
void add_to(geometry::Box2& box, const geometry::Polygon& polygon, Point2 x, Point2 y) {
  for (const Point2 p : polygon.outer) box.add({dot(p, x), dot(p, y)});
}

/// Where a ring crosses the line `dot(p, y) = level`, by dot(p, x).
void add_crossings(const geometry::Ring& ring, Point2 x, Point2 y, double level, std::vector<double>& at) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
    const double va = dot(a, y) - level, vb = dot(b, y) - level;
    if ((va > 0) == (vb > 0)) continue;
    at.push_back(dot(a, x) + (dot(b, x) - dot(a, x)) * va / (va - vb));
  }
}

/// The straight line through a few heights, a cell apart.
struct Slope {
  double rise = 0, rough = 0;  // m per cell; m, root mean square off the line
};
auto slope_of(const double* z, std::size_t count) -> Slope {
  const auto n = static_cast<double>(count);
  double mean = 0, moment = 0, spread = 0;
  for (std::size_t i = 0; i < count; ++i) mean += z[i] / n;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) - 0.5 * (n - 1);
    moment += s * (z[i] - mean);
    spread += s * s;
  }
  Slope slope{moment / spread, 0};
  for (std::size_t i = 0; i < count; ++i) {
    const double off = z[i] - mean - slope.rise * (static_cast<double>(i) - 0.5 * (n - 1));
    slope.rough += off * off / n;
  }
  slope.rough = std::sqrt(slope.rough);
  return slope;
}

/// What the heights of a row show around one of its cells.
struct Look {
  double rise = nothing;         // m, over the flank; NaN where nothing can be said
  double before = 0, after = 0;  // m per cell, slopes on both sides
  double cell = 0, span = 0;     // m; cells across the flank
  [[nodiscard]] auto known() const -> bool { return !std::isnan(rise); }
  /// The slope, of those between the two sides', that explains most of the rise.
  [[nodiscard]] auto slope() const -> double {
    return std::clamp(rise / span, std::min(before, after), std::max(before, after));
  }
  /// m perpendicular to the surface: on steep roofs noise is tall too.
  [[nodiscard]] auto jump() const -> double { return (rise - span * slope()) / std::hypot(1, slope() / cell); }
};

/// `z` points to the heights from `far` cells before to `far` cells after.
auto look_at(const double* z, const Options& o) -> Look {
  const auto [near, far] = Window(o);
  const std::size_t count = far - near + 1;
  for (std::size_t k = 0; k <= 2 * far; ++k)
    if (std::isnan(z[k])) return {};
  const Slope before = slope_of(z, count), after = slope_of(z + far + near, count);
  if (std::max(before.rough, after.rough) > o.step_roughness) return {};
  return {z[far + near] - z[far - near], before.rise, after.rise, o.step_cell, 2.0 * static_cast<double>(near)};
}

/// Cells from the centre to the middle of the flank: the mean place of what climbs more than the slope.
auto middle_of(const double* z, const Look& look, const Window& window) -> double {
  const auto [near, far] = window;
  double weight = 0, moment = 0;
  for (std::size_t k = far - near; k < far + near; ++k) {
    const double climb = (look.jump() > 0 ? 1 : -1) * (z[k + 1] - z[k] - look.slope());
    if (climb <= 0) continue;
    weight += climb;
    moment += climb * (static_cast<double>(k) + 0.5 - static_cast<double>(far));
  }
  return weight > 0 ? moment / weight : 0;
}

/// Heights from `far` cells before to `far` cells after, each the mean with its two neighbours along the line, where
/// all are known.
auto mean_row(const HeightGrid& grid, std::size_t u, std::size_t t, std::size_t far) -> std::vector<double> {
  std::vector<double> row;
  for (std::size_t k = u - far; k <= u + far; ++k) {
    double z = grid.z(k, t);
    if (t > 0 && t + 1 < grid.along())
      if (const double mean = (z + grid.z(k, t - 1) + grid.z(k, t + 1)) / 3; !std::isnan(mean)) z = mean;
    row.push_back(z);
  }
  return row;
}

}  // namespace

auto grains_of(const block::Block& block, const Options& o) -> std::vector<Grain> {
  const auto edges = edges_of(block, o);
  std::vector<char> used(edges.size(), 0);
  std::vector<std::pair<double, Grain>> found;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (used[i] != 0) continue;
    double weight = 0, turn = 0;
    std::vector<double> own(block.members.size(), 0);
    for (std::size_t k = i; k < edges.size(); ++k) {
      const double off = quarter_turned(edges[k].angle, edges[i].angle);
      if (used[k] != 0 || std::abs(off) > o.step_grain_turn) continue;
      used[k] = 1;
      weight += edges[k].length;
      turn += edges[k].length * off;
      own[edges[k].member] += edges[k].length;
    }
    if (weight < o.step_grain_length) continue;
    const double angle = edges[i].angle + turn / weight;
    Grain grain{{geometry::cosine(angle), geometry::sine(angle)}, {}};
    for (std::size_t m = 0; m < own.size(); ++m)
      if (own[m] > 0) grain.members.push_back(m);
    if (!grain.members.empty()) found.emplace_back(weight, std::move(grain));
  }
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Grain> grains;
  for (auto& [weight, grain] : found) grains.push_back(std::move(grain));
  return grains;
}

HeightGrid::HeightGrid(const block::Block& block, const Grain& grain, const rays::Scene& mesh, const Options& options)
    : options_(options), x_(grain.direction), y_(geometry::left_of(grain.direction)) {
  geometry::Box2 box;
  for (const std::size_t m : grain.members)
    for (const auto& polygon : block.members[m].polygons) add_to(box, polygon, x_, y_);
  if (box.empty()) return;
  const double cell = options.step_cell;
  origin_ = box.least.x * x_ + box.least.y * y_;
  nx_ = static_cast<std::size_t>(std::ceil((box.most.x - box.least.x) / cell));
  ny_ = static_cast<std::size_t>(std::ceil((box.most.y - box.least.y) / cell));
  z_.assign(nx_ * ny_, nothing);
  base::parallel_for(ny_, [&](std::size_t j) {
    const double v = (static_cast<double>(j) + 0.5) * cell;
    std::vector<double> at;
    for (const std::size_t m : grain.members)
      for (const auto& polygon : block.members[m].polygons) {
        at.clear();
        add_crossings(polygon.outer, x_, y_, box.least.y + v, at);
        for (const auto& hole : polygon.holes) add_crossings(hole, x_, y_, box.least.y + v, at);
        std::ranges::sort(at);
        for (std::size_t k = 0; k + 1 < at.size(); k += 2) {
          const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil((at[k] - box.least.x) / cell - 0.5)));
          for (std::size_t i = first; i < nx_; ++i) {
            const double u = (static_cast<double>(i) + 0.5) * cell;
            if (u > at[k + 1] - box.least.x) break;
            const auto z = mesh.top_inside_walls(origin_ + u * x_ + v * y_, block.members[m].ground);
            if (z && *z >= block.members[m].ground + options.step_ground) z_[j * nx_ + i] = *z;
          }
        }
      }
  });
}

auto HeightGrid::jumps() const -> std::vector<Jump> {
  const Options& o = options_;
  const Window window(o);
  const auto [near, far] = window;
  const std::size_t columns = across(), rows = along();
  std::vector<Look> looks(columns * rows);
  base::parallel_for(rows, [&](std::size_t t) {
    std::vector<double> row(columns);
    for (std::size_t u = 0; u < columns; ++u) row[u] = z(u, t);
    for (std::size_t u = far; u + far < columns; ++u) looks[t * columns + u] = look_at(&row[u - far], o);
  });
  const auto mean_look = [&](std::size_t u, std::size_t t) {
    Look mean = looks[t * columns + u];
    if (!mean.known()) return mean;
    double n = 1;
    for (std::size_t k = t - std::min(t, o.step_rows); k <= std::min(t + o.step_rows, rows - 1); ++k) {
      const Look& look = looks[k * columns + u];
      if (k == t || !look.known()) continue;
      mean.rise += look.rise, mean.before += look.before, mean.after += look.after, n += 1;
    }
    if (n < o.step_minimum_rows) return Look{};
    mean.rise /= n, mean.before /= n, mean.after /= n;
    return mean;
  };
  std::vector<std::vector<Jump>> by_row(rows);
  base::parallel_for(rows, [&](std::size_t t) {
    std::vector<double> heights(columns, 0);
    for (std::size_t u = far; u + far < columns; ++u) {
      const Look look = mean_look(u, t);
      // The mean goes on for some rows beyond the end of a step.
      if (look.known() && looks[t * columns + u].jump() / look.jump() >= o.step_own_share) heights[u] = look.jump();
    }
    for (std::size_t u = far; u + far < columns; ++u) {
      const double height = std::abs(heights[u]);
      if (height < o.step_noise) continue;
      bool highest = true;
      for (std::size_t k = u - o.step_alone; k <= u + o.step_alone && highest; ++k) {
        const double other = std::abs(heights[k]);
        highest = k == u || other < height || (other == height && k > u);
      }
      const double one = z(u - near, t), two = z(u + near, t);
      if (!highest) continue;
      // A sharp step looks as high from anywhere on its flank: the middle tells where it is.
      const std::vector<double> around = mean_row(*this, u, t, far);
      const double at =
          (static_cast<double>(u) + 0.5 + middle_of(around.data(), mean_look(u, t), window)) * o.step_cell;
      if (at >= 0) by_row[t].push_back({at, t, heights[u], std::min(one, two), std::max(one, two)});
    }
  });
  std::vector<Jump> all;
  for (const auto& row : by_row) all.insert(all.end(), row.begin(), row.end());
  return all;
}

auto HeightGrid::flank_of(std::span<const Jump> jumps, const Line& line) const -> Flank {
  const Window window(options_);
  const std::size_t far = window.far;
  const double cell = options_.step_cell;
  std::vector<double> sum(window.size(), 0);
  double n = 0;
  for (const Jump& j : jumps) {
    // Between the centres of two cells.
    const double place = line.at(static_cast<double>(j.row)) / cell - 0.5 - static_cast<double>(far);
    if (place < 0 || place + static_cast<double>(2 * far + 2) > static_cast<double>(across())) continue;
    const auto first = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(first);
    std::vector<double> z_across(window.size());
    bool known = true;
    for (std::size_t k = 0; k <= 2 * far; ++k) {
      z_across[k] = (1 - part) * z(first + k, j.row) + part * z(first + k + 1, j.row);
      known = known && !std::isnan(z_across[k]);
    }
    if (!known) continue;
    for (std::size_t k = 0; k <= 2 * far; ++k) sum[k] += z_across[k];
    n += 1;
  }
  if (n == 0) return {};
  for (double& z_mean : sum) z_mean /= n;
  const Look look = look_at(sum.data(), options_);
  return look.known() ? Flank{look.jump(), cell * middle_of(sum.data(), look, window)} : Flank{};
}

}  // namespace mansard::sweep::detail
