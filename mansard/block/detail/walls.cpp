#include "mansard/block/detail/walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "mansard/base/statistics.hpp"

namespace mansard::block::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;
using geometry::Ring;

constexpr double strip = 3.0;     // m; from the overhang outward: where the terrain at a wall is measured
constexpr double bin_size = 0.5;  // m; two samples of a coarse laser scan, and less than a car or a hedge is wide
constexpr double apart = 3.0;     // m along a wall: farther than the noise of scans is correlated (docs/accuracy.md)
constexpr double kerb = 0.15;     // m; streets and yards are even to less, gardens and trees are not
constexpr double embankment = 0.5;
constexpr double object = 0.25;  // of the outline: a longer row of objects is more likely a terrace

/// A height beside a wall, at a distance from it, m, that represents so many m².
struct Height {
  Point2 at;
  double away = 0, z = 0, weight = 0;
};

/// A piece of the outline.
struct Station {
  Point2 from, to;
  std::vector<Height> heights;  ///< outward, of one surface
  std::size_t run = 0;
  std::size_t side = 0;  ///< of its ring
  [[nodiscard]] auto middle() const -> Point2 { return 0.5 * (from + to); }
  [[nodiscard]] auto length() const -> double { return geometry::length(to - from); }
  [[nodiscard]] auto seen() const -> bool { return !heights.empty(); }
};
using Stations = std::vector<std::vector<Station>>;  // of every ring, in order

auto stations_of(const std::vector<Polygon>& shape, double step) -> Stations {
  Stations out;
  const auto walk = [&](const Ring& ring) {
    auto& stations = out.emplace_back();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 side = ring[(i + 1) % ring.size()] - ring[i];
      const double pieces = std::ceil(geometry::length(side) / step);
      for (double k = 0; k < pieces; ++k)
        stations.push_back({ring[i] + (k / pieces) * side, ring[i] + ((k + 1) / pieces) * side, {}, 0, i});
    }
  };
  for (const auto& polygon : shape) {
    walk(polygon.outer);
    for (const auto& hole : polygon.holes) walk(hole);
  }
  return out;
}

/// A side of the outline, and its first station among those of its ring.
struct Side {
  Point2 from, to;
  std::size_t ring = 0, first = 0, pieces = 1;
  geometry::Box2 reach;
};

auto sides_of(const Stations& stations, const std::vector<Polygon>& shape, double reach) -> std::vector<Side> {
  std::vector<Side> out;
  std::size_t ring = 0;
  const auto walk = [&](const Ring& corners) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point2 from = corners[i], to = corners[(i + 1) % corners.size()];
      std::size_t end = first;
      while (end < stations[ring].size() && stations[ring][end].side == i) ++end;
      if (end > first)
        out.push_back({from, to, ring, first, end - first, geometry::Box2::of(std::array{from, to}).grown(reach)});
      first = end;
    }
    ++ring;
  };
  for (const auto& polygon : shape) {
    walk(polygon.outer);
    for (const auto& hole : polygon.holes) walk(hole);
  }
  return out;
}

/// The heights of every station: medians of its samples, outward until the surface steps.
void add_heights(Stations& stations, const std::vector<Polygon>& shape, const std::vector<Sample>& samples,
                 double overhang) {
  constexpr auto bins = static_cast<std::size_t>(strip / bin_size);
  struct Seen {
    Height height;
    [[nodiscard]] auto key() const { return std::tuple(height.z, height.at, height.weight); }
  };
  using Bins = std::array<std::vector<Seen>, bins>;
  std::vector<std::vector<Bins>> all;
  for (const auto& ring : stations) all.emplace_back(ring.size());
  const auto sides = sides_of(stations, shape, overhang + strip);
  for (const auto& sample : samples) {
    double nearest = overhang + strip;
    Bins* of = nullptr;
    for (const auto& side : sides) {
      if (!side.reach.contains(sample.at)) continue;
      const Point2 along = side.to - side.from, off = sample.at - side.from;
      const double at = std::clamp(dot(off, along) / dot(along, along), 0.0, 1.0);
      const double d = geometry::length(off - at * along);
      if (d >= nearest) continue;
      nearest = d;
      const auto piece = static_cast<std::size_t>(at * static_cast<double>(side.pieces));
      of = &all[side.ring][side.first + std::min(piece, side.pieces - 1)];
    }
    if (of == nullptr || nearest < overhang) continue;
    (*of)[std::min(bins - 1, static_cast<std::size_t>((nearest - overhang) / bin_size))].push_back(
        {{sample.at, nearest, sample.z, sample.weight}});
  }
  for (std::size_t r = 0; r < stations.size(); ++r)
    for (std::size_t s = 0; s < stations[r].size(); ++s)
      for (auto& bin : all[r][s]) {
        if (bin.empty()) continue;
        std::ranges::sort(bin, {}, &Seen::key);
        double weight = 0;
        for (const auto& one : bin) weight += one.height.weight;
        // The sample that is the median, where it is: so that a slope does not matter.
        Height median = bin.back().height;
        double below = 0;
        for (const auto& one : bin)
          if ((below += one.height.weight) >= weight / 2) {
            median = one.height;
            break;
          }
        median.weight = weight;
        auto& heights = stations[r][s].heights;
        if (!heights.empty() &&
            std::abs(median.z - heights.back().z) > std::max(bin_size, median.away - heights.back().away))
          break;
        heights.push_back(median);
      }
}

