// From labels to output footprints.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mansard/segment/detail/evidence.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment::detail {

/// Sets part_of_face, parts, and every candidate's `chosen`; adds warnings. Parts under smallest_part, and parts of
/// less mean width than narrow, join the neighbour of the same feature with the longest common edge. Left out are small
/// ones without such a neighbour. Narrow ones along the outside that are much lower than theirs stay.
void make_parts(const fracture::Arrangement& arrangement, const Evidence& evidence,
                std::vector<std::optional<std::uint32_t>> label_of_face, const Options& options,
                Segmentation& segmentation);

}  // namespace mansard::segment::detail
