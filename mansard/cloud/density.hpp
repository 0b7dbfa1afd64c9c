// How many points there are over a footprint.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mansard/cloud/cloud.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::cloud {

/// The numbers of points in the cells of 1 m of tiles. Memory: that of the tiles, however far they are apart.
class Density {
 public:
  explicit Density(std::vector<GroundTile> tiles);
  /// Points per m²: the mean of the cells, by their share of the polygons, 0 where there is no tile. None for polygons
  /// smaller than a quarter of a metre. `origin`: where the polygons' coordinates begin, in those of the tiles, metres.
  /// It does not depend on whole metres of the origin. Cost: at most 250,000 places.
  [[nodiscard]] auto over(std::span<const geometry::Polygon> polygons, geometry::Point2 origin) const
      -> std::optional<double>;

 private:
  [[nodiscard]] auto at(std::int64_t x, std::int64_t y) const -> double;

  std::vector<GroundTile> tiles_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> by_place_;  ///< numbers of tiles by their corners
  std::int64_t side_ = 1;                                                  ///< m; of a tile
};

}  // namespace mansard::cloud
