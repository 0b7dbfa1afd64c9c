// Features that are parts of others: OpenStreetMap's building:part.
#pragma once

#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::ingest::detail {

/// Takes the features that are parts of a building off the footprints and their surroundings, and gives them to it
/// (model::Footprint::parts). A part is of the outline with which a relation type=building names it; without a relation
/// of the outline that has most of it, at least half, of several that have it all the smallest. Parts of no outline
/// stay what they are, and so do those among the footprints whose outline is only around them. An outline that is
/// tagged as a part, too, is one of its own parts where it has others. Nothing happens where no feature is tagged as a
/// part. Warns "ingest-parts", "ingest-part-alone". Cost: O(n log n + pairs that overlap).
void join_parts(model::Scene& scene, const std::string& subject, std::vector<base::Diagnostic>& warnings);

}  // namespace mansard::ingest::detail
