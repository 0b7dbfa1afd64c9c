#include "mansard/refine/detail/rims.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/text.hpp"
#include "mansard/geometry/edges.hpp"
#include "mansard/refine/detail/lines.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Segment2;

/// m; other cuts find what is wider. Parapets are as wide as a wall.
constexpr double max_width = 1;
/// Of the length of the outline: a short edge may be hidden, or of another building.
constexpr double around_it = 0.9;

/// How far samples are off the roof, by their distance from the edge of the outline that is nearest.
struct Along {
  Segment2 edge;
  std::vector<Look> looks;
};

auto edges_of(const geometry::Polygon& polygon) -> std::vector<Along> {
  std::vector<Along> out;
  geometry::each_edge(polygon, [&](geometry::Point2 a, geometry::Point2 b) { out.push_back({{a, b}, {}}); });
  return out;
}

/// What is far below the roof is beyond the wall, or a pit.
auto looks_along(const Site& site, const View& roof, const Options& options) -> std::vector<Along> {
  auto edges = edges_of(site.polygon);
  for (std::size_t i = 0; i < site.z.size(); ++i) {
    const double off = site.z[i] - roof.z_of(site, i);
    if (!(off > -options.cuts.min_step)) continue;
    double least = 2 * max_width;
    Along* nearest = nullptr;
    for (auto& one : edges)
      if (const double d = geometry::distance(one.edge, site.places[i]); d < least) least = d, nearest = &one;
    if (nearest != nullptr) nearest->looks.push_back({least, off, site.weight[i]});
  }
  return edges;
}

auto mean_of(const geometry::LineSums& sums) -> double { return sums.z / sums.weight; }

/// The share of the outline along which what is nearer than `width` is above `level`; edges without samples count for
/// nothing.
auto share_above(const std::vector<Along>& edges, double width, double level) -> double {
  double above = 0, all = 0;
  for (const auto& [edge, looks] : edges) {
    geometry::LineSums sums;
    for (const Look& look : looks)
      if (look.inward < width) sums.add(look.inward, look.height, look.weight);
    if (!(sums.weight > 0)) continue;
    const double length = geometry::length(edge.end - edge.start);
    all += length;
    if (mean_of(sums) > level) above += length;
  }
  return all > 0 ? above / all : 0;
}

}  // namespace

auto within_rims(const Site& site, const View& roof, double least_gain, const Options& options)
    -> std::vector<Proposal> {
  const auto edges = looks_along(site, roof, options);
  std::vector<Look> looks;
  for (const auto& one : edges) looks.insert(looks.end(), one.looks.begin(), one.looks.end());
  std::ranges::stable_sort(looks, {}, &Look::inward);
  const auto sums = sums_along(looks);
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  const double whole = sums.back().residual_level();
  const Within within{
      .fewest_before = fewest, .fewest_behind = fewest, .from = options.bends.min_depth, .to = max_width};
  const auto found = best_parting(looks, sums, Before::level, within, whole);
  if (!found) return {};
  const double gain = whole - found->left, noise = options.samples.noise * options.samples.noise * sums.back().weight;
  if (gain * site.sample_area < least_gain || gain < explained * (whole - noise)) return {};
  const double level = mean_of(sums.back() - sums[found->at]), step = mean_of(sums[found->at]) - level;
  const double width = (looks[found->at - 1].inward + looks[found->at].inward) / 2;
  if (step < options.cuts.min_step || share_above(edges, width, level + step / 2) < around_it) return {};
  auto inside = geometry::buffer(site.polygon, -width);
  if (!inside || inside->size() != 1) return {};
  Proposal out{std::move(inside->front()), gain * site.sample_area,
               "lies " + base::to_text(step, 1) + " m below the parapet around it"};
  out.rim = true;
  return {std::move(out)};
}

}  // namespace mansard::refine::detail
