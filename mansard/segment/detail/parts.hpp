// From labels to output footprints.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/segment/detail/evidence.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment::detail {

/// Sets part_of_face, parts, and every candidate's `chosen`; adds warnings. Parts under 1 m² join the neighbour of the
/// same feature with the longest common edge, or are left out where there is none.
void make_parts(const fracture::Arrangement& arrangement, const Evidence& evidence,
                std::vector<std::optional<std::uint32_t>> label_of_face, Segmentation& segmentation);

}  // namespace mansard::segment::detail
