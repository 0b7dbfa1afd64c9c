// Where footprints are beside a scan: coarsely by the fall of the scan across their outlines, then by transects.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/accuracy/detail/transects.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/change.hpp"

namespace mansard::accuracy {
namespace {

using geometry::Point2;
using geometry::Polygon;

constexpr double lattice = 0.5;  // m between the heights, and between the offsets that are tried
constexpr double beside = 0.75;  // m; on both sides of an edge: beyond what a scan rounds
constexpr double storey = 3;     // m; a higher wall says no more
constexpr int reach = static_cast<int>(most_displaced / lattice);
constexpr int tried = 2 * reach + 1;

auto index(double metres) -> std::int64_t { return static_cast<std::int64_t>(std::floor(metres / lattice + 0.5)); }

/// Heights of a piece on a lattice at whole multiples of its step; NaN for none.
struct Lattice {
  std::int64_t column = 0, row = 0, columns = 0, rows = 0;
  std::vector<float> heights;

  Lattice(const rays::Scene& scene, const geometry::Box2& box) {
    column = index(box.least.x), row = index(box.least.y);
    columns = index(box.most.x) - column + 1, rows = index(box.most.y) - row + 1;
    heights.assign(static_cast<std::size_t>(columns * rows), std::numeric_limits<float>::quiet_NaN());
    base::parallel_for(static_cast<std::size_t>(rows), [&](std::size_t r) {
      for (std::int64_t c = 0; c < columns; ++c)
        if (const auto z = scene.top({static_cast<double>(column + c) * lattice,
                                      static_cast<double>(row + static_cast<std::int64_t>(r)) * lattice}))
          heights[r * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)] = static_cast<float>(*z);
    });
  }
  [[nodiscard]] auto at(std::int64_t c, std::int64_t r) const -> float {
    if (c < column || r < row || c >= column + columns || r >= row + rows)
      return std::numeric_limits<float>::quiet_NaN();
    return heights[static_cast<std::size_t>((r - row) * columns + (c - column))];
  }
};

/// By offset, the fall from inside to outside, m times m of outline.
auto falls_of(const Piece& piece) -> std::vector<double> {
  std::vector<double> out(static_cast<std::size_t>(tried) * tried, 0);
  const auto box = geometry::bounds(piece.outline);
  if (box.empty()) return out;
  const Lattice grid(*piece.scene, box.grown(most_displaced + 2 * beside));
  struct Side {
    std::int64_t column, row, outer_column, outer_row;
    double weight;
  };
  std::vector<Side> sides;
  const auto add = [&](const geometry::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], along = ring[(i + 1) % ring.size()] - a;
      const double far = length(along);
      if (far < 1) continue;
      const Point2 inward = geometry::left_of(normalised(along));
      const double count = std::floor(far);
      for (double k = 0; k < count; ++k) {
        const Point2 at = a + ((k + 0.5) / count) * along, in = at + beside * inward, outer = at - beside * inward;
        sides.push_back({index(in.x), index(in.y), index(outer.x), index(outer.y), far / count});
      }
    }
  };
  for (const auto& polygon : piece.outline) {
    add(polygon.outer);
    for (const auto& hole : polygon.holes) add(hole);
  }
  base::parallel_for(static_cast<std::size_t>(tried), [&](std::size_t j) {
    for (std::size_t i = 0; i < tried; ++i) {
      const auto dx = static_cast<std::int64_t>(i) - reach, dy = static_cast<std::int64_t>(j) - reach;
      double sum = 0;
      for (const auto& side : sides) {
        const auto fall = static_cast<double>(grid.at(side.column + dx, side.row + dy)) -
                          static_cast<double>(grid.at(side.outer_column + dx, side.outer_row + dy));
        if (std::isfinite(fall)) sum += side.weight * std::clamp(fall, -storey, storey);
      }
      out[j * tried + i] = sum;
    }
  });
  return out;
}

