// A curve that fills the plane, so that neighbours mostly have near numbers.
#pragma once

#include <array>
#include <cstdint>

namespace mansard::geometry {

/// A place's number along it (Z-order; G. M. Morton, A computer oriented geodetic data base, 1966). Coordinates from
/// −2³¹ to 2³¹ − 1.
[[nodiscard]] auto along_curve(std::int64_t x, std::int64_t y) -> std::uint64_t;
/// The place with that number.
[[nodiscard]] auto from_curve(std::uint64_t number) -> std::array<std::int64_t, 2>;

}  // namespace mansard::geometry
