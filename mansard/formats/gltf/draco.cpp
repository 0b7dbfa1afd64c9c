#include "mansard/formats/gltf/draco.hpp"

#include <draco/compression/decode.h>
#include <algorithm>
#include <array>
#include <cstdint>

namespace mansard::formats {
namespace {

/// Numbers off the front, as the bitstream has them; zeros when it has run out.
class DracoBytes {
 public:
  explicit DracoBytes(std::span<const unsigned char> bytes) : rest_(bytes) {}

  auto byte() -> std::uint64_t {
    if (rest_.empty()) return 0;
    const std::uint64_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }
  auto word() -> std::uint64_t {
    std::uint64_t value = 0;
    for (int i = 0; i < 4; ++i) value |= byte() << (8 * i);
    return value;
  }
  /// Seven bits a byte, the least first; the eighth says that more follow.
  auto varint() -> std::uint64_t {
    std::uint64_t value = 0;
    for (int i = 0; i < 10; ++i) {
      const std::uint64_t next = byte();
      value |= (next & 0x7f) << (7 * i);
      if (next < 0x80) break;
    }
    return value;
  }
  void skip(std::uint64_t count) { rest_ = rest_.subspan(std::min<std::uint64_t>(count, rest_.size())); }
  [[nodiscard]] auto empty() const -> bool { return rest_.empty(); }

 private:
  std::span<const unsigned char> rest_;
};

/// What is told of a mesh and its attributes before it: blocks of names with values, with blocks in them.
void skip_metadata(DracoBytes& bytes) {
  const auto skip_blocks = [&bytes] {
    for (std::uint64_t left = 1; left > 0 && !bytes.empty(); --left) {
      for (std::uint64_t entries = bytes.varint(); entries > 0 && !bytes.empty(); --entries) {
        bytes.skip(bytes.byte());
        bytes.skip(bytes.varint());
      }
      left += bytes.varint();
      if (left > 1) bytes.skip(bytes.byte());  // the name of the next one
    }
  };
  for (std::uint64_t attributes = bytes.varint(); attributes > 0 && !bytes.empty(); --attributes) {
    (void)bytes.varint();
    skip_blocks();
  }
  skip_blocks();
}

/// The number of faces that a mesh says it has (Draco bitstream specification 2.2, sections 3 to 5).
auto faces_in(std::span<const unsigned char> all) -> std::uint64_t {
  DracoBytes bytes(all);
  bytes.skip(5);  // "DRACO"
  const std::uint64_t major = bytes.byte(), minor = bytes.byte(), version = 256 * major + minor;
  bytes.skip(1);  // a mesh, or points
  const bool edgebreaker = bytes.byte() == 1;
  bytes.skip(1);
  constexpr std::uint64_t with_metadata = 0x80;  // the highest of 16 flags
  if ((bytes.byte() & with_metadata) != 0) skip_metadata(bytes);
  if (!edgebreaker) return version < 0x202 ? bytes.word() : bytes.varint();
  const auto count = [&] { return version < 0x200 ? bytes.word() : bytes.varint(); };
  bytes.skip(1);                       // how it is gone through
  if (version < 0x202) (void)count();  // new vertices
  (void)count();                       // vertices
  return count();
}

/// What integers that stand for fractions are divided by: Draco's own conversion goes by its flag, which glTF does not
/// use.
auto scale_of(const draco::PointAttribute& attribute, bool normalised) -> double {
  if (!normalised) return 1.0;
  switch (attribute.data_type()) {
    case draco::DT_INT8: return 127.0;
    case draco::DT_UINT8: return 255.0;
    case draco::DT_INT16: return 32767.0;
    case draco::DT_UINT16: return 65535.0;
    default: return 1.0;
  }
}

void take_extra(const draco::Mesh& packed, DracoExtra& extra) {
  const draco::PointAttribute* given = packed.GetAttributeByUniqueId(extra.attribute);
  constexpr std::size_t most = 4;
  if (given == nullptr || static_cast<std::size_t>(given->num_components()) > most) return;
  if (!given->is_mapping_identity() && given->indices_map_size() < packed.num_points()) return;
  const auto components = static_cast<std::size_t>(given->num_components());
  const double scale = scale_of(*given, extra.normalised);
  for (draco::PointIndex i(0); i < packed.num_points(); ++i) {
    std::array<float, most> value{};
    if (!given->ConvertValue<float, most>(given->mapped_index(i), value.data())) return;
    for (std::size_t c = 0; c < components; ++c)
      extra.values.push_back(static_cast<float>(static_cast<double>(value[c]) / scale));
  }
  extra.components = components;
}

}  // namespace

auto unpack_draco(std::span<const unsigned char> bytes, std::uint32_t position, bool normalised,
                  const std::string& name, std::span<DracoExtra> more) -> base::Result<geometry::Mesh> {
  const auto bad = [&name](const std::string& what) {
    return base::error("ingest-mesh-format",
                       "a primitive packed with Draco cannot be read (" + what + "); export the mesh again", name);
  };
  // Draco takes memory by this number before it looks whether it can be: 24 bytes each. What packs best is a flat grid
  // of equal squares: 27 faces to a byte of a million, the more the larger. A few there may be of anything.
  constexpr std::uint64_t most = 64, few = 4'000'000;
  if (const auto faces = faces_in(bytes); faces > std::max<std::uint64_t>(few, most * bytes.size()))
    return bad("it says it has " + std::to_string(faces) + " faces in " + std::to_string(bytes.size()) + " bytes");
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return bad(decoded.status().error_msg_string());
  const draco::Mesh& packed = *decoded.value();
  const draco::PointAttribute* points = packed.GetAttributeByUniqueId(position);
  if (points == nullptr || points->num_components() != 3) return bad("no positions by the number the file names");

  const double scale = scale_of(*points, normalised);
  if (!points->is_mapping_identity() && points->indices_map_size() < packed.num_points())
    return bad("a position is missing");
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
  for (auto& extra : more) take_extra(packed, extra);
  return mesh;
}

}  // namespace mansard::formats
