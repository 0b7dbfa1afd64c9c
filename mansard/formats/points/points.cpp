// From a name to the reader of its format.
#include "mansard/formats/points.hpp"

#include <new>

#include "mansard/base/text.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/formats/ept/ept.hpp"
#include "mansard/formats/files/ranges.hpp"
#include "mansard/formats/files/virtual_files.hpp"
#include "mansard/formats/las/las_file.hpp"
#include "mansard/formats/mesh/mesh_stream.hpp"
#include "mansard/formats/ply/point_reader.hpp"
#include "mansard/formats/xyz/point_reader.hpp"

namespace mansard::formats {
namespace {

namespace fs = std::filesystem;
constexpr const char* ept_name = "ept.json";

/// The beginning of a file, in which the header of a PLY is; empty where it cannot be read.
auto beginning_of(const fs::path& path) -> std::string {
  constexpr std::uint64_t enough = 65536;
  if (auto window = FileWindow::open(path)) {  // no map of a file that may be larger than what memory is allowed
    if (auto filled = window->fill(enough); !filled) return {};
    return std::string(window->view());
  }
  const auto file = RangeFile::open(path);
  if (!file) return {};
  const auto range = (*file)->read(0, enough);
  return range ? std::string(range->view()) : std::string();
}

/// Text with an extension that is for points alone, and text that may be anything.
auto is_text_of_points(std::string_view extension) -> bool { return extension == ".xyz" || extension == ".pts"; }
auto is_text(std::string_view extension) -> bool {
  return is_text_of_points(extension) || extension == ".csv" || extension == ".txt";
}

auto open(const fs::path& path) -> base::Result<std::unique_ptr<PointCloud>> {
  const auto extension = extension_of(path);
  if (path.filename() == ept_name) return open_ept(path);
  if (extension == ".ply") return open_point_ply(path);
  if (is_text(extension)) return open_point_text(path);
  if (extension != ".las" && extension != ".laz" && is_there(path / ept_name)) return open_ept(path / ept_name);
  auto las = LasFile::open(path);
  if (!las) return las.failure();
  return std::unique_ptr<PointCloud>(std::move(*las));
}

}  // namespace

auto is_point_cloud(const fs::path& path) -> bool {
  if (path.filename() == ept_name) return true;
  const auto extension = extension_of(path);
  if (extension == ".las" || extension == ".laz" || is_text_of_points(extension)) return true;
  if (is_text(extension)) return is_point_text(beginning_of(path));
  return extension == ".ply" && is_point_ply(beginning_of(path));
}

auto open_points(const fs::path& path) -> base::Result<std::unique_ptr<PointCloud>> {
  try {
    return open(path);
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "the points do not fit into memory; cut them into tiles", path.string());
  } catch (const std::exception& e) {
    return base::error("ingest-points-format", std::string("cannot be read (") + e.what() + "); check what it is",
                       path.string());
  }
}

}  // namespace mansard::formats
