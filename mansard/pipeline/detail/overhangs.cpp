#include "mansard/pipeline/detail/overhangs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mansard/base/text.hpp"
#include "mansard/geometry/box_index.hpp"
#include "mansard/geometry/change.hpp"
#include "mansard/profile/overhang.hpp"
#include "mansard/solid/eaves.hpp"

namespace mansard::pipeline::detail {
namespace {

using geometry::Point2;
using geometry::Polygon;
using model::Plan;
using model::PlanRing;

constexpr double centimetres = 100;    // plans have overhangs in whole ones
constexpr double same_gutter = 0.005;  // m; of edges that have one row of eaves
constexpr double no_area = 1e-3;       // m²; what neighbours share by rounding
constexpr double touching = 0.02;      // m; at the ends of a wall, where a neighbour begins

auto ring_of(Plan& plan, std::size_t r) -> PlanRing& { return r == 0 ? plan.outer : plan.holes[r - 1]; }

/// The gutter of an edge and its pitch; no pitch where no roof rises from the top of a vertical wall.
struct Roofed {
  double gutter = 0, pitch = 0;
};
auto roofed(const Plan& plan, const PlanRing& ring, std::size_t i) -> Roofed {
  const auto& profile = plan.profiles[ring.profile_of_edge[i]];
  if (profile.size() < 3 || profile[1].inward > 0 || !(profile[2].inward > 0)) return {};
  return {profile[1].height, (profile[2].height - profile[1].height) / profile[2].inward};
}
auto length_of(const PlanRing& ring, std::size_t i) -> double {
  return length(ring.points[(i + 1) % ring.points.size()] - ring.points[i]);
}

/// Eaves that go around a corner at one height are one row with one soffit: where most of its length was measured,
/// all of it overhangs, each edge as its pitch has it.
void level_rows(const Plan& plan, const PlanRing& ring, std::vector<double>& overhangs, double share) {
  const std::size_t n = ring.points.size();
  const auto goes_on = [&](std::size_t i) {
    const auto a = roofed(plan, ring, i), b = roofed(plan, ring, (i + 1) % n);
    return a.pitch > 0 && b.pitch > 0 && std::abs(a.gutter - b.gutter) < same_gutter;
  };
  std::size_t first = 0;
  while (first < n && goes_on((first + n - 1) % n)) ++first;
  if (first == n) first = 0;  // around
  for (std::size_t k = 0; k < n;) {
    std::vector<std::size_t> row{(first + k) % n};
    while (row.size() < n - k && goes_on(row.back())) row.push_back((row.back() + 1) % n);
    k += row.size();
    double all = 0, seen = 0, drop = 0;
    for (const auto i : row) {
      const double far = length_of(ring, i);
      all += far;
      if (overhangs[i] > 0) seen += far, drop += far * overhangs[i] * roofed(plan, ring, i).pitch;
    }
    if (seen == 0 || seen < share * all) continue;
    for (const auto i : row) overhangs[i] = drop / seen / roofed(plan, ring, i).pitch;
  }
}

auto metres_in_words(double metres) -> std::string { return base::to_text(metres, 2); }

/// What the eaves of a building must not reach into: the ground of other features.
struct Others {
  std::vector<Polygon> grounds;
  std::vector<std::size_t> features;  ///< by ground
  geometry::BoxIndex index;
};
auto others_of(const std::vector<PartResult>& parts) -> Others {
  std::vector<Polygon> grounds;
  std::vector<std::size_t> features;
  std::vector<geometry::Box2> boxes;
  for (const auto& part : parts) {
    grounds.push_back(geometry::oriented(model::polygon_of(part.plan)));
    features.push_back(part.feature);
    boxes.push_back(geometry::bounds(grounds.back().outer));
  }
  return {std::move(grounds), std::move(features), geometry::BoxIndex(boxes)};
}

/// Calls meet(shared) with what the polygon shares with the ground of other features. Where that cannot be computed,
/// it shares all.
template <class Meet>
void each_shared(const Polygon& polygon, std::size_t feature, const Others& others, Meet meet) {
  const auto box = geometry::bounds(polygon.outer);
  for (const auto o : others.index.overlapping(box)) {
    if (others.features[o] == feature) continue;
    const auto shared = geometry::intersect(polygon, others.grounds[o]);
    if (!shared) return meet(polygon);
    for (const auto& piece : *shared)
      if (geometry::area(piece) > no_area) meet(piece);
  }
}

/// The overhang that is left before the nearest ground of another feature.
auto cut_back(Point2 a, Point2 b, double overhang, std::size_t feature, const Others& others) -> double {
  const double far = length(b - a);
  if (far < 4 * touching) return overhang;
  const Point2 along = (1 / far) * (b - a), out{along.y, -along.x};
  const Point2 from = a + touching * along, to = b - touching * along;
  const Polygon strip{{from, from + overhang * out, to + overhang * out, to}, {}};
  double left = overhang;
  each_shared(geometry::oriented(strip), feature, others, [&](const Polygon& piece) {
    for (const Point2 p : piece.outer) left = std::min(left, dot(p - a, out) - 1 / centimetres);
  });
  return left;
}

/// The ground below soffits, in plan.
auto soffits_of(const SolidsOf& made) -> std::vector<Polygon> {
  std::vector<Polygon> out;
  for (const auto& one : made.solids)
    for (std::size_t f = 0; f < one.model.solid.faces.size(); ++f)
      if (one.model.classes[f] == model::FaceClass::soffit)
        out.push_back(geometry::oriented(geometry::polygon_of(
            one.model.solid.faces[f].loops, [&](std::uint32_t v) { return xy(one.model.solid.vertices[v]); })));
  return out;
}

/// One feature: its parts, and the solids that it has without eaves.
struct Building {
  std::size_t feature = 0;
  std::vector<PartResult*> parts;
  SolidsOf* solids = nullptr;
};

auto with_plans(const Building& building) -> SolidsOf {
  std::vector<const Plan*> plans;
  for (const PartResult* part : building.parts) plans.push_back(&part->plan);
  return with_eaves(*building.solids, plans);
}

/// Whether the soffits stay clear of other features, and of the soffits that these have already.
auto stays_clear(const SolidsOf& made, std::size_t feature, const Others& others, const std::vector<Polygon>& taken)
    -> bool {
  bool clear = true;
  for (const auto& soffit : soffits_of(made)) {
    each_shared(soffit, feature, others, [&](const Polygon&) { clear = false; });
    for (const auto& other : taken) {
      const auto shared = geometry::intersect(soffit, other);
      if (!shared) return false;
      for (const auto& piece : *shared) clear = clear && geometry::area(piece) <= no_area;
    }
  }
  return clear;
}

/// Overhangs of the plan's edges to nothing where no soffit of the solids is beside them: the plan says what is made.
void keep_made(Plan& plan, const std::vector<Polygon>& soffits) {
  for (std::size_t r = 0; r <= plan.holes.size(); ++r) {
    auto& ring = ring_of(plan, r);
    for (std::size_t i = 0; i < ring.overhang_of_edge.size(); ++i) {
      double& overhang = ring.overhang_of_edge[i];
      if (overhang == 0) continue;
      const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.points.size()];
      const double far = length(b - a);
      if (!(far > 0)) continue;
      const Point2 along = (1 / far) * (b - a), out{along.y, -along.x};
      const Polygon strip = geometry::oriented({{a, a + overhang * out, b + overhang * out, b}, {}});
      double area = 0;
      for (const auto& soffit : soffits)
        if (const auto shared = geometry::intersect(strip, soffit))
          for (const auto& piece : *shared) area += geometry::area(piece);
      if (area < 0.1 * far * overhang) overhang = 0;
    }
    if (std::ranges::all_of(ring.overhang_of_edge, [](double o) { return o == 0; })) ring.overhang_of_edge.clear();
  }
}

auto words_of(PartResult& part, bool made, double cut) -> std::string {
  const auto& eaves = part.eaves;
  std::string words = "eaves overhang by " + metres_in_words(eaves.area / eaves.overhanging) + " m along " +
                      metres_in_words(eaves.overhanging) + " of " + metres_in_words(eaves.length) + " m";
  if (!made) return words;
  double whole = 0;
  for (std::size_t r = 0; r <= part.plan.holes.size(); ++r) {
    const auto& ring = ring_of(part.plan, r);
    for (std::size_t i = 0; i < ring.overhang_of_edge.size(); ++i)
      if (ring.overhang_of_edge[i] > 0) whole += length_of(ring, i);
  }
  words += "; soffits along " + metres_in_words(whole) + " m";
  if (cut > 0) words += ", cut back before neighbours along " + metres_in_words(cut) + " m";
  return words;
}

/// Eaves on the solids of a building, or none where they would meet a neighbour.
void make(const Building& building, const Others& others, std::vector<Polygon>& taken) {
  if (std::ranges::none_of(building.parts, [](const PartResult* part) { return has_overhangs(part->plan); })) return;
  auto made = with_plans(building);
  if (!stays_clear(made, building.feature, others, taken)) {
    for (PartResult* part : building.parts) {
      if (!has_overhangs(part->plan)) continue;
      for (std::size_t r = 0; r <= part->plan.holes.size(); ++r) ring_of(part->plan, r).overhang_of_edge.clear();
      part->changes.emplace_back("the overhanging eaves were not made: they would reach into a neighbour");
    }
    return;
  }
  auto soffits = soffits_of(made);
  for (PartResult* part : building.parts)
    if (has_overhangs(part->plan)) keep_made(part->plan, soffits);
  *building.solids = with_plans(building);
  taken.insert(taken.end(), soffits.begin(), soffits.end());
}

}  // namespace

