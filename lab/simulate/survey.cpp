// The outlines as a surveyor draws them: merged, with eaves, generalised, a little off.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "mansard/geometry/angles.hpp"

#include "lab/simulate/detail/noise.hpp"
#include "lab/simulate/detail/raising.hpp"
#include "lab/simulate/simulate.hpp"

namespace mansard::simulate {
namespace {

using geometry::Point2;
using geometry::Polygon;
using geometry::Ring;

constexpr double least_drawn = 1.0;  // m²; nobody draws less

/// Which buildings are drawn as one: per building the lowest one of its feature. Buildings merge in pairs, never more.
auto features_of(const Truth& truth, double merged, std::uint64_t seed) -> std::vector<std::size_t> {
  std::vector<std::size_t> feature(truth.city.buildings.size());
  std::iota(feature.begin(), feature.end(), std::size_t{0});
  std::vector<bool> taken(feature.size(), false);
  for (const auto& wall : truth.party_walls) {
    const auto a = static_cast<std::int64_t>(wall.first), b = static_cast<std::int64_t>(wall.second);
    if (taken[wall.first] || taken[wall.second] || detail::drawn(seed, 1, a, b) >= merged) continue;
    taken[wall.first] = taken[wall.second] = true;
    feature[wall.second] = wall.first;
  }
  return feature;
}

/// Grown by the eaves where nobody else stands; whoever comes first takes what two could claim.
auto with_eaves(std::vector<std::vector<Polygon>> outlines, double eaves)
    -> base::Result<std::vector<std::vector<Polygon>>> {
  if (eaves <= 0) return outlines;
  auto boxes = std::vector<geometry::Box2>(outlines.size());
  for (std::size_t f = 0; f < outlines.size(); ++f) boxes[f] = geometry::bounds(outlines[f]);
  for (std::size_t f = 0; f < outlines.size(); ++f) {
    std::vector<Polygon> grown;
    for (const auto& polygon : outlines[f]) {
      auto more = geometry::buffer(polygon, eaves);
      if (!more) return more.error();
      grown.insert(grown.end(), more->begin(), more->end());
    }
    for (std::size_t g = 0; g < outlines.size(); ++g) {
      if (f == g || !boxes[f].grown(2 * eaves).overlaps(boxes[g])) continue;
      for (const auto& neighbour : outlines[g]) {
        std::vector<Polygon> left;
        for (const auto& polygon : grown) {
          auto rest = geometry::subtract(polygon, neighbour);
          if (!rest) return rest.error();
          left.insert(left.end(), rest->begin(), rest->end());
        }
        grown = std::move(left);
      }
    }
    std::erase_if(grown, [](const Polygon& p) { return geometry::area(p) < least_drawn; });
    outlines[f] = std::move(grown);
  }
  return outlines;
}

/// Without the corners that lie nearly on the line of their neighbours, the flattest first.
void generalise(Ring& ring, double tolerance) {
  while (ring.size() > 4) {
    std::size_t flattest = 0;
    double least = tolerance;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 before = ring[(i + ring.size() - 1) % ring.size()], after = ring[(i + 1) % ring.size()];
      if (const double off = geometry::distance({before, after}, ring[i]); off < least) least = off, flattest = i + 1;
    }
    if (flattest == 0) return;
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(flattest - 1));
  }
}

auto displacement_of(const SurveyOptions& options, std::uint64_t seed) -> Point2 {
  const double angle = options.direction.value_or(2 * std::numbers::pi * detail::drawn(seed, 2));
  return options.displacement * Point2{geometry::cosine(angle), geometry::sine(angle)};
}

/// By the place alone, to the centimetre: corners of neighbours that coincide stay together.
auto moved(Point2 p, const SurveyOptions& options, std::uint64_t seed) -> Point2 {
  const auto x = std::lround(p.x * 100), y = std::lround(p.y * 100);
  const double way = 2 * std::numbers::pi * detail::drawn(seed, 3, x, y);
  const double far = options.jitter * detail::drawn(seed, 4, x, y);
  return p + displacement_of(options, seed) + far * Point2{geometry::cosine(way), geometry::sine(way)};
}

/// What remains when outlines are drawn with less care than they were built: mostly one polygon.
auto drawn_outline(Polygon polygon, const SurveyOptions& options, std::uint64_t seed)
    -> base::Result<std::vector<Polygon>> {
  const auto draw = [&](Ring& ring) {
    generalise(ring, options.generalise);
    for (Point2& p : ring) p = moved(p, options, seed);
  };
  draw(polygon.outer);
  std::ranges::for_each(polygon.holes, draw);
  if (geometry::is_simple(polygon)) return std::vector{polygon};
  auto valid = geometry::make_valid(polygon);
  if (!valid) return valid.error();
  std::erase_if(*valid, [](const Polygon& p) { return geometry::area(p) < least_drawn; });
  return valid;
}

/// m above the ground, to 0.1 m: of the highest building of a feature.
auto height_of(const Truth& truth, const std::vector<std::size_t>& feature, std::size_t of) -> double {
  double high = 0;
  for (std::size_t b = of; b < feature.size(); ++b)
    if (feature[b] == of)
      for (const auto& part : truth.city.buildings[b].parts)
        for (const auto v : part.model.solid.vertices) high = std::max(high, v.z - truth.city.buildings[b].ground);
  constexpr double tenths = 10;
  return std::round(high * tenths) / tenths;
}

}  // namespace

auto offset_of(const SurveyOptions& options, std::uint64_t seed) -> Point2 {
  const auto by = displacement_of(options, seed);
  return {0 - by.x, 0 - by.y};
}

auto offset_spread(const SurveyOptions& options) -> double { return options.jitter / std::numbers::sqrt3; }

auto survey(const Truth& truth, const SurveyOptions& options, std::uint64_t seed)
    -> base::Result<std::vector<model::Footprint>> {
  const auto feature = features_of(truth, options.merged, seed);
  std::vector<model::Footprint> footprints;
  std::vector<std::vector<Polygon>> outlines;
  for (std::size_t f = 0; f < feature.size(); ++f) {
    if (feature[f] != f) continue;
    std::vector<Polygon> polygons;
    std::string buildings;
    for (std::size_t b = f; b < feature.size(); ++b) {
      if (feature[b] != f) continue;
      const auto& building = truth.city.buildings[b];
      polygons.insert(polygons.end(), building.footprint.begin(), building.footprint.end());
      buildings += (buildings.empty() ? "" : " ") + building.id;
    }
    auto outline = detail::outline_of(polygons);
    if (!outline) return outline.error();
    outlines.push_back(std::move(*outline));
    auto& footprint = footprints.emplace_back();
    footprint.id = truth.city.buildings[f].id;
    footprint.attributes = {{"id", footprint.id}, {"buildings", buildings}};
    if (options.heights) footprint.attributes.emplace_back("height", height_of(truth, feature, f));
  }
  auto drawn = with_eaves(std::move(outlines), options.eaves);
  if (!drawn) return drawn.error();
  for (std::size_t f = 0; f < footprints.size(); ++f) {
    for (auto& polygon : (*drawn)[f]) {
      const auto outline = drawn_outline(std::move(polygon), options, seed);
      if (!outline) return outline.error();
      footprints[f].polygons.insert(footprints[f].polygons.end(), outline->begin(), outline->end());
    }
  }
  return footprints;
}

}  // namespace mansard::simulate
