#include "mansard/solid/detail/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "mansard/base/disjoint_sets.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point3;

/// A face whose normal is nearer to level than this is a wall: over ten metres it leans by 0.1 mm.
constexpr double upright = 1e-5;

auto ordered(std::uint32_t a, std::uint32_t b) -> Step { return {std::min(a, b), std::max(a, b)}; }

/// How many times as far from the ground as what becomes one with it a roof is that must not touch it.
constexpr std::int64_t clear_of_ground = 3;

struct Cut {
  double t = 0;  ///< 0 … 1 from the lower number of the step
  std::uint32_t at = 0;
  friend auto operator<=>(const Cut&, const Cut&) = default;
};

/// Rounds of merging and breaking until nothing is left to do.
class Conforming {
 public:
  explicit Conforming(Sheets& sheets) : s_(sheets), near_(sheets.near) {
    level_bases();
    bases_ = s_.base;
    std::ranges::sort(bases_);
  }

  auto run() -> bool {
    constexpr int most_rounds = 40;
    // Where edges run back and forth over each other, each round could double them.
    const std::size_t most_nodes = 16 * nodes() + 4096;
    for (int round = 0; round < most_rounds && nodes() <= most_nodes; ++round) {
      merge();
      if (at_points() || at_corners_of_roofs() || lift_roofs() || at_crossings() || at_inversions()) continue;
      return true;
    }
    return false;
  }

 private:
  [[nodiscard]] auto place(std::uint32_t p) const -> const Place& { return s_.places[p]; }
  [[nodiscard]] auto apart2(std::uint32_t p, std::uint32_t q) const -> std::int64_t {
    const std::int64_t dx = place(p)[0] - place(q)[0], dy = place(p)[1] - place(q)[1];
    return dx * dx + dy * dy;
  }

  template <class Work>
  void each_node(Work work) {
    for (Sheet& sheet : s_.sheets)
      for (Path& path : sheet.paths)
        for (Node& node : path) work(node, sheet);
  }

  [[nodiscard]] auto nodes() const -> std::size_t {
    std::size_t count = 0;
    for (const Sheet& sheet : s_.sheets)
      for (const Path& path : sheet.paths) count += path.size();
    return count;
  }

