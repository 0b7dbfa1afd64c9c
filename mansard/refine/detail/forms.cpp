#include "mansard/refine/detail/forms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "mansard/base/statistics.hpp"
#include "mansard/geometry/fit.hpp"
#include "mansard/refine/detail/judge.hpp"
#include "mansard/refine/detail/lines.hpp"
#include "mansard/refine/detail/order.hpp"
#include "mansard/refine/detail/sides_by_planes.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Plan;
using model::PlanRing;
using model::Profile;

template <class See>
void each_edge(const Plan& plan, See see) {
  const auto ring = [&see](const PlanRing& r) {
    for (std::size_t i = 0; i < r.points.size(); ++i)
      see(r.points[i], r.points[(i + 1) % r.points.size()], r.profile_of_edge[i]);
  };
  ring(plan.outer);
  for (const auto& hole : plan.holes) ring(hole);
}

/// m: how far inward of an edge a place is, in a strip widened by 45°.
auto inward_in_strip(const Eaves& edge, Point2 at) -> std::optional<double> {
  const double d = dot(at - edge.start, geometry::left_of(edge.along)), t = dot(at - edge.start, edge.along);
  return d >= 0 && t >= -d && t <= edge.length + d ? std::optional(d) : std::nullopt;
}

/// The nearest so far, or another; which of two as near it is, their order decides.
void consider(std::optional<Nearest>& nearest, Nearest other) {
  if (!nearest || other.inward < nearest->inward - same_distance) nearest = other;
}

/// Rise per run: by less no two pitches differ that a scan of some metres can tell apart.
constexpr double least_bend = 1e-3;

/// m: of a profile at a distance from its edge.
auto height_at(const Profile& profile, double inward) -> double {
  double height = profile.back().height;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    const auto &a = profile[i - 1], &b = profile[i];
    const bool last = i + 1 == profile.size();
    if (b.inward > a.inward && (inward <= b.inward || last))
      return a.height + (b.height - a.height) / (b.inward - a.inward) * (inward - a.inward);
    height = b.height;
  }
  return height;
}

/// m²·m²: of all samples, by the mean of some.
auto of_all(double sum, std::size_t count, const Site& site) -> double {
  return sum / static_cast<double>(std::max<std::size_t>(1, count)) * static_cast<double>(site.cells.size()) *
         site.sample_area;
}

/// Samples, evenly chosen, and the edges in whose strips they are: of every form the same.
class Strips {
 public:
  Strips(const Plan& plan, const Site& site, const Options::Forms& options) : site_(site) {
    const std::size_t stride = 1 + site.cells.size() / static_cast<std::size_t>(options.samples);
    const auto edges = eaves_of(plan, std::vector<bool>(plan.profiles.size(), true));
    for (std::size_t i = 0; i < site.cells.size(); i += stride) {
      for (const Eaves& edge : edges)
        if (const auto inward = inward_in_strip(edge, site.places[i])) edges_.push_back({edge.profile, *inward});
      samples_.push_back({i, edges_.size()});
    }
  }

  /// m²·m²: of a roof whose sides are not alike.
  [[nodiscard]] auto misfit_of(const SidesByPlanes& roof, const Options& options) const -> double {
    double sum = 0;
    std::size_t count = 0;
    each_nearest(roof.carries, [&](const Nearest& nearest, std::size_t i) {
      const double height = height_at(roof.plan.profiles[nearest.profile], nearest.inward);
      sum += site_.weight[i] * loss(std::min(roof.plan.cap, height) - site_.z[i], options.robust);
      ++count;
    });
    return of_all(sum, count, site_);
  }

  /// Heights over the distance from the sides that carry roof.
  [[nodiscard]] auto looks_at(const std::vector<bool>& carries) const -> std::vector<Look> {
    std::vector<Look> looks;
    looks.reserve(samples_.size());
    each_nearest(carries, [&](const Nearest& nearest, std::size_t i) {
      looks.push_back({nearest.inward, site_.z[i], site_.weight[i]});
    });
    return looks;
  }

 private:
  /// Calls see(nearest, i) for every sample in the strip of a side that carries roof.
  template <class See>
  void each_nearest(const std::vector<bool>& carries, See see) const {
    std::size_t edge = 0;
    for (const auto& [i, end] : samples_) {
      std::optional<Nearest> nearest;
      for (; edge < end; ++edge)
        if (carries[edges_[edge].profile]) consider(nearest, edges_[edge]);
      if (nearest) see(*nearest, i);
    }
  }

