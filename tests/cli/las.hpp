// LAS files of a few points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace mansard::cli {

struct LasPoint {
  double x = 0, y = 0, z = 0;
  std::uint8_t classification = 0;
};

/// A flat house of 12 by 8 m on a field of 30 by 26 m, a point every 0.25 m.
inline auto house_points(double x, double y, std::uint8_t building = 6, std::uint8_t ground = 2)
    -> std::vector<LasPoint> {
  std::vector<LasPoint> out;
  for (double dx = -9; dx <= 21; dx += 0.25)
    for (double dy = -9; dy <= 17; dy += 0.25) {
      const bool inside = dx >= 0 && dx <= 12 && dy >= 0 && dy <= 8;
      out.push_back({x + dx, y + dy, inside ? 6.0 : 0.0, inside ? building : ground});
    }
  return out;
}

/// LAS 1.2 with point format 0 and coordinates in centimetres. `epsg`: 0 for no CRS. Without `box`, that of the header
/// is zeros.
inline auto las_of(const std::vector<LasPoint>& points, std::uint16_t epsg = 0, bool box = true) -> std::string {
  const auto put = [](std::string& bytes, auto... values) {
    (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  };
  using U16 = std::uint16_t;
  constexpr double step = 0.01;
  std::string records;
  std::array<double, 3> least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
  for (const auto& p : points) {
    const std::array<double, 3> at{p.x, p.y, p.z};
    for (std::size_t a = 0; a < 3; ++a) {
      put(records, static_cast<std::int32_t>(std::lround(at[a] / step)));
      least[a] = std::min(least[a], at[a]);
      most[a] = std::max(most[a], at[a]);
    }
    put(records, U16{0}, std::uint8_t{9}, p.classification);
    records += std::string(4, '\0');
  }
  std::string keys;  // GeoTIFF: projected, by its code, in metres
  if (epsg != 0)
    for (const int value : {1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, static_cast<int>(epsg), 3076, 0, 1, 9001})
      put(keys, static_cast<U16>(value));
  std::string record;
  if (epsg != 0) {
    record = std::string(2, '\0') + "LASF_Projection" + '\0';
    put(record, U16{34735}, static_cast<U16>(keys.size()));
    record += std::string(32, '\0') + keys;
  }
  const auto count = static_cast<std::uint32_t>(points.size());
  std::string las = "LASF" + std::string(20, '\0') + std::string("\1\2", 2) + std::string(64, '\0');
  put(las, U16{1}, U16{2026}, U16{227}, static_cast<std::uint32_t>(227 + record.size()),
      static_cast<std::uint32_t>(epsg != 0 ? 1 : 0), std::uint8_t{0}, U16{20}, count, count);
  las += std::string(16, '\0');
  put(las, step, step, step, 0.0, 0.0, 0.0);
  for (std::size_t a = 0; a < 3; ++a) put(las, box ? most[a] : 0.0, box ? least[a] : 0.0);
  return las + record + records;
}

}  // namespace mansard::cli
