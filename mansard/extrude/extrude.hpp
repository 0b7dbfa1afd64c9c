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
#include "mansard/geometry/plan.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::extrude {

enum class FaceKind : std::uint8_t {
  side,       ///< swept by a part of an edge's profile: wall or roof by its slope
  connector,  ///< vertical, between collinear neighbours with different profiles
  terrace,    ///< horizontal part of a profile
  cap,        ///< flat top where the extrusion was ended
  base,       ///< the ground floor
  soffit,     ///< the level underside of overhanging eaves
};

/// The plan's edge and the part of its profile that a face comes from.
struct Provenance {
  std::uint32_t ring = 0;  ///< 0 the outer ring, 1 … the holes
  std::uint32_t edge = 0;
  std::uint32_t part = 0;  ///< profile part: between points part and part + 1
  friend auto operator<=>(const Provenance&, const Provenance&) = default;
};

/// A planar polygon with holes.
struct Face {
  std::vector<std::vector<std::uint32_t>> loops;  ///< indices; outer loop first, counter-clockwise seen from outside
  FaceKind kind = FaceKind::side;
  std::optional<Provenance> provenance;  ///< for side and terrace
  geometry::Point3 normal;               ///< unit, outward
};

/// A closed polyhedral surface.
struct Solid {
  std::vector<geometry::Point3> vertices;  ///< metres, local frame
  std::vector<Face> faces;
};

/// How far down the ladder a plan had to go.
enum class Outcome : std::uint8_t { full, simplified, two_part, prism };

struct Options {
  double merge_angle = 0.0087;  ///< rad; turns under this are straightened
  double tolerance = 0.05;      ///< m; the canonical footprint lies within this of the input
  /// m; how far the eaves overhang, with a level soffit below. Only where a roof rises from the lowest eaves; 0: none.
  double overhang = 0;
  /// m; vertices are rounded to multiples of this before the check, for files with that many decimals; 0: not at all.
  double grid = 0;
};
[[nodiscard]] auto option_list(Options& options) -> base::OptionList;

struct Raised {
  Solid solid;
  Outcome outcome = Outcome::full;
  std::vector<base::Diagnostic> warnings;  ///< a reason per step down, and what was straightened
  double residual = 0;  ///< m; the furthest that a vertex lies from the plane of one of its faces, by rounding
};

/// Raises the plan. Speeds are never negative, so the roof is a height field above vertical walls.
/// Guarantees: the numbers of docs/extrude.md; the solid passes check(). Never fails for a simple polygon with area:
/// the ladder ends at the prism, or at that of the outline without its details. Gives up with: "extrude-not-simple",
/// "extrude-no-area", "extrude-profile", "extrude-cap".
[[nodiscard]] auto raise(const geometry::Plan& plan, const Options& options = {}, const base::Run& run = {})
    -> base::Result<Raised>;

/// The flat-roofed prism of the plan's polygon, base to cap: the last rung of the ladder. Checked, like raise() and
/// with the same errors.
[[nodiscard]] auto prism(const geometry::Plan& plan, const Options& options = {}) -> base::Result<Solid>;

/// The height above the base at which the sweep of the plan ends, in metres: its ridge, or the cap. Costs no solid and
/// no check. Gives up as raise() does, and with "extrude-canonical" where that would go down the ladder.
[[nodiscard]] auto crest(const geometry::Plan& plan, const Options& options = {}, const base::Run& run = {})
    -> base::Result<double>;

/// The solid as the sweep leaves it, neither rounded nor checked, and without overhang: for looking at many roofs
/// before one is raised. Cost: about a third of raise(). Gives up as crest() does.
[[nodiscard]] auto sketch(const geometry::Plan& plan, const Options& options = {}, const base::Run& run = {})
    -> base::Result<Solid>;

/// Everything wrong with a solid: "solid-open", "solid-non-manifold", "solid-orientation", "solid-not-planar" (a vertex
/// more than `planar` metres off its face's plane), "solid-self-intersection", "solid-needle" (a triangle that looks
/// aside by more than 20°; not asked where `planar` is over 1e-4), "solid-degenerate". Empty means valid.
/// Cost: O(n log n) for faces of bounded size.
[[nodiscard]] auto check(const Solid& solid, double planar = 1e-4) -> std::vector<base::Diagnostic>;

/// m³ by the divergence theorem.
[[nodiscard]] auto volume(const Solid& solid) -> double;
/// m² of one face.
[[nodiscard]] auto area(const Solid& solid, const Face& face) -> double;
/// The solid's faces cut into triangles (indices into solid.vertices), outward, face by face; `face_of` their faces.
struct Triangulated {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face_of;
};
[[nodiscard]] auto triangulate(const Solid& solid) -> base::Result<Triangulated>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::extrude
