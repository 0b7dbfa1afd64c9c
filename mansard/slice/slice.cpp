#include "mansard/slice/slice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace mansard::slice {
namespace {

using geometry::Point2;
using geometry::Point3;
using geometry::Segment2;

/// The planes from the ground to the highest vertex. Stray vertices of a broken mesh must not cost the memory of
/// millions of planes.
auto plane_heights(const block::Block& block, const Options& options) -> std::vector<double> {
  const double interval = options.interval;
  double top = -std::numeric_limits<double>::infinity();
  for (const auto& triangle : block.mesh.triangles)
    for (const auto vertex : triangle) top = std::max(top, block.mesh.vertices[vertex].z);
  std::vector<double> heights;
  if (!std::isfinite(block.ground) || !(interval > 0)) return heights;
  top = std::min(top, block.ground + options.maximum_height);
  for (std::size_t i = 0;; ++i) {
    const double height = block.ground + (static_cast<double>(i) + 0.5) * interval;
    if (!(height <= top)) return heights;
    heights.push_back(height);
  }
}

/// The planes [first, last) with lowest vertex < height ≤ highest vertex. The quotient may be off by one through
/// rounding, so that the comparison with the planes' own heights decides.
auto crossing_planes(double lowest, double highest, const std::vector<double>& heights, double interval)
    -> std::pair<std::size_t, std::size_t> {
  const auto first_above = [&](double z) -> std::size_t {
    const double guess = std::floor((z - heights.front()) / interval);
    auto i = guess > 0 ? std::min(static_cast<std::size_t>(std::min(guess, 1e9)), heights.size()) : std::size_t{0};
    while (i > 0 && heights[i - 1] > z) --i;
    while (i < heights.size() && heights[i] <= z) ++i;
    return i;
  };
  return {first_above(lowest), first_above(highest)};
}

/// Where an edge meets the plane, always computed from the lower end, so that both triangles of the edge agree.
auto crossing(const Point3& below, const Point3& above, double height) -> Point2 {
  if (above.z == height) return xy(above);
  const double t = (height - below.z) / (above.z - below.z);
  return {below.x + t * (above.x - below.x), below.y + t * (above.y - below.y)};
}

/// Nothing when the plane only touches a corner. Seen from outside a triangle runs counter-clockwise, so the edge that
/// goes up through the plane is on the right: starting there keeps outside on the left.
auto section(const std::array<Point3, 3>& corners, double height) -> std::optional<Segment2> {
  Segment2 segment;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& a = corners[k];
    const auto& b = corners[(k + 1) % 3];
    const bool a_above = a.z >= height, b_above = b.z >= height;
    if (a_above && !b_above) segment.end = crossing(b, a, height);
    if (!a_above && b_above) segment.start = crossing(a, b, height);
  }
  if (segment.start == segment.end) return std::nullopt;
  return segment;
}

}  // namespace

auto option_list(Options& options) -> base::OptionList {
  base::OptionList list("slice");
  list.number("interval", options.interval, "m", {0.01, 10}, "Vertical distance between slices.")
      .source("paper: 0.2 m");
  return list;
}

auto cut(const block::Block& block, const Options& options, const base::Run& run) -> SliceStack {
  SliceStack stack{options.interval, {}};
  const auto heights = plane_heights(block, options);
  if (heights.empty()) return stack;
  stack.slices.resize(heights.size());

  // Counting sort of (plane, triangle) pairs: starts[i] … starts[i + 1] are the triangles of plane i, in mesh order.
  const auto& mesh = block.mesh;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> spans(mesh.triangles.size());
  std::vector<std::int64_t> change(heights.size() + 1, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto [lowest, highest] = std::minmax({mesh.vertices[a].z, mesh.vertices[b].z, mesh.vertices[c].z});
    const auto [first, last] = crossing_planes(lowest, highest, heights, options.interval);
    spans[t] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
    ++change[first];
    --change[last];
  }
  std::vector<std::size_t> starts(heights.size() + 1, 0);
  std::int64_t open = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    open += change[i];
    starts[i + 1] = starts[i] + static_cast<std::size_t>(open);
  }
  std::vector<std::uint32_t> crossed(starts.back());
  auto next = starts;
  for (std::size_t t = 0; t < spans.size(); ++t)
    for (auto i = spans[t].first; i < spans[t].second; ++i) crossed[next[i]++] = static_cast<std::uint32_t>(t);

  base::parallel_for(heights.size(), [&](std::size_t i) {
    stack.slices[i].height = heights[i];
    if (run.cancelled()) return;
    auto& segments = stack.slices[i].segments;
    segments.reserve(starts[i + 1] - starts[i]);
    for (auto k = starts[i]; k < starts[i + 1]; ++k) {
      const auto& [a, b, c] = mesh.triangles[crossed[k]];
      const auto found = section({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, heights[i]);
      if (found) segments.push_back(*found);
    }
  });
  run.report("slice", block.name, 1.0);
  return stack;
}

}  // namespace mansard::slice
