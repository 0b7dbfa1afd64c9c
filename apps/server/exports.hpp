// The models of a run as files, each as `mansard extrude` writes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/server/formats.hpp"
#include "mansard/base/result.hpp"
#include "mansard/formats/results.hpp"

namespace mansard::server {

/// A folder that is deleted with its contents by the destructor.
class WorkFolder {
 public:
  explicit WorkFolder(std::filesystem::path path) : path_(std::move(path)) {}
  WorkFolder(const WorkFolder&) = delete;
  auto operator=(const WorkFolder&) -> WorkFolder& = delete;
  ~WorkFolder() {
    std::error_code status;
    std::filesystem::remove_all(path_, status);
  }
  [[nodiscard]] auto path() const -> const std::filesystem::path& { return path_; }

 private:
  std::filesystem::path path_;
};

/// Layers of the segmentation for a GIS: sweep-edges, faces, cuts. They are of the run, before edits.
inline constexpr const char* run_layers = "segment.gpkg";

/// A temporary folder for an export.
[[nodiscard]] auto work_folder(const std::filesystem::path& exports, std::uint64_t number) -> std::filesystem::path;
/// Deletes the work folders that a server left which was killed during an export.
void remove_work_folders(const std::filesystem::path& exports);

/// The bytes of one of the files_of() a format. The folder `work` is made and deleted again. Fails as the writers
/// do, and with "server-unknown".
[[nodiscard]] auto exported(const model::City& city, const formats::WriteOptions& options, std::string_view file,
                            const std::filesystem::path& work) -> base::Result<std::string>;

struct Exported {
  std::vector<std::string> files;
  std::vector<base::Diagnostic> warnings;
};
/// Writes all of these formats, and the run's layers if it has any, into a folder: all of them or none. Files of an
/// earlier export that this one does not write are deleted. Fails as the writers do.
[[nodiscard]] auto export_to(const std::filesystem::path& folder, const model::City& city,
                             const formats::WriteOptions& options, const std::vector<formats::Format>& formats,
                             const std::optional<std::string>& layers) -> base::Result<Exported>;

}  // namespace mansard::server
