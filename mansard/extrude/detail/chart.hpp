// The points of a trace in exact coordinates, and the planes of its faces as charts in which orientation is decided.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/extrude/detail/surface.hpp"

namespace mansard::extrude::detail {

using Loop = std::vector<std::uint32_t>;

[[nodiscard]] auto exact_place(const Planes& planes, const TracePoint& point) -> ExactPlace;

/// Exact coordinates, computed where doubles leave a question open.
class Places {
 public:
  Places(const Planes& planes, const std::vector<TracePoint>& points, const std::vector<geometry::Point3>& places)
      : planes_(planes), points_(points), places_(places), exact_(points.size()) {}

  [[nodiscard]] auto nearest(std::uint32_t i) const -> geometry::Point3 { return places_[i]; }
  [[nodiscard]] auto operator()(std::uint32_t i) const -> const ExactPlace& {
    auto& place = exact_[i];
    if (!place) place = exact_place(planes_, points_[i]);
    return *place;
  }
  [[nodiscard]] auto same(std::uint32_t i, std::uint32_t j) const -> bool;

 private:
  const Planes& planes_;
  const std::vector<TracePoint>& points_;
  const std::vector<geometry::Point3>& places_;
  mutable std::vector<std::optional<ExactPlace>> exact_;
};

/// The face's own plane, seen from outside: x and y, or for a vertical face along it and up. All signs are exact.
class Chart {
 public:
  Chart(const Places& places, const FaceNode& node);

  /// Sign of (q − p) × (r − o).
  [[nodiscard]] auto cross_sign(std::uint32_t p, std::uint32_t q, std::uint32_t o, std::uint32_t r) const -> int;
  /// Sign of (q − p) · (r − o).
  [[nodiscard]] auto dot_sign(std::uint32_t p, std::uint32_t q, std::uint32_t o, std::uint32_t r) const -> int;
  /// +1 counter-clockwise, judged at the loop's lowest leftmost corner, which is never straight.
  [[nodiscard]] auto orientation(const Loop& loop) const -> int;
  /// Whether the point lies in the loop: 1 inside, 0 on it, −1 outside.
  [[nodiscard]] auto side(const Loop& loop, std::uint32_t point) const -> int;

 private:
  /// A point in doubles; `size` is of the numbers that were rounded on the way.
  struct Near {
    geometry::Point2 at;
    double size = 0;
  };
  /// Up to a positive factor that is the same for all points.
  [[nodiscard]] auto exact(std::uint32_t i) const -> ExactPoint;
  [[nodiscard]] auto nearly(std::uint32_t i) const -> Near;
  /// By x, then by y.
  [[nodiscard]] auto before(std::uint32_t i, std::uint32_t j) const -> bool;

  const Places& places_;
  const FaceNode& node_;
  bool upright_, looks_down_;
  geometry::Point2 along_;
};

}  // namespace mansard::extrude::detail
