// The scan seen along the normal of a face.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mansard/texture/detail/face.hpp"
#include "mansard/texture/texture.hpp"

namespace mansard::texture::detail {

/// 0 to 65535, linear light.
using Light = std::array<std::uint16_t, 3>;

/// A triangle of the scan relative to the building's origin.
struct NearTriangle {
  std::array<Point3, 3> corners;
  Point3 normal;  ///< unit; zero without area
  geometry::Box3 box;
  const ScanTriangle* source = nullptr;
};

/// The texels of a face, row by row from the top.
struct FaceLight {
  std::vector<Light> light;
  std::vector<std::uint8_t> state;  ///< of each texel
  std::uint64_t inside = 0, known = 0;
  std::array<std::uint64_t, 3> sum{};  ///< of the light of the known ones
};
/// outside: of the polygon of the face.
enum TexelState : std::uint8_t { outside, unknown, seen };

/// What the scan shows of the face: every texel that is partly inside the polygon is `unknown` or `seen`. A texel is
/// seen where half of its samples inside the polygon show something, or else where points give it a colour: those of
/// `splatted`, or none.
[[nodiscard]] auto project(const FaceGrid& grid, std::span<const NearTriangle* const> triangles, const Scan& scan,
                           const std::vector<std::optional<Light>>& of_points, const Options& options) -> FaceLight;

}  // namespace mansard::texture::detail
