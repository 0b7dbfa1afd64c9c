#include "mansard/segment/detail/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/base/statistics.hpp"
#include "mansard/segment/detail/origins.hpp"

namespace mansard::segment::detail {
namespace {

using geometry::Box2, geometry::Point2, geometry::Ring;

/// Points spread evenly over a face: a low-discrepancy sequence (Roberts' R2) over its bounding box, of which those
/// inside the face count. They depend on the face's shape and place alone, neither on its number nor on where its ring
/// begins or how it is triangulated, and move with its corners: else a face more anywhere in the block, or a corner
/// moved by a nanometre, would measure all of them anew (docs/decisions/0035). A face that is too thin to be hit gives
/// the middles of the triangles between its first corner and all others.
auto spread(const Ring& ring, double area, const Options& options) -> std::vector<Point2> {
  constexpr std::int64_t draws_per_sample = 256;  // of a strip of 0.3 m width in a box of 40 m by 40 m, half that hit
  constexpr double start_u = 0.3, start_v = 0.9;  // chosen among two: docs/decisions/0035
  const auto fewest_samples = static_cast<std::int64_t>(options.minimum_samples);
  const auto most = std::max(options.samples, fewest_samples);
  const auto wanted = static_cast<std::int64_t>(std::ceil(std::min(area, 1e6) * options.samples_per_area));
  const auto count = std::clamp(wanted, fewest_samples, most);
  const Box2 box = geometry::bounds(ring);
  const Point2 size = box.most - box.least;
  const geometry::Polygon face{ring, {}};
  std::vector<Point2> points;
  for (std::int64_t k = 0; k < draws_per_sample * count && std::ssize(points) < count; ++k) {
    const double u = std::fmod(start_u + 0.7548776662466927 * static_cast<double>(k), 1.0);
    const double v = std::fmod(start_v + 0.5698402909980532 * static_cast<double>(k), 1.0);
    const Point2 p = box.least + Point2{u * size.x, v * size.y};
    if (geometry::contains(face, p)) points.push_back(p);
  }
  if (points.empty())
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
      points.push_back((1.0 / 3) * (ring.front() + ring[i] + ring[i + 1]));
  return points;
}

/// Of the samples, how many must be clear of the rim to stand for a face, and how many of one that is all rim must be
/// roof: the others may be of what is beside it.
constexpr double enough = 0.25;

/// Three make a plane.
constexpr std::ptrdiff_t fewest_points = 3;

/// m: what the face is taken for, and what it reaches where the scan shows what is beside it, too.
struct Seen {
  double height = 0, reached = 0;
};
auto seen_on(const std::vector<double>& sorted, std::vector<double> clear, const Options& options) -> Seen {
  const double median = base::mean_median_of_sorted(sorted);
  if (options.rim == 0) return {median, median};
  if (static_cast<double>(clear.size()) < enough * static_cast<double>(sorted.size()))
    return {median, base::percentile_of_sorted(sorted, 1 - enough)};
  std::ranges::sort(clear);
  const double middle = base::mean_median_of_sorted(clear);
  return {middle, middle};
}

/// The measured points over a face, of a scan that consists of points.
auto points_over(const Ring& ring, const rays::Scene& mesh) -> std::vector<geometry::Point3> {
  auto points = mesh.points_in(geometry::bounds(ring));
  const geometry::Polygon face{ring, {}};
  std::erase_if(points, [&](geometry::Point3 p) { return !geometry::contains(face, xy(p)); });
  return points;
}

struct MemberBoxes {
  const block::Member* member;
  std::vector<Box2> boxes;  ///< of its polygons
};

auto is_in(const MemberBoxes& m, Point2 p) -> bool {
  for (std::size_t i = 0; i < m.boxes.size(); ++i)
    if (m.boxes[i].contains(p) && geometry::contains(m.member->polygons[i], p)) return true;
  return false;
}

/// Heights where the mesh has a hole over the footprints: the neighbour's across the longest edge that is no wall,
/// else across the longest; round by round, so that the order of faces does not matter.
void borrow_heights(const fracture::Arrangement& arrangement, const Options& options, std::vector<FaceEvidence>& faces,
                    std::vector<bool> known) {
  for (bool any = true; any;) {
    any = false;
    const std::vector<bool> before = known;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      if (before[f] || faces[f].gis_share < options.gis_ratio) continue;
      std::pair<bool, double> best{false, 0.0};  // not a wall, length
      for (const std::uint32_t h : half_edges_around(arrangement, f)) {
        const auto other = face_across(arrangement, h);
        if (other && before[*other] && faces[*other].gis_share >= options.gis_ratio) {
          const std::pair<bool, double> found{!on_sweep_edge(arrangement.half_edges[h]), length_of(arrangement, h)};
          if (found > best) best = found, faces[f].height = faces[*other].height, known[f] = any = true;
        }
      }
    }
  }
}

}  // namespace

