// How many points there are to a square metre, as far as a few pieces of a cloud show.
#pragma once

#include <optional>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/crs/mesh_crs.hpp"
#include "mansard/formats/points.hpp"

namespace mansard::ingest::detail {

struct SeenDensity {
  double density = 0;        ///< points/m², each counted once; 0 where the pieces say nothing
  double share_of_once = 1;  ///< of all points of the cloud, without repetitions
};

/// Clouds are often cut out along a street, or of one building: the box around them is mostly empty then. Points in
/// a square of a metre that has any, the median: edges and single points in the air count little. Of some pieces of the
/// cloud, evenly spaced. Pieces with a box are levels of an index, each with a part of the points at its place, and say
/// nothing. Where these pieces have points twice, the share is that of all points, which are read for it. Fails as
/// PointCloud::read.
[[nodiscard]] auto density_where_points_are(const formats::PointCloud& cloud, const std::optional<crs::WayOfMesh>& way,
                                            const base::Run& run) -> base::Result<SeenDensity>;

}  // namespace mansard::ingest::detail
