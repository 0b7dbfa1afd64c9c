// The triangles of a face as validators cut it.
#pragma once

#include <vector>

#include "mansard/solid/triangulator.hpp"

namespace mansard::solid::detail {

/// Turns diagonals of the triangles of one face until no corner is inside the circumcircle of a triangle beside it,
/// seen along `normal`: its constrained Delaunay triangulation (C. L. Lawson, Software for C1 surface interpolation,
/// 1977), which validators look for needles in. Corners nearly on a line near each other make needles there that other
/// triangulations of the face do not have. Cost: O(n²) flips for n triangles, next to none in practice.
void make_delaunay(const model::Solid& solid, geometry::Point3 normal, std::vector<Corners>& triangles);

}  // namespace mansard::solid::detail
