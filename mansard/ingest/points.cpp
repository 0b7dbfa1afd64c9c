#include "mansard/ingest/points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mansard/base/stopped.hpp"
#include "mansard/cloud/classes.hpp"
#include "mansard/formats/points.hpp"
#include "mansard/ingest/detail/cloud_pieces.hpp"
#include "mansard/ingest/detail/files_below.hpp"

namespace mansard::ingest {
namespace {

namespace fs = std::filesystem;

/// The clouds among the paths; what is in an EPT set belongs to it.
auto clouds_in(const std::vector<fs::path>& paths) -> base::Result<std::vector<fs::path>> {
  std::vector<fs::path> out;
  std::error_code failure;
  for (const auto& path : paths) {
    if (!fs::is_directory(path, failure)) {
      if (formats::is_point_cloud(path)) out.push_back(path);
      continue;
    }
    if (fs::exists(path / "ept.json", failure)) {
      out.push_back(path / "ept.json");
      continue;
    }
    auto found = detail::files_below(path);
    if (!found) return found.failure();
    std::erase_if(*found, [](const fs::path& file) {
      return file.filename().string().starts_with('.') || !formats::is_point_cloud(file);
    });
    std::ranges::sort(*found);
    out.insert(out.end(), found->begin(), found->end());
  }
  return out;
}

}  // namespace

auto read_points_of_class(const std::vector<fs::path>& paths, std::uint8_t classification, const model::Frame& frame,
                          const Options& options, const base::Run& run) -> base::Result<std::vector<geometry::Point3>> {
  std::vector<geometry::Point3> out;
  const auto clouds = clouds_in(paths);
  if (!clouds) return clouds.failure();
  const auto map = cloud::class_map(options.cloud);
  if (!map) return map.failure();
  for (const auto& path : *clouds) {
    const auto opened = formats::open_points(path);
    if (!opened) return opened.failure();
    const auto& cloud = **opened;
    std::optional<crs::WayOfMesh> way;
    if (const auto& own = cloud.info().crs; own && !frame.crs.empty()) {
      auto found = crs::WayOfMesh::between(*own, frame.crs, path.string());
      if (!found) return found.failure();
      way = std::move(*found);
    }
    std::vector<std::vector<geometry::Point3>> pieces(cloud.pieces());
    const auto read = detail::each_piece(cloud, run, [&](std::size_t i, const auto& points) {
      for (const auto& p : points)
        if ((*map)[p.classification] == classification && !p.withheld) pieces[i].push_back(p.position);
      if (way) way->take(pieces[i]);
    });
    if (run.cancelled()) return base::stopped();
    if (!read) return read.failure();
    for (const auto& piece : pieces)
      for (const auto& p : piece) {
        const auto along = [&](double value, std::size_t axis) {
          return value + options.mesh_offset[axis] - static_cast<double>(frame.origin[axis]);
        };
        out.push_back({along(p.x, 0), along(p.y, 1), along(p.z, 2)});
      }
  }
  std::erase_if(out,
                [](geometry::Point3 p) { return !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z); });
  if (clouds->size() > 1) {  // which may overlap
    std::ranges::sort(out);
    const auto again = std::ranges::unique(out);
    out.erase(again.begin(), again.end());
  }
  return out;
}

}  // namespace mansard::ingest
