// Outlines clipped at the end of the mesh and parted from each other. Where an operation on polygons fails, an outline
// stays as it was, and a warning "derive-outline-kept" says so: no building is lost by it.
#pragma once

#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::derive::detail {

/// The warning that `what` became of a polygon, because of `why`.
[[nodiscard]] auto kept(const std::string& what, const base::Diagnostic& why, const geometry::Polygon& polygon)
    -> base::Diagnostic;

/// What a straight wall would add beyond the end of the mesh is taken off.
[[nodiscard]] auto clipped(const geometry::Polygon& polygon, const geometry::Box2& to,
                           std::vector<base::Diagnostic>& warnings) -> std::vector<geometry::Polygon>;

/// What of the polygons is not in those drawn before, without the slivers that are left of it.
[[nodiscard]] auto parted(std::vector<geometry::Polygon> polygons, const std::vector<geometry::Polygon>& before,
                          double slip_width, std::vector<base::Diagnostic>& warnings) -> std::vector<geometry::Polygon>;

/// The simple pieces of a polygon whose rings may touch in points, as a subtraction leaves them.
[[nodiscard]] auto simple(const geometry::Polygon& polygon, std::vector<base::Diagnostic>& warnings)
    -> std::vector<geometry::Polygon>;

}  // namespace mansard::derive::detail
