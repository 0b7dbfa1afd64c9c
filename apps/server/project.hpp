// A project on the disk: which inputs, which runs, what they left. Whatever is here is whole at any moment.
//
//   project.json            inputs by path, size and SHA-256, and the options they are read with
//   inputs/                 what was uploaded
//   runs/run-3/run.json     label, state, options, numbers; written last, so that a run that is done has all of the
//   rest
//             report.json, plans.json, layers.json, segment.gpkg, error-0.bin …
//             journal.jsonl the edits
//   exports/, trash/        what was exported; runs that were deleted
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

using Texts = std::map<std::string, std::string>;  ///< "room.name" → value

/// A file as the file system tells of it.
struct Stamp {
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  ///< ns since the file system's epoch
  friend auto operator==(const Stamp&, const Stamp&) -> bool = default;
};

/// An input as it was when it was read.
struct KnownFile {
  std::string path;  ///< absolute where it is on disk; without its password where it is in a database
  std::uint64_t bytes = 0;
  std::string sha256;
  Stamp stamp;  ///< of the file on disk: the archive that it is in, the packed file; nothing for what is elsewhere
  friend auto operator==(const KnownFile&, const KnownFile&) -> bool = default;
};

inline constexpr const char* terrain_option = "ingest.terrain";

struct Inputs {
  std::vector<std::string> meshes;  ///< as given: files or folders, absolute, or what GDAL alone understands
  std::string footprints;           ///< the same, or a database with its password; empty: drawn from the mesh
  Texts reading;                    ///< options of "ingest", "derive" and "block"
  std::vector<KnownFile> mesh_files, terrain_files, footprint_files;
  /// A password makes no other request.
  [[nodiscard]] auto same_request(const Inputs& other) const -> bool;
};

/// Of one block; its values are in a file of its own.
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
  Texts options;                    ///< those that differ from the defaults, those of the reading too
  std::vector<std::string> blocks;  ///< empty: all
  std::optional<RunScores> scores;
  std::vector<pipeline::StageTime> times;
  std::size_t buildings = 0, full = 0, parts = 0, faces = 0;
  std::vector<MapInfo> maps;
};

class Project {
 public:
  /// Makes it where the folder is missing or empty. Nobody else can open it as long as this lives: the kernel lets go
  /// of the lock with the process. Gives up with "server-folder" (it holds something else), "server-locked",
  /// "server-project" (project.json cannot be read), "file-write".
  [[nodiscard]] static auto open(const std::filesystem::path& folder) -> base::Result<Project>;

  [[nodiscard]] auto folder() const -> const std::filesystem::path& { return folder_; }
  [[nodiscard]] auto name() const -> std::string;

  [[nodiscard]] auto inputs() const -> const std::optional<Inputs>& { return inputs_; }
  /// Passwords are known until the end of the program, and not written down.
  [[nodiscard]] auto save(const Inputs& inputs) -> base::Result<void>;

  /// By number. Runs that had not ended when the last server did are interrupted, on the disk too. A folder without a
  /// run.json, as a crash leaves it, is no run.
  [[nodiscard]] auto runs() -> base::Result<std::vector<RunRecord>>;
  /// A number that no run had, not even one that was deleted; its folder is made.
  [[nodiscard]] auto new_run() -> base::Result<std::string>;
  [[nodiscard]] auto save(const RunRecord& run) -> base::Result<void>;
  [[nodiscard]] auto run_folder(const std::string& run) const -> std::filesystem::path;
  [[nodiscard]] auto trash(const std::string& run) -> base::Result<void>;

 private:
  Project(std::filesystem::path folder, Descriptor lock);
  [[nodiscard]] auto read() -> base::Result<void>;

  std::filesystem::path folder_;
  Descriptor lock_;
  std::optional<Inputs> inputs_;
};

/// The file as it is; nothing where it is missing.
[[nodiscard]] auto stamp_of(const std::filesystem::path& path) -> std::optional<Stamp>;

/// How many edits of a journal stand, without looking into them.
[[nodiscard]] auto standing_edits(const std::filesystem::path& journal) -> std::size_t;

}  // namespace mansard::server
