#include "mansard/extrude/extrude.hpp"

#include <algorithm>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/corner_edges.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/narrow.hpp"
#include "mansard/extrude/detail/outlines.hpp"
#include "mansard/extrude/detail/rounding.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/detail/sweep.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::extrude {
namespace {

struct Sound {
  model::Solid solid;
  double residual = 0;
};

/// Sweep → rounding → check: the solid, or what is wrong with it.
auto solid_of(const detail::Footprint& footprint, const model::Plan& plan, const Options& options, const base::Run& run,
              const detail::Eaves* eaves) -> base::Result<Sound> {
  const auto surface = detail::sweep(footprint, detail::on_grid(plan.cap), run, eaves);
  std::vector<base::Diagnostic> faults;
  for (const double short_arc : {options.short_arc, 0.0}) {
    auto rounded = detail::rounded(surface, {footprint.origin, plan.base, options.grid}, short_arc);
    faults = solid::check(rounded.solid);
    if (faults.empty()) return Sound{std::move(rounded.solid), rounded.residual};
    if (rounded.collapsed == 0) break;
  }
  return faults.front();
}

/// The flat prism over the source, or what is wrong with it.
auto prism_over(const detail::Source& source, const model::Plan& plan, const Options& options)
    -> base::Result<model::Solid> {
  model::Solid solid = detail::prism_of(source, plan.base, plan.cap);
  for (auto& v : solid.vertices) v = detail::on_grid(v, options.grid);
  const auto faults = solid::check(solid);
  if (!faults.empty()) return faults.front();
  return solid;
}

/// As given, else without its details, which may be what spoils it.
auto last_rung(const detail::Source& source, const model::Plan& plan, const Options& options)
    -> base::Result<model::Solid> {
  auto solid = prism_over(source, plan, options);
  if (!solid) solid = prism_over(detail::simplified(source, options.simpler.detail), plan, options);
  if (solid) return solid;
  const std::string place = detail::narrow_place(source);
  return base::error("extrude-narrow", "not even a flat-roofed prism can be made of the outline: " +
                                           (place.empty() ? solid.error().message : place));
}

/// The same without exceptions: nothing, and why, where an invariant of the sweep broke too.
auto tried(const detail::Footprint& footprint, const model::Plan& plan, const Options& options, const base::Run& run,
           const detail::Eaves* eaves, std::string& why) -> std::optional<Sound> {
  try {
    auto solid = solid_of(footprint, plan, options, run, eaves);
    if (solid) return std::move(*solid);
    why = solid.error().message + " [" + solid.error().code + "]";
  } catch (const detail::Broken& broken) {
    why = broken.what();
  }
  return std::nullopt;
}

/// The outline with what it does not have by itself: edges at corners, and holes that go on with a slope, which may be
/// that of such an edge. None where it has all. `moved`: m, that its lines were moved before.
auto completed(const detail::Footprint& outline, const detail::Source& source, const Options& options, double moved = 0)
    -> std::optional<detail::Footprint> {
  if (source.corner_edges.empty()) return detail::continued(outline, moved);
  auto with_corners = detail::with_corner_edges(outline, source, options);
  auto out = detail::continued(with_corners, moved);
  return out ? std::move(out) : std::move(with_corners);
}

auto edges_in(const detail::Footprint& footprint) -> std::size_t {
  std::size_t edges = 0;
  for (const auto& ring : footprint.rings) edges += ring.size();
  return edges;
}

/// Canonical footprint → solid; nothing, and why, if it cannot be.
auto attempt(const detail::Source& source, const model::Plan& plan, const Options& options, const base::Run& run,
             std::vector<base::Diagnostic>& warnings, std::string& why) -> std::optional<Sound> {
  // Nudges are made of the outline alone: what they move has to be put on one plane again.
  const auto outline = detail::canonical(source, options, why);
  if (!outline) return std::nullopt;
  auto footprint = completed(*outline, source, options).value_or(*outline);
  auto solid = tried(footprint, plan, options, run, nullptr, why);
  // Vertical walls that meet in a line exactly: the right answer is not a manifold. A little less or more parts them.
  for (int nudge = 0; !solid && nudge < detail::most_nudges && !run.cancelled(); ++nudge) {
    std::string how, reason;
    auto other = detail::nudged(*outline, nudge, options, how);
    if (!other) continue;
    if (auto all = completed(*other, source, options, other->moved - outline->moved)) other = std::move(all);
    solid = tried(*other, plan, options, run, nullptr, reason);
    if (!solid) continue;
    warnings.push_back(base::warning("extrude-nudged", how.append(": ").append(why)));
    footprint = *std::move(other);
  }
  if (solid && options.overhang > 0) {
    std::string hindrance;
    // No hindrance is told where there is nothing that could overhang.
    if (const auto eaves = detail::eaves_of(footprint, detail::on_grid(plan.cap), options, hindrance))
      if (auto roofed = tried(footprint, plan, options, run, &*eaves, hindrance)) solid = std::move(roofed);
    if (!hindrance.empty()) warnings.push_back(base::warning("extrude-overhang", hindrance));
  }
  constexpr double worth_telling = 0.01;  // m; decides about the warning alone
  if (solid && footprint.moved > worth_telling)
    warnings.push_back(
        base::warning("extrude-straightened", "shallow turns were straightened; the outline moved by up to " +
                                                  base::to_text(footprint.moved, 3) +
                                                  " m; lower --extrude-merge-angle to keep them"));
  const std::size_t wanted = edges_in(*outline) + source.corner_edges.size(), made = edges_in(footprint);
  if (solid && made < wanted)
    warnings.push_back(base::warning(
        "extrude-corner-edge", std::to_string(wanted - made) + " of " + std::to_string(source.corner_edges.size()) +
                                   " edges at corners were left out, with their roofs: the walls beside them have "
                                   "other directions now"));
  return solid;
}

/// use(footprint, surface) of the plan as it is, without the ladder.
template <class T, class Use>
auto after_sweep(const model::Plan& plan, const Options& options, const base::Run& run, Use use) -> base::Result<T> {
  const auto source = detail::prepared(plan);
  if (!source) return source.error();
  std::string why;
  try {
    if (const detail::Footprint* footprint = detail::canonical_outline(*source, options, why)) {
      const auto with_all = completed(*footprint, *source, options);
      if (with_all) footprint = &*with_all;
      return use(*footprint, detail::sweep(*footprint, detail::on_grid(plan.cap), run));
    }
  } catch (const detail::Broken& broken) {
    why = broken.what();
  }
  return base::error("extrude-canonical", why);
}

}  // namespace

