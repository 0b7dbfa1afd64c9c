#include "mansard/accuracy/detail/transects.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "mansard/base/run.hpp"
#include "mansard/base/statistics.hpp"
#include "mansard/geometry/edges.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::accuracy::detail {
namespace {

using geometry::Point2;

constexpr double least_edge = 2;  // m
constexpr double most_transects = 400;
constexpr double spacing = 1;                               // m along an edge, at least
constexpr double inner = 1.25, deep = 2.75, sample = 0.25;  // m inside: where the roof is taken
constexpr double near = 1.5, far = 2.5;                     // m outside: where the ground is
constexpr double reach_in = 1, reach_out = 1.5;             // m from the edge: where the roof may end
constexpr double least_drop = 2;                            // m
constexpr double step = 0.05;                               // m
constexpr double even = 0.15;                               // m; root mean square of the roof's samples from their line

/// The roof as a line over the distance outward.
auto roof_at(Point2 place, Point2 outward, const rays::Scene& scene) -> std::optional<geometry::FittedLine> {
  geometry::LineSums sums;
  const auto level = scene.top(place - inner * outward);
  if (!level) return std::nullopt;
  for (double d = inner; d <= deep; d += sample) {
    const auto z = scene.top(place - d * outward);
    if (!z) return std::nullopt;
    sums.add(-d, *z - *level);
  }
  if (sums.residual() > even * even * sums.weight) return std::nullopt;
  auto line = sums.line(sums.joint() / sums.spread());
  line.at_zero += *level;
  return line;
}

/// The steep triangles of a mesh, by the squares that they meet in plan.
class Walls {
 public:
  Walls(const geometry::Mesh& mesh, const geometry::Box2& within) : mesh_(mesh), origin_(within.least) {
    if (within.empty()) return;
    const Point2 size = within.most - within.least;
    columns_ = static_cast<std::int64_t>(size.x / square) + 1, rows_ = static_cast<std::int64_t>(size.y / square) + 1;
    squares_.resize(static_cast<std::size_t>(columns_ * rows_));
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const auto n = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
      if (std::abs(n.z) > steep * length(n)) continue;
      geometry::Box2 box;
      for (const auto v : mesh.triangles[t]) box.add(xy(mesh.vertices[v]));
      if (box.overlaps(within)) each_square(box, [&](std::vector<std::uint32_t>& at) { at.push_back(t); });
    }
  }

  /// Whether one of them, cut at that height, is nearer than that.
  [[nodiscard]] auto near(Point2 at, double z, double within) -> bool {
    bool found = false;
    each_square(geometry::Box2::of(geometry::Segment2{at, at}).grown(within), [&](const auto& triangles) {
      found = found || std::ranges::any_of(triangles, [&](std::uint32_t t) { return meets(t, at, z, within); });
    });
    return found;
  }

 private:
  static constexpr double square = 2;   // m
  static constexpr double steep = 0.5;  // cosine of 60° from level

  template <class See>
  void each_square(const geometry::Box2& box, See see) {
    const auto index = [](double v, std::int64_t count) {
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(v / square)), 0, count - 1);
    };
    if (squares_.empty()) return;
    for (auto row = index(box.least.y - origin_.y, rows_); row <= index(box.most.y - origin_.y, rows_); ++row)
      for (auto column = index(box.least.x - origin_.x, columns_); column <= index(box.most.x - origin_.x, columns_);
           ++column)
        see(squares_[static_cast<std::size_t>(row * columns_ + column)]);
  }

  [[nodiscard]] auto meets(std::uint32_t t, Point2 at, double z, double within) const -> bool {
    std::array<Point2, 2> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3 && count < 2; ++i) {
      const auto &a = mesh_.vertices[mesh_.triangles[t][i]], &b = mesh_.vertices[mesh_.triangles[t][(i + 1) % 3]];
      if ((a.z <= z) == (b.z <= z)) continue;
      ends[count++] = xy(a) + ((z - a.z) / (b.z - a.z)) * (xy(b) - xy(a));
    }
    return count == 2 && geometry::distance({ends[0], ends[1]}, at) <= within;
  }

  const geometry::Mesh& mesh_;
  Point2 origin_;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> squares_;
};

