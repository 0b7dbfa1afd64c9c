// Solids that meet in an vertical line only, as two towers across a corner of a courtyard: no 2-manifold can have that,
// so a corner of a few millimetres is cut off one of them.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "mansard/solid/detail/sheets.hpp"

namespace mansard::solid::detail {
namespace {

using geometry::Point2;
using geometry::Point3;

/// Quanta: new corners are so far apart, a little more than what becomes one.
constexpr double least_side = model::least_apart + 2;
/// Quanta: 2 cm; a sharper corner is not cut, for its cut would be as long.
constexpr double longest_cut = 200;

/// What a roof has at a point of the plan, from the step that leaves it counter-clockwise to the one that comes to it.
struct Sector {
  std::uint32_t sheet = 0, path = 0, solid = 0;
  std::uint32_t from = 0, to = 0;  ///< the far ends of the two steps
  std::int64_t base = 0, z = 0;
};

/// Sectors of a run, solid between two heights, one beside the other.
struct Run {
  std::vector<Sector> sectors;
  std::optional<Sector> before, after;  ///< what is beside it, clockwise and counter-clockwise
};

class Cutting {
 public:
  Cutting(Sheets& sheets, const std::vector<std::uint32_t>& owner_of_solid) : s_(sheets), owner_(owner_of_solid) {
    for (std::uint32_t p = 0; p < s_.places.size(); ++p) numbers_.try_emplace(s_.places[p], p);
    uses_.resize(s_.places.size());
    for (std::uint32_t s = 0; s < s_.sheets.size(); ++s)
      for (std::uint32_t k = 0; k < s_.sheets[s].paths.size(); ++k) {
        std::set<std::uint32_t> at;
        for (const Node& node : s_.sheets[s].paths[k]) at.insert(node.at);
        for (const auto p : at) uses_[p].push_back({s, k});
      }
  }

  auto run() -> bool {
    bool any = false;
    const auto count = static_cast<std::uint32_t>(s_.places.size());
    for (std::uint32_t p = 0; p < count; ++p) {
      std::set<std::uint32_t> owners;
      for (const auto& [sheet, path] : uses_[p]) owners.insert(owner_[s_.sheets[sheet].solid]);
      constexpr int most = 4;  // runs at a point
      for (const auto owner : owners)
        for (int i = 0; i < most && cut_one(p, owner); ++i) any = true;
    }
    return any;
  }

 private:
  [[nodiscard]] auto offset(std::uint32_t from, std::uint32_t to) const -> Point2 {
    return {static_cast<double>(s_.places[to][0] - s_.places[from][0]),
            static_cast<double>(s_.places[to][1] - s_.places[from][1])};
  }

  /// Counter-clockwise. None where a roof has an vertical edge there.
  [[nodiscard]] auto sectors_at(std::uint32_t p, std::uint32_t owner) const -> std::optional<std::vector<Sector>> {
    std::vector<std::pair<double, Sector>> found;
    for (const auto& [s, k] : uses_[p]) {
      const Sheet& sheet = s_.sheets[s];
      if (sheet.facing != Facing::up || owner_[sheet.solid] != owner) continue;
      const Path& path = sheet.paths[k];
      for (std::size_t i = 0; i < path.size(); ++i) {
        if (path[i].at != p) continue;
        const auto to = path[(i + path.size() - 1) % path.size()].at, from = path[(i + 1) % path.size()].at;
        if (to == p || from == p || to == from) return std::nullopt;
        const Point2 d = offset(p, from);
        found.push_back({std::atan2(d.y, d.x), {s, k, sheet.solid, from, to, s_.base[sheet.solid], path[i].z}});
      }
    }
    std::ranges::sort(found, {}, [](const auto& one) { return std::pair(one.first, one.second.sheet); });
    std::vector<Sector> sectors;
    for (auto& [angle, sector] : found) sectors.push_back(sector);
    return sectors;
  }

  /// The runs at the first height at which there are several.
  static auto runs_of(const std::vector<Sector>& sectors) -> std::vector<Run> {
    std::set<std::int64_t> heights;
    for (const Sector& sector : sectors) heights.insert(sector.base), heights.insert(sector.z);
    const std::size_t n = sectors.size();
    const auto beside = [&](std::size_t i) { return sectors[i].to == sectors[(i + 1) % n].from; };
    for (auto low = heights.begin(); low != heights.end() && std::next(low) != heights.end(); ++low) {
      const auto is_solid = [&](std::size_t i) {
        return sectors[i % n].base <= *low && sectors[i % n].z >= *std::next(low);
      };
      std::vector<Run> runs;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t last = (i + n - 1) % n;
        if (!is_solid(i) || (is_solid(last) && beside(last))) continue;
        Run run;
        if (beside(last)) run.before = sectors[last];
        std::size_t k = i;
        for (run.sectors.push_back(sectors[k]); beside(k) && is_solid(k + 1); run.sectors.push_back(sectors[k]))
          k = (k + 1) % n;
        if (beside(k)) run.after = sectors[(k + 1) % n];
        runs.push_back(std::move(run));
      }
      if (runs.size() > 1) return runs;
    }
    return {};
  }

