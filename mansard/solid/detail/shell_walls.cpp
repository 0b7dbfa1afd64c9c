#include "mansard/solid/detail/shell_walls.hpp"

#include <map>
#include <numbers>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/geometry/angles.hpp"
#include "mansard/geometry/polygon.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // from, to

/// A wall in plan, with the heights between which it stands.
struct Wall {
  std::uint32_t face = 0, solid = 0;
  Point2 out;    ///< unit
  Point2 along;  ///< unit, out turned to the left: the inside is on its left
  Point2 start;
  double length = 0, low = 0, high = 0;
  geometry::Box2 box;
};

auto wall_of(const std::vector<Point3>& points, const SurfaceFace& face, std::uint32_t number) -> Wall {
  Wall wall{number, face.solid, geometry::normalised(geometry::xy(face.normal)), {}, {}, 0, 0, 0, {}};
  wall.along = geometry::left_of(wall.out);
  const Point3 first = points[face.loops.front().front()];
  wall.low = wall.high = first.z;
  double least = 0, most = 0;
  for (const std::uint32_t corner : face.loops.front()) {
    const Point3 p = points[corner];
    const double s = dot(geometry::xy(p) - geometry::xy(first), wall.along);
    least = std::min(least, s), most = std::max(most, s);
    wall.low = std::min(wall.low, p.z), wall.high = std::max(wall.high, p.z);
    wall.box.add(geometry::xy(p));
  }
  wall.start = geometry::xy(first) + least * wall.along;
  wall.length = most - least;
  return wall;
}

auto face_each_other(const Wall& a, const Wall& b, double tolerance) -> bool {
  if (a.solid == b.solid || dot(a.out, b.out) > -0.999) return false;
  if (std::min(a.high, b.high) - std::max(a.low, b.low) <= tolerance) return false;
  const Point2 b_end = b.start + b.length * b.along;
  const double from = dot(b_end - a.start, a.along), to = dot(b.start - a.start, a.along);
  const double low = std::max(0.0, from), high = std::min(a.length, to);
  if (high - low <= tolerance) return false;
  const auto gap = [&](double s) {
    const double share = (s - from) / (to - from);
    return std::abs(dot(b_end + share * (b.start - b_end) - a.start, a.out));
  };
  return gap(low) <= tolerance && gap(high) <= tolerance;
}

/// Directed edges in a plane, each with the region on its left.
class Remainder {
 public:
  Remainder(const Surface& surface, const std::vector<std::uint32_t>& group) : points_(surface.points) {
    double longest = -1;
    for (const std::uint32_t f : group) {
      const Wall wall = wall_of(points_, surface.faces[f], f);
      if (wall.length > longest) longest = wall.length, along_ = wall.along, out_ = wall.out;
    }
    std::map<Edge, int> count;
    for (const std::uint32_t f : group)
      for (const auto& loop : surface.faces[f].loops)
        for (std::size_t i = 0; i < loop.size(); ++i) ++count[{loop[i], loop[(i + 1) % loop.size()]}];
    for (const auto& [edge, n] : count) {
      const auto back = count.find({edge.second, edge.first});
      const int net = n - (back == count.end() ? 0 : back->second);
      sound_ = sound_ && net <= 1;
      if (net > 0) edges_.push_back(edge);
    }
  }

  /// Faces that look along out(), then those that look the other way.
  auto faces(std::vector<SurfaceFace>& result) -> bool {
    std::vector<Edge> towards, away;
    for (const Edge& edge : edges_) {
      const int left = on_the_left(edge);
      if (left == 1) towards.push_back(edge);
      else if (left == 0) away.push_back(edge);
      else return false;
    }
    return sound_ && trace(towards, 1, result) && trace(away, -1, result);
  }

 private:
  [[nodiscard]] auto flat(std::uint32_t p) const -> Point2 {
    return {side_ * dot(geometry::xy(points_[p]), along_), points_[p].z};
  }

  /// How often the walls, those that look away counted off, cover what lies left of the edge's middle: a winding
  /// number.
  [[nodiscard]] auto on_the_left(const Edge& edge) const -> int {
    const Point2 middle = 0.5 * (flat(edge.first) + flat(edge.second));
    double turns = 0.5;  // by the edge itself
    for (const Edge& other : edges_) {
      if (other == edge) continue;
      const Point2 a = flat(other.first) - middle, b = flat(other.second) - middle;
      turns += geometry::arc_tangent(cross(a, b), dot(a, b)) / (2 * std::numbers::pi);
    }
    return static_cast<int>(std::lround(turns));
  }

  auto trace(const std::vector<Edge>& edges, double side, std::vector<SurfaceFace>& result) -> bool {
    side_ = side;
    std::map<std::uint32_t, std::vector<std::uint32_t>> leaving;
    for (const auto& [from, to] : edges) leaving[from].push_back(to);
    std::vector<Loop> outer, holes;
    for (auto& [start, ways] : leaving)
      while (!ways.empty()) {
        const auto loops = walk(start, leaving);
        if (loops.empty()) return false;
        for (const Loop& loop : loops) (area(loop) > 0 ? outer : holes).push_back(loop);
      }
    return put_together(outer, holes, result);
  }