auto raise(const model::Plan& plan, const Options& options, const base::Run& run) -> base::Result<Raised> {
  auto source = detail::prepared(plan);
  if (!source) return source.error();
  Raised raised;
  std::string why;
  const auto succeeds = [&](const detail::Source& from, const Options& with, Outcome outcome) {
    if (run.cancelled()) return false;
    auto solid = attempt(from, plan, with, run, raised.warnings, why);
    if (!solid) return false;
    raised.solid = std::move(solid->solid);
    raised.residual = solid->residual;
    raised.outcome = outcome;
    return true;
  };
  if (succeeds(*source, options, Outcome::full)) {
    if (auto edges = detail::small_edges(*source, raised.solid, options.tolerance); !edges.empty())
      raised.warnings.push_back(base::warning("extrude-small-edge", std::move(edges)));
    return raised;
  }

  // Down the ladder: small details and shallow turns go first, then all but one pitch, then the roof.
  Options coarse = options;
  coarse.merge_angle = std::max(options.merge_angle, options.simpler.merge_angle);
  coarse.tolerance = std::max(options.tolerance, options.simpler.detail);
  const detail::Source simple = detail::simplified(*source, options.simpler.detail);
  raised.warnings.push_back(base::warning("extrude-simplified", "the footprint was simplified: " + why));
  if (succeeds(simple, coarse, Outcome::simplified)) return raised;
  raised.warnings.push_back(base::warning("extrude-two-part", "the profiles were reduced to wall and pitch: " + why));
  if (succeeds(detail::two_part(simple), coarse, Outcome::two_part)) return raised;
  raised.warnings.push_back(base::warning(
      "extrude-prism", "the part became a flat-roofed prism: " + (run.cancelled() ? "stopped on request" : why)));
  auto flat = last_rung(*source, plan, options);
  if (!flat) return flat.error();
  raised.solid = std::move(*flat);
  raised.outcome = Outcome::prism;
  return raised;
}

