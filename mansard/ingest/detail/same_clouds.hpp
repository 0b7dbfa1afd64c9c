// Clouds that were given twice.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "mansard/cloud/cloud.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::ingest::detail {

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
