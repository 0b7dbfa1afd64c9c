// The terrain around the models of a run as they are.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "apps/server/scene.hpp"
#include "mansard/base/result.hpp"
#include "mansard/model/city.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::server {

/// As openapi.json describes it. Fails with "pipeline-nothing", and as terrain::make does.
[[nodiscard]] auto terrain_bytes(const model::City& city, const OpenScene& scene, const pipeline::Options& options)
    -> base::Result<std::string>;

/// The files that a terrain can be had as: "terrain.glb", …
[[nodiscard]] auto terrain_files() -> const std::vector<std::string>&;
/// One of them; STL is closed with the models. `work`: a folder for it until then. Fails as terrain_bytes does, with
/// "server-unknown", and as formats::write_terrain does.
[[nodiscard]] auto terrain_file(const model::City& city, const OpenScene& scene, const pipeline::Options& options,
                                std::string_view file, const std::filesystem::path& work) -> base::Result<std::string>;

}  // namespace mansard::server