/// Stations that follow each other on one surface.
struct Run {
  std::vector<Station*> stations;
  double length = 0;
  bool above = false, below = false;  ///< all neighbours
};

auto one_surface(const Station& a, const Station& b) -> bool {
  return std::abs(a.heights.front().z - b.heights.front().z) <= geometry::length(a.middle() - b.middle());
}

auto runs_of(std::vector<Station>& ring) -> std::vector<Run> {
  std::vector<Station*> seen;
  for (auto& station : ring)
    if (station.seen()) seen.push_back(&station);
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!one_surface(*seen[(i + seen.size() - 1) % seen.size()], *seen[i])) starts.push_back(i);
  if (starts.empty()) starts.push_back(0);
  std::vector<Run> out;
  for (std::size_t k = 0; k < starts.size() && !seen.empty(); ++k) {
    auto& run = out.emplace_back();
    const std::size_t end = k + 1 < starts.size() ? starts[k + 1] : starts.front() + seen.size();
    for (std::size_t i = starts[k]; i < end; ++i) run.stations.push_back(seen[i % seen.size()]);
    for (const auto* station : run.stations) run.length += station->length();
    if (starts.size() < 2) continue;
    const double first = run.stations.front()->heights.front().z, last = run.stations.back()->heights.front().z;
    const double before = seen[(starts[k] + seen.size() - 1) % seen.size()]->heights.front().z,
                 after = seen[end % seen.size()]->heights.front().z;
    run.above = first > before && last > after;
    run.below = first < before && last < after;
  }
  return out;
}

/// m: the median of what heights are off the middle of those beside them.
auto roughness(const Run& run) -> double {
  std::vector<double> off;
  for (std::size_t i = 1; i + 1 < run.stations.size(); ++i) {
    const auto z = [&](std::size_t k) { return run.stations[k]->heights.front().z; };
    off.push_back(std::abs(z(i) - (z(i - 1) + z(i + 1)) / 2));
  }
  return off.empty() ? 0 : base::median(std::move(off));
}

/// Leaves out what is no terrain, what is above its neighbours before what is below, the shortest first, and numbers
/// the runs that are left. Nothing is left where all is rough.
void leave_out_objects(Stations& stations, double pit) {
  double all = 0;
  for (const auto& ring : stations)
    for (const auto& station : ring) all += station.seen() ? station.length() : 0;
  const auto clear = [](const Run& run) {
    for (auto* station : run.stations) station->heights.clear();
  };
  std::size_t number = 0;
  for (auto& ring : stations) {
    for (const auto kind : {&Run::above, &Run::below})
      for (;;) {
        const auto runs = runs_of(ring);
        const Run* out = nullptr;
        for (const auto& run : runs)
          if (run.*kind && run.length < (kind == &Run::above ? object : pit) * all)
            if (out == nullptr || run.length < out->length) out = &run;
        if (out == nullptr) break;
        clear(*out);
      }
    for (const auto& run : runs_of(ring)) {
      if (run.length < pit * all || roughness(run) > kerb) clear(run);
      else
        for (auto* station : run.stations) station->run = number;
      ++number;
    }
  }
}

/// z = β · (1, x, y, away), from the middle of the outline.
constexpr std::size_t numbers = 4;
using Vector = std::array<double, numbers>;
using Matrix = std::array<Vector, numbers>;

auto product(const Vector& a, const Vector& b) -> double {
  double sum = 0;
  for (std::size_t i = 0; i < numbers; ++i) sum += a[i] * b[i];
  return sum;
}

