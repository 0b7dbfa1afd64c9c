// The pieces of a point cloud, side by side.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mansard/base/run.hpp"
#include "mansard/formats/points.hpp"

namespace mansard::ingest::detail {

/// Calls work(i, points) for every piece, in any order and on any thread, until the run is cancelled. Fails as
/// PointCloud::read, with the first piece that does.
template <class Work>
[[nodiscard]] auto each_piece(const formats::PointCloud& cloud, const base::Run& run, const Work& work)
    -> base::Result<void> {
  std::vector<std::optional<base::Failure>> failures(cloud.pieces());
  base::parallel_for(failures.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const auto points = cloud.read(i);
    if (points) work(i, *points);
    else failures[i] = points.failure();
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  return {};
}

/// The box that a header should say, from the points; empty where none is finite.
[[nodiscard]] auto measured_plan(const formats::PointCloud& cloud, const base::Run& run)
    -> base::Result<geometry::Box2>;

}  // namespace mansard::ingest::detail