auto transect_at(Point2 place, Point2 outward, const rays::Scene& scene, Walls& walls) -> std::optional<Transect> {
  const auto roof = roof_at(place, outward, scene);
  if (!roof) return std::nullopt;
  std::vector<double> ground;
  for (double d = near; d <= far; d += sample)
    if (const auto z = scene.top(place + d * outward)) ground.push_back(*z);
  if (ground.empty()) return std::nullopt;
  const double low = base::median(std::move(ground)), drop = roof->at_zero - low;
  if (drop < least_drop) return std::nullopt;
  const auto fall = [&](double x) -> std::optional<double> {
    const auto z = scene.top(place + x * outward);
    if (!z) return std::nullopt;
    return roof->at_zero + roof->slope * x - *z;
  };
  // Where the surface first is so far below the roof.
  const auto falls_by = [&](double most) -> std::optional<double> {
    double last = -reach_in;
    for (double x = -reach_in + step; x <= reach_out; x += step) {
      const auto down = fall(x);
      if (!down) return std::nullopt;
      if (*down < most) {
        last = x;
        continue;
      }
      if (last == -reach_in) return std::nullopt;
      double a = last, b = x;
      for (int round = 0; round < 5; ++round) {
        const double middle = (a + b) / 2;
        const auto half = fall(middle);
        if (!half) return std::nullopt;
        (*half < most ? a : b) = middle;
      }
      return (a + b) / 2;
    }
    return std::nullopt;
  };
  // From above a wall is where it bulges most; how round its edge is shows at its head.
  constexpr double head = 1;  // m
  const auto half = falls_by(drop / 2), edge = falls_by(std::min(head, drop / 2));
  if (half && edge) {
    Transect out;
    out.outside = *half;
    for (std::size_t k = 0; k < depths.size(); ++k) {
      const auto at = fall(*edge - depths[k]);
      if (!at) return std::nullopt;
      out.fall[k] = *at;
    }
    constexpr std::array heights{0.25, 0.5, 0.75};  // of the drop
    constexpr double beside = 0.4;                  // m
    const Point2 foot = place + out.outside * outward;
    for (const double h : heights)
      if (walls.near(foot, low + h * drop, beside)) out.walls += 1.0 / heights.size();
    return out;
  }
  return std::nullopt;
}

/// How far below the roof a surface is that was smoothed with a standard deviation of 1, so far inside of the wall: the
/// place where Φ(x) Φ(z) is one half.
auto rounded(double x) -> double {
  constexpr std::array<double, 13> at{0, 0.125, 0.25, 0.375, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3};
  constexpr std::array<double, 13> fall{2.5,    1.2954, 0.9747, 0.7610, 0.5921, 0.3725, 0.2386,
                                        0.1481, 0.0898, 0.0523, 0.0292, 0.0078, 0.0017};
  if (x >= at.back()) return 0;
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(at, x) - at.begin());
  const double t = (x - at[next - 1]) / (at[next] - at[next - 1]);
  return fall[next - 1] + t * (fall[next] - fall[next - 1]);
}

}  // namespace

auto across(std::span<const geometry::Polygon> outline, const geometry::Mesh& mesh, const rays::Scene& scene)
    -> Transects {
  Transects out;
  struct Place {
    std::size_t edge;
    Point2 at;
  };
  std::vector<geometry::Segment2> edges;
  double all = 0;
  for (const auto& polygon : outline)
    geometry::each_edge(polygon, [&](Point2 a, Point2 b) {
      if (const double l = length(b - a); l >= least_edge) edges.push_back({a, b}), all += l;
    });
  std::ranges::sort(edges);
  const double apart = std::max(spacing, all / most_transects);
  std::vector<Place> places;
  for (const auto& edge : edges) {
    const Point2 along = edge.end - edge.start;
    const double l = length(along);
    out.edges.push_back({-1.0 * geometry::left_of(normalised(along)), l});
    const auto count = static_cast<std::size_t>(std::max(1.0, std::floor(l / apart)));
    for (std::size_t k = 0; k < count; ++k)
      places.push_back(
          {out.edges.size() - 1, edge.start + ((static_cast<double>(k) + 0.5) / static_cast<double>(count)) * along});
  }
  Walls walls(mesh, geometry::bounds(outline).grown(2 * reach_out));
  std::vector<std::optional<Transect>> found(places.size());
  base::parallel_for(places.size(), [&](std::size_t i) {
    found[i] = transect_at(places[i].at, out.edges[places[i].edge].outward, scene, walls);
    if (found[i]) found[i]->edge = places[i].edge;
  });
  for (const auto& one : found)
    if (one) out.transects.push_back(*one);
  return out;
}

auto blur_from(const Transects& all) -> std::optional<double> {
  constexpr std::size_t fewest = 8;
  if (all.transects.size() < fewest) return std::nullopt;
  std::array<double, depths.size()> middle{};
  for (std::size_t k = 0; k < depths.size(); ++k) {
    std::vector<double> falls;
    for (const auto& one : all.transects) falls.push_back(one.fall[k]);
    middle[k] = std::max(0.0, base::mean_median(std::move(falls)));
  }
  // What is nearer than 0.1 m is as sharp as a wall can be seen to be.
  constexpr double sharp = 0.02;  // m at 0.1 m inside
  if (middle[0] < sharp) return 0;
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (double blur = 0.02; blur < 1.5; blur *= 1.03) {
    double error = 0;
    for (std::size_t k = 0; k < depths.size(); ++k) {
      const double off = std::min(1.0, middle[k]) - std::min(1.0, blur * rounded(depths[k] / blur));
      error += off * off;
    }
    if (error < least) least = error, best = blur;
  }
  return best;
}

