#include "mansard/derive/detail/buildings.hpp"

#include <map>
#include <numeric>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/base/run.hpp"
#include "mansard/base/statistics.hpp"
#include "mansard/geometry/fit.hpp"

namespace mansard::derive::detail {
namespace {

struct Plane {
  double a = 0, b = 0, z = 0;  ///< z + a · columns + b · rows
  bool known = false;
};

/// Through the cell and those of its eight neighbours that stand too, by least squares.
auto plane_at(const Place& place, const Heights& top, const Mask& standing, std::size_t column, std::size_t row)
    -> Plane {
  geometry::PlaneSums sums;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const std::size_t i = place.index(column + static_cast<std::size_t>(dx), row + static_cast<std::size_t>(dy));
      if (standing[i] != 0) sums.add(dx, dy, top[i]);
    }
  if (sums.count < 4) return {};
  const auto equations = sums.centred();
  if (equations.determinant() < 0.5) return {};
  const auto plane = sums.plane(equations.slopes());
  return {plane.slope.x, plane.slope.y, plane.at_zero, true};
}

/// Grows one plane over the standing cells, from a seed on. It is fitted again each time it has doubled.
class Patch {
 public:
  Patch(const Place& place, const Heights& top, const std::vector<Plane>& planes, std::size_t seed,
        const Options& options)
      : options_(options), place_(place), top_(top), planes_(planes) {
    const Plane& own = planes[seed];
    a_ = own.a, b_ = own.b;
    c_ = own.z - a_ * column(seed) - b_ * row(seed);
  }
  [[nodiscard]] auto takes(std::size_t cell) const -> bool {
    const Plane& own = planes_[cell];
    if (!own.known) return false;
    const double squared = place_.cell * place_.cell, steep = 1 + (a_ * a_ + b_ * b_) / squared;
    const double off = top_[cell] - (a_ * column(cell) + b_ * row(cell) + c_);
    if (off * off > options_.plane_distance * options_.plane_distance * steep) return false;
    const double along = 1 + (a_ * own.a + b_ * own.b) / squared, other = 1 + (own.a * own.a + own.b * own.b) / squared;
    return along * along >= options_.plane_cosine * options_.plane_cosine * steep * other;
  }
  void add(std::size_t cell) {
    sums_.add(column(cell), row(cell), top_[cell]);
    if (sums_.count < next_fit_) return;
    next_fit_ *= 2;
    const auto equations = sums_.centred();
    if (equations.determinant() <= 1e-6 * equations.xx * equations.yy) return;
    const auto plane = sums_.plane(equations.slopes());
    a_ = plane.slope.x, b_ = plane.slope.y, c_ = plane.at_zero;
  }

 private:
  [[nodiscard]] auto column(std::size_t cell) const -> double { return static_cast<double>(cell % place_.columns); }
  [[nodiscard]] auto row(std::size_t cell) const -> double {
    const std::size_t row = cell / place_.columns;
    return static_cast<double>(row);
  }

  const Options& options_;
  const Place& place_;
  const Heights& top_;
  const std::vector<Plane>& planes_;
  double a_ = 0, b_ = 0, c_ = 0;
  geometry::PlaneSums sums_;
  double next_fit_ = 12;
};

/// How far the cell and its neighbours are off their plane, m²: the order in which cells are seeds.
auto unevenness(const Place& place, const Heights& top, const Mask& standing, const Plane& plane, std::size_t cell)
    -> double {
  double sum = 0;
  for_neighbours(place, cell, [&](std::size_t next) {
    if (standing[next] == 0) return;
    const double dx = static_cast<double>(next % place.columns) - static_cast<double>(cell % place.columns);
    const std::size_t row = next / place.columns, from = cell / place.columns;
    const double dy = static_cast<double>(row) - static_cast<double>(from);
    const double off = top[next] - plane.z - plane.a * dx - plane.b * dy;
    sum += off * off;
  });
  return sum / (1 + plane.a * plane.a + plane.b * plane.b);
}

/// Cells of the mask joined over sides where the heights differ by at most piece_step.
auto pieces_of(const Place& place, const Heights& top, const Mask& mask, const Options& o) -> Blobs {
  Blobs pieces;
  pieces.of.assign(place.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < mask.size(); ++first) {
    if (mask[first] == 0 || pieces.of[first] != 0) continue;
    const auto name = static_cast<std::int32_t>(pieces.size.size());
    pieces.size.push_back(0);
    pieces.of[first] = name;
    open.push_back(first);
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      ++pieces.size.back();
      for_neighbours(place, cell, [&](std::size_t next) {
        if (mask[next] == 0 || pieces.of[next] != 0 || std::abs(top[next] - top[cell]) > o.piece_step) return;
        pieces.of[next] = name;
        open.push_back(next);
      });
    }
  }
  return pieces;
}

