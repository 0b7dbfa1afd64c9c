// The files of an earlier run: its models, and its scan where that is still there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mansard/pipeline/pipeline.hpp"
#include "mansard/report/read_run.hpp"

namespace mansard::pipeline::detail {

/// The first of the files of models that a folder of results has: those that come with solids before those that are
/// extruded again. Empty where it has none.
[[nodiscard]] auto models_in(const std::filesystem::path& folder) -> std::filesystem::path;

/// Sets what the run read its scan with: the options of the modules ingest and cloud.
void take_reading(const report::EarlierRun& earlier, Options& options);

/// What an input of a run was.
enum class InputKind { scan, footprints, terrain, other };
[[nodiscard]] auto kind_of(const model::InputFile& input, const Options& options) -> InputKind;

/// The scan of a run in `folder`, where all of it is there as it was: by the names that the run had, or beside it.
struct FoundScan {
  std::vector<std::filesystem::path> files;
  std::string missing;  ///< the first file that is gone or another one; then there are no files
};
[[nodiscard]] auto scan_of(const report::EarlierRun& earlier, const std::filesystem::path& folder,
                           const Options& options) -> FoundScan;

}  // namespace mansard::pipeline::detail
