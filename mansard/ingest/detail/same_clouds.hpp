// Clouds that were given twice.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mansard/cloud/cloud.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::ingest::detail {

/// Points that two scans have at one place by accident are fewer: with 100 points/m², a standard deviation of 0.03 m
/// and coordinates in centimetres, 100/m² · (0.01 m)² · 0.01 m / (√(4π) · 0.03 m), a thousandth.
inline constexpr double noticeable_share = 0.01;

/// A hash of a point, in metres: the same for points at one place (within a quarter of a millimetre) with the same
/// class. None where a coordinate is not finite, or farther away than anything on earth.
[[nodiscard]] auto hash_of(geometry::Point3 p, std::uint8_t classification) -> std::optional<std::uint64_t>;

/// The same for clouds of the same points, in whatever order, pieces and format; of others, it is not by accident.
struct Fingerprint {
  std::uint64_t points = 0, sum = 0;

  /// A point in the working CRS, metres. What cannot be a place is passed over.
  void add(geometry::Point3 p, std::uint8_t classification);
  void include(const Fingerprint& other);
  auto operator<=>(const Fingerprint&) const = default;
};

struct NamedFingerprint {
  std::string name;
  Fingerprint of;
};

/// Which clouds have the same points, and how many points were repeated. Empty where there are neither such clouds nor
/// a noticeable share of points.
[[nodiscard]] auto repeated_in_words(const std::vector<NamedFingerprint>& clouds, const cloud::Counts& counts)
    -> std::string;

}  // namespace mansard::ingest::detail
