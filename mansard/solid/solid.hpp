// Queries on a solid: whether it is valid, its volume and areas, its triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::solid {

/// How strict check() is.
struct Rules {
  double planar = 1e-4;    ///< m; how far a vertex may be off its face's plane
  bool fitted = false;     ///< whether that plane is fitted to the vertices instead of taken from the face's normal
  double snap = 0;         ///< m; vertices nearer than this are taken for one ("solid-near-vertices")
  bool one_shell = false;  ///< whether faces must be connected ("solid-several-shells")
};
/// The rules of files: those of val3dity 2.6 at its defaults (vertices snapped at 1 mm), with planes to 0.1 mm.
[[nodiscard]] auto written_rules() -> Rules;

/// Everything wrong with a solid: "solid-open", "solid-non-manifold", "solid-orientation", "solid-not-planar",
/// "solid-self-intersection", "solid-needle" (a triangle that looks aside by more than 20°; not asked where
/// `planar` is over 1e-4), "solid-degenerate", and what the rules add. Empty means valid.
/// Cost: O(n log n) for faces of bounded size.
[[nodiscard]] auto check(const model::Solid& solid, const Rules& rules = {}) -> std::vector<base::Diagnostic>;

/// m³ by the divergence theorem.
[[nodiscard]] auto volume(const model::Solid& solid) -> double;
/// m² of one face.
[[nodiscard]] auto area(const model::Solid& solid, const model::Face& face) -> double;
/// The solid's faces cut into triangles (indices into solid.vertices), outward, face by face; `face_of` their faces.
/// Fails where that of a face does, and with "solid-degenerate" for a vertex that is not finite.
struct Triangulated {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face_of;
};
[[nodiscard]] auto triangulate(const model::Solid& solid) -> base::Result<Triangulated>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::solid
