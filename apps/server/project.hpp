// A project on disk: its inputs and its runs. The files are consistent at any moment.
//
//   project.json            inputs by path, size and SHA-256, and the options they are read with
//   review.json             what people decided about the models
//   inputs/                 uploaded files
//   runs/run-3/run.json     label, state, options, numbers; written last, so that a run in the state "done" has all
//                           other files
//             report.json, plans.json, layers.json, segment.gpkg, error-0.bin …
//             journal.jsonl the edits
//             index.bin     the list of a large run, made again where it does not fit: run_index.hpp
//   exports/, trash/        exported files; deleted runs
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/server/disk.hpp"
#include "apps/server/state.hpp"
#include "mansard/base/result.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/pipeline/pipeline.hpp"

namespace mansard::server {

using Texts = std::map<std::string, std::string>;  ///< "module.name" → value

/// Size and time of a file, as the file system reports them.
struct Stamp {
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  ///< ns since the file system's epoch
  friend auto operator==(const Stamp&, const Stamp&) -> bool = default;
};

/// An input file at the time it was read.
struct KnownFile {
  std::string path;  ///< absolute for a file on disk; without the password for a database
  std::uint64_t bytes = 0;
  std::string sha256;
  Stamp stamp;  ///< of the file on disk (of an archive, if it is in one); zero for databases and servers
  friend auto operator==(const KnownFile&, const KnownFile&) -> bool = default;
};

inline constexpr const char* terrain_option = "ingest.terrain";

struct Inputs {
  std::vector<std::string> meshes;  ///< as given: absolute paths of files or folders, or names for GDAL
  std::string footprints;           ///< like a mesh, or a database with its password; empty: derived from the mesh
  Texts reading;                    ///< options of "ingest", "derive" and "block"
  std::vector<KnownFile> mesh_files, terrain_files, footprint_files;
  /// Whether meshes, footprints and options are the same, passwords aside.
  [[nodiscard]] auto same_request(const Inputs& other) const -> bool;
};

/// The error map of one block; its values are in a separate file.
struct MapInfo {
  std::string block;
  geometry::Point2 origin;
  double grid = 0;
  std::size_t columns = 0, rows = 0;
};

struct RunScores {
  double mse = 0, footprint_mse = 0, footprint_median_absolute = 0, inside_mse = 0, missed = 0, invented = 0;
};

struct RunRecord {
  std::string id, label;
  State state = State::queued;
  std::optional<base::Diagnostic> failure;
  std::string created;  ///< ISO 8601, UTC
  std::string preset;
  Texts options;  ///< values that differ from the defaults, including those that the inputs are read with
  std::vector<std::string> blocks;  ///< empty: all
  std::optional<RunScores> scores;
  report::Times times;
  std::size_t buildings = 0, full = 0, parts = 0, faces = 0;
  std::vector<MapInfo> maps;
  bool damaged = false;  ///< its file cannot be read: `failure` says why, and the file is left as it is
};

class Project {
 public:
  /// Creates the project if the folder is missing or empty. The project is locked until this object is destroyed; the
  /// kernel releases the lock when the process ends. Fails with "server-folder" (the folder has other contents),
  /// "server-locked", "server-project" (project.json cannot be read), "file-write".
  [[nodiscard]] static auto open(const std::filesystem::path& folder) -> base::Result<Project>;

  [[nodiscard]] auto folder() const -> const std::filesystem::path& { return folder_; }
  [[nodiscard]] auto name() const -> std::string;

  [[nodiscard]] auto inputs() const -> const std::optional<Inputs>& { return inputs_; }
  /// Passwords are kept in memory only.
  [[nodiscard]] auto save(const Inputs& inputs) -> base::Result<void>;

  /// Sorted by number. A run whose record cannot be read is listed as failed, with "server-damaged", and its file is
  /// left as it is. Runs that had not ended when the last server ended become "interrupted", also on disk. A folder
  /// without a run.json, as a crash leaves it, is ignored.
  [[nodiscard]] auto runs() -> base::Result<std::vector<RunRecord>>;
  /// The id of a new run; its folder is created. Ids of deleted runs are not used again.
  [[nodiscard]] auto new_run() -> base::Result<std::string>;
  [[nodiscard]] auto save(const RunRecord& run) -> base::Result<void>;
  [[nodiscard]] auto run_folder(const std::string& run) const -> std::filesystem::path;
  [[nodiscard]] auto trash(const std::string& run) -> base::Result<void>;
  /// How many edits of a run are applied; 0 if its journal cannot be read.
  [[nodiscard]] auto applied_edits(const std::string& run) const -> std::size_t;

 private:
  Project(std::filesystem::path folder, Descriptor lock);
  [[nodiscard]] auto read() -> base::Result<void>;

  std::filesystem::path folder_;
  Descriptor lock_;
  std::optional<Inputs> inputs_;
};

/// Size and time of a file; none if it is missing.
[[nodiscard]] auto stamp_of(const std::filesystem::path& path) -> std::optional<Stamp>;

[[nodiscard]] auto unknown_run(const std::string& run) -> base::Diagnostic;

/// The journal in the folder of a run.
[[nodiscard]] auto journal_of(const std::filesystem::path& run_folder) -> std::filesystem::path;
/// The text of a journal; empty if the file is missing. Fails with "file-read".
[[nodiscard]] auto read_journal(const std::filesystem::path& journal) -> base::Result<std::string>;

}  // namespace mansard::server
