// A sample of the blocks of a scan: what is known of them before anything is reconstructed.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mansard/accuracy/accuracy.hpp"
#include "mansard/ingest/cells.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::pipeline::detail {

/// A footprint and the scan over it.
struct SampledFootprint {
  std::size_t feature = 0;  ///< number in the scene
  double area = 0;          ///< m²
  double covered = 0;       ///< share of it that the scan covers
  bool at_end = false;      ///< the scan also lacks ground beside what it lacks of it
  block::GroundSource ground = block::GroundSource::unknown;
  double above_lowest = 0;  ///< m; of the scan over it, in the median, above the lowest of its block
  std::optional<double>
      height;  ///< m; of the scan over it, in the median, above the ground; none where that is unknown
};

/// A block in its own frame.
struct SampledBlock {
  std::array<std::int64_t, 3> origin{};  ///< of its frame, in that of the scene
  geometry::Mesh mesh;
  std::unique_ptr<rays::Scene> rays;
  std::vector<geometry::Polygon> outline;
  std::vector<SampledFootprint> footprints;
  [[nodiscard]] auto piece() const -> accuracy::Piece { return {&mesh, rays.get(), outline}; }
};

struct ScanSample {
  std::vector<SampledBlock> blocks;
  std::size_t footprints = 0;  ///< in the sample
  std::size_t all = 0;         ///< usable ones in the scene
};

/// Blocks evenly along a curve through the plane, all where they are few: a function of the footprints, whatever their
/// order and the thread count. The mesh is that of the scene, or in `cells`. Fails as MeshCells::load.
/// Cost: that of at most 48 blocks on at most 15 hectares.
[[nodiscard]] auto sample_scan(const model::Scene& scene, const ingest::MeshCells* cells, const Options& options,
                               const base::Run& run) -> base::Result<ScanSample>;

}  // namespace mansard::pipeline::detail