  struct Sample {
    std::size_t index = 0, end = 0;  // of the site; where its edges end
  };
  const Site& site_;
  std::vector<Nearest> edges_;
  std::vector<Sample> samples_;
};

/// m²·m²: that of the samples, as if they were all there are.
template <class Height>
auto misfit_of(std::span<const Look> looks, const Site& site, const Options& options, Height height) -> double {
  double sum = 0;
  for (const Look& look : looks) sum += look.weight * loss(height(look) - look.height, options.robust);
  return of_all(sum, looks.size(), site);
}

/// The one line that suits all sides that carry roof.
auto common_line(std::span<const Look> looks, const Options::Lines& options) -> std::optional<RoofLine> {
  if (looks.empty()) return std::nullopt;
  double mean = 0;
  for (const Look& look : looks) mean += look.height;
  return line_through(looks, {mean / static_cast<double>(looks.size()), 0}, options);
}

auto by_distance(std::vector<Look> looks) -> std::vector<Look> {
  std::ranges::stable_sort(looks, {}, &Look::inward);
  return looks;
}

/// A steep roof and a flatter one above it, of whatever distance from the sides parts them best. A melted corner, or a
/// wall behind the outline, looks the same but for its size. `looks` by their distance.
auto mansard_line(std::span<const Look> looks, const Options& options) -> std::optional<Profile> {
  const auto& mansard = options.mansard;
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  const auto sums = sums_along(looks);
  std::size_t best = 0;
  double least = sums.back().residual();
  for (std::size_t i = fewest; i + fewest < looks.size(); ++i) {
    if (looks[i].inward < mansard.min_depth / 2) continue;
    if (looks[i].inward > mansard.max_depth) break;
    const double left = sums[i].residual() + (sums.back() - sums[i]).residual();
    if (left < least) {
      least = left;
      best = i;
    }
  }
  if (best == 0) return std::nullopt;
  const auto lower = common_line(looks.first(best), options.lines),
             upper = common_line(looks.subspan(best), options.lines);
  if (!lower || !upper || lower->slope < mansard.min_slope || lower->slope > options.forms.max_slope)
    return std::nullopt;
  const double slope = std::max(options.forms.min_slope, upper->slope);
  if (slope > mansard.upper_share * lower->slope) return std::nullopt;
  const double knot = (upper->at_edge - lower->at_edge) / (lower->slope - slope);
  if (!(knot > mansard.min_depth && knot < mansard.max_depth && lower->slope * knot > mansard.min_rise &&
        lower->at_edge > 0))
    return std::nullopt;
  const double height = lower->at_edge + lower->slope * knot;
  return Profile{{0, 0}, {0, lower->at_edge}, {knot, height}, {knot + 1, height + slope}};
}

/// Lines one above the other, each from where the one before ends: a profile, if they meet in that order.
auto profile_through(const std::vector<RoofLine>& lines) -> std::optional<Profile> {
  Profile out{{0, 0}};
  if (!(lines.front().at_edge > 0)) return std::nullopt;
  out.push_back({0, lines.front().at_edge});
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const double bend = lines[i].slope - lines[i + 1].slope;
    if (!(std::abs(bend) > least_bend)) return std::nullopt;
    const double at = (lines[i + 1].at_edge - lines[i].at_edge) / bend;
    if (!(at > out.back().inward)) return std::nullopt;
    out.push_back({at, std::max(out.back().height, lines[i].at_edge + lines[i].slope * at)});
  }
  out.push_back({out.back().inward + 1, out.back().height + lines.back().slope});
  return out;
}

