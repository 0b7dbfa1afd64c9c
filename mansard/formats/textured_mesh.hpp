// A mesh with the pictures on it, as files have them: read where textures are asked for.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/up_axis.hpp"
#include "mansard/geometry/mesh.hpp"

namespace mansard::formats {

struct TileFile;

/// Where the bytes of a picture are: in a file of their own, or here.
struct ImageSource {
  std::filesystem::path path;                  ///< of the picture, or of the file that contains it
  std::shared_ptr<const std::string> bytes{};  ///< of an embedded one; none: to be read from `path`
  std::string name;                            ///< for messages
  std::optional<base::Diagnostic> refused{};   ///< why it must not be opened

  /// The picture that `from` names, which is the input `given` or belongs to it.
  [[nodiscard]] static auto beside(const std::filesystem::path& given, const std::filesystem::path& from,
                                   const std::string& name) -> ImageSource;
};

/// What is beyond the border of a picture.
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// 0 to 65535, linear light.
using LinearColour = std::array<std::uint16_t, 3>;
inline constexpr LinearColour white{65535, 65535, 65535};

/// A point of a cloud with its colour.
struct ColouredPoint {
  geometry::Point3 position;
  LinearColour colour{};
  bool ground = false;  ///< by its class, or water
};

struct TextureMaterial {
  std::optional<ImageSource> image;
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
};

struct TexturedCorners {
  std::array<std::array<float, 2>, 3> uv{};  ///< in widths and heights of the picture from its top left corner
  std::array<LinearColour, 3> colour{white, white, white};  ///< what the picture is multiplied with, or the colour
};

/// Stands for an index that names no material.
inline constexpr std::uint32_t no_material = 0xffffffffU;

struct TexturedMesh {
  geometry::Mesh mesh;  ///< as its file has it: corners may name vertices that do not exist, coordinates may be NaN
  /// Per triangle, as the next one: empty where the file has neither textures nor colours.
  std::vector<TexturedCorners> corners;
  std::vector<std::uint32_t> material_of;  ///< no_material for none
  std::vector<TextureMaterial> materials;
  std::vector<base::Diagnostic> warnings;
  [[nodiscard]] auto has_colour() const -> bool { return !corners.empty() && corners.size() == mesh.triangles.size(); }
};

/// sRGB, 0 to 255, as linear light (IEC 61966-2-1).
[[nodiscard]] auto linear_of(std::uint8_t srgb) -> std::uint16_t;
/// The nearest sRGB value.
[[nodiscard]] auto srgb_of(std::uint16_t linear) -> std::uint8_t;

/// The more goes to the end of all.
void append(TexturedMesh& all, TexturedMesh more);

/// The file of a mesh with what colours it: z up. Formats without colours, and rasters, give the triangles alone; glTF
/// and OBJ give textures and colours of corners. Fails as read_mesh_file; a library of materials that is missing is a
/// warning ("texture-missing").
[[nodiscard]] auto read_textured_file(const std::filesystem::path& path, UpAxis up) -> base::Result<TexturedMesh>;
[[nodiscard]] auto read_textured_tile(const TileFile& tile) -> base::Result<TexturedMesh>;

}  // namespace mansard::formats
