// A building's parts raised among their neighbours and compared with the scan.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/edit/detail/trace.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::edit {
namespace {

using geometry::Box2;
using geometry::Polygon;

/// Solids of plans, by their order; none where a plan cannot be extruded, with its reasons.
struct Attempt {
  std::optional<model::Solid> solid;
  extrude::Outcome outcome = extrude::Outcome::full;
  std::vector<base::Diagnostic> diagnostics;
};

auto attempt(const model::Plan& plan, const pipeline::Options& options, const base::Run& run) -> Attempt {
  Attempt out;
  auto raised = pipeline::raise_part(plan, options, run);
  if (!raised) {
    out.diagnostics.push_back(raised.error());
    return out;
  }
  out.outcome = raised->outcome;
  out.diagnostics = std::move(raised->warnings);
  out.solid = std::move(raised->solid);
  return out;
}

auto box_of(std::span<const NamedPlan> parts) -> Box2 {
  Box2 box;
  for (const auto& part : parts) box.include(Box2::of(part.plan.outer.points));
  return box;
}

/// Ground that parts share, m², with neighbours or with each other. Fails where a pair cannot be computed.
auto shared_with(std::span<const Polygon> parts, const Polygon& neighbour) -> base::Result<double> {
  double sum = 0;
  for (const auto& part : parts) {
    auto area = detail::overlap(part, neighbour);
    if (!area) return area;
    sum += *area;
  }
  return sum;
}
auto shared_among(std::span<const Polygon> parts) -> base::Result<double> {
  double sum = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto area = shared_with(parts.subspan(0, i), parts[i]);
    if (!area) return area;
    sum += *area;
  }
  return sum;
}

auto sound_polygons(std::span<const NamedPlan> parts) -> std::vector<Polygon> {
  std::vector<Polygon> polygons;
  for (const auto& part : parts)
    if (auto polygon = model::polygon_of(part.plan); geometry::is_simple(polygon))
      polygons.push_back(std::move(polygon));
  return polygons;
}

auto overlap_of(const std::string& with, double area, const std::string& subject) -> base::Diagnostic {
  return base::error("edit-overlap",
                     "shares " + base::to_text(area, 2) + " m² of ground with " + with +
                         "; move the corners back, or the neighbour's too",
                     subject);
}

/// An overlap that cannot be computed counts as one; a warning is enough where it could not be computed before the
/// edit.
auto unknown_overlap(const std::string& with, const base::Diagnostic& why, const std::string& subject,
                     const base::Result<double>& before) -> base::Diagnostic {
  return {before ? base::Severity::error : base::Severity::warning, "edit-overlap-unchecked",
          "whether it shares ground with " + with + " could not be computed (" + why.message +
              "); move its corners a little, or the neighbour's",
          subject};
}

/// Whether more ground is shared than before the edit. What could not be computed before excuses nothing that can be
/// computed now.
auto more_than(double area, const base::Result<double>& before) -> bool {
  return !before || area > *before + detail::least_area;
}

/// `parts` are those with a solid, and so with a sound outline.
void find_overlaps(std::span<const NamedPlan* const> parts, std::span<const model::Plan* const> neighbours,
                   std::span<const NamedPlan> before, std::vector<base::Diagnostic>& diagnostics) {
  std::vector<Polygon> polygons;
  for (const auto* part : parts) polygons.push_back(model::polygon_of(part->plan));
  std::optional<std::vector<Polygon>> were;  // made only where there is something to excuse
  const auto earlier = [&]() -> const std::vector<Polygon>& {
    if (!were) were = sound_polygons(before);
    return *were;
  };

  std::vector<base::Diagnostic> own;
  double sum = 0;
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto area = detail::overlap(polygons[i], polygons[j]);
      if (!area) {
        diagnostics.push_back(
            unknown_overlap("part " + parts[j]->id, area.error(), parts[i]->id, shared_among(earlier())));
        continue;
      }
      sum += *area;
      if (*area > detail::least_area) own.push_back(overlap_of("part " + parts[j]->id, *area, parts[i]->id));
    }
  if (!own.empty() && more_than(sum, shared_among(earlier())))
    diagnostics.insert(diagnostics.end(), own.begin(), own.end());

  for (const auto* neighbour : neighbours) {
    const auto polygon = model::polygon_of(*neighbour);
    double total = 0, most = 0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      const auto area = detail::overlap(polygons[i], polygon);
      if (!area) {
        diagnostics.push_back(
            unknown_overlap("a neighbouring building", area.error(), parts[i]->id, shared_with(earlier(), polygon)));
        continue;
      }
      total += *area;
      if (*area <= most) continue;
      most = *area;
      worst = i;
    }
    if (total > detail::least_area && more_than(total, shared_with(earlier(), polygon)))
      diagnostics.push_back(overlap_of("a neighbouring building", total, parts[worst]->id));
  }
}

