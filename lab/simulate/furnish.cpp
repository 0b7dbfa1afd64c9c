// The steps of real footprints with synthetic buildings on them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/base/stopped.hpp"
#include "mansard/geometry/angles.hpp"

#include "lab/simulate/detail/party.hpp"
#include "lab/simulate/detail/raising.hpp"
#include "lab/simulate/simulate.hpp"

namespace mansard::simulate {
namespace {

using detail::House;
using detail::Lot;
using detail::Raised;
using geometry::Point2;
using geometry::Polygon;

/// A plausible house over a real outline: its height by how large it is, its roof by its shape.
auto furnished(const model::Footprint& footprint, const Polygon& polygon, const std::vector<bool>& party,
               base::Random& random) -> House {
  House house;
  house.id = footprint.id;
  const double size = geometry::area(polygon), kind = random.uniform();
  const bool many_sided = polygon.outer.size() > 24 || !polygon.holes.empty();
  constexpr double shed = 40, large = 900;  // m²
  const int most = size < shed ? 1 : size < 150 ? 4 : 6;
  house.storeys = most == 1 ? 1 : 2 + static_cast<int>(random.index(static_cast<std::size_t>(most - 1)));
  Lot lot;
  lot.polygon = polygon;
  lot.eaves = 0.4 + house.storeys * random.uniform(2.8, 3.4);
  lot.upright = party;
  lot.roof = size > large || many_sided ? (kind < 0.7 ? detail::Roof::flat : detail::Roof::mansard)
             : kind < 0.35              ? detail::Roof::flat
             : kind < 0.6               ? detail::Roof::mansard
                                        : detail::Roof::pitched;
  lot.pitch =
      (lot.roof == detail::Roof::mansard ? random.uniform(20, 30) : random.uniform(25, 50)) * std::numbers::pi / 180;
  lot.gutter = random.uniform() < 0.25;
  if (std::ranges::find(party, false) == party.end()) lot.roof = detail::Roof::flat;
  lot.parapet = lot.roof == detail::Roof::flat && size >= shed;
  house.roof = lot.roof == detail::Roof::flat ? "flat" : lot.roof == detail::Roof::mansard ? "mansard" : "pitched";
  house.lots.push_back(std::move(lot));
  return house;
}

/// The same with a flat roof: where no other can be extruded.
auto flattened(House house) -> House {
  for (Lot& lot : house.lots) lot.roof = detail::Roof::flat, lot.parapet = false;
  house.roof = "flat";
  return house;
}

/// Per feature and edge of its outer ring: whether a neighbour stands along most of it.
auto party_edges(const model::Scene& scene) -> std::vector<std::vector<bool>> {
  constexpr double apart = 0.15, most_of_it = 0.5;  // m; of the edge
  std::vector<detail::Side> sides;
  std::vector<std::size_t> first;
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    first.push_back(sides.size());
    for (const auto& polygon : scene.footprints[f].polygons) detail::add_sides(polygon, f, sides);
  }
  std::vector<double> covered(sides.size(), 0);
  for (const auto& [a, b, line] : detail::shared_sides(sides, apart))
    for (const auto side : {a, b}) covered[side] += length(line.end - line.start);
  std::vector<std::vector<bool>> out;
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    auto& edges = out.emplace_back();
    if (scene.footprints[f].polygons.empty()) continue;
    for (std::size_t i = 0; i < scene.footprints[f].polygons.front().outer.size(); ++i) {
      const auto& line = sides[first[f] + i].line;
      edges.push_back(covered[first[f] + i] > most_of_it * length(line.end - line.start));
    }
  }
  return out;
}

/// Those of usable features.
auto furnished_houses(const model::Scene& scene, const BlockOptions& options, std::uint64_t seed,
                      std::vector<base::Diagnostic>& warnings) -> std::vector<House> {
  const auto party = party_edges(scene);
  const double bearing = options.turn.value_or(0);
  const Point2 uphill{geometry::cosine(bearing), geometry::sine(bearing)};
  std::vector<House> houses;
  for (std::size_t f = 0; f < scene.footprints.size(); ++f) {
    const auto& footprint = scene.footprints[f];
    if (footprint.defect) {
      warnings.push_back(*footprint.defect);
      warnings.back().severity = base::Severity::warning;
      continue;
    }
    base::Random random(seed, f);
    auto house = furnished(footprint, footprint.polygons.front(), party[f], random);
    house.ground = options.slope * dot(uphill, footprint.polygons.front().outer.front());
    // A feature of several polygons is as many parts of one height.
    for (std::size_t p = 1; p < footprint.polygons.size(); ++p) {
      Lot more = house.lots.front();
      more.polygon = footprint.polygons[p];
      more.upright.clear();
      house.lots.push_back(std::move(more));
    }
    houses.push_back(std::move(house));
  }
  return houses;
}

}  // namespace

auto furnish(const model::Scene& footprints, const BlockOptions& options, std::uint64_t seed,
             std::vector<base::Diagnostic>& warnings, const base::Run& run) -> base::Result<Truth> {
  const auto houses = furnished_houses(footprints, options, seed, warnings);
  std::vector<base::Result<Raised>> results(houses.size(), Raised{});
  base::parallel_for(houses.size(), [&](std::size_t i) {
    if (!run.cancelled()) results[i] = detail::raise_house(houses[i], run);
  });
  if (run.cancelled()) return base::stopped();
  std::vector<Raised> raised;
  for (std::size_t i = 0; i < houses.size(); ++i) {
    if (!results[i]) {
      warnings.push_back(base::warning("simulate-flat", "made flat: " + results[i].error().message, houses[i].id));
      results[i] = detail::raise_house(flattened(houses[i]), run);
    }
    if (results[i]) raised.push_back(std::move(*results[i]));
    else warnings.push_back(base::warning("simulate-left-out", results[i].error().message, houses[i].id));
  }
  if (raised.empty())
    return base::error("simulate-nothing",
                       "no footprint can be used; give some with area that do not cross themselves");
  auto truth = detail::truth_over(std::move(raised), run);
  truth.city.frame = footprints.frame;
  truth.city.made_by.inputs = footprints.inputs;
  return truth;
}

}  // namespace mansard::simulate
