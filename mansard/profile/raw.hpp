// What the scan shows behind an edge of a plan, before anything is made of it: the raw profiles of the paper's
// Figure 4.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "mansard/geometry/mesh.hpp"
#include "mansard/geometry/polygon.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/profile/profile.hpp"

namespace mansard::profile {

/// One slice across an edge, climbed.
struct RawProfile {
  geometry::Point2 foot;  ///< on the edge
  double along = 0;       ///< m from the edge's start
  /// Metres inward of the foot (negative: outside of the edge) and above the base; heights never decrease, inward may.
  std::vector<model::ProfilePoint> points;
};

/// A mesh prepared for slices; it must outlive this. Queries may run on any thread. Cost: O(triangles) to build.
class RawProfiles {
 public:
  explicit RawProfiles(const geometry::Mesh& mesh);
  RawProfiles(RawProfiles&&) noexcept;
  auto operator=(RawProfiles&&) noexcept -> RawProfiles&;
  RawProfiles(const RawProfiles&) = delete;
  auto operator=(const RawProfiles&) -> RawProfiles& = delete;
  ~RawProfiles();

  /// The climbs that fit() makes behind an edge (ring 0 is the outer one, 1 … the holes), every `options.spacing`;
  /// slices in which nothing stands are left out. `base`: z, metres. Cost: a few thousand triangles looked at a slice.
  [[nodiscard]] auto behind(const geometry::Polygon& polygon, std::size_t ring, std::size_t edge, double base,
                            const Options& options) const -> std::vector<RawProfile>;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mansard::profile
