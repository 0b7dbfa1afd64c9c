// Outlines of parts and buildings, and how well two divisions of the ground agree.
#include <algorithm>
#include <cmath>

#include "mansard/evaluate/detail/plan_of_face.hpp"
#include "mansard/evaluate/detail/shared_boundary.hpp"
#include "mansard/evaluate/truth.hpp"
#include "mansard/geometry/edges.hpp"

namespace mansard::evaluate {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Polygon;
using geometry::Segment2;
using model::SurfaceClass;

auto area_of(const Outline& outline) -> double {
  double sum = 0;
  for (const auto& polygon : outline) sum += geometry::area(polygon);
  return sum;
}

/// A short piece of an outline that runs along another outline.
struct Shared {
  Point2 middle;
  double length = 0;
};

/// The pieces, of at most 10 cm, of every outline whose middles lie within `party_touch` of another one.
auto shared_of(std::span<const Outline> outlines) -> std::vector<Shared> {
  std::vector<std::vector<Segment2>> edges;
  std::vector<Box2> boxes;
  for (const auto& outline : outlines) {
    edges.push_back(detail::edges_of(outline));
    boxes.push_back(geometry::bounds(outline).grown(party_touch));
  }
  std::vector<Shared> shared;
  for (std::size_t a = 0; a < outlines.size(); ++a) {
    std::vector<Segment2> others;
    for (std::size_t b = 0; b < outlines.size(); ++b)
      if (b != a && !boxes[a].empty() && boxes[b].overlaps(boxes[a]))
        others.insert(others.end(), edges[b].begin(), edges[b].end());
    for (const auto& edge : edges[a]) {
      detail::each_piece(edge, [&](Point2 middle, double length) {
        if (std::ranges::any_of(others, [&](const auto& o) { return geometry::distance(o, middle) <= party_touch; }))
          shared.push_back({middle, length});
      });
    }
  }
  return shared;
}

/// Whole and near: the length of the pieces, and of those that have one of the others near by.
auto lengths(const std::vector<Shared>& pieces, const std::vector<Shared>& others) -> std::pair<double, double> {
  // Sorted from west to east, so that each looks at a strip only.
  std::vector<Point2> places;
  for (const auto& other : others) places.push_back(other.middle);
  std::ranges::sort(places);
  double whole = 0, near = 0;
  for (const auto& piece : pieces) {
    whole += piece.length;
    auto at = std::ranges::lower_bound(places, piece.middle.x - party_near, {}, &Point2::x);
    for (; at != places.end() && at->x <= piece.middle.x + party_near; ++at)
      if (length(*at - piece.middle) <= party_near) {
        near += piece.length;
        break;
      }
  }
  return {whole, near};
}

/// A true part and a model part with ground in common.
struct Pair {
  std::size_t truth = 0, model = 0;
  double common = 0, iou = 0;
};

auto pairs_of(std::span<const Outline> truth, std::span<const Outline> model, const std::vector<double>& truth_areas,
              const std::vector<double>& model_areas, std::size_t& unchecked) -> std::vector<Pair> {
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < truth.size(); ++t)
    for (std::size_t m = 0; m < model.size(); ++m) {
      const auto common = common_area(truth[t], model[m]);
      if (!common) ++unchecked;
      else if (*common > 0) pairs.push_back({t, m, *common, *common / (truth_areas[t] + model_areas[m] - *common)});
    }
  return pairs;
}

}  // namespace

auto detail::edges_of(const Outline& outline) -> std::vector<Segment2> {
  std::vector<Segment2> edges;
  for (const auto& polygon : outline)
    geometry::each_edge(polygon, [&](auto from, auto to) { edges.push_back({from, to}); });
  return edges;
}

