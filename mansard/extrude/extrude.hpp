// Raises a footprint along one profile per edge into a watertight solid. A kernel: knows only geometry.
// Reference: T. Kelly, P. Wonka, Interactive Architectural Modeling with Procedural Extrusions, ACM TOG 30(2), 2011.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/options.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::extrude {

/// How far down the ladder a plan had to go.
enum class Outcome : std::uint8_t { full, simplified, two_part, prism };

/// The groups are advanced options: choices that few have a reason to change. What bounds an error is no option, and is
/// found beside its derivation.
struct Options {
  double merge_angle = 0.0087;  ///< rad; turns under this are straightened
  double tolerance = 0.05;      ///< m; the canonical footprint lies within this of the input
  /// m; how far the eaves overhang, with a level soffit below. Only where a roof rises from the lowest eaves; 0: none.
  double overhang = 0;
  /// m; vertices are rounded to multiples of this before the check, for files with that many decimals; 0: not at all.
  double grid = 0;

  /// The lines of a canonical footprint.
  struct Lines {
    double share_move = 1e-3;                         ///< m
    double share_turn = 0.02;                         ///< rad
    static constexpr double min_stretch = 0x1.0p-10;  ///< m; 64 steps of the kernel's grid, a millimetre
  } lines;

  /// Overhanging eaves.
  struct Eaves {
    static constexpr double mitre = 4;          ///< a corner of 29°, the usual limit of mitres
    static constexpr double min_soffit = 0.01;  ///< m; so that the soffit is above the base
  } eaves;

  /// The second rung of the ladder.
  struct Simpler {
    double detail = 0.3;          ///< m
    double merge_angle = 0.0873;  ///< rad
  } simpler;

  /// Walls of neighbours that are put on one line (align.hpp).
  struct Shared {
    double min_overlap = 0.1;  ///< m
    double max_turn = 0.05;    ///< rad
  } shared;

  double short_arc = 1e-3;  ///< m; edges of the solid shorter than this are drawn together where that changes no face
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

struct Raised {
  model::Solid solid;
  Outcome outcome = Outcome::full;
  std::vector<base::Diagnostic> warnings;  ///< a reason per step down, and what was straightened
  double residual = 0;  ///< m; the furthest that a vertex lies from the plane of one of its faces, by rounding
};

/// Raises the plan. Speeds are never negative, so the roof is a height field above vertical walls.
/// Guarantees: the numbers of docs/extrude.md; the solid passes check(). Never fails for a simple polygon with area:
/// the ladder ends at the prism, or at that of the outline without its details. Fails with: "extrude-not-simple",
/// "extrude-no-area", "extrude-narrow", "extrude-profile", "extrude-cap".
[[nodiscard]] auto raise(const model::Plan& plan, const Options& options = {}, const base::Run& run = {})
    -> base::Result<Raised>;

/// The flat-roofed prism of the plan's polygon, base to cap: the last rung of the ladder. Checked, like raise() and
/// with the same errors.
[[nodiscard]] auto prism(const model::Plan& plan, const Options& options = {}) -> base::Result<model::Solid>;

/// The height above the base at which the sweep of the plan ends, in metres: its ridge, or the cap. Costs no solid and
/// no check. Fails as raise() does, and with "extrude-canonical" where that would go down the ladder.
[[nodiscard]] auto crest(const model::Plan& plan, const Options& options = {}, const base::Run& run = {})
    -> base::Result<double>;

/// The solid as the sweep leaves it, neither rounded nor checked, and without overhang: for looking at many roofs
/// before one is raised. Cost: about a third of raise(). Fails as crest() does.
[[nodiscard]] auto sketch(const model::Plan& plan, const Options& options = {}, const base::Run& run = {})
    -> base::Result<model::Solid>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::extrude