auto prism(const model::Plan& plan, const Options& options) -> base::Result<model::Solid> {
  const auto source = detail::prepared(plan);
  if (!source) return source.error();
  return last_rung(*source, plan, options);
}

auto crest(const model::Plan& plan, const Options& options, const base::Run& run) -> base::Result<double> {
  return after_sweep<double>(plan, options, run, [](const auto&, const auto& surface) {
    double top = 0;
    for (const auto& place : surface.places) top = std::max(top, place.z);
    return top;
  });
}

auto sketch(const model::Plan& plan, const Options& options, const base::Run& run) -> base::Result<model::Solid> {
  return after_sweep<model::Solid>(plan, options, run, [&plan](const auto& footprint, const auto& surface) {
    return detail::rounded(surface, {footprint.origin, plan.base, 0}, 0).solid;
  });
}

auto codes() -> std::vector<base::Code> {
  return {
      {"extrude-not-simple", "A footprint's edges cross or touch, or a hole lies outside of it.",
       "Repair the footprint; parts that touch in a point only must be separate.", 1},
      {"extrude-narrow", "A footprint is so narrow somewhere that two of its walls coincide in the files.",
       "Remove the sliver, needle or neck that the message names, or widen it to at least 5 mm.", 1},
      {"extrude-no-area", "A footprint has no area.", "Remove it, or give it at least three corners.", 1},
      {"extrude-profile", "A profile does not start at (0, 0), leans outwards, goes down, or is missing.",
       "Correct the plan's profile: inward and height must never decrease.", 1},
      {"extrude-cap", "The height at which the extrusion ends is not above the base, or more than 100 km above it.",
       "Set the plan's cap to a height between 0.1 mm and 100 km; a steep last pitch makes high roofs on wide "
       "outlines.",
       1},
      {"extrude-canonical", "A footprint has no simple outline on exact lines within tolerance.",
       "Widen the narrow place that the message names, or raise --extrude-tolerance.", 1},
      {"extrude-straightened", "Shallow turns of a footprint were straightened by more than a centimetre.",
       "Lower --extrude-merge-angle to keep them.", 0},
      {"extrude-small-edge",
       "An edge shorter than the tolerance has a profile of its own. Whether it decides a large part of the roof or "
       "none "
       "depends on millimetres of the outline.",
       "Give the edge the profile of a neighbour, or remove it.", 0},
      {"extrude-nudged",
       "Vertical walls met exactly in a line, which no manifold can; runs were shortened by up to 1 %, or walls moved "
       "by up to 3 mm.",
       "Change a setback or a wall by a few millimetres.", 0},
      {"extrude-corner-edge", "An edge at a corner, which gives a roof a direction of its own, could not be made.",
       "Give the edge a direction between those of the walls beside it, at least half a degree from both.", 1},
      {"extrude-overhang", "A building got no overhanging eaves, or not all around.",
       "Give its roof edges eaves at one height above vertical walls, and less overhang where walls are close.", 0},
      {"extrude-simplified",
       "A building could not be extruded in full detail; its footprint was simplified by up to 30 cm.",
       "Look for very small or nearly parallel edges in its plan.", 1},
      {"extrude-two-part", "A building could only be extruded with one pitch per edge.",
       "Look for profile knots and terraces that leave slivers.", 1},
      {"extrude-prism", "A building fell back to a flat-roofed prism.", "See the reason; edit its plan or profiles.",
       1},
  };
}

}  // namespace mansard::extrude
