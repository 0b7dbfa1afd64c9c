// Writes points as LAS.
#pragma once

#include <span>
#include <string>

#include "mansard/base/result.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// LAS 1.4, point format 6, or 7 where a point has a colour, not compressed, in millimetres: `points` are in the frame;
/// the file has them in the frame's file coordinates, with its CRS as WKT. Coordinates are rounded to 1 mm. The same
/// points give the same bytes. Fails with "write-las": a coordinate that is not finite, or more than 2,147 km from the
/// frame's origin.
[[nodiscard]] auto las(std::span<const CloudPoint> points, const model::Frame& frame) -> base::Result<std::string>;

}  // namespace mansard::formats
