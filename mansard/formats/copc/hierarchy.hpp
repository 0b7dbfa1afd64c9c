// The octree of COPC, the cloud-optimised form of LAZ.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/formats/files/ranges.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {

struct CopcNode {
  std::uint64_t offset = 0, bytes = 0, points = 0;
  geometry::Box3 box;  ///< file coordinates, grown by a thousandth: points are rounded to the scale
};
struct CopcHierarchy {
  std::vector<CopcNode> nodes;
};

/// `info` is the content of the record "copc" 1. All pages are read, each once: a page that is named twice is an error.
/// Fails with "ingest-points-format", "file-read". Reference: COPC specification 1.0 (copc.io).
[[nodiscard]] auto read_copc_hierarchy(std::string_view info, const RangeFile& file, const std::string& name)
    -> base::Result<CopcHierarchy>;

}  // namespace mansard::formats