/// Of a symmetric positive definite matrix (Cholesky).
auto inverse(const Matrix& m) -> Matrix {
  Matrix lower{}, out{};
  for (std::size_t i = 0; i < numbers; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = m[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
    }
  for (std::size_t c = 0; c < numbers; ++c) {
    Vector y{};
    for (std::size_t i = 0; i < numbers; ++i) {
      double sum = i == c ? 1 : 0;
      for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * y[k];
      y[i] = sum / lower[i][i];
    }
    for (std::size_t i = numbers; i-- > 0;) {
      double sum = y[i];
      for (std::size_t k = i + 1; k < numbers; ++k) sum -= lower[k][i] * out[k][c];
      out[i][c] = sum / lower[i][i];
    }
  }
  return out;
}

/// What is fitted, and what is left.
struct Trend {
  Point2 middle;
  Vector beta{};
  Matrix covariance{};  ///< of beta, for a variance of 1 of the mean of all

  [[nodiscard]] auto row(Point2 p, double away) const -> Vector { return {1, p.x - middle.x, p.y - middle.y, away}; }
  [[nodiscard]] auto at(Point2 p, double away) const -> double { return product(beta, row(p, away)); }
  [[nodiscard]] auto variance(Point2 p, double away) const -> double {
    const Vector x = row(p, away);
    double sum = 0;
    for (std::size_t i = 0; i < numbers; ++i) sum += x[i] * product(covariance[i], x);
    return sum;
  }
};

/// Least absolute deviations by reweighting (Schlossmacher 1973), down to a centimetre.
auto trend_of(const std::vector<const Station*>& stations) -> Trend {
  constexpr int rounds = 12;
  constexpr double least = 0.01;  // m
  // Slopes that nothing shows (across the only open wall) are 0: a slope of 1 is worth as much as a thousandth of all.
  constexpr double ridge = 1e-3;
  Trend out;
  double all = 0;
  for (const auto* s : stations)
    for (const auto& h : s->heights) out.middle = out.middle + h.weight * h.at, all += h.weight;
  out.middle = (1 / all) * out.middle;
  for (int round = 0; round < rounds; ++round) {
    Matrix m{};
    Vector right{};
    double sum = 0;
    for (const auto* s : stations)
      for (const auto& h : s->heights) {
        const Vector x = out.row(h.at, h.away);
        const double w = h.weight / (round == 0 ? 1 : std::max(least, std::abs(h.z - product(out.beta, x))));
        for (std::size_t i = 0; i < numbers; ++i) {
          right[i] += w * x[i] * h.z;
          for (std::size_t j = 0; j < numbers; ++j) m[i][j] += w * x[i] * x[j];
        }
        sum += w;
      }
    for (std::size_t i = 0; i < numbers; ++i) {
      right[i] /= sum;
      for (auto& entry : m[i]) entry /= sum;
      if (i > 0) m[i][i] += ridge;
    }
    out.covariance = inverse(m);
    for (std::size_t i = 0; i < numbers; ++i) out.beta[i] = product(out.covariance[i], right);
  }
  return out;
}

/// How the surface at a station departs from the trend: the mean, and its rise away from the wall, with those beside
/// it.
struct Departure {
  double mean = 0, rise = 0, away = 0;
};

auto departures_of(const std::vector<const Station*>& stations, const Trend& trend) -> std::vector<Departure> {
  std::vector<Departure> out(stations.size());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    double weight = 0, z = 0, away = 0, spread = 0, joint = 0;
    const auto each = [&](auto&& take) {
      for (std::size_t k = i == 0 ? 0 : i - 1; k <= i + 1 && k < stations.size(); ++k) {
        if (stations[k]->run != stations[i]->run) continue;
        if (geometry::length(stations[k]->middle() - stations[i]->middle()) > apart / 2) continue;
        for (const auto& h : stations[k]->heights) take(h, h.z - trend.at(h.at, h.away));
      }
    };
    each([&](const Height& h, double r) { weight += h.weight, z += h.weight * r, away += h.weight * h.away; });
    z /= weight, away /= weight;
    each([&](const Height& h, double r) {
      spread += h.weight * (h.away - away) * (h.away - away), joint += h.weight * (h.away - away) * (r - z);
    });
    // A quarter of the variance over the whole strip tells how the surface rises; steeper than 45° it is no ground.
    const bool told = spread > weight * strip * strip / 48;
    out[i] = {z, told ? std::clamp(joint / spread, -1.0, 1.0) : 0, away};
  }
  return out;
}

