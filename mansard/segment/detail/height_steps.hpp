// O2: the mesh's height step across an edge, measured along it.
#pragma once

#include <vector>

#include "mansard/rays/rays.hpp"
#include "mansard/segment/segment.hpp"

namespace mansard::segment::detail {

/// Sets every candidate's height difference to the mean difference of the mesh's heights `height_offset` metres to its
/// left and right (less in narrow faces), at places spread evenly. Candidates beside which the
/// mesh shows nothing keep theirs.
void measure_steps(const fracture::Arrangement& arrangement, const rays::Scene& mesh, const Options& options,
                   std::vector<Candidate>& candidates);

}  // namespace mansard::segment::detail
