#include "apps/server/review_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mansard/base/run.hpp"
#include "mansard/evaluate/walls.hpp"

namespace mansard::server {
namespace {

/// Side of the square over which a difference is averaged: single points and the smear of a wall are narrower, dormers
/// and chimneys that a model should have are not.
constexpr double look_side = 1.0;  // m
// From the outline, m: where confidence looks for a building that is elsewhere or of another size (confidence.md).
constexpr double rim_from = 0.25, rim_to = 1, ring_from = 0.5, ring_to = 1.25;

constexpr double nothing = evaluate::HeightCells::outside;

/// Values are made by `see(point)`.
template <class See>
auto looked_over(const Looked& looked, double around, See see) -> HeightsOver {
  // A hall is looked at more coarsely: so many places are enough to find the worst one.
  constexpr double most_places = 20'000;
  const auto box = geometry::bounds(looked.footprint).grown(around);
  const auto size = box.most - box.least;
  HeightsOver out;
  out.grid = std::max(looked.options.grid, std::sqrt(size.x * size.y / most_places));
  out.origin = {out.grid * std::floor(box.least.x / out.grid), out.grid * std::floor(box.least.y / out.grid)};
  out.columns = static_cast<std::size_t>(size.x / out.grid) + 2;
  out.rows = static_cast<std::size_t>(size.y / out.grid) + 2;
  out.over.assign(out.columns * out.rows, nothing);
  base::parallel_for(out.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < out.columns; ++column)
      out.over[row * out.columns + column] = see(out.at(column, row));
  });
  return out;
}

auto difference_at(const Looked& looked, geometry::Point2 at) -> double {
  const auto z = looked.scan.top(at);
  return z ? looked.model.top(at).value_or(looked.ground) - *z : nothing;
}

auto from_outline(const Looked& looked, geometry::Point2 at) -> double {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& polygon : looked.footprint) least = std::min(least, geometry::boundary_distance(polygon, at));
  return least;
}

auto differences_inside(const Looked& looked) -> HeightsOver {
  return looked_over(looked, 0, [&](geometry::Point2 at) {
    if (!geometry::contains(looked.footprint, at)) return nothing;
    const double from = from_outline(looked, at);
    return from >= rim_from && from <= rim_to ? difference_at(looked, at) : nothing;
  });
}

auto differences_outside(const Looked& looked) -> HeightsOver {
  return looked_over(looked, ring_to, [&](geometry::Point2 at) {
    if (geometry::contains(looked.footprint, at) || geometry::contains(looked.others, at)) return nothing;
    const double from = from_outline(looked, at);
    return from >= ring_from && from <= ring_to ? difference_at(looked, at) : nothing;
  });
}

struct Largest {
  geometry::Point2 at;
  double difference = 0;  ///< m
};
auto largest_in_squares(const HeightsOver& all, std::size_t side) -> std::optional<Largest> {
  std::optional<Largest> best;
  for (std::size_t row = 0; row + side <= all.rows; ++row)
    for (std::size_t column = 0; column + side <= all.columns; ++column) {
      double sum = 0;  // NaN where one of them has no value
      for (std::size_t r = row; r < row + side; ++r)
        for (std::size_t c = column; c < column + side; ++c) sum += all.over[r * all.columns + c];
      const double mean = sum / static_cast<double>(side * side);
      if (!std::isfinite(mean) || (best && std::abs(mean) <= std::abs(best->difference))) continue;
      const double half = 0.5 * static_cast<double>(side - 1) * all.grid;
      const auto corner = all.at(column, row);
      best = Largest{{corner.x + half, corner.y + half}, mean};
    }
  return best;
}

/// In smaller squares where no larger one has values everywhere.
auto largest_of(const HeightsOver& all, const Looked& looked, Doubted what) -> std::optional<Place> {
  for (auto side = std::max<std::size_t>(1, static_cast<std::size_t>(std::round(look_side / all.grid))); side > 0;
       side /= 2)
    if (const auto found = largest_in_squares(all, side)) {
      const double z = looked.scan.top(found->at).value_or(looked.ground);
      return Place{{found->at.x, found->at.y, z}, what, found->difference};
    }
  return std::nullopt;
}

/// Of the whole footprint, beside walls too.
auto differences_and_walls(const Looked& looked) -> HeightsOver {
  return looked_over(looked, 0, [&](geometry::Point2 at) {
    return geometry::contains(looked.footprint, at) ? difference_at(looked, at) : nothing;
  });
}

/// The point without a scan that is nearest to the middle of all of them.
auto middle_of_unseen(const Looked& looked) -> std::optional<Place> {
  constexpr double is_unseen = 0;
  const auto cells = looked_over(looked, 0, [&](geometry::Point2 at) {
    return geometry::contains(looked.footprint, at) && !looked.scan.top(at) ? is_unseen : nothing;
  });
  std::vector<geometry::Point2> points;
  geometry::Point2 middle;
  for (std::size_t row = 0; row < cells.rows; ++row)
    for (std::size_t column = 0; column < cells.columns; ++column)
      if (!std::isnan(cells.over[row * cells.columns + column])) {
        points.push_back(cells.at(column, row));
        middle = middle + points.back();
      }
  if (points.empty()) return std::nullopt;
  middle = 1.0 / static_cast<double>(points.size()) * middle;
  const auto at = *std::ranges::min_element(
      points, {}, [&](geometry::Point2 p) { return std::hypot(p.x - middle.x, p.y - middle.y); });
  return Place{{at.x, at.y, looked.model.top(at).value_or(looked.ground)}, Doubted::unseen, {}};
}

}  // namespace

auto differences_on_roof(const Looked& looked) -> HeightsOver {
  auto out = differences_and_walls(looked);
  const auto built = looked_over(looked, 0, [&](geometry::Point2 at) {
    return geometry::contains(looked.footprint, at) ? looked.model.top(at).value_or(looked.ground) : nothing;
  });
  const auto kept = evaluate::away_from_walls({out.columns, out.rows, out.grid, built.over}, looked.options.inset);
  for (std::size_t cell = 0; cell < kept.size(); ++cell)
    if (!kept[cell]) out.over[cell] = nothing;
  return out;
}

auto place_of(std::string_view reason, const Looked& looked) -> std::optional<Place> {
  std::optional<Place> found;
  if (reason == "confidence-beside") found = largest_of(differences_outside(looked), looked, Doubted::outside);
  if (reason == "confidence-rim") found = largest_of(differences_inside(looked), looked, Doubted::inside);
  if (reason == "confidence-walls") found = largest_of(differences_and_walls(looked), looked, Doubted::roof);
  if (reason == "confidence-unseen") found = middle_of_unseen(looked);
  return found ? found : largest_of(differences_on_roof(looked), looked, Doubted::roof);
}

}  // namespace mansard::server
