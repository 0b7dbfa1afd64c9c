// The report of a run for those who ordered it, from the files of its folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"

namespace mansard::pipeline {

struct RunReportOptions {
  std::vector<std::filesystem::path> scans;    ///< instead of those that the run names
  bool use_scans = true;                       ///< of pictures
  std::vector<std::filesystem::path> reviews;  ///< review.json or folders of projects; none: that of the run's project
  std::filesystem::path changes;               ///< changes.json of `mansard compare`, or its folder; empty: none
  std::size_t worst = 10;                      ///< models that are shown with a picture
  std::string title, date;                     ///< of the page; empty: by the name of the run; none
};

struct RunReport {
  std::string html;                        ///< one page that needs nothing else
  std::vector<base::Diagnostic> warnings;  ///< "report-scan": why pictures are without the scan
};

/// Reads run.json and the models of a folder of `mansard reconstruct` or `extrude`, building by building, and pictures
/// the models that are least sure, or that have the largest error, with the scan where it is still there as it was.
/// A run of a project has its report in report.json. Memory: about 500 bytes a building, and the scan around what is
/// pictured, or one cell of it. Fails with "report-run", "report-models" (a folder without models), "review-file",
/// "report-changes", as the reader of models does, and when the run is cancelled.
[[nodiscard]] auto run_report(const std::filesystem::path& folder, const RunReportOptions& options,
                              const base::Run& run = {}) -> base::Result<RunReport>;

}  // namespace mansard::pipeline
