// What makes a mesh and footprints match that do not: another CRS, or an offset of the mesh.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mansard/align/align.hpp"
#include "mansard/pipeline/inputs.hpp"

namespace mansard::pipeline {

struct Placing {
  std::string crs, title;        ///< the CRS to work in, "EPSG:n", and what it is called; empty: as it is
  std::array<double, 3> offset;  ///< m; Options::ingest.mesh_offset
  align::Match match;            ///< with both
  std::string working;           ///< the CRS of the coordinates without `crs`, as model::Frame has it; empty: unknown
};

/// "--mesh-offset 84800 447400 0"
[[nodiscard]] auto offset_in_words(const std::array<double, 3>& offset) -> std::string;
/// The options to add to a command, "--mesh-offset 84800 447400 0"; empty where they match as they are.
[[nodiscard]] auto options_in_words(const Placing& placing, const Options& options) -> std::string;
/// Why: how much of the footprints is high in the mesh, here and elsewhere.
[[nodiscard]] auto reason_in_words(const Placing& placing) -> std::string;

/// The least correlation at which mesh and footprints are taken to match, and how many times that of the next best
/// place it must be for an offset. Footprints of the same place reach 0.33 (Delft, with trees) to 0.93 and 1.6 to 4
/// times the next best place, on the shared and simulated data.
inline constexpr double least_correlation = 0.2, least_lead = 1.25;
/// And the share of the footprints, or of what is high, that must have been compared.
inline constexpr double least_met = 0.5;
[[nodiscard]] auto fits(const align::Match& match) -> bool;

/// How the files match: as they are; else in a CRS in which the footprints come to lie where the mesh does; else with
/// an offset of the mesh. None where nothing is found, and where the mesh says where it is and the footprints are
/// elsewhere. Reads all of the mesh. Fails as ingest::read_footprints and ingest::read_mesh do.
[[nodiscard]] auto find_placing(const InputPaths& paths, const Options& options, const base::Run& run = {})
    -> base::Result<std::optional<Placing>>;

struct MeasuredScan {
  model::Accuracy accuracy;
  std::vector<base::Diagnostic> findings;  ///< of the checks of the scan (scan_checks.hpp)
};
/// The accuracy of a scan over its footprints, of at most so many of its blocks, evenly, and what is wrong with it as a
/// whole. Reads all of the mesh. Fails as read_inputs does.
[[nodiscard]] auto accuracy_of_scan(const InputPaths& paths, const Options& options, const base::Run& run = {},
                                    std::size_t most_blocks = 24) -> base::Result<MeasuredScan>;

/// Of options with which the scan is where its footprints are, the offset of the mesh; none where it is there already,
/// or where that could not be measured. Reads all of the mesh. Fails as read_city_inputs does.
[[nodiscard]] auto align_scan(const InputPaths& paths, const Options& options, const base::Run& run = {})
    -> base::Result<std::optional<std::array<double, 3>>>;

}  // namespace mansard::pipeline