auto detail::shared_boundary(const Outline& first, const Outline& second) -> double {
  if (first.empty() || second.empty()) return 0;
  const auto box = geometry::bounds(second).grown(party_touch);
  if (!geometry::bounds(first).overlaps(box)) return 0;
  const auto others = edges_of(second);
  double sum = 0;
  for (const auto& edge : edges_of(first))
    each_piece(edge, [&](Point2 middle, double piece) {
      if (!box.contains(middle)) return;
      const auto touches = [&](const auto& o) { return geometry::distance(o, middle) <= party_touch; };
      if (std::ranges::any_of(others, touches)) sum += piece;
    });
  return sum;
}

auto outline_of(std::span<const model::ModelPart> parts) -> base::Result<Outline> {
  std::vector<Polygon> ground, above;
  for (const auto& part : parts)
    for (const auto& face : part.faces) {
      if (face.kind == SurfaceClass::wall) continue;
      auto pieces = detail::plan_of_face(face);
      if (!pieces) return pieces;
      auto& list = face.kind == SurfaceClass::ground ? ground : above;
      list.insert(list.end(), pieces->begin(), pieces->end());
    }
  return geometry::unite(ground.empty() ? above : ground);
}

auto common_area(const Outline& a, const Outline& b) -> base::Result<double> {
  double sum = 0;
  for (const auto& p : a)
    for (const auto& q : b) {
      if (!geometry::bounds(p.outer).overlaps(geometry::bounds(q.outer))) continue;
      const auto both = geometry::intersect(p, q);
      if (!both) return both.failure();
      sum += area_of(*both);
    }
  return sum;
}

auto compare_partition(std::span<const Outline> truth, std::span<const Outline> model) -> Partition {
  std::vector<double> truth_areas, model_areas;
  for (const auto& outline : truth) truth_areas.push_back(area_of(outline));
  for (const auto& outline : model) model_areas.push_back(area_of(outline));
  std::size_t unchecked = 0;
  auto pairs = pairs_of(truth, model, truth_areas, model_areas, unchecked);
  const auto positive = [](const std::vector<double>& areas) {
    return static_cast<std::size_t>(std::ranges::count_if(areas, [](double a) { return a > 0; }));
  };
  Partition out{positive(truth_areas), positive(model_areas), unchecked, 0, 0, 0, 0};

  // The best pairs first, each part once: parts may overlap, as a tower and its podium do.
  std::ranges::stable_sort(pairs, std::ranges::greater{}, &Pair::iou);
  constexpr std::size_t none = ~std::size_t{0};
  std::vector<std::size_t> match_of_truth(truth.size(), none), match_of_model(model.size(), none);
  for (const auto& pair : pairs) {
    if (pair.iou < 0.5 || match_of_truth[pair.truth] != none || match_of_model[pair.model] != none) continue;
    match_of_truth[pair.truth] = pair.model;
    match_of_model[pair.model] = pair.truth;
    ++out.matched;
    out.iou += pair.iou;
  }
  if (out.matched > 0) out.iou /= static_cast<double>(out.matched);

  // What is matched elsewhere is no piece of this part.
  std::vector<std::size_t> pieces(truth.size(), 0), swallowed(model.size(), 0);
  for (const auto& [t, m, common, iou] : pairs) {
    const bool free_model = match_of_model[m] == none || match_of_model[m] == t;
    const bool free_truth = match_of_truth[t] == none || match_of_truth[t] == m;
    if (free_model && common > 0.5 * model_areas[m]) ++pieces[t];
    if (free_truth && common > 0.5 * truth_areas[t]) ++swallowed[m];
  }
  const auto several = [](const std::vector<std::size_t>& counts) {
    return static_cast<std::size_t>(std::ranges::count_if(counts, [](std::size_t n) { return n >= 2; }));
  };
  out.splits = several(pieces);
  out.merges = several(swallowed);
  return out;
}

auto compare_party_walls(std::span<const Outline> truth, std::span<const Outline> model) -> PartyWalls {
  const auto of_truth = shared_of(truth), of_model = shared_of(model);
  PartyWalls out;
  std::tie(out.truth, out.found) = lengths(of_truth, of_model);
  std::tie(out.model, out.right) = lengths(of_model, of_truth);
  return out;
}

}  // namespace mansard::evaluate