/// The mean square of a number of the departures, and how much of it places some way along the wall share.
struct Shared {
  double square = 0, share = 0;
  [[nodiscard]] auto own() const -> double { return (1 - share) * square; }
  /// What is left unknown of what is shared.
  [[nodiscard]] auto unknown() const -> double { return share * own(); }
};
auto shared(const std::vector<const Station*>& stations, const std::vector<Departure>& departures,
            double Departure::*number) -> Shared {
  Shared out;
  double products = 0, squares = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    out.square += departures[i].*number * departures[i].*number / static_cast<double>(stations.size());
    for (std::size_t k = i + 1; k < stations.size() && stations[k]->run == stations[i]->run; ++k) {
      if (geometry::length(stations[k]->middle() - stations[i]->middle()) < apart) continue;
      const double a = departures[i].*number, b = departures[k].*number;
      products += a * b, squares += (a * a + b * b) / 2;
      break;
    }
  }
  if (squares > 0) out.share = std::clamp(products / squares, 0.0, 1.0);
  return out;
}

auto found_in(const Stations& all) -> std::optional<TerrainFound> {
  std::vector<const Station*> stations;
  for (const auto& ring : all)
    for (const auto& station : ring)
      if (station.seen()) stations.push_back(&station);
  if (stations.empty()) return std::nullopt;
  const auto trend = trend_of(stations);
  const auto departures = departures_of(stations, trend);
  const auto mean = shared(stations, departures, &Departure::mean),
             rise = shared(stations, departures, &Departure::rise);
  double length = 0, sum = 0;
  TerrainFound out{std::numeric_limits<double>::infinity(), {}};
  out.walls.highest = -out.lowest;
  Point2 lowest;
  double away = 0, nearest = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto& s = *stations[i];
    const auto& d = departures[i];
    const double own = mean.share * d.mean - rise.share * d.rise * d.away;
    for (const Point2 p : {s.from, s.to}) {
      // No farther off what is seen next to it than a steep embankment (1 : 2) falls on the way to the wall.
      const auto& beside = s.heights.front();
      const double most = embankment * (beside.away + s.length());
      const double z = std::clamp(trend.at(p, 0) + own, beside.z - most, beside.z + most);
      if (z < out.lowest) out.lowest = z, lowest = p, away = d.away, nearest = s.heights.front().away;
      out.walls.highest = std::max(out.walls.highest, z);
      sum += s.length() * z / 2;
    }
    length += s.length();
  }
  out.walls.mean = sum / length;
  // Places 3 m apart are independent; four numbers are fitted to them.
  const double places = std::max(1.0, length / apart), left = std::max(1.0, places - static_cast<double>(numbers));
  // What departs as a whole moves the trend in the middle of the strip, what rises moves it on the way to the wall.
  const double fitted = (mean.own() * trend.variance(lowest, away) + rise.own() * away * away) / left;
  // Nobody sees the terrain between the strip and the wall: its slope may end anywhere there, or go on. The mean square
  // of what is evenly distributed between 0 and its most is a third of that squared.
  const double slope = geometry::length(Point2{trend.beta[1], trend.beta[2]}) + std::abs(trend.beta[3]);
  const double unseen = slope * nearest / std::sqrt(3.0);
  out.walls.error = std::sqrt(fitted + mean.unknown() + rise.unknown() * away * away + unseen * unseen);
  return out;
}

}  // namespace

auto terrain_at_walls(const std::vector<Polygon>& shape, const std::vector<Sample>& samples, const Options& options)
    -> std::optional<TerrainFound> {
  auto stations = stations_of(shape, options.terrain_step);
  add_heights(stations, shape, samples, options.overhang);
  leave_out_objects(stations, options.ground_percentile / 100);
  return found_in(stations);
}

auto terrain_at_walls(const std::vector<Polygon>& shape, const model::HeightGrid& terrain, Point3 origin,
                      const Options& options) -> std::optional<TerrainFound> {
  auto stations = stations_of(shape, options.terrain_step);
  double all = 0, seen = 0;
  for (auto& ring : stations)
    for (auto& station : ring) {
      all += station.length();
      const auto z = terrain.at(station.middle() + xy(origin));
      if (!z) continue;
      station.heights.push_back({station.middle(), 0, *z - origin.z, station.length()});
      seen += station.length();
    }
  if (!(seen > 0) || seen < options.terrain_share * all) return std::nullopt;
  leave_out_objects(stations, options.ground_percentile / 100);
  return found_in(stations);
}

}  // namespace mansard::block::detail
