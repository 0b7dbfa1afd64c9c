// Point clouds of any format, piece by piece: LAS, LAZ, COPC, EPT, PLY without faces, and text.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/crs/mesh_crs.hpp"
#include "mansard/geometry/points.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::formats {

/// One point of a cloud, as its file has it. What a file lacks is 0; returns are 1 of 1 then.
struct CloudPoint {
  geometry::Point3 position;  ///< file coordinates, in the units of its CRS; may hold NaN where the file does
  std::uint8_t classification = 0;
  std::uint8_t return_number = 1, returns = 1;
  bool withheld = false;     ///< not to be used, says the producer
  std::uint16_t source = 0;  ///< the flight line, or another set that was measured together; 0: not known
  std::uint16_t intensity = 0;
  std::array<std::uint16_t, 3> colour{};  ///< red, green, blue; 16 bits each, or 8 where the producer did so
};

struct PointInfo {
  std::string format;     ///< "LAS 1.2", "LAZ 1.4", "COPC 1.0", "EPT 1.0.0", "PLY", "text"
  int point_format = -1;  ///< of LAS; -1 for others
  std::uint64_t points = 0;
  /// What the header says, in file coordinates: a hint. None where that is not finite or empty.
  std::optional<geometry::Box3> stated_bounds;
  std::optional<crs::MeshCrs> crs;  ///< of the coordinates, with the unit of heights; none where nothing is said
  std::string crs_title;            ///< for people; empty for none
  double unit = 1;                  ///< m, of x and y; 0 for degrees
  bool has_classes = false, has_returns = false, has_colours = false;
  std::vector<base::Diagnostic> warnings;
};

/// A cloud that is open. Its pieces are chunks, nodes or ranges of records; together they are the cloud, in the order
/// of the file.
class PointCloud {
 public:
  virtual ~PointCloud() = default;
  PointCloud() = default;
  PointCloud(const PointCloud&) = delete;
  auto operator=(const PointCloud&) -> PointCloud& = delete;

  [[nodiscard]] virtual auto info() const -> const PointInfo& = 0;
  [[nodiscard]] virtual auto pieces() const -> std::size_t = 0;
  [[nodiscard]] virtual auto points_of(std::size_t piece) const -> std::uint64_t = 0;
  /// File coordinates, where the cloud has an index: no point of the piece is outside. None elsewhere.
  [[nodiscard]] virtual auto box_of(std::size_t piece) const -> std::optional<geometry::Box3> = 0;
  /// From any thread. Fails with "ingest-points-format", "ingest-points-truncated", "ingest-points-unsupported",
  /// "ingest-memory", "file-missing", "file-read".
  [[nodiscard]] virtual auto read(std::size_t piece) const -> base::Result<std::vector<CloudPoint>> = 0;
  /// What was read, with hashes. Of a file on a server, from which parts are read, the hash is that of its header and
  /// index.
  [[nodiscard]] virtual auto inputs() const -> base::Result<std::vector<model::InputFile>> = 0;
};

/// Whether the name is that of a cloud: .las, .laz, .xyz, .pts, ept.json; .ply with vertices and no face, .csv and .txt
/// that begin as a cloud (which are looked into).
[[nodiscard]] auto is_point_cloud(const std::filesystem::path& path) -> bool;

/// Reads headers and indexes, no points. `path` is a file, or the folder of an EPT set. Memory does not grow with what
/// a header promises. Fails with "ingest-points-format" (what is wrong), "ingest-points-truncated",
/// "ingest-points-unsupported", "ingest-memory", "file-missing", "file-read".
[[nodiscard]] auto open_points(const std::filesystem::path& path) -> base::Result<std::unique_ptr<PointCloud>>;

}  // namespace mansard::formats
