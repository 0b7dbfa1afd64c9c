#include "mansard/block/detail/ground.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/run.hpp"
#include "mansard/base/statistics.hpp"
#include "mansard/block/detail/near.hpp"
#include "mansard/block/detail/neighbours.hpp"
#include "mansard/geometry/mesh_part.hpp"

namespace mansard::block::detail {
namespace {

using geometry::Box2;
using geometry::Point2;
using geometry::Point3;
using geometry::Polygon;

using Triangle3 = std::array<Point3, 3>;

/// Twice as many halvings as take a side of a thousand kilometres down to a metre: against endless recursion only.
constexpr int most_halvings = 40;

auto plan(const Triangle3& t) -> PlanTriangle { return {xy(t[0]), xy(t[1]), xy(t[2])}; }

/// Cuts a triangle at the middle of its longest side until its pieces are small, leaving out what the box does not
/// meet.
template <class Take>
void cut_up(const Triangle3& t, const Box2& within, double piece_size, int depth, const Take& take) {
  if (!Box2::of(plan(t)).overlaps(within)) return;
  std::size_t longest = 0;
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (const Point2 side = xy(t[(k + 1) % 3]) - xy(t[k]); dot(side, side) > most) {
      most = dot(side, side);
      longest = k;
    }
  if (most <= piece_size * piece_size || depth == 0) return take(t);
  const Point3 a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
  const Point3 middle = 0.5 * (a + b);
  cut_up({a, middle, c}, within, piece_size, depth - 1, take);
  cut_up({middle, b, c}, within, piece_size, depth - 1, take);
}

/// Which of the shapes that come near a region are near a point: what is above their eaves is roof.
struct Obstacles {
  double overhang = 0;
  std::vector<const Polygon*> polygons;
  std::vector<Box2> boxes;

  void add(const std::vector<Polygon>& shape) {
    for (const auto& polygon : shape) {
      polygons.push_back(&polygon);
      boxes.push_back(geometry::bounds(polygon.outer).grown(overhang));
    }
  }
  [[nodiscard]] auto hold(Point2 p) const -> bool {
    for (std::size_t i = 0; i < polygons.size(); ++i)
      if (boxes[i].contains(p) && geometry::contains(*polygons[i], p)) return true;
    return false;
  }
  [[nodiscard]] auto are_near(Point2 p) const -> bool {
    for (std::size_t i = 0; i < polygons.size(); ++i)
      if (boxes[i].contains(p) && geometry::boundary_distance(*polygons[i], p) < overhang) return true;
    return false;
  }
};

auto is_steep(Point3 normal, const Options& options) -> bool {
  // Upside down is as good: orientation is not to be relied on.
  return normal.z * normal.z < options.ground_cosine * options.ground_cosine * dot(normal, normal);
}

template <class Take>
void each_sample(const geometry::Mesh& mesh, const Take& take) {
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const Point3 centre = (1.0 / 3) * (a + b + c), normal = cross(b - a, c - a);
    // The lowest corner: a wall in one piece from eaves to street says where the street is.
    take(Sample{xy(centre), std::min({a.z, b.z, c.z}), length(normal) / 2}, normal);
  }
}

}  // namespace

auto percentile(std::vector<Sample> samples, double share, double least) -> std::optional<double> {
  std::ranges::sort(samples, [](const Sample& p, const Sample& q) {
    return p.z != q.z ? p.z < q.z : std::tuple(p.at, p.weight) < std::tuple(q.at, q.weight);
  });
  double all = 0;
  for (const auto& sample : samples) all += sample.weight;
  if (samples.empty() || !(all >= least)) return std::nullopt;
  return base::weighted_percentile_of_sorted(samples, share, &Sample::z, &Sample::weight);
}

auto ground_samples(const geometry::Mesh& mesh, const std::vector<std::vector<Polygon>>& shapes, std::size_t count,
                    const Options& options) -> std::vector<std::vector<Sample>> {
  const double reach = options.ground_ring;
  std::vector<Box2> boxes;
  for (const auto& shape : shapes) boxes.push_back(geometry::bounds(shape).grown(reach));
  const auto triangles =
      geometry::triangles_near(mesh, std::vector(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(count)));

  // Shapes sorted by x, so that those near a region are found without looking at all.
  std::vector<std::size_t> order(shapes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(boxes[i].least.x, i); });
  double widest = 0;
  for (const auto& box : boxes) widest = std::max(widest, box.empty() ? 0 : box.most.x - box.least.x);

  std::vector<std::vector<Sample>> out(count);
  base::parallel_for(count, [&](std::size_t i) {
    if (boxes[i].empty()) return;
    Obstacles obstacles{options.overhang, {}, {}};
    auto at =
        std::ranges::lower_bound(order, boxes[i].least.x - widest, {}, [&](std::size_t j) { return boxes[j].least.x; });
    for (; at != order.end() && boxes[*at].least.x <= boxes[i].most.x; ++at)
      if (boxes[*at].overlaps(boxes[i])) obstacles.add(shapes[*at]);
    const Nearness near(shapes[i], reach);
    std::vector<Sample> beside;  // may be of eaves
    double clear = 0;            // m² of the others
    for (const std::uint32_t index : triangles[i]) {
      const auto& t = mesh.triangles[index];
      const Triangle3 corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
      if (is_steep(cross(corners[1] - corners[0], corners[2] - corners[0]), options)) continue;
      cut_up(corners, boxes[i], options.ground_piece, most_halvings, [&](const Triangle3& piece) {
        const Point3 centre = (1.0 / 3) * (piece[0] + piece[1] + piece[2]);
        if (!near(xy(centre)) || obstacles.hold(xy(centre))) return;
        const double area = std::abs(cross(xy(piece[1]) - xy(piece[0]), xy(piece[2]) - xy(piece[0]))) / 2;
        if (obstacles.are_near(xy(centre))) {
          beside.push_back({xy(centre), centre.z, area});
        } else {
          out[i].push_back({xy(centre), centre.z, area});
          clear += area;
        }
      });
    }
    if (clear >= options.ground_area) out[i].insert(out[i].end(), beside.begin(), beside.end());
  });
  return out;
}

auto surface_samples(const geometry::Mesh& mesh) -> std::vector<Sample> {
  std::vector<Sample> out;
  out.reserve(mesh.triangles.size());
  each_sample(mesh, [&](const Sample& sample, Point3) { out.push_back(sample); });
  return out;
}

auto beside_samples(const geometry::Mesh& mesh, const std::vector<std::vector<Polygon>>& shapes,
                    const std::vector<Polygon>& outline, const Options& options) -> std::vector<Sample> {
  Obstacles obstacles{options.overhang, {}, {}};
  for (const auto& shape : shapes) obstacles.add(shape);
  const auto on_outline = [&](Point2 p) {
    return std::ranges::any_of(
        outline, [&](const Polygon& polygon) { return geometry::boundary_distance(polygon, p) < options.overhang; });
  };
  std::vector<Sample> out;
  each_sample(mesh, [&](const Sample& sample, Point3 normal) {
    const bool off = !obstacles.hold(sample.at) && !obstacles.are_near(sample.at);
    if (off || (is_steep(normal, options) && on_outline(sample.at))) out.push_back(sample);
  });
  return out;
}

}  // namespace mansard::block::detail