  /// How far from a point its sectors are cut. None where that is too far, or parts of a solid are not in the run.
  [[nodiscard]] auto reach_of(std::uint32_t p, const Run& run, const std::vector<Sector>& all) const
      -> std::optional<double> {
    double reach = least_side, shortest = length(offset(p, run.sectors.front().from));
    for (const Sector& sector : run.sectors) {
      const auto of_solid = [&](const Sector& other) { return other.solid == sector.solid; };
      if (std::ranges::count_if(all, of_solid) != std::ranges::count_if(run.sectors, of_solid)) return std::nullopt;
      const Point2 a = offset(p, sector.from), b = offset(p, sector.to);
      const double turn = std::atan2(cross(a, b), dot(a, b));
      if (!(turn > 0)) return std::nullopt;
      reach = std::max({reach, least_side / (2 * std::sin(turn / 2)), least_side / std::cos(turn / 2)});
      shortest = std::min(shortest, length(b));
    }
    if (!(reach <= longest_cut) || shortest < reach + least_side) return std::nullopt;
    return reach;
  }

  auto cut_one(std::uint32_t p, std::uint32_t owner) -> bool {
    const auto sectors = sectors_at(p, owner);
    if (!sectors || sectors->size() < 2) return false;
    const Run* chosen = nullptr;
    double reach = 0;
    const auto runs = runs_of(*sectors);
    for (const Run& run : runs) {
      const auto own = reach_of(p, run, *sectors);
      if (!own ||
          (chosen != nullptr && std::pair(run.sectors.size(), *own) >= std::pair(chosen->sectors.size(), reach)))
        continue;
      chosen = &run, reach = *own;
    }
    return chosen != nullptr && cut(p, *chosen, reach);
  }

  /// New corners on the steps that bound the sectors, clockwise first.
  auto cut(std::uint32_t p, const Run& run, double reach) -> bool {
    std::vector<std::uint32_t> ends{run.sectors.front().from}, chain;
    for (const Sector& sector : run.sectors) ends.push_back(sector.to);
    std::vector<Place> places;
    for (const auto end : ends) {
      const Point2 d = offset(p, end);
      const double t = reach / length(d);
      places.push_back({s_.places[p][0] + std::llround(t * d.x), s_.places[p][1] + std::llround(t * d.y)});
      if (numbers_.contains(places.back())) return false;
    }
    for (std::size_t i = 0; i < ends.size(); ++i) {
      chain.push_back(static_cast<std::uint32_t>(s_.places.size()));
      numbers_.emplace(places[i], chain.back());
      s_.places.push_back(places[i]);
      break_step(p, ends[i], chain.back(), reach / length(offset(p, ends[i])));
    }
    for (std::size_t i = 0; i < run.sectors.size(); ++i) {
      const Sector& sector = run.sectors[i];
      replace(sector.sheet, sector.path, chain[i + 1], p, chain[i], {});
    }
    cut_ground(p, run, chain);
    give_away(p, run, chain);
    return true;
  }

  void break_step(std::uint32_t p, std::uint32_t end, std::uint32_t by, double t) {
    uses_.resize(s_.places.size());
    for (const auto& [s, k] : uses_[p]) {
      Path out;
      const Path& path = s_.sheets[s].paths[k];
      for (std::size_t i = 0; i < path.size(); ++i) {
        const Node &a = path[i], &b = path[(i + 1) % path.size()];
        out.push_back(a);
        if ((a.at != p || b.at != end) && (a.at != end || b.at != p)) continue;
        const Node &near = a.at == p ? a : b, &far = a.at == p ? b : a;
        out.push_back({by, near.z + std::llround(t * static_cast<double>(far.z - near.z))});
      }
      if (out.size() != path.size()) uses_[by].push_back({s, k});
      s_.sheets[s].paths[k] = std::move(out);
    }
  }

