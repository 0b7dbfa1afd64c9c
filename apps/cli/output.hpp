// The output folder: nothing is overwritten silently, and files appear whole or not at all.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/files.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/layers.hpp"

namespace mansard::cli {

/// Checks that the folder is empty, holds nothing but what a stopped run left, or may be overwritten, makes it, and
/// checks that it can be written, before any work. Fails with "output-exists", "file-write", and "usage" where a new
/// folder would have a file's name ("city.gpkg").
[[nodiscard]] auto prepare(const std::filesystem::path& folder, bool overwrite) -> base::Result<void>;

/// Whether anything is in the folder but what a stopped run keeps to go on from, and its half-written files.
[[nodiscard]] auto holds_results(const std::filesystem::path& folder) -> bool;

/// Takes away the folders that `prepare` made and nothing was written into: a run that failed leaves nothing.
void remove_folders_left_empty();

/// Fails with "output-input" where an output would replace an input, or lie in a folder that is one.
[[nodiscard]] auto spare_inputs(const std::vector<std::filesystem::path>& outputs,
                                const std::vector<std::filesystem::path>& inputs) -> base::Result<void>;

/// Fails with "usage" where a result has the place of another one.
[[nodiscard]] auto spare_results(const std::filesystem::path& result, const std::vector<std::filesystem::path>& others)
    -> base::Result<void>;

/// Ordinary files, and folders of tiles, that an earlier run of a verb left in the folder: those that are its own by
/// name, where the file is there that it always writes. To be asked before that is written again.
[[nodiscard]] auto leftovers(const std::filesystem::path& folder, const std::string& always,
                             const std::function<bool(const std::string&)>& own) -> std::vector<std::filesystem::path>;
/// Takes away those of them that have not been written again, so that no folder has results of two runs.
void remove_stale(const std::vector<std::filesystem::path>& left, const std::vector<std::filesystem::path>& written);
void remove_stale(const std::vector<std::filesystem::path>& left, const std::vector<base::FileToWrite>& written);

/// Checks that `path`, a file or a folder, can be made in `folder`. Fails with "file-write".
[[nodiscard]] auto can_be_made_in(const std::filesystem::path& folder, const std::filesystem::path& path)
    -> base::Result<void>;

/// Checks that a file can be written there and replaces nothing unasked. Fails with "output-exists", "file-write".
[[nodiscard]] auto file_free(const std::filesystem::path& path, bool overwrite) -> base::Result<void>;

/// The named files as they shall stand in the folder; `named` must outlive what is returned.
[[nodiscard]] auto in_folder(const std::filesystem::path& folder,
                             const std::vector<std::pair<std::string, std::string>>& named)
    -> std::vector<base::FileToWrite>;

/// What `mansard report` writes into the folder of a run.
inline constexpr auto run_report_name = "report.html";
inline constexpr std::array picture_names{"picture.png", "above.png", "error.png"};

}  // namespace mansard::cli
