// Inputs as a page names them: whatever `mansard reconstruct` reads, by the same rules.
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

/// Names of files and folders are made absolute; all others stay as they are.
[[nodiscard]] auto absolute_name(const std::string& name) -> std::string;

/// The inputs of a sample folder: all meshes by their file extensions, the file footprints.*, and reading.json with the
/// options to read them with. Fails with "server-sample".
[[nodiscard]] auto sample_inputs(const std::filesystem::path& folder) -> base::Result<InputsRequest>;

/// The request with absolute names. If the page names a database without its password, as it was shown, the password is
/// taken from `known`, the inputs of the project. Fails with "option-…", "server-input" (a database in place of a
/// mesh or of the terrain), and as formats::check_input does.
[[nodiscard]] auto requested_inputs(const InputsRequest& request, const std::optional<Inputs>& known)
    -> base::Result<Inputs>;

/// The inputs with the files that were read.
[[nodiscard]] auto with_files(Inputs inputs, const std::vector<model::InputFile>& read) -> Inputs;

/// What a scene is made from, as a hash: files, options and this program. Empty where something of it is not known: a
/// database, a file on a server.
[[nodiscard]] auto key_of(const Inputs& inputs) -> std::string;

/// The requested names without passwords: {"meshes", "footprints"}.
[[nodiscard]] auto shown_json(const Inputs& inputs) -> Json;

/// Why the inputs cannot be read. If a password is missing because the project does not keep it, the message says so.
[[nodiscard]] auto explained(base::Diagnostic why, const Inputs& inputs) -> base::Diagnostic;

}  // namespace mansard::server
