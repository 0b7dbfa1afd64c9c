// The measured points over a block, with the planes that they lie on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/planes/planes.hpp"
#include "mansard/rays/rays.hpp"
#include "mansard/refine/options.hpp"

namespace mansard::refine::detail {

class Evidence {
 public:
  /// All points of the scan but those on walls: these say nothing of what is seen from above.
  Evidence(const rays::Scene& mesh, const Options& options);

  struct Sample {
    geometry::Point3 point;
    std::uint32_t plane = planes::Found::none;  ///< of `planes()`
  };
  /// The points in the box, in order.
  [[nodiscard]] auto in(const geometry::Box2& box) const -> std::vector<Sample>;
  [[nodiscard]] auto planes() const -> std::span<const planes::Plane> { return planes_; }
  /// m: the height, at a place, of the plane of the nearest point, or of that point where it is on none; nothing where
  /// no point is near.
  [[nodiscard]] auto height_at(geometry::Point2 place) const -> std::optional<double>;
  /// The same by the points over a polygon only.
  [[nodiscard]] auto height_at(geometry::Point2 place, const geometry::Polygon& over) const -> std::optional<double>;
  /// m: farther points say nothing of a place.
  [[nodiscard]] auto reach() const -> double { return reach_; }

 private:
  template <class Take>
  [[nodiscard]] auto height_by_nearest(geometry::Point2 place, Take take) const -> std::optional<double>;
  void leave_out_walls(double spacing);
  template <class See>
  void each_near(geometry::Point2 place, See see) const;

  double reach_ = 0;  // m: the side of a bucket; points are looked for in those around a place
  geometry::Point2 origin_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::uint32_t> first_;      // per bucket
  std::vector<geometry::Point3> points_;  // by bucket
  std::vector<std::uint32_t> plane_of_;
  std::vector<planes::Plane> planes_;
};

}  // namespace mansard::refine::detail
