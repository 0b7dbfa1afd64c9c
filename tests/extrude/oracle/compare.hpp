// The kernel's exact surface beside the oracle's.
#pragma once

#include <string>

#include "mansard/extrude/detail/sweep.hpp"
#include "oracle.hpp"

namespace oracle {

using mansard::extrude::detail::ExactSurface;

/// The exact place of a surface's point.
[[nodiscard]] inline auto exact_point(const ExactSurface& surface, std::uint32_t i) -> Point3 {
  const auto p = surface.exact(i);
  return {p.x, p.y, p.z};
}

/// m³ of the closed surface, exact, by the divergence theorem.
[[nodiscard]] auto volume(const ExactSurface& surface) -> Rational;

/// The surface's faces in the oracle's form: terraces that share an edge joined, all faces of the cap as one, and those
/// of the base.
[[nodiscard]] auto faces(const ExactSurface& surface) -> std::vector<Face>;

/// Where the surface's edges pass the height z upwards or downwards, sorted: the corners of its section.
[[nodiscard]] auto section_corners(const ExactSurface& surface, const Rational& z) -> std::vector<Point>;
/// m² of the section, exact. z is no vertex's height.
[[nodiscard]] auto section_area(const ExactSurface& surface, const Rational& z) -> Rational;

/// What differs between the kernel's surface and the oracle's, in words; empty when nothing does. Names aside.
[[nodiscard]] auto difference(const ExactSurface& surface, const Solid& solid) -> std::string;

/// The first face whose name is that of an edge that does not sweep it, in words; empty when there is none. Edges on
/// one line with one profile sweep one face where they have met, and it goes by any of them; so does a terrace, which
/// goes by the first of all edges that sweep it.
[[nodiscard]] auto misnamed(const mansard::extrude::detail::Footprint& footprint, const std::vector<Face>& ours,
                            const std::vector<Face>& judged) -> std::string;

}  // namespace oracle
