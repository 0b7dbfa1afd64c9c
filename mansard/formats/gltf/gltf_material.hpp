// What of a material of glTF colours a surface: its base colour.
#pragma once

#include <tiny_gltf.h>
#include <array>
#include <string>

#include "mansard/formats/textured_mesh.hpp"

namespace mansard::formats {

struct GltfMaterial {
  int image = -1;  ///< of the file; −1 for none
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
  std::array<double, 3> factor{1, 1, 1};  ///< linear light
  int uv_set = 0;
  /// KHR_texture_transform: rows of a 2 × 3 matrix.
  std::array<std::array<double, 3>, 2> turn{{{1, 0, 0}, {0, 1, 0}}};

  [[nodiscard]] auto turned(float u, float v) const -> std::array<float, 2> {
    const auto row = [&](const std::array<double, 3>& r) {
      return static_cast<float>(r[0] * static_cast<double>(u) + r[1] * static_cast<double>(v) + r[2]);
    };
    return {row(turn[0]), row(turn[1])};
  }
};

/// The material of that number; white for none.
[[nodiscard]] auto material_of(const tinygltf::Model& model, int number) -> GltfMaterial;
/// Where that image is; `file` is the name of the glTF file, beside which others are. None where there is no such.
[[nodiscard]] auto image_source(const tinygltf::Model& model, int image, const std::string& file)
    -> std::optional<ImageSource>;

}  // namespace mansard::formats
