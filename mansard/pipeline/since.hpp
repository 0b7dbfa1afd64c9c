// A run over a new scan that makes again only what has changed since an earlier run, and takes over the rest of that
// with its edits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mansard/compare/compare.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/pipeline/states.hpp"

namespace mansard::pipeline {

/// What of an earlier run is as the new scan shows it.
struct Since {
  StateFiles old;                                  ///< with its city, in the frame of the scene
  compare::Comparison found;                       ///< the old models against the new scan, on the new footprints
  std::vector<std::optional<std::uint32_t>> kept;  ///< by footprint: the old building that is taken over
  std::vector<std::string> blocks;                 ///< to be made again
  std::size_t all_blocks = 0;
};

/// Compares the models of an earlier run with the new scan. A block is taken over as a whole: where each of its
/// footprints has the ground of one old building with a model, of four fifths of both together (a fifth is what surveys
/// of a small building differ by), the scan covers half of it or more, and nowhere on it, nor where it was, is a place
/// that differs, significant or not: what is made again without need costs time, what is not made again is wrong.
/// Fails with "since-models" (models that cannot be taken over), and as read_state and in_one_frame do.
[[nodiscard]] auto find_changed(const model::Scene& scene, const std::filesystem::path& old, const Options& options,
                                const base::Run& run = {}) -> base::Result<Since>;

/// The blocks that have changed as reconstruct makes them, and the buildings of the others as they were, with the
/// attributes of the new footprints and `ms_kept_from`. Fails as reconstruct does.
[[nodiscard]] auto reconstruct_since(const model::Scene& scene, const Since& since, const Options& options,
                                     const base::Run& run = {}, Keep keep = Keep::models, const Schedule& schedule = {})
    -> base::Result<report::Reconstruction>;

}  // namespace mansard::pipeline
