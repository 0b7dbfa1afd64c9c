// Which features of a source have to be known besides those that are asked for.
#pragma once

#include <vector>

#include "mansard/formats/vector/features.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::ingest::detail {

/// m; features nearer to each other than this are taken to touch. block.touch is at most as much.
inline constexpr double touching = 1;

/// Marks what touches a marked feature, and what touches that, and so on.
/// Cost: O(n log n + pairs whose boxes come near).
void close_under_touching(const std::vector<formats::RawFeature>& features, std::vector<bool>& marked);

}  // namespace mansard::ingest::detail
