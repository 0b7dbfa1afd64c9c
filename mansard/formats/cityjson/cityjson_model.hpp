// Geometry of CityJSON as mansard wrote it, back to polygons and labelled solids.
#pragma once

#include <array>

#include "mansard/formats/json/json_item.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats::detail {

/// The vertices of a file or a feature, in the local frame.
class Vertices {
 public:
  /// `transform` and `list` must outlive it. Throws a Defect.
  Vertices(const Item& transform, const Item& list, const std::array<std::int64_t, 3>& origin);
  /// The very doubles that the kernel rounded to, since 0.1 mm is its grid. Throws a Defect.
  [[nodiscard]] auto at(const Item& index) const -> geometry::Point3;

 private:
  [[nodiscard]] auto coordinate(double quanta, std::size_t axis) const -> double;

  const Item& list_;
  std::array<double, 3> scale_, shift_;
};

/// The polygons of LoD 0 of a city object and the ground they lie on.
void read_lod_0(const Item& object, const Vertices& vertices, model::Building& building);

/// The solid of LoD 2.2 of a city object, without faces where there is none. Classes are those of the semantics, or
/// by the normal without; the normals of roofs are those of their slope and azimuth, which were taken before rounding.
[[nodiscard]] auto read_model(const Item& object, const Vertices& vertices) -> model::LabelledSolid;

}  // namespace mansard::formats::detail
