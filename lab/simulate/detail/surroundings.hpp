// What stands around and upon the buildings: the ground, trees, cars, chimneys.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "lab/simulate/detail/nearest.hpp"
#include "lab/simulate/detail/noise.hpp"
#include "lab/simulate/simulate.hpp"

namespace mansard::simulate::detail {

/// Per triangle: whether it is a base of a building on the ground, and not one on top of another part.
[[nodiscard]] auto on_ground(const Surface& surface) -> std::vector<bool>;

/// Ground that passes by the foot of every building, smooth in between, with bumps.
class Terrain {
 public:
  Terrain(const Surface& surface, const geometry::Box2& area, const ScanOptions& options, std::uint64_t seed);
  /// z, metres.
  [[nodiscard]] auto at(geometry::Point2 p) const -> double;

 private:
  [[nodiscard]] auto smooth(geometry::Point2 p) const -> double;

  geometry::Point2 origin_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<double> heights_;  // at the knots of a grid, row by row
  double waves_;
  Noise noise_;
};

/// A turned box or an ellipsoid.
struct Object {
  enum class Form : std::uint8_t { box, ellipsoid } form = Form::box;
  geometry::Point3 centre;
  geometry::Point2 axis{1, 0};  ///< unit; where half.x lies
  geometry::Point3 half;        ///< half extents, metres

  /// Where a vertical line enters and leaves.
  [[nodiscard]] auto span(geometry::Point2 p) const -> std::optional<std::pair<double, double>>;
  /// About how far the surface is, in metres; exact for boxes from outside.
  [[nodiscard]] auto distance(geometry::Point3 p) const -> double;
  [[nodiscard]] auto bounds() const -> geometry::Box2;
};

/// Trees and cars on open ground, chimneys on roofs, and the trees that are over roofs.
struct Surroundings {
  std::vector<Object> objects;
  std::vector<Crown> crowns;
};
[[nodiscard]] auto surroundings_of(const Surface& surface, const Nearest& nearest, const Terrain& terrain,
                                   const geometry::Box2& area, const ScanOptions& options, std::uint64_t seed)
    -> Surroundings;

}  // namespace mansard::simulate::detail
