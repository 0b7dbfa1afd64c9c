// The grid of the coordinates in files, and what validators accept on it.
#pragma once

#include <cstdint>

namespace mansard::model {

/// A quantum of 0.1 mm: at 1 mm, rounding alone makes faces fail the planarity tests of validators.
inline constexpr double quanta_per_metre = 10000;
/// Quanta. Validators take points that are at most 1 mm apart for one (val3dity's default): solids and outlines have no
/// two points nearer than this, a little more.
inline constexpr std::int64_t least_apart = 11;
/// Of a face narrower than this, as a share of its length, validators that work in doubles cannot find the plane
/// (val3dity 2.6 finds a vertical strip of 1.2 mm by 14 m, a share of 8e-5, to bend by 0.2 mm). Triangles need none.
inline constexpr double narrowest_face = 1e-3;

}  // namespace mansard::model
