// A model of any producer compared with a mesh, and with ground truth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mansard/ingest/model.hpp"
#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/evaluation.hpp"

namespace mansard::pipeline {

struct EvaluationFiles {
  std::filesystem::path model;
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path truth, footprints;  ///< empty for none
  std::string lod;                          ///< of model and truth; empty: the highest
};

/// Reads the files. The CRS is the model's, else `options.crs`; footprints are projected to it, a truth must be in it.
/// Fails as ingest::read_model, read_mesh and read_footprints do, and with "ingest-model-overlap".
[[nodiscard]] auto read_evaluation(const EvaluationFiles& files, const ingest::Options& options,
                                   const base::Run& run = {}) -> base::Result<report::EvaluationInput>;

/// Guarantees: 1 with the footprints that a model was reconstructed from, the blocks' scores are those of its run.json
/// to within the rounding of the file · 2 the same input, options and seed give the same numbers at any thread count.
/// Fails with "cancelled", "pipeline-nothing" (no usable footprint).
[[nodiscard]] auto evaluate_model(const report::EvaluationInput& input, const Options& options,
                                  const base::Run& run = {}) -> base::Result<report::Evaluation>;

}  // namespace mansard::pipeline