  /// Ground floors at nearly one height come to be at the lowest of them.
  void level_bases() {
    std::vector<std::uint32_t> order(s_.base.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(s_.base[i], i); });
    std::vector<std::int64_t> to = s_.base;
    for (std::size_t i = 1; i < order.size(); ++i)
      if (s_.base[order[i]] - s_.base[order[i - 1]] < near_) to[order[i]] = to[order[i - 1]];
    each_node([&](Node& node, const Sheet& sheet) {
      if (node.z == s_.base[sheet.solid]) node.z = to[sheet.solid];
    });
    s_.base = to;
  }

  /// Nodes near each other in space share their point of the plan, and nodes near each other above it their height.
  void merge() {
    for (bool again = true; again;) {
      again = false;
      std::vector<Node> nodes;
      std::vector<std::uint8_t> on_ground(s_.places.size(), 0);
      each_node([&](const Node& node, const Sheet& sheet) {
        nodes.push_back(node);
        if (sheet.facing == Facing::down) on_ground[node.at] = 1;
      });
      std::ranges::sort(nodes);
      nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
      std::ranges::sort(nodes, {}, [&](const Node& n) { return std::pair(place(n.at), n); });
      base::DisjointSets sets(s_.places.size());
      for (std::size_t i = 0; i < nodes.size(); ++i)
        for (std::size_t k = i; k-- > 0 && place(nodes[i].at)[0] - place(nodes[k].at)[0] < near_;) {
          if (nodes[i].at == nodes[k].at) continue;
          const std::int64_t dz = nodes[i].z - nodes[k].z, d2 = apart2(nodes[i].at, nodes[k].at);
          if (d2 == 0 || d2 + dz * dz < near_ * near_) {
            again = again || sets.of(nodes[i].at) != sets.of(nodes[k].at);
            sets.join(nodes[i].at, nodes[k].at);
          }
        }
      // Corners of the ground stay where they are.
      std::vector<std::uint32_t> chosen(s_.places.size());
      std::iota(chosen.begin(), chosen.end(), 0U);
      for (std::uint32_t p = 0; p < chosen.size(); ++p)
        if (auto& at = chosen[sets.of(p)]; on_ground[p] > on_ground[at]) at = p;
      if (again) each_node([&](Node& node, const Sheet&) { node.at = chosen[sets.of(node.at)]; });
      flatten_upright();
      level();
      tidy();
    }
  }

  /// Where merging made an edge of a steep roof upright, its ends come to be one: cut into triangles, the roof could
  /// otherwise lie in the wall below it.
  void flatten_upright() {
    constexpr std::int64_t steepest = 57;  // a roof of 89° rises so many times as far as it goes
    std::map<Node, std::int64_t> to;
    for (const Sheet& sheet : s_.sheets) {
      if (sheet.facing != Facing::up) continue;
      for (const Path& path : sheet.paths)
        for (std::size_t i = 0; i < path.size(); ++i) {
          const Node &a = path[i], &b = path[(i + 1) % path.size()];
          if (a.at == b.at && a.z != b.z && std::abs(a.z - b.z) < steepest * model::least_apart)
            to[std::max(a, b)] = std::min(a, b).z;
        }
    }
    set_heights(to);
  }

  void set_heights(const std::map<Node, std::int64_t>& to) {
    if (to.empty()) return;
    each_node([&](Node& node, const Sheet&) {
      if (const auto found = to.find(node); found != to.end()) node.z = found->second;
    });
  }

  void level() {
    std::map<std::uint32_t, std::map<std::int64_t, int>> uses;
    each_node([&](const Node& node, const Sheet&) { ++uses[node.at][node.z]; });
    std::map<Node, std::int64_t> to;
    for (const auto& [at, heights] : uses) {
      auto first = heights.begin();
      while (first != heights.end()) {
        auto last = std::next(first);
        while (last != heights.end() && last->first - std::prev(last)->first < near_) ++last;
        if (std::next(first) != last) {
          auto most = first;
          for (auto h = first; h != last; ++h)
            if (std::pair(is_base(h->first), h->second) > std::pair(is_base(most->first), most->second)) most = h;
          for (auto h = first; h != last; ++h) to[{at, h->first}] = most->first;
        }
        first = last;
      }
    }
    set_heights(to);
  }

  [[nodiscard]] auto is_base(std::int64_t z) const -> bool { return std::ranges::binary_search(bases_, z); }

  void tidy() {
    for (Sheet& sheet : s_.sheets) {
      for (Path& path : sheet.paths) {
        path.erase(std::ranges::unique(path).begin(), path.end());
        while (path.size() > 1 && path.front() == path.back()) path.pop_back();
      }
      if (sheet.paths.front().size() < 3) sheet.paths.clear();
      std::erase_if(sheet.paths, [](const Path& path) { return path.size() < 3; });
    }
    std::erase_if(s_.sheets, [](const Sheet& sheet) { return sheet.paths.empty(); });
  }

  /// A roof that comes down to the ground beside another solid gets a wall of its own there, higher than what becomes
  /// one: in one solid with the other, its edge would lie inside the ground.
  auto lift_roofs() -> bool {
    constexpr std::uint32_t nobody = UINT32_MAX, several = UINT32_MAX - 1;
    std::vector<std::uint32_t> user(s_.places.size(), nobody);
    each_node([&](const Node& node, const Sheet& sheet) {
      if (user[node.at] == nobody) user[node.at] = sheet.solid;
      else if (user[node.at] != sheet.solid) user[node.at] = several;
    });
    bool lifted = false;
    for (Sheet& sheet : s_.sheets) {
      if (sheet.facing != Facing::up) continue;
      for (Path& path : sheet.paths)
        for (Node& node : path)
          if (node.z == s_.base[sheet.solid] && user[node.at] == several)
            node.z += clear_of_ground * near_, lifted = true;
    }
    return lifted;
  }

  /// Steps of walls, and of the ground where a roof begins without one, and the points at their ends.
  void gather() {
    std::set<Step> steps;
    std::set<std::uint32_t> points;
    for (const Sheet& sheet : s_.sheets) {
      if (sheet.facing == Facing::up) continue;
      for (const Path& path : sheet.paths)
        for (std::size_t i = 0; i < path.size(); ++i) {
          const Node &a = path[i], &b = path[(i + 1) % path.size()];
          points.insert(a.at);
          if (a.at != b.at) steps.insert(ordered(a.at, b.at));
        }
    }
    steps_.assign(steps.begin(), steps.end());
    points_.assign(points.begin(), points.end());
    std::ranges::sort(points_, {}, [&](std::uint32_t p) { return std::pair(place(p), p); });
    cuts_.clear();
  }

  auto at_points() -> bool {
    gather();
    for (const Step& step : steps_) {
      const Place &a = place(step.first), &b = place(step.second);
      const double dx = static_cast<double>(b[0] - a[0]), dy = static_cast<double>(b[1] - a[1]);
      const double length2 = dx * dx + dy * dy;
      const std::int64_t least = std::min(a[0], b[0]) - near_, most = std::max(a[0], b[0]) + near_;
      const std::int64_t low = std::min(a[1], b[1]) - near_, high = std::max(a[1], b[1]) + near_;
      auto p = std::ranges::lower_bound(points_, least, {}, [&](std::uint32_t i) { return place(i)[0]; });
      for (; p != points_.end() && place(*p)[0] <= most; ++p) {
        if (*p == step.first || *p == step.second || place(*p)[1] < low || place(*p)[1] > high) continue;
        const double px = static_cast<double>(place(*p)[0] - a[0]), py = static_cast<double>(place(*p)[1] - a[1]);
        const double t = (px * dx + py * dy) / length2, off = px * dy - py * dx;
        if (t > 0 && t < 1 && off * off < length2 * static_cast<double>(near_ * near_)) cuts_[step].push_back({t, *p});
      }
    }
    return apply();
  }

  /// Edges of roofs that come near a corner of a roof in space: else a roof whose edge runs back along another one, a
  /// hair beside it, would cross itself by rounding.
  auto at_corners_of_roofs() -> bool {
    cuts_.clear();
    std::set<std::pair<Node, Node>> edges;
    std::set<Node> corners;
    for (const Sheet& sheet : s_.sheets) {
      if (sheet.facing != Facing::up) continue;
      for (const Path& path : sheet.paths)
        for (std::size_t i = 0; i < path.size(); ++i) {
          const Node &a = path[i], &b = path[(i + 1) % path.size()];
          corners.insert(a);
          if (a.at != b.at) edges.insert(std::minmax(a, b));
        }
    }
    std::vector<Node> by_place(corners.begin(), corners.end());
    std::ranges::sort(by_place, {}, [&](const Node& n) { return std::pair(place(n.at), n); });
    const auto difference = [&](const Node& from, const Node& to) {
      return Point3{static_cast<double>(place(to.at)[0] - place(from.at)[0]),
                    static_cast<double>(place(to.at)[1] - place(from.at)[1]), static_cast<double>(to.z - from.z)};
    };
    for (const auto& [a, b] : edges) {
      const Point3 along = difference(a, b);
      const std::int64_t least = std::min(place(a.at)[0], place(b.at)[0]) - near_,
                         most = std::max(place(a.at)[0], place(b.at)[0]) + near_;
      auto n = std::ranges::lower_bound(by_place, least, {}, [&](const Node& node) { return place(node.at)[0]; });
      for (; n != by_place.end() && place(n->at)[0] <= most; ++n) {
        if (n->at == a.at || n->at == b.at) continue;
        const Point3 to = difference(a, *n);
        const double t = dot(to, along) / dot(along, along);
        if (t > 0 && t < 1 && length(to - t * along) < static_cast<double>(near_))
          cuts_[ordered(a.at, b.at)].push_back({a.at < b.at ? t : 1 - t, n->at});
      }
    }
    return apply();
  }

  /// Where a and b, and c and d, are on different sides of each other's line.
  [[nodiscard]] auto side(std::uint32_t a, std::uint32_t b, std::uint32_t p) const -> int {
    const std::int64_t area = (place(b)[0] - place(a)[0]) * (place(p)[1] - place(a)[1]) -
                              (place(b)[1] - place(a)[1]) * (place(p)[0] - place(a)[0]);
    return (area > 0) - (area < 0);
  }

  auto point_at(double x, double y) -> std::uint32_t {
    const Place where{std::llround(x), std::llround(y)};
    if (numbers_.size() != s_.places.size())
      for (std::uint32_t p = 0; p < s_.places.size(); ++p) numbers_.try_emplace(s_.places[p], p);
    const auto [entry, added] = numbers_.try_emplace(where, static_cast<std::uint32_t>(s_.places.size()));
    if (added) s_.places.push_back(where);
    return entry->second;
  }

  auto at_crossings() -> bool {
    gather();
    const auto least_x = [&](const Step& e) { return std::min(place(e.first)[0], place(e.second)[0]); };
    const auto most_x = [&](const Step& e) { return std::max(place(e.first)[0], place(e.second)[0]); };
    std::ranges::sort(steps_, {}, [&](const Step& e) { return std::pair(least_x(e), e); });
    for (std::size_t i = 0; i < steps_.size(); ++i)
      for (std::size_t k = i + 1; k < steps_.size() && least_x(steps_[k]) <= most_x(steps_[i]); ++k) {
        const auto [a, b] = steps_[i];
        const auto [c, d] = steps_[k];
        if (std::max(place(a)[1], place(b)[1]) < std::min(place(c)[1], place(d)[1]) ||
            std::max(place(c)[1], place(d)[1]) < std::min(place(a)[1], place(b)[1]))
          continue;
        if (a == c || a == d || b == c || b == d) continue;
        if (side(a, b, c) * side(a, b, d) >= 0 || side(c, d, a) * side(c, d, b) >= 0) continue;
        const double ux = static_cast<double>(place(b)[0] - place(a)[0]);
        const double uy = static_cast<double>(place(b)[1] - place(a)[1]);
        const double vx = static_cast<double>(place(d)[0] - place(c)[0]);
        const double vy = static_cast<double>(place(d)[1] - place(c)[1]);
        const double wx = static_cast<double>(place(c)[0] - place(a)[0]);
        const double wy = static_cast<double>(place(c)[1] - place(a)[1]);
        const double divisor = ux * vy - uy * vx;
        const double t = (wx * vy - wy * vx) / divisor, u = (wx * uy - wy * ux) / divisor;
        const std::uint32_t p =
            point_at(static_cast<double>(place(a)[0]) + t * ux, static_cast<double>(place(a)[1]) + t * uy);
        if (p != a && p != b) cuts_[steps_[i]].push_back({t, p});
        if (p != c && p != d) cuts_[steps_[k]].push_back({u, p});
      }
    return apply();
  }

  /// A step along which one of two roofs is higher at its start and the other at its end is broken where they meet.
  auto at_inversions() -> bool {
    const auto sides = sides_of(s_);
    if (!sides) return false;
    gather();
    std::set<std::uint32_t> levelled;  // points of the plan
    for (const auto& [step, left] : *sides) {
      if (step.first > step.second || levelled.contains(step.first) || levelled.contains(step.second)) continue;
      const auto back = sides->find({step.second, step.first});
      if (back == sides->end()) continue;
      const Side& right = back->second;
      const std::array lines{std::array{left.z0, left.z1}, std::array{right.z1, right.z0}, ground(left), ground(right)};
      for (const auto& [i, k] : {std::pair{0, 1}, {0, 3}, {1, 2}}) {
        const std::int64_t d0 = lines[i][0] - lines[k][0], d1 = lines[i][1] - lines[k][1];
        if ((d0 < 0) == (d1 < 0) || d0 == 0 || d1 == 0) continue;
        const double t = static_cast<double>(d0) / static_cast<double>(d0 - d1);
        const Place &a = place(step.first), &b = place(step.second);
        const double dx = static_cast<double>(b[0] - a[0]), dy = static_cast<double>(b[1] - a[1]);
        // Near the end of either: what is a point of its own on the steeper one is one with the end of the flatter one.
        const auto rise = [&](int line) { return std::abs(lines[line][1] - lines[line][0]); };
        const double reach = std::hypot(dx, dy, static_cast<double>(std::min(rise(i), rise(k))));
        const bool at_start = t * reach < static_cast<double>(near_),
                   at_end = (1 - t) * reach < static_cast<double>(near_);
        const std::uint32_t p = point_at(static_cast<double>(a[0]) + t * dx, static_cast<double>(a[1]) + t * dy);
        if (at_start || at_end || p == step.first || p == step.second) {
          const bool start = at_start || p == step.first;
          const std::uint32_t end = start ? step.first : step.second;
          // The steeper one: its plane hardly moves. The ground stays where it is, and a roof that met it there would
          // touch the other solid along an edge.
          const auto [from, to] = k < 2 && rise(k) > rise(i) ? std::pair(k, i) : std::pair(i, k);
          const std::int64_t clear = k < 2 ? 0 : ((start ? d1 : d0) > 0 ? clear_of_ground : -clear_of_ground) * near_;
          set_height({end, lines[from][start ? 0 : 1]}, lines[to][start ? 0 : 1] + clear);
          levelled.insert(end);
          break;
        }
        cuts_[step].push_back({t, p});
        break;
      }
    }
    const bool broken = apply();
    return broken || !levelled.empty();
  }

  [[nodiscard]] auto ground(const Side& side) const -> std::array<std::int64_t, 2> {
    const std::int64_t z = s_.base[s_.sheets[side.sheet].solid];
    return {z, z};
  }

  void set_height(const Node& from, std::int64_t z) {
    each_node([&](Node& node, const Sheet&) {
      if (node == from) node.z = z;
    });
  }

  auto apply() -> bool {
    if (cuts_.empty()) return false;
    for (auto& [step, cuts] : cuts_) {
      std::ranges::sort(cuts);
      cuts.erase(std::ranges::unique(cuts, {}, &Cut::at).begin(), cuts.end());
    }
    for (Sheet& sheet : s_.sheets)
      for (Path& path : sheet.paths) path = broken(path);
    tidy();
    return true;
  }

  [[nodiscard]] auto broken(const Path& path) const -> Path {
    Path out;
    for (std::size_t i = 0; i < path.size(); ++i) {
      out.push_back(path[i]);
      const Node &from = path[i], &to = path[(i + 1) % path.size()];
      const auto found = cuts_.find(ordered(from.at, to.at));
      if (from.at == to.at || found == cuts_.end()) continue;
      const bool forth = from.at < to.at;
      const Node &low = forth ? from : to, &high = forth ? to : from;
      const auto& cuts = found->second;
      for (std::size_t k = 0; k < cuts.size(); ++k) {
        const Cut& cut = cuts[forth ? k : cuts.size() - 1 - k];
        out.push_back({cut.at, low.z + std::llround(cut.t * static_cast<double>(high.z - low.z))});
      }
    }
    return out;
  }

  Sheets& s_;
  std::int64_t near_;
  std::vector<std::int64_t> bases_;  ///< rising
  std::vector<Step> steps_;
  std::vector<std::uint32_t> points_;  ///< by place
  std::map<Step, std::vector<Cut>> cuts_;
  std::map<Place, std::uint32_t> numbers_;
};

}  // namespace

