#include "mansard/pipeline/detail/overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/report/measures.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Polygon;

/// A solid is compared with so many others in the source's order, and with every one that has as few: where many are
/// stacked on one place, the work grows with their number and not with that of their pairs.
constexpr std::size_t most_compared = 32;
/// m²: less is no reason to look at a building: 0.1 mm, the unit of the files, along a wall of 5 m. It is counted among
/// all overlaps.
constexpr double least_told = 5e-4;
/// So many overlaps are reported of a solid, the largest ones, and so many of the whole that could not be computed.
constexpr std::size_t most_reported = 20;

/// Its ground in the units of the files, 0.1 mm, in which coordinates are whole numbers and walls that coincide do so
/// exactly.
constexpr double units_per_metre = 1e4;

auto standing(std::size_t building, std::string name, const model::Solid& solid) -> Standing {
  Standing out{building, std::move(name), {}, {}};
  for (const auto& v : solid.vertices) {
    out.low = std::min(out.low, v.z);
    out.high = std::max(out.high, v.z);
  }
  for (const auto& face : solid.faces) {
    if (face.kind != model::FaceKind::base) continue;
    auto polygon = geometry::polygon_of(face.loops, [&](auto v) {
      return geometry::Point2{std::round(solid.vertices[v].x * units_per_metre),
                              std::round(solid.vertices[v].y * units_per_metre)};
    });
    out.box.include(geometry::bounds(polygon.outer));
    out.ground.push_back(geometry::oriented(std::move(polygon)));
  }
  return out;
}

/// In m. Walls that coincide share none: the library's predicates are exact, and it makes no corners where chains are
/// equal.
auto shared_ground(const Standing& a, const Standing& b) -> base::Result<std::vector<Polygon>> {
  std::vector<Polygon> out;
  for (const auto& p : a.ground)
    for (const auto& q : b.ground) {
      auto shared = geometry::intersect(p, q);
      if (!shared) return shared.failure();
      std::ranges::move(*shared, std::back_inserter(out));
    }
  const auto in_metres = [](geometry::Ring& ring) {
    for (auto& point : ring) point = (1 / units_per_metre) * point;
  };
  for (auto& polygon : out) {
    in_metres(polygon.outer);
    std::ranges::for_each(polygon.holes, in_metres);
  }
  return out;
}

/// Whether the insides of both boxes have something in common: neighbours with a common wall do not overlap.
auto may_overlap(const Extent& a, const Extent& b) -> bool {
  const auto common = [](double least_a, double most_a, double least_b, double most_b) {
    return std::min(most_a, most_b) > std::max(least_a, least_b);
  };
  return common(a.box.least.x, a.box.most.x, b.box.least.x, b.box.most.x) &&
         common(a.box.least.y, a.box.most.y, b.box.least.y, b.box.most.y) && common(a.low, a.high, b.low, b.high);
}

/// Two solids by their numbers, and what they share.
struct Pair {
  std::uint32_t first = 0, second = 0;
  double area = 0;                   ///< m² of ground
  std::vector<Polygon> ground = {};  ///< m
  std::string failure = {};          ///< why it could not be computed; empty where it could
};

/// The pairs to compare, in the source's order, and whether there may be others.
struct Candidates {
  std::vector<Pair> pairs;
  bool all = true;
};

auto candidates(const std::vector<Extent>& solids, const base::Run& run) -> Candidates {
  std::vector<geometry::Box2> boxes;
  boxes.reserve(solids.size());
  for (const Extent& solid : solids) boxes.push_back(solid.box);
  const geometry::BoxIndex index(boxes);
  std::vector<std::vector<std::uint32_t>> near(solids.size());
  base::parallel_for(solids.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    // Solids of one building with different bases are above each other; unite_parts() has compared them.
    const auto is_stacked = [&](std::uint32_t k) {
      return solids[i].building == solids[k].building && solids[i].low != solids[k].low;
    };
    const auto other = [&](std::uint32_t k) { return k != i && may_overlap(solids[i], solids[k]) && !is_stacked(k); };
    near[i] = index.first_overlapping(boxes[i], most_compared + 1, other);
  });
  Candidates out;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < near.size(); ++i) {
    if (near[i].size() > most_compared) {
      near[i].pop_back();
      out.all = false;
    }
    for (const auto k : near[i]) pairs.emplace_back(std::min(i, k), std::max(i, k));
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [first, second] : pairs) out.pairs.push_back({first, second});
  return out;
}

