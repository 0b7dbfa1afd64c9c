#include "mansard/pipeline/detail/overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/geometry/change.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Polygon;

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

/// m². Walls that coincide share none: the library's predicates are exact, and it makes no corners where chains are
/// equal.
auto shared_ground(const Standing& a, const Standing& b) -> base::Result<double> {
  double sum = 0;
  for (const auto& p : a.ground)
    for (const auto& q : b.ground) {
      const auto shared = geometry::intersect(p, q);
      if (!shared) return shared.failure();
      for (const auto& polygon : *shared) sum += geometry::area(polygon);
    }
  return sum / (units_per_metre * units_per_metre);
}

struct Ordered : Standing {
  std::size_t order = 0;  ///< by building
};

/// Small areas with the digits that they have.
auto text(double value) -> std::string { return base::to_text(value, value < 0.01 ? 7 : 3); }

}  // namespace

auto standing(std::size_t number, const model::Building& building) -> std::vector<Standing> {
  std::vector<Standing> all;
  for (const auto& solid : building.solids)
    all.push_back(standing(number, building.parts[solid.parts.front()].id, solid.model.solid));
  return all;
}

auto overlaps(const std::vector<model::Building>& buildings) -> std::vector<Overlap> {
  std::vector<Standing> all;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    std::ranges::move(standing(i, buildings[i]), std::back_inserter(all));
  return overlaps(std::move(all));
}

auto overlaps(std::vector<Standing> in_order) -> std::vector<Overlap> {
  std::vector<Ordered> all;
  for (auto& one : in_order) all.push_back({std::move(one), all.size()});
  std::ranges::stable_sort(all, {}, [](const Standing& s) { return s.box.least.x; });

  struct Pair {
    const Ordered *a, *b;
  };
  std::vector<Pair> pairs;
  std::vector<std::size_t> open;  // those that reach as far as the next begins
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::erase_if(open, [&](std::size_t k) { return all[k].box.most.x < all[i].box.least.x; });
    for (const std::size_t k : open)
      if (all[k].box.overlaps(all[i].box) && std::min(all[k].high, all[i].high) > std::max(all[k].low, all[i].low))
        pairs.push_back({&all[k], &all[i]});
    open.push_back(i);
  }
  // By the source's order, not by place.
  for (auto& pair : pairs)
    if (pair.b->order < pair.a->order) std::swap(pair.a, pair.b);
  std::ranges::sort(pairs, {}, [](const Pair& pair) { return std::pair(pair.a->order, pair.b->order); });
  std::vector<base::Result<double>> areas(pairs.size(), 0.0);
  base::parallel_for(pairs.size(), [&](std::size_t i) { areas[i] = shared_ground(*pairs[i].a, *pairs[i].b); });

  std::vector<Overlap> out;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [a, b] = pairs[i];
    if (areas[i] && *areas[i] == 0) continue;
    const double height = std::min(a->high, b->high) - std::max(a->low, b->low);
    Overlap& one = out.emplace_back();
    one.building = a->building, one.other = b->building;
    const auto said = [&](const Standing& of, const Standing& with) {
      if (!areas[i])
        return base::warning("pipeline-overlap-unchecked",
                             "whether it shares ground with " + with.name + " could not be computed (" +
                                 areas[i].error().message + "); look at both",
                             of.name);
      return base::warning("pipeline-overlap",
                           "it shares " + text(*areas[i]) + " m² of ground, and at most " + text(*areas[i] * height) +
                               " m³, with " + with.name,
                           of.name);
    };
    one.first = said(*a, *b);
    one.second = said(*b, *a);
    if (areas[i]) one.volume = *areas[i] * height;
  }
  return out;
}

auto overlaps_in_all(const std::vector<Overlap>& overlaps) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> out;
  const Overlap* most = nullptr;
  std::size_t known = 0;
  for (const Overlap& one : overlaps) {
    if (!one.volume) {
      out.push_back(one.first);
      continue;
    }
    ++known;
    if (most == nullptr || *one.volume > *most->volume) most = &one;
  }
  if (known > 0)
    out.push_back(base::warning("pipeline-overlap", std::to_string(known) + (known == 1 ? " pair" : " pairs") +
                                                        " of solids overlap, by at most " + text(*most->volume) +
                                                        " m³: " + most->first.subject + " and " +
                                                        most->second.subject));
  return out;
}

void report_overlaps(report::Reconstruction& reconstruction) {
  const auto found = overlaps(reconstruction.city.buildings);
  for (const Overlap& one : found) {
    reconstruction.buildings[one.building].reasons.push_back(one.first);
    if (one.building != one.other) reconstruction.buildings[one.other].reasons.push_back(one.second);
  }
  for (auto& warning : overlaps_in_all(found)) reconstruction.warnings.push_back(std::move(warning));
}

}  // namespace mansard::pipeline::detail