/// The error of the parts, weighted by their area.
auto error_of_parts(std::span<const RaisedPart> parts) -> std::optional<double> {
  double squared = 0, area = 0;
  for (const auto& part : parts) {
    if (!part.mse || !part.model) continue;
    const double ground = label::areas(*part.model).ground;
    squared += *part.mse * ground;
    area += ground;
  }
  return area > 0 ? std::optional(squared / area) : std::nullopt;
}

}  // namespace

auto RaisedBuilding::valid() const -> bool {
  const auto is_error = [](const base::Diagnostic& d) { return d.severity == base::Severity::error; };
  return std::ranges::none_of(diagnostics, is_error) &&
         std::ranges::all_of(parts, [](const auto& part) { return part.model.has_value(); });
}

auto raise(std::span<const NamedPlan> parts, const Site& site, const pipeline::Options& options, const base::Run& run)
    -> RaisedBuilding {
  base::Run inner = run;
  inner.progress = nullptr;
  auto box = box_of(parts);
  if (!site.footprint.empty()) box.include(geometry::bounds(site.footprint));
  box = box.grown(options.label.party_distance + detail::snap);
  std::vector<const model::Plan*> near;
  for (const auto& plan : site.neighbours)
    if (box.overlaps(geometry::bounds(plan.outer.points))) near.push_back(&plan);

  std::vector<Attempt> attempts(parts.size() + near.size());
  base::parallel_for(attempts.size(), [&](std::size_t i) {
    attempts[i] = attempt(i < parts.size() ? parts[i].plan : *near[i - parts.size()], options, inner);
  });

  // Neighbours come along for the party walls.
  std::vector<model::Solid> solids;
  for (auto& raised : attempts)
    if (raised.solid) solids.push_back(std::move(*raised.solid));
  auto labelled = label::classify(std::move(solids), options.label, inner);

  RaisedBuilding out;
  out.parts.resize(parts.size());
  std::vector<const NamedPlan*> sound;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto& part = out.parts[i];
    part.id = parts[i].id;
    part.outcome = attempts[i].outcome;
    part.diagnostics = std::move(attempts[i].diagnostics);
    for (auto& diagnostic : part.diagnostics) diagnostic.subject = part.id;
    if (!attempts[i].solid) continue;
    part.model = std::move(labelled[sound.size()]);
    sound.push_back(&parts[i]);
  }
  base::parallel_for(parts.size(), [&](std::size_t i) {
    auto& part = out.parts[i];
    if (!part.model) return;
    part.volume = solid::volume(part.model->solid);
    if (site.mesh == nullptr) return;
    const double mse =
        evaluate::error_over(part.model->solid, model::polygon_of(parts[i].plan), *site.mesh, options.evaluate);
    if (std::isfinite(mse)) part.mse = mse;
  });

  if (site.mesh == nullptr || site.footprint.empty()) {
    out.mse = error_of_parts(out.parts);
  } else {
    // Neighbours too: a part of theirs may cover some of the footprint, as after a merge.
    std::vector<const model::Solid*> solids_near;
    for (const auto& part : out.parts)
      if (part.model) solids_near.push_back(&part.model->solid);
    for (std::size_t i = sound.size(); i < labelled.size(); ++i) solids_near.push_back(&labelled[i].solid);
    out.mse = evaluate::footprint_error(solids_near, *site.mesh, site.footprint, site.ground, options.evaluate);
  }

  std::set<std::string_view> ids;
  for (const auto& part : parts)
    if (!ids.insert(part.id).second)
      out.diagnostics.push_back(base::error(
          "edit-duplicate-id", "two parts of the building have this id; give one of them another", part.id));
  find_overlaps(sound, near, site.before, out.diagnostics);
  return out;
}

}  // namespace mansard::edit
