#include "mansard/refine/detail/refit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/refine/detail/lines.hpp"

namespace mansard::refine::detail {
namespace {

using geometry::Point2;
using model::Plan;
using model::PlanRing;
using model::Profile;

/// Error bound, rise per run, on the division that makes two lines meet. Heights at the edge are means of heights below
/// 1e3 m, rounded to some 1e-12 m; divided by a difference of slopes of 1e-6 that is 1e-6 m of the knot. Below it the
/// knot stays where it was.
constexpr double parallel = 1e-6;

/// Rise per run: the least that a plane keeps, since a profile has to rise to its end. A centimetre over a roof of 10
/// m, less than the smallest detail; from 0.0001 to 0.005 roofs are as good (decision 171).
constexpr double least_slope = 1e-3;

/// Looks by profile and by the part of the profile that made the face they see.
using Looks = std::vector<std::vector<std::vector<Look>>>;

}  // namespace

auto edges_of(const Plan& plan) -> std::vector<std::vector<Edge>> {
  std::vector<std::vector<Edge>> out;
  const auto add = [&out](const PlanRing& ring) {
    auto& edges = out.emplace_back();
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      const Point2 along = ring.points[(i + 1) % ring.points.size()] - ring.points[i];
      edges.push_back({ring.points[i], geometry::left_of(geometry::normalised(along)), ring.profile_of_edge[i]});
    }
  };
  add(plan.outer);
  for (const auto& hole : plan.holes) add(hole);
  return out;
}

auto line_of(const Profile& profile, std::size_t i) -> std::optional<RoofLine> {
  const auto &a = profile[i], &b = profile[i + 1];
  if (b.inward <= a.inward) return std::nullopt;
  const double slope = (b.height - a.height) / (b.inward - a.inward);
  return RoofLine{a.height - slope * a.inward, slope};
}

namespace {

struct Sorted {
  Looks looks;
  std::vector<double> cap;  ///< heights seen on the cap
};

/// Whether a look sees the middle of a face: nothing else is seen `melt` along the edge and up and down the slope.
class Middle {
 public:
  Middle(const Judged& judged, const Heights& grid, double melt) : judged_(judged), grid_(grid), melt_(melt) {}

  [[nodiscard]] auto holds(std::size_t cell, const Profile& profile, std::uint32_t part, Point2 at, double inward,
                           Point2 up) const -> bool {
    const auto &foot = profile[part], &head = profile[part + 1];
    const double slope = (head.height - foot.height) / (head.inward - foot.inward);
    const double reach = melt_ / std::sqrt(1 + slope * slope);  // as it is seen from above
    if (inward < foot.inward + reach) return false;
    const bool ends = part + 2 < profile.size();  // the last part goes on until it meets another face
    if (ends ? inward > head.inward - reach : !same(cell, at + reach * up)) return false;
    const Point2 along = melt_ * geometry::left_of(up);
    return same(cell, at + along) && same(cell, at - along);
  }

 private:
  [[nodiscard]] auto same(std::size_t cell, Point2 at) const -> bool {
    const double column = std::round((at.x - grid_.origin.x) / grid_.spacing);
    const double row = std::round((at.y - grid_.origin.y) / grid_.spacing);
    if (column < 0 || row < 0 || column >= static_cast<double>(grid_.columns) || row >= static_cast<double>(grid_.rows))
      return false;
    const auto other = static_cast<std::size_t>(row) * grid_.columns + static_cast<std::size_t>(column);
    return !std::isnan(grid_.z[other]) && judged_.view.face[other] == judged_.view.face[cell];
  }

