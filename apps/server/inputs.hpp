// What a page names as inputs, and what is told of them: whatever `mansard reconstruct` reads, by the same rules.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/server/json.hpp"
#include "apps/server/project.hpp"
#include "apps/server/requests.hpp"
#include "mansard/base/result.hpp"
#include "mansard/ingest/ingest.hpp"

namespace mansard::server {

/// Files and folders get their whole names, everything else stays as it is.
[[nodiscard]] auto whole_name(const std::string& name) -> std::string;

/// Of the files that lie beside each other, as a sample's do.
[[nodiscard]] auto named_as_mesh(const std::filesystem::path& path) -> bool;

/// Whether an option says how inputs are read, so that all runs have it in common.
[[nodiscard]] auto of_reading(const std::string& key) -> bool;

/// The request with whole names. `known`, the inputs of the project, have the password where the page names a database
/// as it was shown. Gives up with "option-…", "server-input" (a database in place of a mesh or of the terrain), and as
/// ingest::check_input does.
[[nodiscard]] auto inputs_asked_for(const InputsRequest& request, const std::optional<Inputs>& known)
    -> base::Result<Inputs>;

/// With the files that were read.
[[nodiscard]] auto with_files(Inputs inputs, const std::vector<model::InputFile>& read) -> Inputs;

/// What was asked for, as it may be shown: {"meshes", "footprints"}.
[[nodiscard]] auto shown_json(const Inputs& inputs) -> Json;

/// Why they cannot be read, in words that may be shown; where the project has kept no password, that too.
[[nodiscard]] auto explained(base::Diagnostic why, const Inputs& inputs) -> base::Diagnostic;

}  // namespace mansard::server
