// One reader per mesh format, from the bytes of a file. All fail with "ingest-mesh-format" (what is wrong, and the
// line where there are lines), "ingest-mesh-truncated" (the file ends too early) and "ingest-mesh-empty".
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/mesh/raw_mesh.hpp"
#include "mansard/formats/up_axis.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// Wavefront OBJ: v and f; negative indices, polygons, continued lines.
[[nodiscard]] auto read_obj(std::string_view bytes, const std::string& name) -> base::Result<RawMesh>;
/// Stanford PLY: ascii and binary of either byte order; vertices, faces, triangle strips.
[[nodiscard]] auto read_ply(std::string_view bytes, const std::string& name) -> base::Result<RawMesh>;
/// OFF with its C, N and ST variants, as text.
[[nodiscard]] auto read_off(std::string_view bytes, const std::string& name) -> base::Result<RawMesh>;

struct GltfMesh {
  RawMesh mesh;                            ///< y up, as the file has it
  std::optional<geometry::Point3> centre;  ///< CESIUM_RTC: to be added once z is up
  std::vector<model::InputFile> buffers;   ///< files beside it that were read
};
/// glTF 2.0, binary or JSON, plain or compressed with Draco or meshopt; `path` leads to the buffers beside it. Fails
/// with "file-missing" and "file-read" for those too.
[[nodiscard]] auto read_gltf(std::string_view bytes, const std::filesystem::path& path) -> base::Result<GltfMesh>;

struct AssimpMesh {
  RawMesh mesh;           ///< in metres; of STL, in its own unit
  UpAxis up = UpAxis::y;  ///< that of `mesh`, never automatic; STL, which does not say, is taken as z up
  std::vector<base::Diagnostic> warnings;
};
/// What the Open Asset Import Library reads, in another process, by the file extension without its dot: "stl", "dae" or
/// "fbx". In single precision, with a warning where that is coarse ("ingest-mesh-precision").
[[nodiscard]] auto read_by_assimp(std::string_view bytes, const std::string& name, const std::string& extension)
    -> base::Result<AssimpMesh>;

}  // namespace mansard::formats
