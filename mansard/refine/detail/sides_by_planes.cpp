#include "mansard/refine/detail/sides_by_planes.hpp"

#include <algorithm>
#include <iterator>

#include "mansard/refine/detail/forms.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Profile;

/// Cosine of 10°: a plane that rises from a side does so across it. Sides of a plan differ by more, errors of a plane
/// of a few square metres are less.
constexpr double across = 0.985;
/// m²: fewer points than stand for this say little of a plane over the strip of one side.
constexpr double least_support = 1;
/// The part of a profile behind another is flatter by a tenth at least: else both are one.
constexpr double flatter = 0.9;

/// What a plane is to one side.
struct Rising {
  std::uint32_t plane = 0;
  double at_edge = 0, slope = 0;          // m above the base, and rise per run
  double samples = 0, sum_of_inward = 0;  // of the samples in the strip of the side
  [[nodiscard]] auto inward() const -> double { return sum_of_inward / samples; }
};

auto rising_from(const Eaves& edge, std::uint32_t plane, const Site& site) -> Rising {
  const auto& p = site.planes[plane];
  const Point2 middle = edge.start + (edge.length / 2) * edge.along;
  return {plane, p.at(middle) - site.base, dot(p.slope, geometry::left_of(edge.along)), 0, 0};
}

/// Per profile the planes that rise from its sides.
auto planes_by_side(const model::Plan& plan, const Site& site, const Options::Forms& options)
    -> std::vector<std::vector<Rising>> {
  std::vector<std::vector<Rising>> out(plan.profiles.size());
  const auto edges = eaves_of(plan, std::vector<bool>(plan.profiles.size(), true));
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const auto plane = site.plane_of[i];
    if (plane >= site.planes.size()) continue;
    const Point2 slope = site.planes[plane].slope;
    const double rise = length(slope);
    if (rise < options.min_slope || rise > options.max_slope) continue;
    for (const Eaves& edge : edges) {
      const Point2 inward = geometry::left_of(edge.along), off = site.places[i] - edge.start;
      const double t = dot(off, edge.along), d = dot(off, inward);
      if (d < 0 || t < 0 || t > edge.length || dot(slope, inward) < across * rise) continue;
      auto& of_side = out[edge.profile];
      auto known = std::ranges::find(of_side, plane, &Rising::plane);
      if (known == of_side.end()) known = of_side.insert(known, rising_from(edge, plane, site));
      known->samples += 1;
      known->sum_of_inward += d;
    }
  }
  return out;
}

auto profile_of(std::vector<Rising> planes, double fewest) -> std::optional<Profile> {
  std::erase_if(planes, [&](const Rising& one) { return one.samples < fewest || !(one.at_edge > 0); });
  if (planes.empty()) return std::nullopt;
  std::ranges::stable_sort(planes, {}, &Rising::inward);
  const Rising& foot = planes.front();
  Profile out{{0, 0}, {0, foot.at_edge}};
  for (const Rising& next : planes) {
    if (next.slope > flatter * foot.slope) continue;
    const double knot = (next.at_edge - foot.at_edge) / (foot.slope - next.slope);
    if (knot < foot.inward() || knot > next.inward()) continue;
    const double height = foot.at_edge + foot.slope * knot;
    out.push_back({knot, height});
    out.push_back({knot + 1, height + next.slope});
    return out;
  }
  out.push_back({1, foot.at_edge + foot.slope});
  return out;
}

}  // namespace

auto by_planes(const model::Plan& plan, const Site& site, const Options& options) -> std::optional<SidesByPlanes> {
  if (site.planes.empty()) return std::nullopt;
  const double fewest = std::max(static_cast<double>(options.lines.min_samples), least_support / site.sample_area);
  const auto sides = sides_of(plan);
  SidesByPlanes out{plan, std::vector<bool>(sides.size(), false)};
  auto planes = planes_by_side(plan, site, options.forms);
  double gutters = 0, length = 0;
  for (std::size_t p = 0; p < sides.size(); ++p) {
    auto profile = profile_of(std::move(planes[p]), fewest);
    if (!profile) continue;
    out.carries[p] = true;
    out.plan.profiles[p] = std::move(*profile);
    gutters += sides[p].length * out.plan.profiles[p][1].height;
    length += sides[p].length;
  }
  if (length == 0) return std::nullopt;
  for (std::size_t p = 0; p < sides.size(); ++p)
    if (!out.carries[p]) out.plan.profiles[p] = wall(gutters / length, options.forms);
  return out;
}

}  // namespace mansard::refine::detail