  /// From a point back to it, always as far left as can be; a loop of its own wherever that comes to a point again.
  auto walk(std::uint32_t start, std::map<std::uint32_t, std::vector<std::uint32_t>>& leaving) -> std::vector<Loop> {
    std::vector<Loop> loops;
    Loop way{start};
    do {
      const auto found = leaving.find(way.back());
      if (found == leaving.end() || found->second.empty()) return {};
      auto& ways = found->second;
      const auto next = way.size() < 2 ? ways.begin() : leftmost(way[way.size() - 2], way.back(), ways);
      const std::uint32_t to = *next;
      ways.erase(next);
      const auto before = std::ranges::find(way, to);
      if (before == way.end()) {
        way.push_back(to);
        continue;
      }
      loops.emplace_back(before, way.end());
      way.erase(before + 1, way.end());
    } while (way.size() > 1);
    return loops;
  }

  auto leftmost(std::uint32_t from, std::uint32_t at, std::vector<std::uint32_t>& ways) const
      -> std::vector<std::uint32_t>::iterator {
    const Point2 back = flat(from) - flat(at);
    const auto turn = [&](std::uint32_t to) {  // clockwise from where we came
      const Point2 on = flat(to) - flat(at);
      const double angle = -geometry::arc_tangent(cross(back, on), dot(back, on));
      return angle <= 0 ? angle + 2 * std::numbers::pi : angle;
    };
    return std::ranges::min_element(ways, {}, turn);
  }

  [[nodiscard]] auto ring(const Loop& loop) const -> geometry::Ring {
    geometry::Ring ring;
    for (const std::uint32_t p : loop) ring.push_back(flat(p));
    return ring;
  }
  [[nodiscard]] auto area(const Loop& loop) const -> double { return geometry::signed_area(ring(loop)); }

  auto put_together(const std::vector<Loop>& outer, const std::vector<Loop>& holes, std::vector<SurfaceFace>& result)
      -> bool {
    const std::size_t first = result.size();
    std::vector<geometry::Ring> rings;
    for (const Loop& loop : outer) {
      result.push_back({{loop}, {side_ * out_.x, side_ * out_.y, 0}, 0});
      rings.push_back(ring(loop));
    }
    for (const Loop& hole : holes) {
      std::size_t owner = outer.size();
      for (std::size_t i = 0; i < outer.size(); ++i)
        if (holds(rings[i], outer[i], hole) && (owner == outer.size() || area(outer[i]) < area(outer[owner])))
          owner = i;
      if (owner == outer.size()) return false;
      result[first + owner].loops.push_back(hole);
    }
    return true;
  }

  /// By a corner that the two do not share.
  [[nodiscard]] auto holds(const geometry::Ring& ring, const Loop& outer, const Loop& hole) const -> bool {
    for (const std::uint32_t p : hole)
      if (std::ranges::find(outer, p) == outer.end()) return geometry::contains(ring, flat(p));
    return true;
  }

  const std::vector<Point3>& points_;
  Point2 along_, out_;
  double side_ = 1;
  std::vector<Edge> edges_;
  bool sound_ = true;
};

}  // namespace

auto facing_walls(const std::vector<SurfaceFace>& faces, const std::vector<Point3>& points, double tolerance)
    -> std::vector<std::pair<std::uint32_t, std::uint32_t>> {
  constexpr double upright = 1e-3;  // rad
  std::vector<Wall> walls;
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    if (std::abs(faces[f].normal.z) < upright) walls.push_back(wall_of(points, faces[f], f));
  std::ranges::sort(walls, {}, [](const Wall& w) { return std::pair(w.box.least.x, w.face); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto box = walls[i].box.grown(tolerance);
    for (std::size_t k = i + 1; k < walls.size() && walls[k].box.least.x <= box.most.x; ++k)
      if (box.overlaps(walls[k].box) && face_each_other(walls[i], walls[k], tolerance))
        pairs.push_back(std::minmax(walls[i].face, walls[k].face));
  }
  std::ranges::sort(pairs);
  return pairs;
}

auto without_facing_walls(Surface& surface, double tolerance) -> bool {
  base::DisjointSets sets(surface.faces.size());
  std::vector<std::uint8_t> faces_another(surface.faces.size(), 0);
  for (const auto& [a, b] : facing_walls(surface.faces, surface.points, tolerance)) {
    sets.join(a, b);
    faces_another[a] = faces_another[b] = 1;
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  std::vector<SurfaceFace> kept;
  for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
    if (faces_another[f] != 0) groups[sets.of(f)].push_back(f);
    else kept.push_back(surface.faces[f]);
  }
  for (const auto& [name, group] : groups)
    if (!Remainder(surface, group).faces(kept)) return false;
  surface.faces = std::move(kept);
  return true;
}

}  // namespace mansard::solid::detail
