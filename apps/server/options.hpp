// Options as the page sends and shows them: "module.name" → value, as text.
#pragma once

#include <string>

#include "apps/server/json.hpp"
#include "apps/server/project.hpp"
#include "apps/server/requests.hpp"
#include "mansard/base/result.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::server {

/// Sets options by name. Fails with "option-unknown", "option-value".
[[nodiscard]] auto set_all(pipeline::Options& options, const Texts& values) -> base::Result<void>;
/// The values that differ from the defaults.
[[nodiscard]] auto differing(pipeline::Options options) -> Texts;

/// Whether the option says how inputs are read. All runs of a project share these.
[[nodiscard]] auto is_input_option(const std::string& key) -> bool;

/// The options of a run: those that the inputs were read with, then the preset, then the run's own. Fails with
/// "option-unknown", "option-value".
[[nodiscard]] auto run_options(const RunRequest& request, const Texts& reading) -> base::Result<pipeline::Options>;

/// Options of openapi.json: every option of every module with its default, the presets, and the file formats.
[[nodiscard]] auto options_json() -> Json;

}  // namespace mansard::server
