// What each triangle of a scan shows.
#pragma once

#include <vector>

#include "lab/simulate/detail/world.hpp"

namespace mansard::simulate::detail {

struct Label {
  Class kind = Class::other;
  std::uint32_t triangle = Scan::none;  ///< of the surface that is shown; none for ground and other
};

/// By the nearest of all surfaces, of two about as near the one that looks the same way.
[[nodiscard]] auto labels_of(const geometry::Mesh& mesh, const World& world, const Nearest& nearest, double radius,
                             const base::Run& run) -> std::vector<Label>;

/// Outward, of unit length; zero without area.
[[nodiscard]] auto normal_of(const geometry::Mesh& mesh, const geometry::Triangle& triangle) -> geometry::Point3;
[[nodiscard]] auto centre_of(const geometry::Mesh& mesh, const geometry::Triangle& triangle) -> geometry::Point3;
/// m².
[[nodiscard]] auto area_of(const geometry::Mesh& mesh, const geometry::Triangle& triangle) -> double;

}  // namespace mansard::simulate::detail