/// The mean smoothness of each piece.
auto mean_of(const Blobs& pieces, const Heights& smooth) -> std::vector<double> {
  std::vector<double> sum(pieces.size.size(), 0);
  for (std::size_t i = 0; i < smooth.size(); ++i)
    if (pieces.of[i] != 0) sum[static_cast<std::size_t>(pieces.of[i])] += smooth[i];
  for (std::size_t p = 1; p < sum.size(); ++p) sum[p] /= static_cast<double>(pieces.size[p]);
  return sum;
}

/// The rims of pieces: what is not in a plane there is cornice, parapet or smoothed wall. Of a piece that is mostly
/// smooth, wider ones.
void reclaim(const Place& place, const Blobs& pieces, const std::vector<double>& mean, const Options& o,
             Mask& building) {
  std::size_t rounds = place.cells(o.wide_rim);
  const std::size_t narrow = place.cells(o.narrow_rim);
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < building.size(); ++i) {
      const auto piece = static_cast<std::size_t>(pieces.of[i]);
      if (building[i] != 0 || piece == 0 || (round >= narrow && mean[piece] < o.wide_rim_smooth * o.smooth)) continue;
      bool beside = false;
      for_neighbours(place, i, [&](std::size_t next) {
        beside = beside || (building[next] != 0 && pieces.of[next] == pieces.of[i]);
      });
      if (beside) found.push_back(i);
    }
    for (const std::size_t cell : found) building[cell] = 1;
  }
}

/// Small pieces are buildings where more of the judged cells beside them are than are not.
void judge_small(const Place& place, const Blobs& pieces, const std::vector<bool>& small, const Mask& standing,
                 std::size_t rounds, Mask& building) {
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<std::int64_t> votes(pieces.size.size(), 0);
    for (std::size_t i = 0; i < building.size(); ++i) {
      const auto piece = static_cast<std::size_t>(pieces.of[i]);
      if (piece == 0 || !small[piece]) continue;
      for_neighbours(place, i, [&](std::size_t next) {
        const auto other = static_cast<std::size_t>(pieces.of[next]);
        if (standing[next] == 0 || other == piece) return;
        if (building[next] != 0) ++votes[piece];
        else if (!small[other]) --votes[piece];
      });
    }
    for (std::size_t i = 0; i < building.size(); ++i) {
      const auto piece = static_cast<std::size_t>(pieces.of[i]);
      if (piece != 0 && small[piece]) building[i] = votes[piece] > 0 ? 1 : 0;
    }
  }
}

/// Blobs of fewer cells go, holes of fewer cells are closed.
void without_small(const Place& place, Mask& mask, double cells) {
  const auto blobs = blobs_of(place, mask);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] != 0 && static_cast<double>(blobs.size[static_cast<std::size_t>(blobs.of[i])]) < cells) mask[i] = 0;
  Mask rest(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) rest[i] = mask[i] != 0 ? 0 : 1;
  const auto holes = blobs_of(place, rest);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (rest[i] != 0 && static_cast<double>(holes.size[static_cast<std::size_t>(holes.of[i])]) < cells) mask[i] = 1;
}

