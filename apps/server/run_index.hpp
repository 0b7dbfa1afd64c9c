// What a page needs of all buildings of a large run, as one file beside plans.json: with it, the run is opened again
// without reading its other files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/server/model_boxes.hpp"
#include "apps/server/project.hpp"
#include "mansard/formats/plans_file.hpp"

namespace mansard::server {

/// One value a building, in the order of plans.json. Everything is as the run made it, before edits.
struct RunIndex {
  formats::Header header;
  std::vector<std::string> ids;
  std::vector<formats::PlansFile::Place> places;
  std::vector<geometry::Box2> boxes;          ///< of the outlines of the parts, in the frame; empty without parts
  std::vector<std::optional<double>> errors;  ///< m², of the parts, weighted by area
  std::vector<std::uint8_t> marked;           ///< whether it was edited before it was exported and opened again
  std::string shapes;                         ///< shapes_of() of all, one after the other
  std::vector<std::uint64_t> shape_ends;      ///< in `shapes`
  std::vector<std::string> attributes;        ///< names: of buildings, then of parts, in the order in which they come
  // From the report.
  std::vector<std::string> strings;             ///< those of the next three, each once
  std::vector<std::uint32_t> blocks, outcomes;  ///< in `strings`
  std::vector<std::uint32_t> reasons;           ///< in `strings`: an array of Diagnostic; an empty text for none
  std::vector<double> grounds, volumes;         ///< m, m³
  std::vector<std::optional<double>> confidences;
};

/// [[base, height, x, y, x, y …], …] of the parts, in centimetres.
[[nodiscard]] auto shapes_of(const std::vector<edit::NamedPlan>& parts) -> std::string;
[[nodiscard]] auto number_of(const model::Attributes& attributes, std::string_view name) -> std::optional<double>;
/// m², of the parts, weighted by area; none where no part has an error.
[[nodiscard]] auto error_of(const model::Building& building) -> std::optional<double>;
/// Whether the building was edited before it was exported and opened again.
[[nodiscard]] auto has_mark(const model::Building& building) -> bool;

/// The index in the folder of a run; made from plans.json and report.json, and kept, where there is none, it is
/// damaged, another version of mansard wrote it, or the files are not those that it was made from: their sizes, times,
/// and first and last bytes are compared. Files are read in one pass each, on all threads. None where one of them is
/// unusual or at fault: reading them as a whole tells. Where the index cannot be written, the next opening takes
/// longer, and nothing else.
[[nodiscard]] auto run_index(const std::filesystem::path& folder) -> std::optional<RunIndex>;

}  // namespace mansard::server
