// What can be asked of a solid: whether it is valid, its volume and areas, its triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/solid.hpp"

namespace mansard::solid {

/// Everything wrong with a solid: "solid-open", "solid-non-manifold", "solid-orientation", "solid-not-planar" (a vertex
/// more than `planar` metres off its face's plane), "solid-self-intersection", "solid-needle" (a triangle that looks
/// aside by more than 20°; not asked where `planar` is over 1e-4), "solid-degenerate". Empty means valid.
/// Cost: O(n log n) for faces of bounded size.
[[nodiscard]] auto check(const model::Solid& solid, double planar = 1e-4) -> std::vector<base::Diagnostic>;

/// m³ by the divergence theorem.
[[nodiscard]] auto volume(const model::Solid& solid) -> double;
/// m² of one face.
[[nodiscard]] auto area(const model::Solid& solid, const model::Face& face) -> double;
/// The solid's faces cut into triangles (indices into solid.vertices), outward, face by face; `face_of` their faces.
struct Triangulated {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face_of;
};
[[nodiscard]] auto triangulate(const model::Solid& solid) -> base::Result<Triangulated>;

[[nodiscard]] auto codes() -> std::vector<base::Code>;

}  // namespace mansard::solid