auto with_overhangs(const geometry::Mesh& mesh, const Options& options, const base::Run& run,
                    std::vector<PartResult>& parts, std::vector<std::pair<std::size_t, SolidsOf>> solids)
    -> std::vector<std::pair<std::size_t, SolidsOf>> {
  std::vector<Plan> plans;
  for (const auto& part : parts) plans.push_back(part.plan);
  const auto seen = profile::measure_overhangs(plans, mesh, options.profile, run);
  const auto others = others_of(parts);
  std::vector<double> cut_of(parts.size(), 0);  // m of eaves that end before a neighbour
  const bool made = options.profile.overhangs == profile::Overhangs::soffits;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    PartResult& part = parts[p];
    double& cut = cut_of[p];
    for (std::size_t r = 0; r < seen[p].size(); ++r) {
      auto& ring = ring_of(part.plan, r);
      std::vector<double> overhangs;
      for (std::size_t i = 0; i < ring.points.size(); ++i) {
        const auto& one = seen[p][r][i];
        const double far = length_of(ring, i);
        if (roofed(part.plan, ring, i).pitch > 0) part.eaves.length += far;
        // The edge of the roof stays where it was seen, also where the edge of the plan is beside the wall.
        overhangs.push_back(one ? std::max(0.0, one->distance + one->wall) : 0);
        if (!one) continue;
        part.eaves.overhanging += far;
        part.eaves.area += far * one->distance;
      }
      level_rows(part.plan, ring, overhangs, options.profile.overhang_support);
      for (std::size_t i = 0; i < overhangs.size(); ++i) {
        if (!(overhangs[i] > 0)) continue;
        const double far = length_of(ring, i);
        const Point2 a = ring.points[i], b = ring.points[(i + 1) % ring.points.size()];
        double left = cut_back(a, b, std::min(overhangs[i], options.profile.overhang_max), part.feature, others);
        if (left < overhangs[i] - 1 / centimetres) cut += far;
        left = std::floor(left * centimetres + 0.5) / centimetres;
        overhangs[i] = left < options.profile.overhang_min ? 0 : left;
      }
      if (made && std::ranges::any_of(overhangs, [](double o) { return o > 0; }))
        ring.overhang_of_edge = std::move(overhangs);
    }
  }
  if (made) {
    std::vector<Polygon> taken;
    for (auto& [feature, of] : solids) {
      Building building{feature, {}, &of};
      for (auto& part : parts)
        if (part.feature == feature) building.parts.push_back(&part);
      make(building, others, taken);
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (parts[p].eaves.overhanging > 0) parts[p].changes.push_back(words_of(parts[p], made, cut_of[p]));
  return solids;
}

}  // namespace mansard::pipeline::detail