auto roughness_of(const Transects& all) -> std::optional<double> {
  // Of a transect and the next on its edge: what bends or leans as a whole is not rough.
  constexpr std::size_t fewest = 8;
  constexpr double of_median = 1.4826;
  std::vector<double> apart;
  for (std::size_t i = 1; i < all.transects.size(); ++i)
    if (all.transects[i].edge == all.transects[i - 1].edge)
      apart.push_back(std::abs(all.transects[i].outside - all.transects[i - 1].outside));
  if (apart.size() < fewest) return std::nullopt;
  return of_median * base::mean_median(std::move(apart)) / std::numbers::sqrt2;
}

auto offset_from(const Transects& all) -> std::optional<Offset> {
  constexpr std::size_t least_on_edge = 2, least_edges = 4;
  constexpr double of_median = 1.4826;  // standard deviation of a normal distribution by its median
  struct Wall {
    Point2 outward;
    double outside, weight;
  };
  std::vector<Wall> walls;
  for (std::size_t from = 0, to = 0; from < all.transects.size(); from = to) {
    std::vector<double> outside;
    for (to = from; to < all.transects.size() && all.transects[to].edge == all.transects[from].edge; ++to)
      outside.push_back(all.transects[to].outside);
    if (outside.size() < least_on_edge) continue;
    const auto& edge = all.edges[all.transects[from].edge];
    walls.push_back({edge.outward, base::mean_median(std::move(outside)), edge.length});
  }
  if (walls.size() < least_edges) return std::nullopt;
  // outside = outward · offset + common, robust by reweighting with Huber's function. Of few walls three numbers leave
  // so little that the fit would pass through all but one: then all count.
  constexpr std::size_t few = 8, numbers = 3;
  const auto count = static_cast<double>(walls.size());
  const double unfitted = count / (count - numbers);  // of the squares, what a fit leaves
  Point2 offset;
  double common = 0, spread = 0, weight = 0, determinant = 0;
  double nxx = 0, nxy = 0, nyy = 0;
  const auto rest = [&](const Wall& wall) { return wall.outside - dot(wall.outward, offset) - common; };
  const auto spread_now = [&] {
    std::vector<double> off;
    double squares = 0, lengths = 0;
    for (const auto& wall : walls) {
      off.push_back(std::abs(rest(wall)));
      squares += wall.weight * rest(wall) * rest(wall), lengths += wall.weight;
    }
    const double squared = walls.size() < few ? squares / lengths : std::pow(of_median * base::mean_median(off), 2);
    return std::max(1e-4, std::sqrt(unfitted * squared));
  };
  for (int round = 0; round < 20; ++round) {
    spread = spread_now();
    double sx = 0, sy = 0, so = 0, xx = 0, xyy = 0, yy = 0, xo = 0, yo = 0;
    weight = 0;
    for (const auto& wall : walls) {
      const double off = std::max(1e-9, std::abs(rest(wall)));
      const double w = wall.weight * (walls.size() < few ? 1.0 : std::min(1.0, 1.5 * spread / off));
      const auto [x, y] = wall.outward;
      weight += w, sx += w * x, sy += w * y, so += w * wall.outside;
      xx += w * x * x, xyy += w * x * y, yy += w * y * y, xo += w * x * wall.outside, yo += w * y * wall.outside;
    }
    nxx = xx - sx * sx / weight, nxy = xyy - sx * sy / weight, nyy = yy - sy * sy / weight;
    const double rx = xo - sx * so / weight, ry = yo - sy * so / weight;
    determinant = nxx * nyy - nxy * nxy;
    constexpr double determined = 0.02;  // of the weight: what must face across every direction
    if (determinant < determined * determined * weight * weight) return std::nullopt;
    offset = {(rx * nyy - ry * nxy) / determinant, (ry * nxx - rx * nxy) / determinant};
    common = (so - sx * offset.x - sy * offset.y) / weight;
  }
  spread = spread_now();
  const double mean = weight / static_cast<double>(walls.size());
  const double variance = spread * spread * mean * std::max(nxx, nyy) / determinant;
  return Offset{offset, std::sqrt(variance), spread, walls.size()};
}

}  // namespace mansard::accuracy::detail