/// Small areas with the digits that they have.
auto text(double value) -> std::string { return base::to_text(value, value < 0.01 ? 7 : 3); }

auto height(const Extent& a, const Extent& b) -> double { return std::min(a.high, b.high) - std::max(a.low, b.low); }

/// The solids, and the names of those that are in pairs.
struct Named {
  const std::vector<Extent>& solids;
  std::map<std::uint32_t, std::string> names;
};

/// What is said of a solid because of another one.
auto said(const Pair& pair, const Named& all, std::uint32_t solid, std::uint32_t other) -> base::Diagnostic {
  const auto &of = all.names.at(solid), &with = all.names.at(other);
  if (!pair.failure.empty())
    return base::warning(
        "pipeline-overlap-unchecked",
        "whether it shares ground with " + with + " could not be computed (" + pair.failure + "); look at both", of);
  return base::warning("pipeline-overlap",
                       "it shares " + text(pair.area) + " m² of ground, and at most " +
                           text(pair.area * height(all.solids[solid], all.solids[other])) + " m³, with " + with,
                       of);
}

/// "at least " where not every pair was compared.
auto at_least(bool all) -> std::string { return all ? "" : "at least "; }

/// What is said of each solid: its largest overlaps, and the number of the others. In the order of the pairs; of two
/// solids of one building, only by the first.
auto said_of_each(const Named& named, const std::vector<Pair>& pairs, bool all) -> std::vector<Overlaps::Of> {
  const auto& solids = named.solids;
  std::vector<std::vector<std::uint32_t>> of(solids.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].failure.empty() && pairs[i].area < least_told) continue;
    of[pairs[i].first].push_back(i);
    if (solids[pairs[i].first].building != solids[pairs[i].second].building) of[pairs[i].second].push_back(i);
  }
  const auto volume = [&](std::uint32_t i) {
    const Pair& pair = pairs[i];
    if (!pair.failure.empty()) return std::numeric_limits<double>::infinity();
    return pair.area * height(solids[pair.first], solids[pair.second]);
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> told;  // a pair, and the solid of which it is told
  std::vector<Overlaps::Of> more;
  for (std::uint32_t s = 0; s < of.size(); ++s) {
    auto& own = of[s];
    if (const std::size_t count = own.size(); count > most_reported) {
      std::ranges::stable_sort(own, std::greater<>(), volume);
      own.resize(most_reported);
      more.push_back(
          {solids[s].building, base::warning("pipeline-overlap",
                                             "it overlaps " + at_least(all) + std::to_string(count - most_reported) +
                                                 " more solids, none of them by more; look for footprints that overlap",
                                             named.names.at(s))});
    }
    for (const auto i : own) told.emplace_back(i, s);
  }
  std::ranges::sort(told);
  std::vector<Overlaps::Of> out;
  for (const auto& [i, s] : told) {
    const auto other = pairs[i].first == s ? pairs[i].second : pairs[i].first;
    out.push_back({solids[s].building, said(pairs[i], named, s, other)});
  }
  std::ranges::move(more, std::back_inserter(out));
  return out;
}

/// What is said of the whole.
auto said_of_all(const Named& named, const std::vector<Pair>& pairs, bool all) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> out;
  const Pair* most = nullptr;
  double volume = 0;
  std::size_t known = 0, unknown = 0;
  for (const Pair& pair : pairs) {
    const Extent &a = named.solids[pair.first], &b = named.solids[pair.second];
    if (!pair.failure.empty()) {
      if (++unknown <= most_reported) out.push_back(said(pair, named, pair.first, pair.second));
      continue;
    }
    ++known;
    const double own = pair.area * height(a, b);
    if (most == nullptr || own > volume) most = &pair, volume = own;
  }
  if (unknown > most_reported)
    out.push_back(base::warning("pipeline-overlap-unchecked",
                                "the same of " + std::to_string(unknown - most_reported) + " more pairs of solids"));
  if (known > 0)
    out.push_back(base::warning("pipeline-overlap",
                                at_least(all) + std::to_string(known) + (known == 1 ? " pair" : " pairs") +
                                    " of solids overlap, by at most " + text(volume) +
                                    " m³: " + named.names.at(most->first) + " and " + named.names.at(most->second)));
  return out;
}

}  // namespace

