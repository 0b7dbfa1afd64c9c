// The origin of the local frame.
#pragma once

#include <array>
#include <cstdint>

#include "mansard/geometry/points.hpp"

namespace mansard::ingest::detail {

/// Whole metres. Coordinates within 1024 m of zero stay as they are, so that a local frame is read and written without
/// a rounding; others are counted from the middle of `centred` and the lowest z of `all`, which is exact too where it
/// makes the numbers smaller. `centred` are the footprints where there are any; `all` is the extent of the mesh or
/// model.
[[nodiscard]] auto origin_of(const geometry::Box2& centred, const geometry::Box3& all) -> std::array<std::int64_t, 3>;

}  // namespace mansard::ingest::detail
