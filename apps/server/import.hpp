// Models that were made elsewhere, as a finished run.
#pragma once

#include <filesystem>
#include <optional>

#include "apps/server/outcome.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::server {

/// Whether mansard wrote the file, in a format with plans in it. Gives up with "file-missing" and as formats::read_city.
[[nodiscard]] auto check_import(const std::filesystem::path& path) -> base::Result<void>;

/// What mansard wrote, in any format, as a run without a mesh leaves it: plans and a report, no layers, no error maps.
/// With `frame`, that of the scene, everything is moved there. Gives up with "server-import" (another CRS), and as
/// formats::read_city and pipeline::raise_plans do.
[[nodiscard]] auto import_city(const std::filesystem::path& path, const std::optional<model::Frame>& frame,
                               RunRecord record, const base::Run& run) -> base::Result<RunOutcome>;

}  // namespace mansard::server