auto standing(std::size_t number, const model::Building& building) -> std::vector<Standing> {
  std::vector<Standing> all;
  for (const auto& solid : building.solids)
    all.push_back(standing(number, building.parts[solid.parts.front()].id, solid.model.solid));
  return all;
}

auto extents(const std::vector<Standing>& solids) -> std::vector<Extent> {
  std::vector<Extent> out;
  std::uint32_t number = 0;
  for (const auto& solid : solids) {
    number = out.empty() || out.back().building != solid.building ? 0 : number + 1;
    out.push_back({static_cast<std::uint32_t>(solid.building), number, solid.box, solid.low, solid.high});
  }
  return out;
}

auto overlaps(const std::vector<model::Building>& buildings, const base::Run& run) -> Overlaps {
  std::vector<Extent> all;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    std::ranges::move(extents(standing(i, buildings[i])), std::back_inserter(all));
  return overlaps(
      all, [&](std::uint32_t building) { return standing(building, buildings[building]); }, run);
}

auto overlaps(const std::vector<Extent>& solids, const LoadStanding& load, const base::Run& run) -> Overlaps {
  auto [pairs, all] = candidates(solids, run);
  const auto loaded = [&](std::uint32_t i) -> base::Result<Standing> {
    auto of_building = load(solids[i].building);
    if (!of_building) return of_building.failure();
    return std::move((*of_building)[solids[i].solid]);
  };
  // Pairs of one solid follow each other: it is loaded once for all of them.
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (i == 0 || pairs[i].first != pairs[i - 1].first) starts.push_back(i);
  starts.push_back(pairs.size());
  base::parallel_for(starts.size() - 1, [&](std::size_t s) {
    if (run.cancelled()) return;
    const auto first = loaded(pairs[starts[s]].first);
    for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
      if (run.cancelled()) return;
      const auto second = loaded(pairs[i].second);
      auto ground = !first    ? base::Result<std::vector<Polygon>>(first.failure())
                    : !second ? base::Result<std::vector<Polygon>>(second.failure())
                              : shared_ground(*first, *second);
      if (ground) {
        for (const auto& polygon : *ground) pairs[i].area += geometry::area(polygon);
        pairs[i].ground = std::move(*ground);
      } else {
        pairs[i].failure = ground.error().message;
      }
    }
  });
  std::erase_if(pairs, [](const Pair& pair) { return pair.failure.empty() && pair.area == 0; });
  if (run.cancelled()) return {};
  Named named{solids, {}};
  for (const Pair& pair : pairs)
    for (const auto i : {pair.first, pair.second})
      if (auto& name = named.names[i]; name.empty())
        if (auto one = loaded(i)) name = std::move(one->name);
  Overlaps out{said_of_each(named, pairs, all), said_of_all(named, pairs, all), {}};
  for (Pair& pair : pairs)
    if (pair.failure.empty())
      out.pairs.push_back({named.names.at(pair.first), named.names.at(pair.second), pair.area,
                           height(solids[pair.first], solids[pair.second]), std::move(pair.ground)});
  return out;
}

void report_overlaps(report::Reconstruction& reconstruction, const base::Run& run) {
  auto [of_each, in_all, pairs] = overlaps(reconstruction.city.buildings, run);
  for (auto& [building, what] : of_each) {
    auto& reasons = reconstruction.buildings[building].reasons;
    reasons.push_back(std::move(what));
    report::set_reasons(reconstruction.city.buildings[building].attributes, reasons);
  }
  for (auto& warning : in_all) reconstruction.warnings.push_back(std::move(warning));
  reconstruction.overlaps = std::move(pairs);
}

}  // namespace mansard::pipeline::detail
