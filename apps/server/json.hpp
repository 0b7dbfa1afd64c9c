// JSON of the server's answers. The names are those of openapi.json.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/server/jobs.hpp"
#include "apps/server/project.hpp"
#include "mansard/base/result.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/ingest/ingest.hpp"
#include "mansard/picture/tiles.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::server {

using Json = nlohmann::ordered_json;

/// On one line. Bytes of file names and ids that are not UTF-8 are replaced.
[[nodiscard]] auto text_of(const Json& json) -> std::string;

[[nodiscard]] auto json_of(const base::Diagnostic& diagnostic) -> Json;
[[nodiscard]] auto json_of(std::span<const base::Diagnostic> diagnostics) -> Json;
[[nodiscard]] auto json_of(const Job& job) -> Json;
[[nodiscard]] auto json_of(const MapInfo& map) -> Json;
[[nodiscard]] auto json_of(const std::optional<RunScores>& scores) -> Json;
/// RunSummary; `edits` are applied.
[[nodiscard]] auto json_of(const RunRecord& run, std::size_t edits) -> Json;
[[nodiscard]] auto json_of(const model::Plan& plan) -> Json;
[[nodiscard]] auto json_of(const model::LabelledSolid& model) -> Json;
[[nodiscard]] auto json_of(const model::ProfilePoint& point) -> Json;
[[nodiscard]] auto json_of(std::span<const geometry::Point2> points) -> Json;
[[nodiscard]] auto json_of(const edit::NamedPlan& part) -> Json;
[[nodiscard]] auto json_of(const edit::Change& change) -> Json;
[[nodiscard]] auto json_of(const edit::History& history) -> Json;

/// {"buildings": …, "history": …}; the buildings as text.
[[nodiscard]] auto both_of(const std::string& buildings, const Json& history) -> std::string;

/// RaisedBuilding. `plans` are those of its parts, in the same order.
[[nodiscard]] auto json_of(const std::string& id, std::uint64_t revision, std::span<const edit::NamedPlan> plans,
                           const edit::RaisedBuilding& raised) -> Json;

/// Layers.
[[nodiscard]] auto layers_json(const std::vector<report::SegmentedBlock>& blocks) -> Json;

/// Id of a tile: "1-3-4".
[[nodiscard]] auto id_of(const picture::Tile& tile) -> std::string;
/// TileIndex.
[[nodiscard]] auto json_of(const picture::Tile& tile) -> Json;

/// A block with its mesh.
[[nodiscard]] auto json_of(const block::Block& block, const model::Scene& scene) -> Json;
/// Scene, with its blocks, whose meshes are not needed; `shown` is the JSON of each.
[[nodiscard]] auto json_of(const model::Scene& scene, std::span<const block::Block> blocks, std::vector<Json> shown)
    -> Json;

}  // namespace mansard::server
