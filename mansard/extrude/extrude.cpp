#include "mansard/extrude/extrude.hpp"

#include <algorithm>
#include <utility>

#include "mansard/base/text.hpp"
#include "mansard/extrude/detail/footprint.hpp"
#include "mansard/extrude/detail/measure.hpp"
#include "mansard/extrude/detail/rounding.hpp"
#include "mansard/extrude/detail/source.hpp"
#include "mansard/extrude/detail/sweep.hpp"

namespace mansard::extrude {
namespace {

/// Sweep → rounding → check: the solid, or what is wrong with it.
auto solid_of(const detail::Footprint& footprint, const geometry::Plan& plan, const base::Run& run)
    -> base::Result<Solid> {
  const auto surface = detail::sweep(footprint, detail::on_grid(plan.cap), run);
  std::vector<base::Diagnostic> faults;
  for (const bool collapse : {true, false}) {
    Solid solid = detail::rounded(surface, {footprint.origin, plan.base}, collapse);
    faults = check(solid);
    if (faults.empty()) return solid;
  }
  return faults.front();
}

/// Canonical footprint → solid; nothing, and why, if it cannot be.
auto attempt(const detail::Source& source, const geometry::Plan& plan, const Options& options, const base::Run& run,
             std::vector<base::Diagnostic>& warnings, std::string& why) -> std::optional<Solid> {
  try {
    auto footprint = detail::canonical(source, options, why);
    if (!footprint) return std::nullopt;
    auto solid = solid_of(*footprint, plan, run);
    if (!solid && solid.error().code == "solid-non-manifold") {
      // Upright walls that meet in a line exactly: the right answer is not a manifold. A little less run parts them.
      detail::shorten_runs(footprint->tracks);
      solid = solid_of(*footprint, plan, run);
      if (solid)
        warnings.push_back(
            base::warning("extrude-nudged", "upright walls met in a line; all runs were shortened by 0.1 %"));
    }
    constexpr double worth_telling = 0.01;
    if (solid && footprint->moved > worth_telling)
      warnings.push_back(base::warning(
          "extrude-straightened",
          "shallow turns were straightened; the outline moved by up to " + base::to_text(footprint->moved, 3) + " m"));
    if (solid) return std::move(*solid);
    why = solid.error().message + " [" + solid.error().code + "]";
  } catch (const detail::Broken& broken) {
    why = broken.what();
  }
  return std::nullopt;
}

}  // namespace

auto raise(const geometry::Plan& plan, const Options& options, const base::Run& run) -> base::Result<Raised> {
  auto source = detail::prepared(plan);
  if (!source) return source.error();
  Raised raised;
  std::string why;
  const auto succeeds = [&](const detail::Source& from, const Options& with, Outcome outcome) {
    if (run.cancelled()) return false;
    auto solid = attempt(from, plan, with, run, raised.warnings, why);
    if (!solid) return false;
    raised.solid = std::move(*solid);
    raised.outcome = outcome;
    return true;
  };
  if (succeeds(*source, options, Outcome::full)) return raised;

  // Down the ladder: details of 30 cm and turns of 5° go first, then all but one pitch, then the roof.
  constexpr double detail_size = 0.3, shallow = 0.0873;
  Options coarse;
  coarse.merge_angle = std::max(options.merge_angle, shallow);
  coarse.tolerance = std::max(options.tolerance, detail_size);
  const detail::Source simple = detail::simplified(*source, detail_size);
  raised.warnings.push_back(base::warning("extrude-simplified", "the footprint was simplified: " + why));
  if (succeeds(simple, coarse, Outcome::simplified)) return raised;
  raised.warnings.push_back(base::warning("extrude-two-part", "the profiles were reduced to wall and pitch: " + why));
  if (succeeds(detail::two_part(simple), coarse, Outcome::two_part)) return raised;
  raised.warnings.push_back(base::warning(
      "extrude-prism", "the part became a flat-roofed prism: " + (run.cancelled() ? "stopped on request" : why)));
  raised.solid = detail::prism_of(*source, plan.base, plan.cap);
  raised.outcome = Outcome::prism;
  return raised;
}

auto prism(const geometry::Plan& plan) -> base::Result<Solid> {
  const auto source = detail::prepared(plan);
  if (!source) return source.error();
  return detail::prism_of(*source, plan.base, plan.cap);
}

auto volume(const Solid& solid) -> double {
  if (solid.vertices.empty()) return 0;
  const geometry::Point3 o = solid.vertices.front();  // near the solid, so that far-away ones keep their digits
  double sum = 0;
  for (const Face& face : solid.faces)
    if (!face.loops.empty() && !face.loops[0].empty())
      sum += dot(detail::area_vector(solid, face), solid.vertices[face.loops[0][0]] - o) / 6;
  return sum;
}

auto area(const Solid& solid, const Face& face) -> double { return length(detail::area_vector(solid, face)) / 2; }

auto triangulate(const Solid& solid) -> base::Result<Triangulated> {
  Triangulated out;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const auto part = detail::triangles_of(solid, solid.faces[f]);
    if (!part) return part.error();
    out.triangles.insert(out.triangles.end(), part->begin(), part->end());
    out.face_of.insert(out.face_of.end(), part->size(), f);
  }
  return out;
}

