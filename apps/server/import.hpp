// Models of an earlier run, imported as a finished run.
#pragma once

#include <filesystem>
#include <optional>

#include "apps/server/outcome.hpp"
#include "mansard/base/result.hpp"
#include "mansard/base/run.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::server {

/// Checks that mansard wrote the file, in a format that contains the plans; of a ZIP file as exports make them, that it
/// can be unpacked. Fails with "file-missing", "server-archive", and as formats::read_city.
[[nodiscard]] auto check_import(const std::filesystem::path& path) -> base::Result<void>;

/// Models in any format that mansard wrote, as a run without a mesh: plans and a report, no layers, no error maps.
/// With `frame`, the frame of the scene, the models are moved into it. A ZIP file is unpacked into the folder `work`,
/// which is deleted afterwards. Fails with "server-import" (another CRS), "server-archive", and as formats::read_city
/// and pipeline::raise_plans do.
[[nodiscard]] auto import_city(const std::filesystem::path& path, const std::filesystem::path& work,
                               const std::optional<model::Frame>& frame, RunRecord record, const base::Run& run)
    -> base::Result<RunOutcome>;

}  // namespace mansard::server
