#include "mansard/ingest/detail/draco.hpp"

#include <draco/compression/decode.h>
#include <array>

namespace mansard::ingest::detail {

auto unpack_draco(std::span<const unsigned char> bytes, std::uint32_t position, bool normalised,
                  const std::string& name) -> base::Result<geometry::Mesh> {
  const auto bad = [&name](const std::string& what) {
    return base::error("ingest-mesh-format", "a primitive packed with Draco cannot be read (" + what +
                                                 "); export the mesh again",
                       name);
  };
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return bad(decoded.status().error_msg_string());
  const draco::Mesh& packed = *decoded.value();
  const draco::PointAttribute* points = packed.GetAttributeByUniqueId(position);
  if (points == nullptr || points->num_components() != 3) return bad("no positions by the number the file names");

  // Draco's own conversion of normalised integers goes by its flag, which glTF does not use.
  const auto scale = [&] {
    if (!normalised) return 1.0;
    switch (points->data_type()) {
      case draco::DT_INT8: return 127.0;
      case draco::DT_UINT8: return 255.0;
      case draco::DT_INT16: return 32767.0;
      case draco::DT_UINT16: return 65535.0;
      default: return 1.0;
    }
  }();
  geometry::Mesh mesh;
  mesh.vertices.reserve(packed.num_points());
  for (draco::PointIndex i(0); i < packed.num_points(); ++i) {
    std::array<double, 3> value{};
    if (!points->ConvertValue<double, 3>(points->mapped_index(i), value.data())) return bad("a position is missing");
    mesh.vertices.push_back({value[0] / scale, value[1] / scale, value[2] / scale});
  }
  mesh.triangles.reserve(packed.num_faces());
  for (draco::FaceIndex f(0); f < packed.num_faces(); ++f) {
    const auto& face = packed.face(f);
    mesh.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return mesh;
}

}  // namespace mansard::ingest::detail
