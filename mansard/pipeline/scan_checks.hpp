// What is wrong with a scan as a whole, told before a reconstruction begins.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/ingest/cells.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline {

struct CheckedScan {
  std::vector<base::Diagnostic> findings;              ///< codes "scan-…", one for each kind of fault; errors first
  std::optional<accuracy::Registration> registration;  ///< none where it could not be measured
};

/// Compares a scan with its footprints, on a sample of blocks: offset, axis, units, digits, ground,
/// coverage. The mesh is that of the scene, or in `cells`; footprints that were derived from it fit it and are not
/// compared. Every finding is significant: docs/pipeline.md has the tests. Guarantees: 1 the same at any thread count,
/// in cells or not, whatever the order of the input · 2 the scene is not changed.
/// Cost: that of at most 48 blocks on at most 15 hectares; where the scan does not fit its footprints at all, ten times
/// a pass over the mesh. Fails with "cancelled", "file-write".
[[nodiscard]] auto check_scan(const model::Scene& scene, const ingest::MeshCells* cells, const Options& options,
                              const base::Run& run = {}) -> base::Result<CheckedScan>;

/// Options::ingest.mesh_offset with which the scan is where the footprints are; none where the offset is not
/// significant.
[[nodiscard]] auto aligned_offset(const accuracy::Registration& registration, const std::array<double, 3>& present)
    -> std::optional<std::array<double, 3>>;

[[nodiscard]] auto scan_codes() -> std::vector<base::Code>;

}  // namespace mansard::pipeline