/// A roof that bends to one side, as barrels and domes do: the fewest pitches, three at least, from which it is no
/// farther on average than half of the smallest detail, or whose further pitches would not pay. What more pitches than
/// the most do not explain is noise; where that is more than a roof's noise and the smallest detail, it is no such
/// roof. `looks` by their distance. Cost: O(looks), and O(pitches · places²) where it may be such a roof.
auto bent_line(std::span<const Look> looks, double area_of_look, const Options& options) -> std::optional<Profile> {
  constexpr std::size_t fewest_pitches = 3, most_pitches = 12;
  constexpr std::size_t most_places = 96;  // at which a pitch may end: eight for each
  const auto sums = sums_along(looks);
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  const std::size_t places = std::min(most_places, looks.size() / fewest);
  if (places < fewest_pitches) return std::nullopt;
  const auto place = [&](std::size_t i) { return i * looks.size() / places; };
  const auto between = [&](std::size_t i, std::size_t j) { return sums[place(j)] - sums[place(i)]; };
  // Squares, by weight: what is of no interest, and what noise leaves.
  const auto squares = [&](double metres) { return metres * metres * sums.back().weight; };
  const double wanted = squares(of_detail * options.detail),
               most_noise = squares(std::max(options.detail, options.lines.robust));
  if (sums.back().residual() <= wanted) return std::nullopt;  // it does not bend
  double in_places = 0;
  for (std::size_t i = 0; i < places; ++i) in_places += between(i, i + 1).residual();
  if (in_places > most_noise) return std::nullopt;
  std::vector<std::vector<double>> own(places + 1, std::vector<double>(places + 1, 0));
  for (std::size_t i = 0; i < places; ++i)
    for (std::size_t j = i + 1; j <= places; ++j) own[i][j] = between(i, j).residual();
  std::vector<std::vector<double>> least(1, own[0]);  // by pitches − 1 and by where the last ends
  std::vector<std::vector<std::size_t>> from(1, std::vector<std::size_t>(places + 1, 0));
  for (std::size_t k = 1; k < std::min(most_pitches, places); ++k) {
    least.emplace_back(places + 1, std::numeric_limits<double>::infinity());
    from.emplace_back(places + 1, 0);
    for (std::size_t j = k + 1; j <= places; ++j)
      for (std::size_t i = k; i < j; ++i)
        if (const double sum = least[k - 1][i] + own[i][j]; sum < least[k][j]) least[k][j] = sum, from[k][j] = i;
  }
  const double noise = least.back()[places];
  if (noise > most_noise) return std::nullopt;
  std::size_t k = 0;
  for (; k + 1 < least.size(); ++k) {
    const double left = least[k][places] - noise, gain = least[k][places] - least[k + 1][places];
    if (left <= wanted || gain * area_of_look < options.face_price) break;
  }
  if (k + 1 < fewest_pitches) return std::nullopt;
  std::vector<RoofLine> lines;
  for (std::size_t j = places; j > 0; j = from[k][j], k = k > 0 ? k - 1 : 0) {
    const std::size_t i = from[k][j];
    const auto some = between(i, j);
    if (!(some.weight > 0 && some.spread() > 0)) return std::nullopt;
    const double slope = std::clamp(some.joint() / some.spread(), 0.0, options.forms.max_slope);
    lines.push_back({some.line(slope).at_zero, slope});
  }
  std::ranges::reverse(lines);
  const auto bends = [&](auto order) { return std::ranges::is_sorted(lines, order, &RoofLine::slope); };
  if (!bends(std::ranges::less()) && !bends(std::ranges::greater())) return std::nullopt;
  return profile_through(lines);
}

/// A level strip and what stands behind it, of whatever depth parts them best.
auto setback(std::vector<Look> looks, const Options& options) -> std::vector<Profile> {
  const auto& o = options.setback;
  const auto fewest = static_cast<std::size_t>(options.lines.min_samples);
  std::ranges::stable_sort(looks, {}, &Look::inward);
  std::erase_if(looks, [&](const Look& look) { return look.inward > o.max_depth + o.behind; });
  const auto sums = sums_along(looks);
  std::size_t best = 0;
  double least = o.max_rest * sums.back().residual();
  for (std::size_t i = fewest; i + fewest < looks.size(); ++i) {
    if (looks[i].inward < options.mansard.min_depth) continue;
    if (looks[i].inward > o.max_depth) break;
    const double left = sums[i].residual_level() + (sums.back() - sums[i]).residual();
    if (left < least) {
      least = left;
      best = i;
    }
  }
  if (best == 0) return {};
  const double depth = (looks[best - 1].inward + looks[best].inward) / 2;
  const std::span<const Look> all(looks);
  const auto behind = common_line(all.subspan(best), options.lines);
  const double low = middle_height(all.first(best));
  if (!behind || !(low > 0)) return {};
  const double high = behind->at_edge + behind->slope * depth;
  if (high - low < o.min_rise) return {};
  // A tower on the roof stands behind a part of the strip only.
  constexpr double tower_reach = 1;    // m: what is looked at behind the step
  constexpr double tower_share = 0.8;  // of it, raised: along all of the side but what the scan lacks
  std::size_t seen = 0, upright = 0;
  for (const Look& look : all.subspan(best)) {
    if (look.inward > depth + tower_reach) break;
    ++seen;
    upright += look.height > (low + high) / 2 ? 1 : 0;
  }
  if (static_cast<double>(upright) < tower_share * static_cast<double>(seen)) return {};
  std::vector<Profile> out{{{0, 0}, {0, low}, {depth, low}}};
  if (behind->slope > options.forms.min_slope && behind->slope < options.forms.max_slope)
    out.push_back({{0, 0}, {0, low}, {depth, low}, {depth, high}, {depth + 1, high + behind->slope}});
  return out;
}

