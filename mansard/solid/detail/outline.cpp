#include "mansard/solid/detail/outline.hpp"
#include "mansard/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace mansard::solid::detail {
namespace {

using geometry::Point2;

class Tracing {
 public:
  Tracing(const std::set<Edge>& edges, const Flat& flat) : flat_(flat) {
    for (const auto& [from, to] : edges) leaving_[from].push_back(to);
  }

  auto loops() -> std::optional<std::vector<Path>> {
    std::vector<Path> all;
    for (auto& [start, ways] : leaving_)
      while (!ways.empty()) {
        const auto some = walk(start);
        if (some.empty()) return std::nullopt;
        all.insert(all.end(), some.begin(), some.end());
      }
    return all;
  }

 private:
  /// From a node back to it, always as far left as can be; a loop of its own wherever that comes to a node again.
  auto walk(const Node& start) -> std::vector<Path> {
    std::vector<Path> loops;
    Path way{start};
    do {
      auto& ways = leaving_[way.back()];
      if (ways.empty()) return {};
      const auto next = way.size() < 2 ? ways.begin() : leftmost(way[way.size() - 2], way.back(), ways);
      const Node to = *next;
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

  auto leftmost(const Node& from, const Node& at, std::vector<Node>& ways) const -> std::vector<Node>::iterator {
    if (ways.size() == 1) return ways.begin();
    const Point2 back = flat_(from) - flat_(at);
    const auto turn = [&](const Node& to) {  // clockwise from where we came
      const Point2 on = flat_(to) - flat_(at);
      const double angle = -std::atan2(cross(back, on), dot(back, on));
      return angle <= 0 ? angle + 2 * std::numbers::pi : angle;
    };
    return std::ranges::min_element(ways, {}, turn);
  }

  std::map<Node, std::vector<Node>> leaving_;
  const Flat& flat_;
};

auto ring_of(const Path& path, const Flat& flat) -> geometry::Ring {
  geometry::Ring ring;
  for (const Node& node : path) ring.push_back(flat(node));
  return ring;
}

}  // namespace

auto united_faces(const std::vector<Path>& polygons, const Flat& flat)
    -> std::optional<std::vector<std::vector<Path>>> {
  std::map<Edge, int> count;
  for (const Path& path : polygons)
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Edge edge{path[i], path[(i + 1) % path.size()]};
      if (const auto back = count.find({edge.second, edge.first}); back != count.end() && back->second > 0)
        --back->second;
      else ++count[edge];
    }
  std::set<Edge> edges;
  for (const auto& [edge, n] : count) {
    if (n > 1) return std::nullopt;
    if (n == 1) edges.insert(edge);
  }
  const auto loops = Tracing(edges, flat).loops();
  if (!loops) return std::nullopt;
  struct Outer {
    geometry::Ring ring;
    double area;
  };
  std::vector<std::vector<Path>> faces;
  std::vector<Outer> outers;
  std::vector<const Path*> holes;
  for (const Path& loop : *loops) {
    if (loop.size() < 3) continue;
    auto ring = ring_of(loop, flat);
    const double area = geometry::signed_area(ring);
    if (area > 0) faces.push_back({loop}), outers.push_back({std::move(ring), area});
    else holes.push_back(&loop);
  }
  for (const Path* hole : holes) {
    std::size_t owner = faces.size();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const auto own = std::ranges::find_if(
          *hole, [&](const Node& n) { return std::ranges::find(faces[i][0], n) == faces[i][0].end(); });
      if (own == hole->end() || !geometry::contains(outers[i].ring, flat(*own))) continue;
      if (owner == faces.size() || outers[i].area < outers[owner].area) owner = i;
    }
    if (owner == faces.size()) return std::nullopt;
    faces[owner].push_back(*hole);
  }
  return faces;
}

auto simple_loops(const Path& path) -> std::vector<Path> {
  std::vector<Path> loops;
  Path way;
  for (const Node& node : path) {
    const auto before = std::ranges::find(way, node);
    if (before == way.end()) {
      way.push_back(node);
      continue;
    }
    if (way.end() - before > 2) loops.emplace_back(before, way.end());
    way.erase(before + 1, way.end());
  }
  if (way.size() > 2) loops.push_back(std::move(way));
  return loops;
}

}  // namespace mansard::solid::detail
