// Little glTF files and tilesets for the tests of reading, written here by hand.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

#include "ingest/workshop.hpp"

namespace mansard::ingest::test {

using geometry::Point3;
using geometry::Triangle;
using Json = nlohmann::json;

template <class T>
void put(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

inline void pad(std::string& bytes, char with, std::size_t to = 4) {
  while (bytes.size() % to != 0) bytes += with;
}

inline auto glb(const Json& json, std::string binary) -> std::string {
  std::string text = json.dump();
  pad(text, ' ');
  pad(binary, '\0');
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size())));
  put(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  if (!binary.empty()) {
    put(out, static_cast<std::uint32_t>(binary.size()));
    out += std::string("BIN\0", 4) + binary;
  }
  return out;
}

/// One primitive over buffers 0 and 1: positions as floats, indices of 32 bits.
inline auto plain_gltf(std::size_t points, std::size_t corners) -> Json {
  return {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", {{{"mesh", 0}}}},
          {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
          {"accessors",
           {{{"bufferView", 0}, {"componentType", 5126}, {"count", points}, {"type", "VEC3"}},
            {{"bufferView", 1}, {"componentType", 5125}, {"count", corners}, {"type", "SCALAR"}}}},
          {"bufferViews",
           {{{"buffer", 0}, {"byteLength", 12 * points}},
            {{"buffer", 0}, {"byteOffset", 12 * points}, {"byteLength", 4 * corners}}}},
          {"buffers", {{{"byteLength", 12 * points + 4 * corners}}}}};
}

struct Surface {
  std::vector<std::array<float, 3>> points;  ///< as in the file: y up in glTF
  std::vector<std::uint32_t> corners;
};

inline auto bytes_of(const Surface& surface) -> std::string {
  std::string bytes;
  for (const auto& p : surface.points)
    for (const float c : p) put(bytes, c);
  for (const auto c : surface.corners) put(bytes, c);
  return bytes;
}

inline auto plain_glb(const Surface& surface, const Json& more = Json::object()) -> std::string {
  auto json = plain_gltf(surface.points.size(), surface.corners.size());
  json.update(more, true);
  return glb(json, bytes_of(surface));
}

/// A level triangle of 1 m at (x, y, z) with z up, as glTF has it.
inline auto triangle_at(float x, float y, float z = 0) -> Surface {
  return {{{x, z, -y}, {x + 1, z, -y}, {x, z, -y - 1}}, {0, 1, 2}};
}

/// A level grid of `n` × `n` squares of 1 m, with bumps.
inline auto grid(std::uint32_t n) -> Surface {
  Surface out;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j)
      out.points.push_back(
          {static_cast<float>(i), static_cast<float>((i * 7 + j * 3) % 5) / 4, -static_cast<float>(j)});
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      for (const auto c : {a, b, b + 1, a, b + 1, a + 1}) out.corners.push_back(c);
    }
  return out;
}

/// Header, tables and glTF of a batched model.
inline auto b3dm(const std::string& model, std::string table = "", std::string table_binary = "",
                 std::string batch = "") -> std::string {
  pad(table, ' ');
  pad(batch, ' ');
  std::string out = "b3dm";
  put(out, std::uint32_t{1});
  put(out, static_cast<std::uint32_t>(28 + table.size() + table_binary.size() + batch.size() + model.size()));
  for (const std::size_t size : {table.size(), table_binary.size(), batch.size(), std::size_t{0}})
    put(out, static_cast<std::uint32_t>(size));
  return out + table + table_binary + batch + model;
}

inline auto cmpt(const std::vector<std::string>& tiles) -> std::string {
  std::string inside;
  for (const auto& tile : tiles) inside += tile;
  std::string out = "cmpt";
  put(out, std::uint32_t{1});
  put(out, static_cast<std::uint32_t>(16 + inside.size()));
  put(out, static_cast<std::uint32_t>(tiles.size()));
  return out + inside;
}

/// On the ellipsoid of WGS 84 (a = 6378137 m, 1/f = 298.257223563), by the closed formula.
inline auto geocentric(double longitude, double latitude, double height) -> Point3 {
  const double l = longitude * std::numbers::pi / 180, b = latitude * std::numbers::pi / 180;
  const double f = 1 / 298.257223563, e2 = f * (2 - f), n = 6378137 / std::sqrt(1 - e2 * std::sin(b) * std::sin(b));
  return {(n + height) * std::cos(b) * std::cos(l), (n + height) * std::cos(b) * std::sin(l),
          (n * (1 - e2) + height) * std::sin(b)};
}

/// East, north, up of a place to geocentric coordinates, by columns.
inline auto east_north_up(double longitude, double latitude, double height) -> Json {
  const double l = longitude * std::numbers::pi / 180, b = latitude * std::numbers::pi / 180;
  const Point3 p = geocentric(longitude, latitude, height);
  return {-std::sin(l),
          std::cos(l),
          0,
          0,
          -std::sin(b) * std::cos(l),
          -std::sin(b) * std::sin(l),
          std::cos(b),
          0,
          std::cos(b) * std::cos(l),
          std::cos(b) * std::sin(l),
          std::sin(b),
          0,
          p.x,
          p.y,
          p.z,
          1};
}

inline auto moved_by(double x, double y, double z) -> Json { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}; }

/// An upright box in the tile's coordinates.
inline auto box(double x0, double y0, double x1, double y1, double z0 = -50, double z1 = 50) -> Json {
  return {
      {"box",
       {(x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2, (x1 - x0) / 2, 0, 0, 0, (y1 - y0) / 2, 0, 0, 0, (z1 - z0) / 2}}};
}

inline auto tileset(const Json& root) -> std::string {
  return Json{{"asset", {{"version", "1.0"}}}, {"geometricError", 500}, {"root", root}}.dump();
}

}  // namespace mansard::ingest::test
