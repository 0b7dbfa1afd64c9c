#include "mansard/refine/detail/place.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "mansard/geometry/fit.hpp"
#include "mansard/refine/detail/order.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;

/// A sample beside a side: along it, off it (positive into the piece), and its height.
struct Beside {
  double along, off, height;  // m
};

struct FreeSide {
  Point2 start, along, inward;
  double length;
};

/// m: a side is looked for as far as it may be wrong, and the planes beside it are read as far again beyond.
constexpr double most_move = 1, read = 1;

/// Of what is off the planes, as for the least height of a structure (law.cpp).
constexpr double stands_clear = 10;

/// m²: sums of some thousand squares of up to 9 m² are exact to 1e-11.
constexpr double as_little = 1e-9;

constexpr double beside_reach = most_move + read;

/// Calls see(place, height) for what is sampled near the side.
template <class See>
void each_near(const FreeSide& side, const Heights& grid, const OnPlanes& samples, See see) {
  if (samples.of_points) {
    for (std::size_t i = 0; i < samples.heights.size(); ++i) see(samples.places[i], samples.heights[i]);
    return;
  }
  auto box =
      geometry::Box2::of(geometry::Segment2{side.start, side.start + side.length * side.along}).grown(beside_reach);
  const auto index = [&](double v, double origin, std::size_t count) {
    return static_cast<std::size_t>(
        std::clamp(std::ceil((v - origin) / grid.spacing), 0.0, static_cast<double>(count)));
  };
  const std::size_t right = index(box.most.x, grid.origin.x, grid.columns),
                    top = index(box.most.y, grid.origin.y, grid.rows);
  for (std::size_t row = index(box.least.y, grid.origin.y, grid.rows); row < top; ++row)
    for (std::size_t column = index(box.least.x, grid.origin.x, grid.columns); column < right; ++column)
      if (const double z = grid.at(column, row); !std::isnan(z)) see(grid.centre(column, row), z);
}

/// Those of the part's samples whose foot is on the side, but for what is rounded: at its ends, and along the outline.
auto samples_beside(const FreeSide& side, const Polygon& part, const Heights& grid, const OnPlanes& samples,
                    double rounded) -> std::vector<Beside> {
  const double trim = side.length > 4 * rounded ? rounded : 0;
  std::vector<Beside> out;
  each_near(side, grid, samples, [&](Point2 place, double z) {
    const Point2 from = place - side.start;
    const double along = dot(from, side.along), off = dot(from, side.inward);
    if (along <= trim || along >= side.length - trim || std::abs(off) >= beside_reach) return;
    if (geometry::boundary_distance(part, place) >= rounded) out.push_back({along, off, z});
  });
  return out;
}

/// z over (along, off), robustly: half of the samples may be of something else, as behind a ridge.
struct PlaneBeside {
  geometry::FittedPlane plane;
  double error = 0;  // m, RMS of what was kept
};
auto plane_through(const std::vector<Beside>& samples, double from, double to, double noise, std::size_t fewest)
    -> std::optional<PlaneBeside> {
  std::vector<Beside> kept;
  for (const auto& s : samples)
    if (s.off >= from && s.off < to) kept.push_back(s);
  constexpr int rounds = 4;
  std::optional<PlaneBeside> out;
  for (int round = 0; round < rounds; ++round) {
    if (kept.size() < fewest) return std::nullopt;
    geometry::PlaneSums sums;
    for (const auto& s : kept) sums.add(s.along, s.off, s.height);
    const auto centred = sums.centred();
    if (centred.determinant() <= 1e-6 * centred.xx * centred.yy) return std::nullopt;  // all on one line
    const auto plane = sums.plane(centred.slopes());
    double squares = 0;
    for (const auto& s : kept) {
      const double d = s.height - plane.at(s.along, s.off);
      squares += d * d;
    }
    const double rms = std::sqrt(squares / static_cast<double>(kept.size()));
    out = PlaneBeside{plane, rms};
    const double limit = std::max(noise, 2 * rms);
    const auto before = kept.size();
    std::erase_if(kept, [&](const Beside& s) { return std::abs(s.height - plane.at(s.along, s.off)) > limit; });
    if (kept.size() == before) break;
  }
  return out;
}