auto measure(const fracture::Arrangement& arrangement, const block::Block& block, const rays::Scene& mesh,
             const Options& options) -> Evidence {
  std::vector<MemberBoxes> members;
  for (const block::Member& member : block.members) {
    members.push_back({&member, {}});
    for (const auto& polygon : member.polygons) members.back().boxes.push_back(geometry::bounds(polygon.outer));
  }
  const std::size_t count = arrangement.faces.size();
  Evidence evidence{std::vector<FaceEvidence>(count), std::vector<FaceSamples>(count),
                    std::vector<double>(count, block.ground)};
  std::vector<double>& ground = evidence.ground;
  std::vector<double> reached(count, 0);

  base::parallel_for(count, [&](std::size_t f) {
    FaceEvidence& face = evidence.faces[f];
    FaceSamples& samples = evidence.samples[f];
    const Ring ring = arrangement.ring(static_cast<std::uint32_t>(f));
    const Box2 box = geometry::bounds(ring);
    std::vector<std::size_t> near;
    for (std::size_t m = 0; m < members.size(); ++m)
      if (std::ranges::any_of(members[m].boxes, [&](const Box2& b) { return b.overlaps(box); })) near.push_back(m);

    const std::vector<Point2> points = spread(ring, arrangement.faces[f].area, options);
    std::vector<std::size_t> hits(near.size(), 0);
    std::size_t inside = 0;
    std::vector<double> clear;  // off the rim
    const auto take = [&](Point2 p, double z) {
      samples.heights.push_back(z);
      if (options.rim > 0 && geometry::boundary_distance({ring, {}}, p) >= options.rim) clear.push_back(z);
    };
    const auto measured = options.by_points ? points_over(ring, mesh) : std::vector<geometry::Point3>();
    // Fewer may all be of what is beside the face; between them nothing was measured.
    if (std::ssize(measured) >= fewest_points)
      for (const auto p : measured) take(xy(p), p.z);
    for (const Point2 p : points) {
      bool in = false;
      for (std::size_t i = 0; i < near.size(); ++i)
        if (is_in(members[near[i]], p)) ++hits[i], in = true;
      if (!options.by_points)
        if (const auto z = mesh.top(p)) take(p, *z);
      if (in) ++inside;
    }
    std::ranges::sort(samples.heights);
    const auto total = static_cast<double>(points.size());
    face.gis_share = static_cast<double>(inside) / total;
    face.seen = !samples.heights.empty();
    if (face.seen) {
      const auto [height, most_of_it] = seen_on(samples.heights, std::move(clear), options);
      face.height = height;
      reached[f] = face.gis_share > options.surely_inside ? most_of_it : height;
    }
    std::size_t most = 0;
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (hits[i] == 0) continue;
      const block::Member& member = *members[near[i]].member;
      samples.shares.emplace_back(member.feature, static_cast<double>(hits[i]) / total);
      if (hits[i] > most) most = hits[i], face.feature = member.feature, ground[f] = member.ground;
    }
  });

  std::vector<bool> known;
  for (std::size_t f = 0; f < count; ++f) {
    FaceEvidence& face = evidence.faces[f];
    known.push_back(face.seen);
    // Over a hole in the mesh with nothing around to borrow from, the least a building may have.
    if (!face.seen) face.height = ground[f] + options.min_height;
  }
  borrow_heights(arrangement, options, evidence.faces, std::move(known));
  for (std::size_t f = 0; f < count; ++f) {
    FaceEvidence& face = evidence.faces[f];
    face.inside = face.gis_share >= options.gis_ratio &&
                  (face.seen ? reached[f] - ground[f] >= options.min_height : face.gis_share > options.surely_inside);
  }
  return evidence;
}

void peel(const fracture::Arrangement& arrangement, const Options& options, std::vector<FaceEvidence>& faces) {
  const auto exposed_too_much = [&](std::uint32_t f) {
    double exposed = 0, safe = 0;
    for (const std::uint32_t h : half_edges_around(arrangement, f)) {
      const fracture::HalfEdge& edge = arrangement.half_edges[h];
      const auto other = face_across(arrangement, h);
      const bool open = (!other || !faces[*other].inside) && !on_sweep_edge(edge) && !on_gis_edge(edge);
      (open ? exposed : safe) += length_of(arrangement, h);
    }
    return exposed > options.exposed * safe;
  };
  // Taking a face off can only expose its neighbours more, so the order does not matter. Other than in the reference,
  // faces that the footprints hold to be inside are never taken: in meshes whose walls are missing nothing has walls.
  for (bool any = true; any;) {
    any = false;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      if (faces[f].inside && faces[f].gis_share < options.surely_inside && exposed_too_much(f))
        faces[f].inside = false, any = true;
  }
}

}  // namespace mansard::segment::detail
