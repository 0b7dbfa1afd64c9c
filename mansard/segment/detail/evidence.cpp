#include "mansard/segment/detail/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mansard/base/statistics.hpp"
#include "mansard/segment/detail/origins.hpp"

namespace mansard::segment::detail {
namespace {

using geometry::Box2, geometry::Point2, geometry::Ring;

/// Points spread evenly over a face: its triangles in turn, each as often as its area asks for, a low-discrepancy
/// pair of numbers (Roberts' R2 sequence) inside the triangle. A face that cannot be cut into triangles gives those of
/// its first corner with all others, and only the points that are inside; one of them where none is.
auto spread(const Ring& ring, double area, const Options& options, base::Random random) -> std::vector<Point2> {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (auto made = geometry::triangulate({ring, {}})) triangles = std::move(*made);
  const bool is_fan = triangles.empty();
  if (is_fan)
    for (std::uint32_t i = 1; i + 1 < ring.size(); ++i) triangles.push_back({0, i, i + 1});
  std::vector<double> up_to;
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    up_to.push_back(sum += std::abs(geometry::cross(ring[b] - ring[a], ring[c] - ring[a])) / 2);

  const auto fewest_samples = static_cast<std::int64_t>(options.minimum_samples);
  const auto most = std::max(options.samples, fewest_samples);
  const auto wanted = static_cast<std::int64_t>(std::ceil(std::min(area, 1e6) * options.samples_per_area));
  const auto count = std::clamp(wanted, fewest_samples, most);
  const double shift = random.uniform(), shift_u = random.uniform(), shift_v = random.uniform();
  std::vector<Point2> points;
  for (std::int64_t k = 0; k < count; ++k) {
    const double at = sum * (static_cast<double>(k) + shift) / static_cast<double>(count);
    const auto which = std::min<std::ptrdiff_t>(std::ranges::upper_bound(up_to, at) - up_to.begin(),
                                                static_cast<std::ptrdiff_t>(triangles.size()) - 1);
    const auto& [a, b, c] = triangles[static_cast<std::size_t>(which)];
    double u = std::fmod(shift_u + 0.7548776662466927 * static_cast<double>(k), 1.0);
    double v = std::fmod(shift_v + 0.5698402909980532 * static_cast<double>(k), 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points.push_back(ring[a] + u * (ring[b] - ring[a]) + v * (ring[c] - ring[a]));
  }
  if (is_fan) {
    const Point2 first = points.front();
    std::erase_if(points, [&](Point2 p) { return !geometry::contains(geometry::Polygon{ring, {}}, p); });
    if (points.empty()) points.push_back(first);
  }
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
             const Options& options, const base::Run& run) -> Evidence {
  std::vector<MemberBoxes> members;
  for (const block::Member& member : block.members) {
    members.push_back({&member, {}});
    for (const auto& polygon : member.polygons) members.back().boxes.push_back(geometry::bounds(polygon.outer));
  }
  const std::size_t count = arrangement.faces.size();
  Evidence evidence{std::vector<FaceEvidence>(count), std::vector<FaceSamples>(count),
                    std::vector<double>(count, block.ground)};
  std::vector<double>& ground = evidence.ground;

  base::parallel_for(count, [&](std::size_t f) {
    FaceEvidence& face = evidence.faces[f];
    FaceSamples& samples = evidence.samples[f];
    const Ring ring = arrangement.ring(static_cast<std::uint32_t>(f));
    const Box2 box = geometry::bounds(ring);
    std::vector<std::size_t> near;
    for (std::size_t m = 0; m < members.size(); ++m)
      if (std::ranges::any_of(members[m].boxes, [&](const Box2& b) { return b.overlaps(box); })) near.push_back(m);

    const std::vector<Point2> points = spread(ring, arrangement.faces[f].area, options, base::Random(run.seed, f));
    std::vector<std::size_t> hits(near.size(), 0);
    std::size_t inside = 0;
    std::vector<double> inside_heights;
    for (const Point2 p : points) {
      bool in = false;
      for (std::size_t i = 0; i < near.size(); ++i)
        if (is_in(members[near[i]], p)) ++hits[i], in = true;
      const auto z = mesh.top(p);
      if (z) samples.heights.push_back(*z);
      if (in) ++inside;
      if (in && z) inside_heights.push_back(*z);
    }
    // A face that reaches over the footprints is judged by the part under them: how much that is, gis_ratio asks.
    if (inside_heights.size() >= options.minimum_inside_samples) samples.heights = std::move(inside_heights);
    std::ranges::sort(samples.heights);
    const auto total = static_cast<double>(points.size());
    face.gis_share = static_cast<double>(inside) / total;
    face.seen = !samples.heights.empty();
    if (face.seen) face.height = base::mean_median_of_sorted(samples.heights);
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
                  (face.seen ? face.height - ground[f] >= options.min_height : face.gis_share > options.surely_inside);
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