  const Judged& judged_;
  const Heights& grid_;
  double melt_;  // m
};

auto sort_looks(const Judged& judged, const Site& site, const Options& options, Used used) -> Sorted {
  const Middle middle(judged, site.measured, options.samples.melt);
  Sorted out;
  out.looks.resize(judged.plan.profiles.size());
  for (std::size_t p = 0; p < out.looks.size(); ++p) out.looks[p].resize(judged.plan.profiles[p].size());
  const auto edges = edges_of(judged.plan);
  struct Target {
    const Edge* edge = nullptr;  // none: the face has no line of its own
    std::uint32_t part = 0;
    std::vector<Look>* looks = nullptr;
    bool is_cap = false;
  };
  std::vector<Target> targets(judged.sketch.faces.size());  // by face
  for (std::size_t f = 0; f < targets.size(); ++f) {
    const auto& face = judged.sketch.faces[f];
    targets[f].is_cap = face.kind == model::FaceKind::cap;
    if (!face.provenance || face.kind == model::FaceKind::connector) continue;
    const Edge& edge = edges[face.provenance->ring][face.provenance->edge];
    auto& parts = out.looks[edge.profile];
    const auto part = face.provenance->part;
    const bool ends = used == Used::middle && part + 1 >= parts.size();
    if (part < parts.size() && !ends) targets[f] = {&edge, part, &parts[part], targets[f].is_cap};
  }
  for (std::size_t i = 0; i < site.cells.size(); ++i) {
    const auto cell = site.cells[i];
    if (std::isnan(judged.view.z_of(site, i))) continue;
    const Target& target = targets[judged.view.face_of(site, i)];
    if (target.is_cap && site.weight[i] == 1) out.cap.push_back(site.z[i]);
    if (!target.edge) continue;
    const Point2 at = site.places[i];
    const double inward = target.edge->to(at);
    if (used == Used::all) target.looks->push_back({inward, site.z[i], site.weight[i]});
    else if (middle.holds(cell, judged.plan.profiles[target.edge->profile], target.part, at, inward,
                          target.edge->inward))
      target.looks->push_back({inward, site.z[i], 1});
  }
  return out;
}

auto refitted_line(const RoofLine& line, const std::vector<Look>& looks, const Options& options) -> RoofLine {
  if (std::ssize(looks) < options.refit.min_samples) return line;
  const auto free = line_through(looks, line, options.lines);
  RoofLine out = free.value_or(raised_line(looks, line, options.lines));
  out.slope = line.slope == 0 ? 0 : std::clamp(out.slope, least_slope, std::max(least_slope, options.forms.max_slope));
  return free && out.slope == free->slope ? out : raised_line(looks, out, options.lines);
}

auto rebuilt(const Profile& profile, const std::vector<std::vector<Look>>& looks, const Options& options)
    -> std::optional<Profile> {
  std::vector<std::optional<RoofLine>> lines;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    auto line = line_of(profile, i);
    if (line) line = refitted_line(*line, looks[i], options);
    lines.push_back(line);
  }
  return chained(profile, lines);
}

}  // namespace

auto chained(const Profile& profile, std::span<const std::optional<RoofLine>> lines) -> std::optional<Profile> {
  Profile out{{0, 0}};
  const auto add = [&out](double inward, double height) { add_point(out, inward, height); };
  double last_inward = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& own = lines[i];
    if (!own) continue;
    const RoofLine& line = *own;
    if (i == 0) {  // a roof from the ground up: its foot stays
      if (line.at_edge > 0) add(0, line.at_edge);
    } else if (!lines[i - 1]) {  // behind a wall
      add(profile[i].inward, line.at_edge + line.slope * profile[i].inward);
    }
    const auto next = i + 1 < lines.size() ? lines[i + 1] : std::nullopt;
    double end = profile[i + 1].inward;
    if (next && std::abs(next->slope - line.slope) > parallel) {
      end = (line.at_edge - next->at_edge) / (next->slope - line.slope);
    }
    if (end < last_inward) return std::nullopt;
    last_inward = end;
    add(end, line.at_edge + line.slope * end);
  }
  if (out.size() < 2) return std::nullopt;
  if (!lines.back())
    add(out.back().inward, out.back().height + profile.back().height - profile[profile.size() - 2].height);
  for (std::size_t i = 1; i < out.size(); ++i)
    if (out[i].inward < out[i - 1].inward || out[i].height < out[i - 1].height) return std::nullopt;
  return out;
}

auto middles_of(const Judged& judged, const Site& site, const Options& options) -> Looks {
  return sort_looks(judged, site, options, Used::middle).looks;
}

auto refitted(const Judged& judged, const Site& site, const Options& options, Used used) -> Plan {
  auto sorted = sort_looks(judged, site, options, used);
  Plan plan = judged.plan;
  for (std::size_t p = 0; p < plan.profiles.size(); ++p) {
    const auto& profile = plan.profiles[p];
    if (profile.back().inward == 0) continue;
    if (std::ranges::all_of(sorted.looks[p], [](const auto& looks) { return looks.empty(); })) continue;
    if (auto better = rebuilt(profile, sorted.looks[p], options)) plan.profiles[p] = std::move(*better);
  }
  if (std::ssize(sorted.cap) >= options.refit.min_cap_samples)
    plan.cap = std::max(options.forms.min_height, base::median(std::move(sorted.cap)));
  return plan;
}

}  // namespace mansard::refine::detail
