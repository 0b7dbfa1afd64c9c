// What a scan loses and how it is torn.
#pragma once

#include <vector>

#include "lab/simulate/detail/labels.hpp"

namespace mansard::simulate::detail {

/// Per vertex, outward, of unit length; weighted by area.
[[nodiscard]] auto vertex_normals(const geometry::Mesh& mesh) -> std::vector<geometry::Point3>;

/// Per vertex: how much of what cameras above could see of such a surface they do see, 0 … 1. Cameras look down, and at
/// `tilt` radians from that from eight sides.
[[nodiscard]] auto visibility(const geometry::Mesh& mesh, const std::vector<geometry::Point3>& normals, double tilt,
                              const base::Run& run) -> std::vector<double>;

/// How far roofs were moved along their normals: root mean squares over their area, metres.
struct Roughness {
  double noise = 0, bulge = 0, both = 0;
};
/// Moves the vertices along their normals: noise everywhere and a longer wave of what is steep, both stronger by up to
/// `noise_hidden` where few cameras see.
auto roughen(geometry::Mesh& mesh, const std::vector<geometry::Point3>& normals, const std::vector<double>& seen,
             const std::vector<Label>& labels, const ScanOptions& options, std::uint64_t seed) -> Roughness;

/// Marks what is lost: walls that were not matched, and holes where few cameras see, first of all low down.
[[nodiscard]] auto losses(const geometry::Mesh& mesh, const std::vector<Label>& labels, const std::vector<double>& seen,
                          const World& world, const ScanOptions& options, std::uint64_t seed) -> std::vector<bool>;

/// What remains, in tiles that do not quite fit, without crumbs of a few triangles.
[[nodiscard]] auto torn(const geometry::Mesh& mesh, const std::vector<Label>& labels, std::vector<bool> lost,
                        const Surface& surface, const ScanOptions& options, std::uint64_t seed) -> Scan;

}  // namespace mansard::simulate::detail
