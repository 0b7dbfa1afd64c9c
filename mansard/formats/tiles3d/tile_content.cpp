#include "mansard/formats/tiles3d/tile_content.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "mansard/formats/mesh/append.hpp"
#include "mansard/formats/mesh/mesh_formats.hpp"
#include "mansard/formats/mesh/textured_formats.hpp"

namespace mansard::formats {
namespace {

using geometry::Point3;
using PlainJson = nlohmann::json;

/// Little endian, as everything in 3D Tiles.
template <class Number>
auto number_at(std::string_view bytes, std::size_t at) -> Number {
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

class ContentReader {
 public:
  /// With `textured`, the mesh goes there, with its textures.
  ContentReader(const std::filesystem::path& path, const Transform& turn, const Transform& place,
                TexturedMesh* textured = nullptr)
      : path_(path), name_(path.string()), turn_(turn), place_(place), textured_(textured) {}

  auto take(std::string_view bytes, int depth = 0) -> base::Result<void> {
    if (bytes.empty()) return base::error("ingest-mesh-empty", "the tile is empty; copy or export it again", name_);
    if (bytes.starts_with("glTF") || bytes.starts_with("{")) return take_gltf(bytes, {});
    const std::string kind(bytes.substr(0, 4));
    static constexpr std::array<std::string_view, 6> kinds{"b3dm", "cmpt", "i3dm", "pnts", "vctr", "geom"};
    if (std::ranges::find(kinds, kind) == kinds.end())
      return bad("the tile is neither glTF, b3dm nor cmpt; check what it is");
    if (bytes.size() < 12 || number_at<std::uint32_t>(bytes, 8) > bytes.size()) return cut_short();
    bytes = bytes.substr(0, number_at<std::uint32_t>(bytes, 8));
    if (kind == "b3dm") return take_b3dm(bytes);
    if (kind == "cmpt") return take_cmpt(bytes, depth);
    out_.skipped.insert(kind);
    return {};
  }

  auto result() -> TileContent { return std::move(out_); }

 private:
  [[nodiscard]] auto bad(const std::string& what) const -> base::Diagnostic {
    return base::error("ingest-mesh-format", what, name_);
  }
  [[nodiscard]] auto cut_short() const -> base::Diagnostic {
    return base::error("ingest-mesh-truncated",
                       "the tile ends before what its header promises; copy or export it again", name_);
  }

  [[nodiscard]] auto whole_way(Point3 centre) const -> Transform {
    return place_.after(Transform::shift(centre)).after(turn_);
  }

  auto take_textured(std::string_view bytes, Point3 centre) -> base::Result<void> {
    auto read = read_textured_gltf(bytes, path_);
    if (!read) return read.error();
    const Transform whole = whole_way(centre + read->centre.value_or(Point3{}));
    auto& mesh = read->mesh;
    for (auto& v : mesh.mesh.vertices) v = whole(v);
    if (whole.mirrors())
      for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
        std::swap(mesh.mesh.triangles[t][1], mesh.mesh.triangles[t][2]);
        if (!mesh.has_colour()) continue;
        std::swap(mesh.corners[t].uv[1], mesh.corners[t].uv[2]);
        std::swap(mesh.corners[t].colour[1], mesh.corners[t].colour[2]);
      }
    append(*textured_, std::move(mesh));
    return {};
  }

  auto take_gltf(std::string_view bytes, Point3 centre) -> base::Result<void> {
    if (textured_ != nullptr) return take_textured(bytes, centre);
    auto read = read_gltf(bytes, path_);
    if (!read) return read.error();
    const Transform whole = whole_way(centre + read->centre.value_or(Point3{}));
    auto& mesh = read->mesh;
    for (auto& v : mesh.vertices) v = whole(v);
    if (whole.mirrors())
      for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    out_.buffers.insert(out_.buffers.end(), read->buffers.begin(), read->buffers.end());
    append(out_.mesh, std::move(mesh));
    return {};
  }

  /// magic, version, length, then the lengths of the feature table (JSON, binary) and the batch table (JSON, binary).
  auto take_b3dm(std::string_view bytes) -> base::Result<void> {
    constexpr std::size_t header = 28;
    if (bytes.size() < header) return cut_short();
    const std::array<std::size_t, 4> sizes{number_at<std::uint32_t>(bytes, 12), number_at<std::uint32_t>(bytes, 16),
                                           number_at<std::uint32_t>(bytes, 20), number_at<std::uint32_t>(bytes, 24)};
    // Before 3D Tiles 1.0 the header was 20 or 24 bytes long; what follows it is then read as a length: '{"' or "glTF".
    constexpr std::size_t no_length = 0x22000000;
    if (sizes[2] >= no_length || sizes[3] >= no_length)
      return bad(
          "the tile has a header from before 3D Tiles 1.0, which is not read; convert the tileset to 1.0 or 1.1");
    std::size_t all = header;
    for (const auto size : sizes) all += size;
    if (all > bytes.size()) return cut_short();
    const auto centre = centre_of(bytes.substr(header, sizes[0]), bytes.substr(header + sizes[0], sizes[1]));
    if (!centre) return bad("the RTC_CENTER of the tile is not three numbers; export it again");
    return take_gltf(bytes.substr(all), *centre);
  }

  /// RTC_CENTER of a feature table: three numbers, or where they are in its binary part; zero where there is none.
  static auto centre_of(std::string_view table, std::string_view binary) -> std::optional<Point3> {
    if (table.empty()) return Point3{};
    const auto json = PlainJson::parse(table, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    const auto found = json.find("RTC_CENTER");
    if (found == json.end()) return Point3{};
    std::array<double, 3> at{};
    if (found->is_object() && found->contains("byteOffset") && (*found)["byteOffset"].is_number_unsigned()) {
      const auto offset = (*found)["byteOffset"].get<std::size_t>();
      if (binary.size() < 12 || offset > binary.size() - 12) return std::nullopt;
      for (std::size_t i = 0; i < 3; ++i) at[i] = number_at<float>(binary, offset + 4 * i);
    } else {
      if (!found->is_array() || found->size() != 3) return std::nullopt;
      for (std::size_t i = 0; i < 3; ++i) {
        if (!(*found)[i].is_number()) return std::nullopt;
        at[i] = (*found)[i].get<double>();
      }
    }
    return Point3{at[0], at[1], at[2]};
  }

  /// magic, version, length, number of tiles; then the tiles, each with its length in its third word.
  auto take_cmpt(std::string_view bytes, int depth) -> base::Result<void> {
    constexpr std::size_t header = 16;
    if (bytes.size() < header) return cut_short();
    if (depth > 16) return bad("tiles of several parts are nested too deep; export the tileset again");
    const auto count = number_at<std::uint32_t>(bytes, 12);
    std::size_t at = header;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (bytes.size() - at < 12) return cut_short();
      const std::size_t size = number_at<std::uint32_t>(bytes, at + 8);
      if (size < 12 || size > bytes.size() - at) return cut_short();
      if (auto done = take(bytes.substr(at, size), depth + 1); !done) return done;
      at += size;
    }
    return {};
  }

  const std::filesystem::path& path_;
  const std::string name_;
  const Transform turn_, place_;
  TexturedMesh* textured_;
  TileContent out_;
};

}  // namespace

auto read_tile_content(std::string_view bytes, const std::filesystem::path& path, const Transform& turn,
                       const Transform& place) -> base::Result<TileContent> {
  ContentReader reader(path, turn, place);
  if (auto done = reader.take(bytes); !done) return done.error();
  return reader.result();
}

auto read_textured_content(std::string_view bytes, const std::filesystem::path& path, const Transform& turn,
                           const Transform& place) -> base::Result<TexturedMesh> {
  TexturedMesh out;
  ContentReader reader(path, turn, place, &out);
  if (auto done = reader.take(bytes); !done) return done.error();
  return out;
}

}  // namespace mansard::formats
