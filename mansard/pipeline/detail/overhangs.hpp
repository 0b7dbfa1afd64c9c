// Overhanging eaves of the parts of a block, as the scan shows them.
#pragma once

#include <utility>
#include <vector>

#include "mansard/pipeline/detail/block_run.hpp"

namespace mansard::pipeline::detail {

/// Measures the eaves of the parts (profile::measure_overhangs), says so in their changes, and with
/// profile::Overhangs::soffits puts them into the plans and on the solids, as far as they do not reach into the ground
/// of another feature or into its eaves. `mesh`: of the block. Parts by feature.
[[nodiscard]] auto with_overhangs(const geometry::Mesh& mesh, const Options& options, const base::Run& run,
                                  std::vector<PartResult>& parts, std::vector<std::pair<std::size_t, SolidsOf>> solids)
    -> std::vector<std::pair<std::size_t, SolidsOf>>;

}  // namespace mansard::pipeline::detail