/// Every cell of the mask without a number takes that of its neighbours, nearest first, of several the least.
void spread(const Place& place, const Mask& mask, std::vector<std::int32_t>& of) {
  for (bool more = true; more;) {
    more = false;
    std::vector<std::pair<std::size_t, std::int32_t>> found;
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (mask[i] == 0 || of[i] != 0) continue;
      std::int32_t least = 0;
      for_neighbours(place, i, [&](std::size_t next) {
        if (of[next] != 0 && (least == 0 || of[next] < least)) least = of[next];
      });
      if (least != 0) found.emplace_back(i, least);
    }
    for (const auto& [cell, number] : found) of[cell] = number, more = true;
  }
}

auto median_heights(const Heights& top, const std::vector<std::int32_t>& of, std::size_t count) -> std::vector<double> {
  std::vector<std::vector<float>> heights(count);
  for (std::size_t i = 0; i < of.size(); ++i)
    if (of[i] != 0 && !std::isnan(top[i])) heights[static_cast<std::size_t>(of[i])].push_back(top[i]);
  std::vector<double> out(count, 0);
  for (std::size_t b = 1; b < count; ++b) {
    if (heights[b].empty()) continue;
    out[b] = base::median(std::move(heights[b]));
  }
  return out;
}

/// Joins numbers that touch and differ by less than the step, nearest heights first.
auto joined(const Place& place, const std::vector<std::int32_t>& of, const std::vector<double>& height, double step)
    -> std::vector<std::int32_t> {
  base::DisjointSets sets(height.size());
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> touching;
  for (std::size_t i = 0; i < of.size(); ++i)
    for_neighbours(place, i, [&](std::size_t next) {
      if (of[i] != 0 && of[i] < of[next]) ++touching[{of[i], of[next]}];
    });
  for (const auto& [pair, sides] : touching) {
    const double difference =
        height[static_cast<std::size_t>(pair.first)] - height[static_cast<std::size_t>(pair.second)];
    if (std::abs(difference) >= step) continue;
    sets.join(static_cast<std::uint32_t>(pair.first), static_cast<std::uint32_t>(pair.second));
  }
  std::vector<std::int32_t> root;
  for (std::uint32_t number = 0; number < height.size(); ++number)
    root.push_back(static_cast<std::int32_t>(sets.of(number)));
  return root;
}

/// Numbers 1, 2 … without gaps, in the order of their first cell; returns how many there are, with 0.
auto renumbered(std::vector<std::int32_t>& of, const std::vector<std::int32_t>& root) -> std::size_t {
  std::vector<std::int32_t> name(root.size(), 0);
  std::int32_t last = 0;
  for (auto& number : of) {
    if (number == 0) continue;
    auto& own = name[static_cast<std::size_t>(root[static_cast<std::size_t>(number)])];
    if (own == 0) own = ++last;
    number = own;
  }
  return static_cast<std::size_t>(last) + 1;
}

}  // namespace

auto standing(const Heights& top, const Heights& ground, double above) -> Mask {
  Mask out(top.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = top[i] - ground[i] >= above ? 1 : 0;  // not so for NaN
  return out;
}

auto in_planes(const Place& place, const Heights& top, const Mask& standing, const Options& o) -> Mask {
  std::vector<Plane> planes(place.size());
  std::vector<float> uneven(place.size(), 0);
  base::parallel_for(place.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < place.columns; ++column) {
      const std::size_t i = place.index(column, row);
      if (standing[i] == 0) continue;  // never so in the rim
      planes[i] = plane_at(place, top, standing, column, row);
      uneven[i] = static_cast<float>(unevenness(place, top, standing, planes[i], i));
    }
  });
  std::vector<std::size_t> seeds;
  const double steep = o.plane_slope * o.plane_slope * place.cell * place.cell;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (planes[i].known && planes[i].a * planes[i].a + planes[i].b * planes[i].b <= steep) seeds.push_back(i);
  std::ranges::stable_sort(seeds, {}, [&](std::size_t i) { return uneven[i]; });

  Mask taken(place.size(), 0), out(place.size(), 0);
  std::vector<std::size_t> cells;
  for (const std::size_t seed : seeds) {
    if (taken[seed] != 0) continue;
    Patch patch(place, top, planes, seed, o);
    cells.assign(1, seed);
    taken[seed] = 1;
    for (std::size_t next = 0; next < cells.size(); ++next) {
      patch.add(cells[next]);
      for_neighbours(place, cells[next], [&](std::size_t other) {
        if (taken[other] != 0 || !patch.takes(other)) return;
        taken[other] = 1;
        cells.push_back(other);
      });
    }
    if (static_cast<double>(cells.size()) * place.cell * place.cell < o.plane_area) continue;
    for (const std::size_t cell : cells) out[cell] = 1;
  }
  return out;
}