auto option_list(Options& options) -> base::OptionList {
  return std::move(base::OptionList("extrude")
                       .number("merge_angle", options.merge_angle, "rad", {0, 0.2},
                               "Turns of the footprint under this are straightened.")
                       .number("tolerance", options.tolerance, "m", {0.001, 1},
                               "The footprint that is raised lies within this of the given one."));
}

auto codes() -> std::vector<base::Code> {
  return {
      {"extrude-not-simple", "A footprint's edges cross or touch, or a hole lies outside of it.",
       "Repair the footprint; parts that touch in a point only must be separate.", 1},
      {"extrude-no-area", "A footprint has no area.", "Remove it, or give it at least three corners.", 1},
      {"extrude-profile", "A profile does not start at (0, 0), leans outwards, goes down, or is missing.",
       "Correct the plan's profile: inward and height must never decrease.", 1},
      {"extrude-cap", "The height at which the extrusion ends is not above the base.", "Set the plan's cap above 0.",
       1},
      {"extrude-straightened", "Shallow turns of a footprint were straightened by more than a centimetre.",
       "Lower --extrude-merge-angle to keep them.", 0},
      {"extrude-nudged",
       "Walls above setbacks met exactly in a line, which no manifold can; runs were shortened by 0.1 %.",
       "Change a setback by a few millimetres.", 0},
      {"extrude-simplified",
       "A building could not be raised in full detail; its footprint was simplified by up to 30 cm.",
       "Look for very small or nearly parallel edges in its plan.", 1},
      {"extrude-two-part", "A building could only be raised with one pitch per edge.",
       "Look for profile knots and terraces that leave slivers.", 1},
      {"extrude-prism", "A building fell back to a flat-roofed prism.", "See the reason; edit its plan or profiles.",
       1},
      {"solid-open", "A solid has an edge with a face on one side only.",
       "This is a fault of the program that made it.", 1},
      {"solid-non-manifold", "More than two faces meet at an edge, or faces meet at a vertex only.",
       "Separate the parts that touch.", 1},
      {"solid-orientation", "A solid or one of its faces is inside out.",
       "This is a fault of the program that made it.", 1},
      {"solid-not-planar", "A face bends by more than 0.1 mm.", "This is a fault of the program that made it.", 1},
      {"solid-self-intersection", "Faces of a solid cross or touch where they are no neighbours.",
       "This is a fault of the program that made it.", 1},
      {"solid-degenerate", "A solid has a face without area, a repeated vertex or a value that is not finite.",
       "This is a fault of the program that made it.", 1},
  };
}

}  // namespace mansard::extrude