/// The offset with the largest fall; of equals the nearest.
auto steepest(std::span<const Piece> pieces) -> Point2 {
  // Summed in an order of their own, whatever the order of pieces.
  std::vector<std::vector<double>> each;
  for (const auto& piece : pieces) each.push_back(falls_of(piece));
  std::ranges::sort(each);
  std::vector<double> sum(static_cast<std::size_t>(tried) * tried, 0);
  for (const auto& one : each)
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += one[k];
  std::tuple<double, int, int, int> best{-1, 0, 0, 0};
  for (int j = 0; j < tried; ++j)
    for (int i = 0; i < tried; ++i) {
      const int dx = i - reach, dy = j - reach;
      best = std::max(best, std::tuple(sum[static_cast<std::size_t>(j * tried + i)], -(dx * dx + dy * dy), dx, dy));
    }
  return {lattice * std::get<2>(best), lattice * std::get<3>(best)};
}

/// Transects of several pieces as one.
struct Pooled {
  std::vector<detail::Transects> pieces;

  Pooled(std::span<const Piece> all, Point2 moved) {
    for (const auto& piece : all) {
      std::vector<Polygon> outline(piece.outline.begin(), piece.outline.end());
      for (auto& polygon : outline) geometry::move(polygon, moved);
      pieces.push_back(detail::across(outline, *piece.mesh, *piece.scene));
    }
  }
  [[nodiscard]] auto count() const -> std::size_t {
    std::size_t sum = 0;
    for (const auto& one : pieces) sum += one.transects.size();
    return sum;
  }
  [[nodiscard]] auto without(std::size_t left_out) const -> std::optional<detail::Offset> {
    detail::Transects all;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (p == left_out) continue;
      for (auto one : pieces[p].transects) {
        one.edge += all.edges.size();
        all.transects.push_back(one);
      }
      all.edges.insert(all.edges.end(), pieces[p].edges.begin(), pieces[p].edges.end());
    }
    return detail::offset_from(all);
  }
};

/// Standard error by leaving out each piece (M. Quenouille, Notes on bias in estimation, 1956; J. Tukey 1958): walls of
/// a piece may share what is wrong with its footprints.
auto jackknife(const Pooled& pooled) -> double {
  std::vector<Point2> each;
  for (std::size_t p = 0; p < pooled.pieces.size(); ++p)
    if (!pooled.pieces[p].transects.empty())
      if (const auto one = pooled.without(p)) each.push_back(one->offset);
  constexpr std::size_t fewest = 4;
  if (each.size() < fewest) return 0;
  Point2 mean;
  for (const auto& one : each) mean = mean + (1.0 / static_cast<double>(each.size())) * one;
  double sum = 0;
  for (const auto& one : each) sum += dot(one - mean, one - mean) / 2;  // of each coordinate
  return std::sqrt(sum * static_cast<double>(each.size() - 1) / static_cast<double>(each.size()));
}

}  // namespace

auto registration(std::span<const Piece> pieces) -> std::optional<Registration> {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<Piece> sorted(pieces.begin(), pieces.end());
  std::ranges::sort(sorted, [](const Piece& a, const Piece& b) {
    return std::ranges::lexicographical_compare(a.outline, b.outline, [](const auto& p, const auto& q) {
      return std::tie(p.outer, p.holes) < std::tie(q.outer, q.holes);
    });
  });
  Pooled pooled(sorted, {});
  Point2 moved;
  if (const Point2 coarse = steepest(sorted); length(coarse) > lattice) {
    // Counts of walls that were met or not: a difference of three standard deviations (Poisson).
    Pooled there(sorted, coarse);
    const auto here_met = static_cast<double>(pooled.count()), there_met = static_cast<double>(there.count());
    if (there_met - here_met > 3 * std::sqrt(there_met + here_met)) {
      pooled = std::move(there);
      moved = coarse;
    }
  }
  auto found = pooled.without(none);
  if (!found) return std::nullopt;
  // A second time from where the first one leads: the fit of walls near the ends of what is looked at is cut off.
  constexpr double far = 0.25;  // m
  if (length(found->offset) > far) {
    Pooled again(sorted, moved + found->offset);
    if (const auto nearer = again.without(none)) {
      moved = moved + found->offset;
      found = nearer;
      pooled = std::move(again);
    }
  }
  return Registration{moved + found->offset, std::max(found->error, jackknife(pooled)), found->spread, found->edges,
                      pooled.count()};
}

}  // namespace mansard::accuracy
