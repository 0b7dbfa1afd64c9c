#include "mansard/segment/detail/height_steps.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/segment/detail/walk.hpp"

namespace mansard::segment::detail {
namespace {

using geometry::Point2;

/// The mesh's height beside a place on a half-edge, inside its face: half-way to the face's far side at most.
auto height_beside(const fracture::Arrangement& arrangement, const rays::Scene& mesh, std::uint32_t half_edge,
                   Point2 place, double offset) -> std::optional<double> {
  const geometry::Segment2 s = arrangement.segment(half_edge);
  const Point2 inwards = geometry::normalised(geometry::left_of(s.end - s.start));
  if (const auto exit = exit_of(arrangement, half_edge, place, inwards)) offset = std::min(offset, exit->distance / 2);
  return mesh.top(place + offset * inwards);
}

}  // namespace

void measure_steps(const fracture::Arrangement& arrangement, const rays::Scene& mesh, const Options& options,
                   std::vector<Candidate>& candidates) {
  base::parallel_for(candidates.size(), [&](std::size_t i) {
    double sum = 0, weight = 0;
    for (const std::uint32_t h : candidates[i].half_edges) {
      const geometry::Segment2 s = arrangement.segment(h);
      const double length = length_of(arrangement, h);
      const auto count = static_cast<int>(std::ceil(std::min(length, 1e4) / options.height_spacing));
      for (int k = 0; k < count; ++k) {
        const Point2 place = s.start + ((k + 0.5) / count) * (s.end - s.start);
        const auto left = height_beside(arrangement, mesh, h, place, options.height_offset);
        const auto right =
            height_beside(arrangement, mesh, arrangement.half_edges[h].twin, place, options.height_offset);
        if (!left || !right) continue;
        sum += length / count * std::abs(*left - *right);
        weight += length / count;
      }
    }
    if (weight > 0) candidates[i].amounts[Term::height] = sum / weight;
  });
}

}  // namespace mansard::segment::detail
