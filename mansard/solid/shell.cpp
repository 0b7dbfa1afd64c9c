#include "mansard/solid/shell.hpp"

#include <array>
#include <map>
#include <set>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/base/text.hpp"
#include "mansard/solid/detail/shell_walls.hpp"

namespace mansard::solid {
namespace {

using detail::Loop;
using detail::Surface;
using geometry::Point3;
using model::Solid;
using Solids = std::vector<const Solid*>;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// m. The last is what straightening an outline may move it by (extrude::Options::tolerance), and a centimetre.
constexpr std::array tolerances{0.001, 0.01, 0.06};
/// m. Triangles need no planes; this is what the last of those may do to a face.
constexpr double planar = 0.12;

auto surface_area(const Solid& solid) -> double {
  double sum = 0;
  for (const auto& face : solid.faces) sum += area(solid, face);
  return sum;
}

auto newell(const Surface& surface, const Loop& loop) -> Point3 {
  Point3 sum;
  const Point3 first = surface.points[loop.front()];
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum = sum + cross(surface.points[loop[i]] - first, surface.points[loop[(i + 1) % loop.size()]] - first);
  return sum;
}

auto solid_of(const Surface& surface) -> Solid {
  Solid solid;
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const auto& face : surface.faces) {
    model::Face out{face.loops, model::FaceKind::side, {}, {}};
    for (auto& loop : out.loops) {
      out.normal = out.normal + newell(surface, loop);
      for (auto& point : loop) {
        const auto [at, is_new] = numbers.try_emplace(point, static_cast<std::uint32_t>(solid.vertices.size()));
        if (is_new) solid.vertices.push_back(surface.points[point]);
        point = at->second;
      }
    }
    out.normal = geometry::normalised(out.normal);
    solid.faces.push_back(std::move(out));
  }
  return solid;
}

/// The union of solids, or what is wrong with it.
auto united(const Solids& solids, double tolerance) -> std::pair<Solid, std::string> {
  Surface surface = detail::surface_of(solids);
  if (!detail::conform(surface, tolerance)) return {{}, "edges cross again and again"};
  if (!detail::without_facing_walls(surface, 2 * tolerance)) return {{}, "walls overlap"};
  Solid shell = solid_of(surface);
  const auto faults = check(shell, planar);
  if (!faults.empty()) return {{}, faults.front().message};
  double whole = 0, area = 0;
  for (const Solid* solid : solids) whole += volume(*solid), area += surface_area(*solid);
  const double lost = whole - volume(shell);
  if (std::abs(lost) > tolerance * area) return {{}, "the volume would change by " + base::to_text(lost, 3) + " m³"};
  return {std::move(shell), ""};
}

/// The same at the first tolerance at which it is sound; else what is wrong at the first.
auto united(const Solids& solids) -> std::pair<Solid, std::string> {
  std::string why;
  for (const double tolerance : tolerances) {
    auto [shell, fault] = united(solids, tolerance);
    if (fault.empty()) return {std::move(shell), ""};
    if (why.empty()) why = std::move(fault);
  }
  return {{}, why};
}

/// Joins what can be, neighbour by neighbour: one corner that no shell can have leaves the others whole.
class Gathering {
 public:
  explicit Gathering(const Solids& solids) {
    for (const Solid* solid : solids) heaps_.push_back({{solid}, *solid});
  }

  auto shells(const std::vector<Pair>& neighbours) -> std::vector<Solid> {
    base::DisjointSets sets(heaps_.size());
    std::set<Pair> failed;
    for (const auto& [first, second] : neighbours) {
      const auto [a, b] = std::minmax({sets.of(first), sets.of(second)});
      if (a == b || failed.contains({a, b})) continue;
      Heap both{heaps_[a].solids, {}};
      both.solids.insert(both.solids.end(), heaps_[b].solids.begin(), heaps_[b].solids.end());
      auto [shell, why] = united(both.solids);
      if (!why.empty()) {
        failed.insert({a, b});
        continue;
      }
      both.shell = std::move(shell);
      heaps_[a] = std::move(both);
      heaps_[b] = {};
      sets.join(a, b);
    }
    std::vector<Solid> shells;
    for (auto& heap : heaps_)
      if (!heap.solids.empty()) shells.push_back(std::move(heap.shell));
    return shells;
  }

 private:
  struct Heap {
    Solids solids;
    Solid shell;
  };
  std::vector<Heap> heaps_;
};

void join(std::span<const Solid* const> all, const std::vector<Pair>& neighbours, Joined::One& group) {
  Solids solids;
  for (const std::size_t s : group.of) solids.push_back(all[s]);
  if (solids.size() == 1) {
    group.shells = {*solids.front()};
    return;
  }
  auto [shell, why] = united(solids);
  if (why.empty()) group.shells = {std::move(shell)};
  else group.shells = Gathering(solids).shells(neighbours);
  group.why = std::move(why);
}

}  // namespace

auto join(std::span<const Solid* const> solids) -> Joined {
  const Surface surface = detail::surface_of(solids);
  std::set<Pair> neighbours;
  base::DisjointSets sets(solids.size());
  for (const auto& [a, b] : detail::facing_walls(surface.faces, surface.points, tolerances.back())) {
    neighbours.insert(std::minmax({surface.faces[a].solid, surface.faces[b].solid}));
    sets.join(surface.faces[a].solid, surface.faces[b].solid);
  }
  std::map<std::uint32_t, Joined::One> groups;
  std::vector<std::uint32_t> place(solids.size());  // in its group
  for (std::uint32_t s = 0; s < solids.size(); ++s) {
    auto& of = groups[sets.of(s)].of;
    place[s] = static_cast<std::uint32_t>(of.size());
    of.push_back(s);
  }
  Joined all;
  for (auto& [name, group] : groups) {
    std::vector<Pair> within;
    for (const auto& [a, b] : neighbours)
      if (sets.of(a) == name) within.emplace_back(place[a], place[b]);
    join(solids, within, group);
    all.groups.push_back(std::move(group));
  }
  return all;
}

}  // namespace mansard::solid
