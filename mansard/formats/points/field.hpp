// What a column or a property of a point may be.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "mansard/formats/points.hpp"

namespace mansard::formats {

enum class PointField { none, x, y, z, classification, return_number, returns, source, intensity, red, green, blue };

template <class T>
[[nodiscard]] auto clamped(double value) -> T {
  constexpr double most = std::numeric_limits<T>::max();
  return value > 0 ? static_cast<T>(std::min(value, most)) : T{0};
}

[[nodiscard]] inline auto is_colour(PointField field) -> bool {
  return field == PointField::red || field == PointField::green || field == PointField::blue;
}

inline void put(CloudPoint& point, PointField field, double value) {
  switch (field) {
    case PointField::none: break;
    case PointField::x: point.position.x = value; break;
    case PointField::y: point.position.y = value; break;
    case PointField::z: point.position.z = value; break;
    case PointField::classification: point.classification = clamped<std::uint8_t>(value); break;
    case PointField::return_number: point.return_number = clamped<std::uint8_t>(value); break;
    case PointField::returns: point.returns = clamped<std::uint8_t>(value); break;
    case PointField::source: point.source = clamped<std::uint16_t>(value); break;
    case PointField::intensity: point.intensity = clamped<std::uint16_t>(value); break;
    case PointField::red: point.colour[0] = clamped<std::uint16_t>(value); break;
    case PointField::green: point.colour[1] = clamped<std::uint16_t>(value); break;
    case PointField::blue: point.colour[2] = clamped<std::uint16_t>(value); break;
  }
}

}  // namespace mansard::formats
