// What the mesh and the footprints say of every face, and which faces are inside the building.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "mansard/segment/segment.hpp"

namespace mansard::segment::detail {

/// The samples behind a FaceEvidence.
struct FaceSamples {
  std::vector<double> heights;                         ///< z of the mesh's top surface, ascending, metres
  std::vector<std::pair<std::size_t, double>> shares;  ///< of the face's area, by feature; ascending, none are 0
};

struct Evidence {
  std::vector<FaceEvidence> faces;
  std::vector<FaceSamples> samples;
  std::vector<double> ground;  ///< z of the ground of the face's feature, metres
};

/// Samples every face and decides which are inside, exposed faces still among them.
[[nodiscard]] auto measure(const fracture::Arrangement& arrangement, const block::Block& block, const rays::Scene& mesh,
                           const Options& options) -> Evidence;

/// Takes faces off from outside that nothing but the fracture's continuations bounds (reference facts 4.2).
void peel(const fracture::Arrangement& arrangement, const Options& options, std::vector<FaceEvidence>& faces);

}  // namespace mansard::segment::detail
