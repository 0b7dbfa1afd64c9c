// Which coordinate reference systems bring a place to where something else is.
#pragma once

#include <string>
#include <vector>

#include "mansard/geometry/points.hpp"

namespace mansard::crs {

struct Candidate {
  std::string name;     ///< "EPSG:28992"
  std::string title;    ///< "Amersfoort / RD New"
  geometry::Point2 at;  ///< where the place is in it, metres
  double area = 0;      ///< of its use, square degrees
};

/// The projected systems of the EPSG register in metres whose area of use contains the place `at` of the system `from`
/// and in which the place is in `box`: those that are used in the smallest area first. Empty where `from` is not known.
/// Cost: about 0.2 s.
[[nodiscard]] auto candidates(const std::string& from, geometry::Point2 at, const geometry::Box2& box)
    -> std::vector<Candidate>;

}  // namespace mansard::crs