/// The directions of the plan's longest sides, of each pair of opposite ones one.
auto axes_of(const std::vector<Side>& sides, const Options::Forms& options) -> std::vector<Point2> {
  std::vector<std::size_t> order(sides.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  rank(
      order, [&](std::size_t i) { return -sides[i].length; }, same_length);
  std::vector<Point2> axes;
  for (const std::size_t i : order) {
    const bool known = std::ranges::any_of(
        axes, [&](Point2 axis) { return std::abs(dot(axis, sides[i].inward)) > options.axis_cosine; });
    if (!known && std::ssize(axes) < options.max_axes) axes.push_back(sides[i].inward);
  }
  return axes;
}

/// Sides much shorter than both of their neighbours, at outer corners: where gables stand on bent plans.
auto ends_of(const Plan& plan, const std::vector<Side>& sides, const Options::Forms& options) -> std::vector<bool> {
  std::vector<bool> ends(sides.size(), false);
  const auto& ring = plan.outer;
  const std::size_t n = ring.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto before = ring.profile_of_edge[(i + n - 1) % n], here = ring.profile_of_edge[i],
               after = ring.profile_of_edge[(i + 1) % n];
    if (before == here || after == here) continue;
    const double turn_in = cross(sides[before].inward, sides[here].inward);
    const double turn_out = cross(sides[here].inward, sides[after].inward);
    ends[here] = turn_in > options.gable_turn && turn_out > options.gable_turn &&
                 sides[here].length < options.gable_length * std::min(sides[before].length, sides[after].length);
  }
  return ends;
}

}  // namespace

auto eaves_of(const Plan& plan, const std::vector<bool>& carries) -> std::vector<Eaves> {
  std::vector<Eaves> out;
  each_edge(plan, [&](Point2 a, Point2 b, std::uint32_t profile) {
    const double length = geometry::length(b - a);
    if (carries[profile] && length > 0) out.push_back({a, (1 / length) * (b - a), length, profile});
  });
  return out;
}

auto nearest_eaves(const std::vector<Eaves>& eaves, Point2 at) -> std::optional<Nearest> {
  std::optional<Nearest> nearest;
  for (const Eaves& edge : eaves)
    if (const auto inward = inward_in_strip(edge, at)) consider(nearest, {edge.profile, *inward});
  return nearest;
}

auto wall(double height, const Options::Forms& options) -> Profile {
  return {{0, 0}, {0, std::max(options.min_height, height)}};
}

auto pitched(double gutter, double slope) -> Profile {
  if (!(gutter > 0)) return {{0, 0}, {1, slope}};
  return {{0, 0}, {0, gutter}, {1, gutter + slope}};
}

auto sides_of(const Plan& plan) -> std::vector<Side> {
  std::vector<Side> sides(plan.profiles.size());
  each_edge(plan, [&](Point2 a, Point2 b, std::uint32_t profile) {
    sides[profile].inward = sides[profile].inward + geometry::left_of(b - a);
    sides[profile].length += geometry::length(b - a);
  });
  for (auto& side : sides) side.inward = geometry::normalised(side.inward);
  return sides;
}

auto roof_over(const Plan& plan, const Site& site, const std::vector<bool>& carries, bool steep_foot,
               const Options& options) -> std::optional<Profile> {
  const Strips strips(plan, site, options.forms);
  auto looks = strips.looks_at(carries);
  if (looks.empty()) return std::nullopt;
  const auto& forms = options.forms;
  if (!steep_foot) {
    auto line = common_line(looks, options.lines);
    if (!line || line->slope < forms.min_slope || line->slope > forms.max_slope) {
      const double slope = line ? std::clamp(line->slope, forms.min_slope, forms.max_slope) : forms.min_slope;
      line = raised_line(looks, {0, slope}, options.lines);
    }
    return pitched(line->at_edge, line->slope);
  }
  if (auto found = mansard_line(by_distance(looks), options)) return found;
  // About 70° and 20°, as roofs with a steep foot mostly have; the scan says how high.
  constexpr double run = 0.85, rise = 2.4, upper = 0.36;
  const auto above_gutter = [](double inward) {
    return inward < run ? rise / run * inward : rise + upper * (inward - run);
  };
  for (auto& look : looks) look.height -= above_gutter(look.inward);
  const double gutter = std::max(forms.min_height, middle_height(looks));
  return Profile{{0, 0}, {0, gutter}, {run, gutter + rise}, {run + 1, gutter + rise + upper}};
}