/// A sample beside a side, and what it costs more on the outer plane than on the inner one, m².
struct Excess {
  double along, off, cost;
};

/// A side moved into the piece, and turned about its middle.
struct Moved {
  double at = 0;     ///< m
  double slope = 0;  ///< m per m along the side
  double cost = 0;   ///< m²: of the samples that are outside
};

/// Samples within reach of a side are of the outer plane up to where it is, and of the inner one from there on.
class Sides {
 public:
  Sides(std::vector<Excess> samples, double length) : samples_(std::move(samples)), length_(length) {}

  [[nodiscard]] auto cost_at(double at) const -> double {
    double sum = 0;
    for (const auto& s : samples_)
      if (s.off <= at) sum += s.cost;
    return sum;
  }

  /// Turned by that slope, the cheapest place. Samples at one distance, as in a column of the grid, are on one side:
  /// rounding orders them.
  [[nodiscard]] auto best(double slope) -> std::optional<Moved> {
    double sum = 0, from = -most_move;
    in_reach_.clear();
    for (const auto& s : samples_) {
      const double off = s.off - slope * (s.along - length_ / 2);
      if (off <= -most_move) sum += s.cost;
      else if (off < most_move) in_reach_.emplace_back(off, s.cost);
    }
    std::ranges::sort(in_reach_);
    std::optional<Moved> out;
    for (std::size_t i = 0; i <= in_reach_.size(); ++i) {
      const double to = i < in_reach_.size() ? in_reach_[i].first : most_move;
      if (to - from > same_distance && (!out || sum < out->cost - as_little)) out = Moved{(from + to) / 2, slope, sum};
      from = to;
      if (i < in_reach_.size()) sum += in_reach_[i].second;
    }
    return out;
  }

  /// The same turned, where that is worth a number more. A turn that moves the ends by no more than the scan's edges
  /// are uncertain is none.
  [[nodiscard]] auto turned(const Moved& straight, double area, const Options& options) -> Moved {
    constexpr double most_turn = 0.05;  // 3°: directions of walls are known better
    constexpr double step = 0.02;       // m, at either end
    double least = 0;
    for (const auto& s : samples_) least += std::min(0.0, s.cost);
    if ((straight.cost - least) * area < options.value_price) return straight;
    Moved out = straight;
    const int first = 1 + static_cast<int>(options.samples.blur / step),
              last = static_cast<int>(most_turn * length_ / 2 / step);
    for (int i = first; i <= last; ++i)
      for (const double way : {1.0, -1.0}) {
        const auto other = best(way * step * i / (length_ / 2));
        if (other && other->cost < out.cost - as_little) out = *other;
      }
    return (straight.cost - out.cost) * area < options.value_price ? straight : out;
  }

 private:
  std::vector<Excess> samples_;
  double length_;
  std::vector<std::pair<double, double>> in_reach_;  // m, and what it costs more outside
};

/// Where the side is to move in the piece; nothing where that is not worth a number.
auto move_of(std::vector<Beside> samples, double length, double area, const Options& options) -> std::optional<Moved> {
  const double noise = options.lines.robust, melt = options.samples.melt, middle = length / 2;
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  std::ranges::sort(samples, {}, [](const Beside& s) { return std::pair(s.off, s.along); });
  Moved found;
  double gain = 0;
  std::optional<Sides> sides;
  constexpr int rounds = 3;  // what is read clear of the side is another after it moved
  for (int round = 0; round < rounds; ++round) {
    const double at = found.at, clear = round == 0 ? most_move / 2 + melt : melt;
    const auto inner = plane_through(samples, at + clear, at + clear + read, noise, fewest),
               outer = plane_through(samples, at - clear - read, at - clear, noise, fewest);
    if (!inner || !outer) return std::nullopt;
    if (const double error = std::max(inner->error, outer->error); error > noise) {
      // Beside a parapet what is near the side is on no plane. Where one side stands clear of the other by more than
      // that, what is farther from it holds.
      if (round == 0 || std::abs(inner->plane.at(middle, at) - outer->plane.at(middle, at)) < stands_clear * error)
        return std::nullopt;
      break;
    }
    std::vector<Excess> costs;
    for (const auto& s : samples) {
      const auto off_plane = [&](const PlaneBeside& plane) {
        return std::min(std::abs(s.height - plane.plane.at(s.along, s.off)), options.robust);
      };
      const double in = off_plane(*inner), out = off_plane(*outer);
      costs.push_back({s.along, s.off, out * out - in * in});
    }
    sides.emplace(std::move(costs), length);
    const auto best = sides->best(0);
    if (!best) return std::nullopt;
    if (round == 0) gain = (sides->cost_at(at) - best->cost) * area;
    found = *best;
    if (std::abs(found.at) >= most_move) return std::nullopt;
  }
  const Moved turned = sides->turned(found, area, options);
  gain += (found.cost - turned.cost) * area;
  return gain < options.value_price ? std::nullopt : std::optional(turned);
}