auto smoothness(const Place& place, const Mask& standing, const Mask& planes, const Options& o) -> Heights {
  const std::vector<float> share(planes.begin(), planes.end()), counts(standing.begin(), standing.end());
  const auto reach = place.cells(o.smooth_radius);
  const auto total = sums(place, share, reach), count = sums(place, counts, reach);
  Heights out(place.size(), none);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (standing[i] != 0) out[i] = static_cast<float>(total[i] / count[i]);
  return out;
}

auto buildings(const Place& place, const Heights& top, const Mask& standing, const Mask& planes, const Options& o)
    -> Mask {
  const double area = place.cell * place.cell;
  const auto smooth = smoothness(place, standing, planes, o);
  const auto pieces = pieces_of(place, top, standing, o);
  const auto mean = mean_of(pieces, smooth);
  std::vector<bool> small(mean.size(), false);
  for (std::size_t p = 1; p < small.size(); ++p) small[p] = static_cast<double>(pieces.size[p]) * area < o.judged_area;

  // Cluttered places between smooth ones belong to the roof; a crown beside it is wider.
  Mask building(place.size(), 0);
  for (std::size_t i = 0; i < building.size(); ++i) building[i] = smooth[i] >= o.smooth ? 1 : 0;
  building = shrunk(place, grown(place, building, o.clutter_radius / place.cell), o.clutter_radius / place.cell);
  for (std::size_t i = 0; i < building.size(); ++i) {
    const auto piece = static_cast<std::size_t>(pieces.of[i]);
    if (piece == 0 || small[piece] || mean[piece] < o.smooth) building[i] = 0;
  }
  reclaim(place, pieces, mean, o, building);
  judge_small(place, pieces, small, standing, o.judged_rounds, building);
  without_small(place, building, o.least_area / area);
  const double narrow = o.minimum_width / 2 / place.cell;
  building = grown(place, shrunk(place, building, narrow), narrow);
  without_small(place, building, o.least_area / area);
  return building;
}

auto cut_at_steps(const Place& place, const Heights& top, const Mask& mask, const Options& options) -> Cut {
  Cut cut;
  auto pieces = pieces_of(place, top, mask, options);
  const double least = options.least_area / (place.cell * place.cell);
  std::vector<std::int32_t> own(pieces.size.size());
  std::iota(own.begin(), own.end(), 0);
  for (auto& piece : pieces.of)
    if (static_cast<double>(pieces.size[static_cast<std::size_t>(piece)]) < least) piece = 0;
  // A blob of small pieces alone is one all the same.
  spread(place, mask, pieces.of);
  const auto blobs = blobs_of(place, mask);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] != 0 && pieces.of[i] == 0) pieces.of[i] = static_cast<std::int32_t>(own.size()) + blobs.of[i] - 1;
  const std::size_t names = own.size() + blobs.size.size() - 1;

  const auto height = median_heights(top, pieces.of, names);
  const double step = options.step > 0 ? options.step : std::numeric_limits<double>::infinity();
  const auto count = renumbered(pieces.of, joined(place, pieces.of, height, step));
  cut.of = std::move(pieces.of);
  cut.height = median_heights(top, cut.of, count);
  return cut;
}

}  // namespace mansard::derive::detail
