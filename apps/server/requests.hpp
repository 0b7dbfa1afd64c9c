// The bodies of requests, parsed strictly: every error names the place, e.g. changes[0].parts[1].plan.cap.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/server/project.hpp"
#include "mansard/base/result.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/refine/kinds.hpp"
#include "mansard/report/review.hpp"

namespace mansard::server {

struct InputsRequest {
  std::vector<std::string> meshes;
  std::string footprints;
  Texts reading;
};
struct ImportRequest {
  std::string path, label;
};
struct RunRequest {
  std::string label, preset;
  Texts options;
  std::vector<std::string> blocks;
};
struct ExportRequest {
  bool overwrite = false;
  std::vector<std::string> formats;  ///< names of formats; empty: all
};
struct SectionRequest {
  model::Plan plan;
  std::size_t ring = 0, edge = 0;
  double share = 0;
};
struct ReviewRequest {
  std::string building;
  std::uint64_t revision = 0;               ///< of the building that was looked at
  std::optional<report::Verdict> decision;  ///< none: the decision is taken back
  std::string note;
};
struct PartName {
  std::string building, part;
};
struct SplitRequest {
  PartName at;
  std::vector<geometry::Point2> line;
};
/// Parts, with the plans that are to get another roof.
struct RoofsRequest {
  struct Of {
    PartName at;
    model::Plan plan;
  };
  std::optional<refine::Kind> kind;  ///< none: the roofs that they have, fitted
  std::vector<Of> parts;
};
using MergeRequest = std::pair<PartName, PartName>;

/// All of these fail with "server-body", and with "write-plan-…" for plans.
[[nodiscard]] auto read_inputs(std::string_view body) -> base::Result<InputsRequest>;
[[nodiscard]] auto read_run(std::string_view body) -> base::Result<RunRequest>;
[[nodiscard]] auto read_import(std::string_view body) -> base::Result<ImportRequest>;
[[nodiscard]] auto read_label(std::string_view body) -> base::Result<std::string>;
[[nodiscard]] auto read_section(std::string_view body) -> base::Result<SectionRequest>;
[[nodiscard]] auto read_changes(std::string_view body) -> base::Result<std::vector<edit::Change>>;
[[nodiscard]] auto read_edit(std::string_view body) -> base::Result<edit::Edit>;
[[nodiscard]] auto read_split(std::string_view body) -> base::Result<SplitRequest>;
[[nodiscard]] auto read_roofs(std::string_view body) -> base::Result<RoofsRequest>;
[[nodiscard]] auto read_merge(std::string_view body) -> base::Result<MergeRequest>;
[[nodiscard]] auto read_review_request(std::string_view body) -> base::Result<ReviewRequest>;
[[nodiscard]] auto read_export(std::string_view body) -> base::Result<ExportRequest>;
/// The run whose edits are carried over.
[[nodiscard]] auto read_from(std::string_view body) -> base::Result<std::string>;
/// For calls without parameters: the body is empty or {}.
[[nodiscard]] auto read_nothing(std::string_view body) -> base::Result<void>;

/// Checks that the plan has the edge and that the share is from 0 to 1. Fails with "server-body".
[[nodiscard]] auto check_edge(const model::Plan& plan, std::size_t ring, std::size_t edge, double share)
    -> base::Result<void>;

}  // namespace mansard::server