  /// Puts nodes in the place of the one at p between two others. False where these do not follow each other.
  auto replace(std::uint32_t sheet, std::uint32_t number, std::uint32_t before, std::uint32_t p, std::uint32_t after,
               const Path& nodes) -> bool {
    Path& path = s_.sheets[sheet].paths[number];
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (path[i].at != p || path[(i + path.size() - 1) % path.size()].at != before ||
          path[(i + 1) % path.size()].at != after)
        continue;
      path.erase(path.begin() + static_cast<std::ptrdiff_t>(i));
      path.insert(path.begin() + static_cast<std::ptrdiff_t>(i), nodes.begin(), nodes.end());
      for (const Node& node : nodes) uses_[node.at].push_back({sheet, number});
      return true;
    }
    return false;
  }

  /// The ground of a solid runs the other way round than its roof.
  void cut_ground(std::uint32_t p, const Run& run, const std::vector<std::uint32_t>& chain) {
    for (std::size_t first = 0; first < run.sectors.size();) {
      std::size_t last = first;
      const std::uint32_t solid = run.sectors[first].solid;
      while (last + 1 < run.sectors.size() && run.sectors[last + 1].solid == solid) ++last;
      Path between;
      for (std::size_t i = first + 1; i <= last; ++i) between.push_back({chain[i], s_.base[solid]});
      in_ground(p, solid, [&](std::uint32_t s, std::uint32_t k) {
        return replace(s, k, chain[first], p, chain[last + 1], between);
      });
      first = last + 1;
    }
  }

  template <class Work>
  void in_ground(std::uint32_t p, std::uint32_t solid, const Work& work) {
    for (const auto& [s, k] : std::vector(uses_[p]))
      if (s_.sheets[s].facing == Facing::down && s_.sheets[s].solid == solid && work(s, k)) return;
  }

  /// What was cut off belongs to what is beside it, so that this is joined across the corner; else to nobody.
  void give_away(std::uint32_t p, const Run& run, const std::vector<std::uint32_t>& chain) {
    const bool clockwise = run.before.has_value();
    if (!clockwise && !run.after) return;
    const Sector& taker = clockwise ? *run.before : *run.after;
    std::vector<std::uint32_t> points(chain.begin() + (clockwise ? 1 : 0), chain.end() - (clockwise ? 0 : 1));
    Path roof, ground;
    for (const auto at : points) roof.push_back({at, height(taker, p, at)});
    for (const auto at : points) ground.push_back({at, taker.base});
    std::ranges::reverse(ground);
    const Node own{p, taker.z}, own_ground{p, taker.base};
    if (clockwise) {
      roof.push_back(own);
      replace(taker.sheet, taker.path, chain.front(), p, taker.from, roof);
      ground.insert(ground.begin(), own_ground);
    } else {
      roof.insert(roof.begin(), own);
      replace(taker.sheet, taker.path, taker.to, p, chain.back(), roof);
      ground.push_back(own_ground);
    }
    in_ground(p, taker.solid, [&](std::uint32_t s, std::uint32_t k) {
      const Path& path = s_.sheets[s].paths[k];
      for (std::size_t i = 0; i < path.size(); ++i) {
        const auto before = path[(i + path.size() - 1) % path.size()].at, after = path[(i + 1) % path.size()].at;
        if (path[i].at == p && (clockwise ? after == chain.front() : before == chain.back()))
          return replace(s, k, before, p, after, ground);
      }
      return false;
    });
  }

  /// Of the taker's roof at a new point; that of another roof there, where they would come too near to each other.
  [[nodiscard]] auto height(const Sector& taker, std::uint32_t p, std::uint32_t at) const -> std::int64_t {
    Point3 normal;
    const Path& path = s_.sheets[taker.sheet].paths[0];
    const auto from_first = [&](const Node& node) {
      const Point2 d = offset(path[0].at, node.at);
      return Point3{d.x, d.y, static_cast<double>(node.z - path[0].z)};
    };
    for (std::size_t i = 0; i < path.size(); ++i)
      normal = normal + cross(from_first(path[i]), from_first(path[(i + 1) % path.size()]));
    const Point2 d = offset(p, at);
    std::int64_t z = taker.z;
    if (normal.z > 0) z -= std::llround((normal.x * d.x + normal.y * d.y) / normal.z);
    for (const auto& [s, k] : uses_[at])
      for (const Node& node : s_.sheets[s].paths[k])
        if (node.at == at && std::abs(node.z - z) < model::least_apart) return node.z;
    return z;
  }

  Sheets& s_;
  const std::vector<std::uint32_t>& owner_;
  std::map<Place, std::uint32_t> numbers_;
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> uses_;  ///< sheet and path by place
};

}  // namespace

auto cut_corners(Sheets& sheets, const std::vector<std::uint32_t>& owner_of_solid) -> bool {
  return Cutting(sheets, owner_of_solid).run();
}

}  // namespace mansard::solid::detail