auto crossing_of(Point2 a, Point2 along_a, Point2 b, Point2 along_b) -> std::optional<Point2> {
  constexpr double parallel = 0.1;  // sine of 6°: a corner would move ten times as far as its side
  const double sine = cross(along_a, along_b);
  if (std::abs(sine) < parallel) return std::nullopt;
  return a + (cross(b - a, along_b) / sine) * along_a;
}

auto is_free(const Polygon& part, const FreeSide& side, double near) -> bool {
  constexpr int places = 8;
  int on = 0;
  for (int i = 0; i < places; ++i) {
    const Point2 at = side.start + (side.length * (i + 0.5) / places) * side.along;
    on += geometry::boundary_distance(part, at) < near ? 1 : 0;
  }
  return on <= places / 4;
}

/// Whether the side goes on in the line of one of the part's own edges.
auto goes_on(const Polygon& part, const FreeSide& side) -> bool {
  constexpr double same_line = 0.02, same_direction = 0.02;  // m, and the sine of 1°
  const auto any = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (std::abs(cross(geometry::normalised(b - a), side.along)) > same_direction) continue;
      const Point2 middle = 0.5 * (a + b);
      if (std::abs(dot(middle - side.start, side.inward)) < same_line) return true;
    }
    return false;
  };
  return any(part.outer) || std::ranges::any_of(part.holes, any);
}

}  // namespace

auto placed(const Polygon& part, Polygon piece, const Heights& measured, const Options& options,
            const OnPlanes& samples) -> Polygon {
  const double area = samples.of_points ? samples.area : measured.spacing * measured.spacing;
  for (std::size_t i = 0; i < piece.outer.size(); ++i) {
    auto& ring = piece.outer;
    const std::size_t n = ring.size(), h = (i + n - 1) % n, j = (i + 1) % n, k = (i + 2) % n;
    if (n < 4) break;
    const Point2 along = geometry::normalised(ring[j] - ring[i]);
    FreeSide side{ring[i], along, geometry::left_of(along), length(ring[j] - ring[i])};
    if (side.length < options.cuts.min_width || !is_free(part, side, options.outlines.near_line)) continue;
    const auto move =
        move_of(samples_beside(side, part, measured, samples, options.margin), side.length, area, options);
    // Walls go on in one line, but where the scan says that they do not.
    if (!move || (std::abs(move->at) <= options.margin && goes_on(part, side))) continue;
    const Point2 on = side.start + side.length / 2 * along + move->at * side.inward,
                 way = along + move->slope * side.inward;
    const auto a = crossing_of(on, way, ring[h], ring[i] - ring[h]),
               b = crossing_of(on, way, ring[k], ring[j] - ring[k]);
    if (!a || !b || dot(*b - *a, along) < options.cuts.min_width) continue;
    if (length(*a - ring[i]) > 2 * most_move || length(*b - ring[j]) > 2 * most_move) continue;
    Polygon next = piece;
    next.outer[i] = *a;
    next.outer[j] = *b;
    if (geometry::area(next) > 0 && geometry::is_simple(next)) piece = std::move(next);
  }
  return piece;
}

}  // namespace mansard::refine::detail
