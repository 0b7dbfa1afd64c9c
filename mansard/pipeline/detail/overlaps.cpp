#include "mansard/pipeline/detail/overlaps.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/geometry/change.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Polygon;

/// A part as it stands on the ground.
struct Standing {
  std::size_t order = 0, building = 0;
  const model::Part* part = nullptr;
  std::vector<Polygon> ground;
  geometry::Box2 box;
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

auto standing(std::size_t order, std::size_t building, const model::Part& part) -> Standing {
  Standing out{order, building, &part, {}, {}};
  const auto& solid = part.model.solid;
  for (const auto& v : solid.vertices) {
    out.low = std::min(out.low, v.z);
    out.high = std::max(out.high, v.z);
  }
  for (const auto& face : solid.faces) {
    if (face.kind != model::FaceKind::base) continue;
    auto polygon = geometry::polygon_of(face.loops, [&](auto v) { return geometry::xy(solid.vertices[v]); });
    out.box.include(geometry::bounds(polygon.outer));
    out.ground.push_back(geometry::oriented(std::move(polygon)));
  }
  return out;
}

/// m²; strips no wider than rounding and straightening leave them are not counted.
auto shared_ground(const Standing& a, const Standing& b) -> base::Result<double> {
  constexpr double narrow = 1e-3;  // m, on average
  double sum = 0;
  for (const auto& p : a.ground)
    for (const auto& q : b.ground) {
      const auto shared = geometry::intersect(p, q);
      if (!shared) return shared.failure();
      for (const auto& polygon : *shared) {
        const double area = geometry::area(polygon);
        if (2 * area > narrow * geometry::perimeter(polygon.outer)) sum += area;
      }
    }
  return sum;
}

/// Among the reasons of both buildings, and of the whole.
void report_unchecked(const Standing& a, const Standing& b, const base::Diagnostic& why,
                      report::Reconstruction& reconstruction) {
  const auto between = [&](const Standing& one, const Standing& other) {
    return base::warning("pipeline-overlap-unchecked",
                         "whether it shares ground with " + other.part->id + " could not be computed (" + why.message +
                             "); look at both",
                         one.part->id);
  };
  reconstruction.buildings[a.building].reasons.push_back(between(a, b));
  if (a.building != b.building) reconstruction.buildings[b.building].reasons.push_back(between(b, a));
  reconstruction.warnings.push_back(between(a, b));
}

}  // namespace

void report_overlaps(report::Reconstruction& reconstruction) {
  std::vector<Standing> all;
  for (std::size_t i = 0; i < reconstruction.city.buildings.size(); ++i)
    for (const auto& part : reconstruction.city.buildings[i].parts) all.push_back(standing(all.size(), i, part));
  std::ranges::stable_sort(all, {}, [](const Standing& s) { return s.box.least.x; });

  struct Pair {
    const Standing *a, *b;
    std::size_t number = 0;  // of its area
  };
  std::vector<Pair> pairs;
  std::vector<std::size_t> open;  // those that reach as far as the next begins
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::erase_if(open, [&](std::size_t k) { return all[k].box.most.x < all[i].box.least.x; });
    for (const std::size_t k : open)
      if (all[k].box.overlaps(all[i].box) && std::min(all[k].high, all[i].high) > std::max(all[k].low, all[i].low))
        pairs.push_back({&all[k], &all[i], pairs.size()});
    open.push_back(i);
  }
  std::vector<base::Result<double>> areas(pairs.size(), 0.0);
  base::parallel_for(pairs.size(), [&](std::size_t i) { areas[i] = shared_ground(*pairs[i].a, *pairs[i].b); });
  std::erase_if(pairs, [&](const Pair& pair) { return areas[pair.number] && *areas[pair.number] == 0; });
  // By the source's order, not by place.
  for (auto& pair : pairs)
    if (pair.b->order < pair.a->order) std::swap(pair.a, pair.b);
  std::ranges::sort(pairs, {}, [](const Pair& pair) { return std::pair(pair.a->order, pair.b->order); });

  double most = 0;
  std::size_t known = 0;
  std::string where;
  for (const auto& [a, b, number] : pairs) {
    const auto& shared = areas[number];
    if (!shared) {
      report_unchecked(*a, *b, shared.error(), reconstruction);
      continue;
    }
    ++known;
    const double area = *shared;
    const double height = std::min(a->high, b->high) - std::max(a->low, b->low);
    const auto tell = [&](const Standing& one, const Standing& other) {
      reconstruction.buildings[one.building].reasons.push_back(
          base::warning("pipeline-overlap",
                        "it shares " + base::to_text(area, 3) + " m² of ground, and at most " +
                            base::to_text(area * height, 3) + " m³, with " + other.part->id,
                        one.part->id));
    };
    tell(*a, *b);
    if (a->building != b->building) tell(*b, *a);
    if (area * height <= most) continue;
    most = area * height;
    where = a->part->id + " and " + b->part->id;
  }
  if (known > 0)
    reconstruction.warnings.push_back(base::warning(
        "pipeline-overlap", std::to_string(known) + (known == 1 ? " pair" : " pairs") +
                                " of solids overlap, by at most " + base::to_text(most, 3) + " m³: " + where));
}

}  // namespace mansard::pipeline::detail
