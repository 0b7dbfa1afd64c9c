// The readers of meshes with textures, one per format that has them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "mansard/formats/mesh/transform.hpp"
#include "mansard/formats/textured_mesh.hpp"

namespace mansard::formats {

/// Wavefront OBJ with its libraries (mtllib, usemtl, map_Kd, Kd) and the colours of vertices behind their coordinates;
/// fails as read_obj.
[[nodiscard]] auto read_textured_obj(std::string_view bytes, const std::filesystem::path& path)
    -> base::Result<TexturedMesh>;

/// PLY with texture coordinates of faces or vertices, its files ("comment TextureFile"), and colours of vertices or
/// faces; fails as read_ply.
[[nodiscard]] auto read_textured_ply(std::string_view bytes, const std::filesystem::path& path)
    -> base::Result<TexturedMesh>;

struct TexturedGltf {
  TexturedMesh mesh;                       ///< y up, as the file has it
  std::optional<geometry::Point3> centre;  ///< as of GltfMesh
};
/// glTF 2.0 with base colour textures (KHR_texture_transform, EXT_texture_webp, KHR_techniques_webgl), factors and
/// COLOR_0; fails as read_gltf.
[[nodiscard]] auto read_textured_gltf(std::string_view bytes, const std::filesystem::path& path)
    -> base::Result<TexturedGltf>;

/// A tile of 3D Tiles; fails as read_tile_content.
[[nodiscard]] auto read_textured_content(std::string_view bytes, const std::filesystem::path& path,
                                         const Transform& turn, const Transform& place) -> base::Result<TexturedMesh>;

}  // namespace mansard::formats