auto sheets_of(std::span<const model::LabelledSolid* const> parts, std::int64_t near) -> std::optional<Sheets> {
  Sheets out;
  out.near = near;
  // Halves go up everywhere, so that a shift by whole metres shifts the result.
  const auto quanta = [](double v) { return static_cast<std::int64_t>(std::floor(v * quanta_per_metre + 0.5)); };
  bool first = true;
  for (const auto* part : parts)
    for (const Point3 p : part->solid.vertices) {
      const Place place{quanta(p.x), quanta(p.y)};
      if (first) out.origin = place;
      first = false;
      out.origin = {std::min(out.origin[0], place[0]), std::min(out.origin[1], place[1])};
    }
  std::map<Place, std::uint32_t> numbers;
  for (std::uint32_t s = 0; s < parts.size(); ++s) {
    const auto& solid = parts[s]->solid;
    std::optional<std::int64_t> base;
    for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
      const model::Face& face = solid.faces[f];
      const Facing facing = face.normal.z > upright    ? Facing::up
                            : face.normal.z < -upright ? Facing::down
                                                       : Facing::aside;
      if (face.kind == model::FaceKind::soffit) return std::nullopt;
      Sheet& sheet = out.sheets.emplace_back(Sheet{facing, s, f, {}});
      for (const auto& loop : face.loops) {
        Path& path = sheet.paths.emplace_back();
        for (const std::uint32_t v : loop) {
          const Point3 p = solid.vertices[v];
          const Place place{quanta(p.x) - out.origin[0], quanta(p.y) - out.origin[1]};
          const auto [entry, added] = numbers.try_emplace(place, static_cast<std::uint32_t>(out.places.size()));
          if (added) out.places.push_back(place);
          path.push_back({entry->second, quanta(p.z)});
          if (facing != Facing::down) continue;
          if (base && *base != path.back().z) return std::nullopt;
          base = path.back().z;
        }
      }
    }
    if (!base) return std::nullopt;
    out.base.push_back(*base);
  }
  if (!out.base.empty()) out.level = *std::ranges::min_element(out.base);
  return out;
}

auto sides_of(const Sheets& sheets) -> std::optional<Sides> {
  Sides sides;
  bool sound = true;
  for (std::uint32_t s = 0; s < sheets.sheets.size(); ++s) {
    const Sheet& sheet = sheets.sheets[s];
    if (sheet.facing != Facing::up) continue;
    std::map<Step, Side> own;
    for (const Path& path : sheet.paths)
      for (std::size_t i = 0; i < path.size(); ++i) {
        const Node &from = path[i], &to = path[(i + 1) % path.size()];
        if (from.at == to.at) continue;
        if (own.erase({to.at, from.at}) > 0) continue;  // a strip without width
        sound = own.try_emplace({from.at, to.at}, Side{s, from.z, to.z}).second && sound;
      }
    for (const auto& [step, side] : own) sound = sides.try_emplace(step, side).second && sound;
  }
  if (!sound) return std::nullopt;
  return sides;
}

auto conform(Sheets& sheets) -> bool { return Conforming(sheets).run(); }

}  // namespace mansard::solid::detail
