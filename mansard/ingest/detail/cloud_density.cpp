#include "mansard/ingest/detail/cloud_density.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mansard/base/statistics.hpp"
#include "mansard/ingest/detail/cloud_pieces.hpp"
#include "mansard/ingest/detail/same_clouds.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Point3;

auto is_finite(Point3 p) -> bool { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// In the working CRS; those that are finite.
auto positions_of(const std::vector<formats::CloudPoint>& points, const std::optional<crs::WayOfMesh>& way)
    -> std::vector<Point3> {
  std::vector<Point3> out;
  out.reserve(points.size());
  for (const auto& p : points)
    if (is_finite(p.position)) out.push_back(p.position);
  if (way) way->take(out);
  std::erase_if(out, [](Point3 p) { return !is_finite(p); });
  return out;
}

/// Leaves each place once; returns the share that stays.
auto keep_once(std::vector<Point3>& points) -> double {
  const auto all = points.size();
  std::ranges::sort(points);
  const auto again = std::ranges::unique(points);
  points.erase(again.begin(), again.end());
  return all == 0 ? 1 : static_cast<double>(points.size()) / static_cast<double>(all);
}

/// The median over the squares of a metre that have points.
auto density_in_squares(const std::vector<Point3>& points) -> double {
  std::vector<std::pair<double, double>> squares;
  squares.reserve(points.size());
  for (const auto& p : points) squares.emplace_back(std::floor(p.x), std::floor(p.y));
  std::ranges::sort(squares);
  std::vector<double> counts;
  for (auto at = squares.begin(); at != squares.end();) {
    const auto end = std::ranges::upper_bound(at, squares.end(), *at);
    counts.push_back(static_cast<double>(end - at));
    at = end;
  }
  return base::median(std::move(counts));
}

/// Of about a million places of the cloud, chosen by what they are: what is at one place is chosen together.
auto share_of_once(const formats::PointCloud& cloud, const std::optional<crs::WayOfMesh>& way, const base::Run& run)
    -> base::Result<double> {
  constexpr std::uint64_t enough = 1'000'000;
  const std::uint64_t every = cloud.info().points / enough + 1;
  std::vector<std::vector<Point3>> chosen(cloud.pieces());
  const auto read = each_piece(cloud, run, [&](std::size_t i, const auto& points) {
    for (const auto& p : positions_of(points, way))
      if (hash_of(p, 0).value_or(0) % every == 0) chosen[i].push_back(p);
  });
  if (!read) return read.failure();
  std::vector<Point3> all;
  for (const auto& piece : chosen) all.insert(all.end(), piece.begin(), piece.end());
  return keep_once(all);
}

}  // namespace

auto density_where_points_are(const formats::PointCloud& cloud, const std::optional<crs::WayOfMesh>& way,
                              const base::Run& run) -> base::Result<SeenDensity> {
  // Pieces of 50,000 points in most files. Of a file with few, all of them together: strips that overlap follow each
  // other in it. Of others some, each for itself.
  constexpr std::size_t few = 8, some = 4;
  const bool together = cloud.pieces() <= few;
  std::vector<std::vector<Point3>> pieces(together ? cloud.pieces() : some);
  std::vector<std::optional<base::Failure>> failures(pieces.size());
  base::parallel_for(pieces.size(), [&](std::size_t k) {
    const std::size_t piece = k * cloud.pieces() / pieces.size();
    if (run.cancelled() || cloud.box_of(piece)) return;
    const auto points = cloud.read(piece);
    if (points) pieces[k] = positions_of(*points, way);
    else failures[k] = points.failure();
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  std::vector<Point3> all;
  for (const auto& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  SeenDensity out;
  out.share_of_once = keep_once(all);
  if (together) {
    if (!all.empty()) out.density = density_in_squares(all);
    return out;
  }
  std::vector<double> densities;
  for (auto& piece : pieces) {
    static_cast<void>(keep_once(piece));
    if (!piece.empty()) densities.push_back(density_in_squares(piece));
  }
  if (!densities.empty()) out.density = base::median(std::move(densities));
  if (1 - out.share_of_once < noticeable_share) return out;
  const auto share = share_of_once(cloud, way, run);
  if (!share) return share.failure();
  out.share_of_once = *share;
  return out;
}

}  // namespace mansard::ingest::detail