auto setbacks_of(const Plan& plan, const Site& site, const Options& options) -> std::vector<std::vector<Profile>> {
  const auto eaves = eaves_of(plan, std::vector<bool>(plan.profiles.size(), true));
  std::vector<std::vector<Look>> looks(plan.profiles.size());
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    if (site.weight[i] < 1) continue;  // the melted wall hides how level the strip is
    if (const auto near = nearest_eaves(eaves, site.places[i]))
      looks[near->profile].push_back({near->inward, site.z[i], site.weight[i]});
  }
  std::vector<std::vector<Profile>> out;
  for (auto& of_side : looks) out.push_back(setback(std::move(of_side), options));
  return out;
}

auto forms_of(const Plan& plan, const Site& site, const Options& options) -> std::vector<Form> {
  std::vector<Form> out;
  if (site.sorted.empty()) return out;
  const auto& forms = options.forms;
  const auto share = [&](double s) { return base::percentile_of_sorted(site.sorted, s, base::Rank::below); };
  const double top = std::max(forms.min_height, share(forms.cap_percentile) + forms.cap_clearance);
  const auto sides = sides_of(plan);
  const Strips strips(plan, site, forms);

  const auto all = strips.looks_at(std::vector<bool>(sides.size(), true));
  for (const double level : {commonest(site.sorted, options), share(0.5)}) {
    Plan flat = plan;
    flat.cap = std::max(forms.min_height, level);
    for (auto& profile : flat.profiles) profile = wall(flat.cap, forms);
    const double misfit = misfit_of(all, site, options, [&](const Look&) { return flat.cap; });
    out.push_back({std::move(flat), misfit});
  }

  std::vector<std::vector<bool>> tried;
  const auto propose = [&](const std::function<bool(std::size_t)>& carries_roof) {
    std::vector<bool> carries(sides.size());
    for (std::size_t p = 0; p < sides.size(); ++p) carries[p] = sides[p].length > 0 && carries_roof(p);
    if (std::ranges::none_of(carries, [](bool c) { return c; }) || std::ranges::find(tried, carries) != tried.end())
      return;
    tried.push_back(carries);
    const auto looks = strips.looks_at(carries);
    const auto line = common_line(looks, options.lines);
    const auto give = [&](const Profile& roof, double gutter) {
      Form form{plan, 0};
      form.plan.cap = top;
      for (std::size_t p = 0; p < sides.size(); ++p) form.plan.profiles[p] = carries[p] ? roof : wall(gutter, forms);
      form.misfit = misfit_of(looks, site, options,
                              [&](const Look& look) { return std::min(top, height_at(roof, look.inward)); });
      out.push_back(std::move(form));
    };
    if (line && line->slope >= forms.min_slope && line->slope <= forms.max_slope)
      give(pitched(line->at_edge, line->slope), line->at_edge);
    if (looks.empty()) return;
    const auto sorted = by_distance(looks);
    if (const auto roof = mansard_line(sorted, options)) give(*roof, (*roof)[1].height);
    if (const auto roof = bent_line(sorted, of_all(1, looks.size(), site), options)) give(*roof, (*roof)[1].height);
  };
  for (const Point2 axis : axes_of(sides, forms)) {
    propose([&](std::size_t p) { return std::abs(dot(sides[p].inward, axis)) > forms.across_cosine; });
    propose([&](std::size_t p) { return dot(sides[p].inward, axis) > forms.across_cosine; });
    propose([&](std::size_t p) { return dot(sides[p].inward, axis) < -forms.across_cosine; });
  }
  const auto ends = ends_of(plan, sides, forms);
  propose([&](std::size_t p) { return !ends[p]; });
  propose([](std::size_t) { return true; });
  if (auto roof = by_planes(plan, site, options)) {
    const auto give = [&](double cap) {
      roof->plan.cap = cap;
      out.push_back({roof->plan, strips.misfit_of(*roof, options)});
    };
    give(top);
    give(commonest(site.sorted, options));
  }
  rank(out, &Form::misfit, options.same_cost);
  return out;
}

}  // namespace mansard::refine::detail
