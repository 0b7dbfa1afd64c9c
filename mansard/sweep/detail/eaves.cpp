#include "mansard/sweep/detail/eaves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "mansard/base/statistics.hpp"
#include "mansard/sweep/detail/line_index.hpp"
#include "mansard/sweep/detail/registration.hpp"

namespace mansard::sweep::detail {

using geometry::Point2;
using geometry::Segment2;

namespace {

/// Outside of the wall, in metres, at one place along it.
struct Place {
  double footprint = 0, eaves = 0;
};

/// How far outside of a point the nearest of some edges is; none where they are not beside it.
auto nearest_outside(Point2 p, Point2 along, const std::vector<Segment2>& edges) -> std::optional<double> {
  const Point2 out = geometry::left_of(along);
  std::optional<double> nearest;
  for (const auto& edge : edges) {
    const double from = dot(edge.start - p, along), to = dot(edge.end - p, along);
    if (from > 0 || to <= 0) continue;
    const double at = dot(edge.start - p, out) - from / (to - from) * dot(edge.end - edge.start, out);
    if (at > 0 && (!nearest || at < *nearest)) nearest = at;
  }
  return nearest;
}

/// How far the eaves reach out over a wall: half as high as the roof `behind` the wall, from `most` inward. None where
/// no roof is behind it.
auto reach_of_eaves(Point2 p, Point2 out, double most, double behind, const rays::Scene& mesh, double ground,
                    double least) -> std::optional<double> {
  constexpr double stride = 0.05;  // m; a fifth of the cells in which models are compared with the scan
  const auto roof = mesh.top(p - behind * out);
  if (!roof || *roof - ground < least) return std::nullopt;
  for (double x = most; x > 0; x -= stride)
    if (const auto z = mesh.top(p + x * out); z && *z - ground >= 0.5 * (*roof - ground)) return x;
  return 0.0;
}

}  // namespace

auto moved_under_eaves(std::vector<SweepEdge> edges, const block::Block& block, const Registration& registration,
                       const rays::Scene& mesh, const Options& o) -> std::vector<SweepEdge> {
  if (!(o.gis_offset > 0 && o.eaves_reach > o.gis_inward)) return edges;
  const auto footprints = edges_of_footprints(block, registration);
  const LineIndex index(footprints, 8);
  for (auto& edge : edges) {
    const Segment2 s = edge.segment;
    const Point2 d = normalised(s.end - s.start), out = geometry::left_of(d);
    std::vector<Segment2> beside;
    for (const auto k : index.near(geometry::Box2::of(s).grown(o.eaves_reach)))
      if (dot(normalised(footprints[k].end - footprints[k].start), d) >= o.footprint_cosine)
        beside.push_back(footprints[k]);
    if (beside.empty()) continue;
    const auto columns = static_cast<std::size_t>(length(s.end - s.start) / o.column_width);
    std::vector<Place> places;
    for (std::size_t i = 0; i < columns; ++i) {
      const Point2 p = s.start + (static_cast<double>(i) + 0.5) * o.column_width * d;
      const auto footprint = nearest_outside(p, d, beside);
      if (!footprint || *footprint <= o.gis_inward || *footprint > o.eaves_reach) continue;
      if (const auto eaves = reach_of_eaves(p, out, *footprint, o.gis_inward, mesh, block.ground, o.roof_height))
        places.push_back({*footprint, *eaves});
    }
    if (2 * places.size() <= columns) continue;  // eaves and a footprint's edge along most of the wall
    const auto median_of = [&](auto value) {
      std::vector<double> values;
      for (const auto& place : places) values.push_back(value(place));
      return base::median(std::move(values));
    };
    const double eaves = median_of([](const Place& place) { return place.eaves; });
    const double footprint = median_of([](const Place& place) { return place.footprint; });
    const double spread = median_of([&](const Place& place) { return std::abs(place.eaves - eaves); });
    if (spread > o.eaves_spread || footprint - eaves < o.gis_inward) continue;
    edge.segment = {s.start + eaves * out, s.end + eaves * out};
  }
  return edges;
}

}  // namespace mansard::sweep::detail
