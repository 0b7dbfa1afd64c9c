#include "mansard/solid/unite.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/base/run.hpp"
#include "mansard/model/append.hpp"
#include "mansard/solid/detail/disjoint.hpp"
#include "mansard/solid/detail/uniting.hpp"

namespace mansard::solid {
namespace {

using detail::Reach;
using detail::Shared;
using model::LabelledSolid;
using One = United::One;

/// Corners are cut where there is no union without. Where parts overlap by more than the least, or a face is caught
/// between points that near, 5 mm and 2 cm help.
constexpr std::array reaches{Reach{.corners = false}, Reach{}, Reach{50}, Reach{200}, Reach{.prisms = true}};

/// What is left of a part, closed.
struct Closed {
  std::optional<LabelledSolid> solid;  ///< none where no valid solid can be made of it
  bool simplified = false;
};
auto closed(const LabelledSolid& shape) -> Closed {
  const std::array<const LabelledSolid*, 1> alone{&shape};
  const auto made = detail::united_by(alone, Reach{});
  if (made.solids.empty()) return {};
  LabelledSolid out;
  for (const One& one : made.solids) model::append(one.model, out);
  return {std::move(out), !made.warnings.empty()};
}

/// The parts of buildings that are united together, as they are given or without what they share.
class Parts {
 public:
  /// `families`: buildings, by number, no two solids of which may share ground.
  Parts(std::vector<std::vector<const LabelledSolid*>> buildings, std::vector<std::vector<std::uint32_t>> families)
      : given_(buildings),
        of_(std::move(buildings)),
        families_(std::move(families)),
        numbers_(of_.size()),
        covered_(of_.size()),
        warnings_(of_.size()) {
    for (std::size_t b = 0; b < of_.size(); ++b)
      for (std::size_t p = 0; p < of_[b].size(); ++p) numbers_[b].push_back(p);
  }

  [[nodiscard]] auto of() const -> const std::vector<std::vector<const LabelledSolid*>>& { return of_; }
  [[nodiscard]] auto families() const -> const std::vector<std::vector<std::uint32_t>>& { return families_; }

  /// Whether solids of one family share ground.
  [[nodiscard]] static auto overlap(const std::vector<std::uint32_t>& family, const std::vector<United>& made) -> bool {
    return any_two(family, made, detail::share_ground);
  }

  /// The same, or walls of theirs lean into others.
  [[nodiscard]] static auto overlap_or_lean(const std::vector<std::uint32_t>& family, const std::vector<United>& made)
      -> bool {
    return any_two(family, made, detail::overlap);
  }

  /// Takes what parts share off one of them, in the families whose solids do. Whether anything changed.
  auto part(const std::vector<United>& made, Shared shared) -> bool {
    bool any = false;
    for (const auto& family : families_)
      if (overlap(family, made)) any = part(family, shared) || any;
    return any;
  }

  /// Numbers of parts as they were given, and what became of them.
  void finish(std::vector<United>& made) {
    for (std::size_t b = 0; b < made.size(); ++b) {
      const auto number = [&](auto& p) { p = static_cast<std::remove_reference_t<decltype(p)>>(numbers_[b][p]); };
      for (One& one : made[b].solids) {
        std::ranges::for_each(one.of, number);
        std::ranges::for_each(one.part_of_face, number);
      }
      std::ranges::for_each(made[b].simplified, number);
      made[b].warnings.insert(made[b].warnings.begin(), warnings_[b].begin(), warnings_[b].end());
    }
    for (const auto& family : families_)
      for (const auto b : family) settle_lost(b, family, made);
  }

 private:
  template <class Test>
  static auto any_two(const std::vector<std::uint32_t>& family, const std::vector<United>& made, Test test) -> bool {
    std::vector<const LabelledSolid*> solids;
    for (const auto b : family)
      for (const One& one : made[b].solids) solids.push_back(&one.model);
    const auto near = detail::near_each(solids);
    for (std::size_t i = 0; i < solids.size(); ++i)
      for (const std::uint32_t k : near[i])
        if (k < i && test(*solids[k], *solids[i])) return true;
    return false;
  }

  /// Whatever went wrong above, what is in no solid is made without its narrow places, or among the lost, and told.
  void settle_lost(std::uint32_t b, const std::vector<std::uint32_t>& family, std::vector<United>& made) const {
    United& own = made[b];
    std::set<std::size_t> in;
    for (const One& one : own.solids) in.insert(one.of.begin(), one.of.end());
    bool any = false, wide = false;
    for (std::size_t p = 0; p < given_[b].size(); ++p) {
      if (in.contains(p) || covered_[b].contains(p)) continue;
      any = true;
      std::erase(own.simplified, p);  // a solid of it gave way
      if (replaced(b, p, family, made)) continue;
      own.lost.push_back(p);
      wide = wide || detail::wider_than_points(*given_[b][p], reaches[3].near);
    }
    if (!any) return;
    const auto is_left_out = [](const auto& warning) { return warning.code == "solid-left-out"; };
    if (own.lost.empty()) std::erase_if(own.warnings, is_left_out);
    else if (wide && std::ranges::none_of(own.warnings, is_left_out))
      own.warnings.push_back(base::warning("solid-left-out", "a part of it is in none of its solids"));
    std::ranges::stable_sort(own.solids, {}, [](const One& one) { return one.of.front(); });
  }

  /// A part without its narrow places, where that is valid and shares no space with the solids of its family.
  auto replaced(std::uint32_t b, std::size_t p, const std::vector<std::uint32_t>& family,
                std::vector<United>& made) const -> bool {
    auto prisms = detail::prisms_without_narrow_places(*given_[b][p]);
    for (const auto& prism : prisms)
      for (const auto other : family)
        for (const One& one : made[other].solids)
          if (detail::overlap(one.model, prism)) return false;
    if (prisms.empty()) return false;
    for (auto& prism : prisms) {
      std::vector<std::uint32_t> from(prism.solid.faces.size(), static_cast<std::uint32_t>(p));
      made[b].solids.push_back({{p}, std::move(prism), std::move(from)});
    }
    made[b].simplified.push_back(p);
    const auto why = std::ranges::find(made[b].warnings, "solid-left-out", &base::Diagnostic::code);
    made[b].warnings.push_back(
        base::warning("solid-simplified",
                      "a part became a flat-roofed prism, and narrow places of its outline were closed or opened" +
                          (why == made[b].warnings.end() ? std::string() : ": " + why->message)));
    return true;
  }

  /// The parts of a family without what they share. A part of which no valid solid is left keeps its ground, and the
  /// others are cut back from it: not a part is lost for a strip that it shares with another one.
  using Flat = std::vector<bool>;
  static auto parted_and_closed(std::span<const LabelledSolid* const> all, Shared shared)
      -> std::pair<detail::Parted, Flat> {
    std::vector<bool> firm(all.size(), false);
    while (true) {
      auto parted = detail::parted(all, firm, shared);
      Flat flat(all.size(), false);
      bool again = false;
      for (std::size_t p = 0; p < all.size(); ++p) {
        if (!parted.changed[p] && !parted.failed[p]) continue;
        Closed rest;
        if (parted.changed[p]) rest = closed(*parted.changed[p]);
        if ((!rest.solid || rest.simplified) && !firm[p]) {
          again = firm[p] = true;
          continue;
        }
        parted.changed[p] = std::move(rest.solid);  // without one it stays as it is, and shares ground still
        flat[p] = rest.simplified;
      }
      if (!again) return {std::move(parted), std::move(flat)};
    }
  }

  auto part(const std::vector<std::uint32_t>& family, Shared shared) -> bool {
    std::vector<const LabelledSolid*> all;
    for (const auto b : family) all.insert(all.end(), of_[b].begin(), of_[b].end());
    auto [parted, flat] = parted_and_closed(all, shared);
    if (!parted.any) return false;
    std::size_t next = 0;
    for (const auto b : family) {
      std::vector<const LabelledSolid*> left;
      std::vector<std::size_t> numbers;
      bool changed = false;
      for (std::size_t p = 0; p < of_[b].size(); ++p, ++next) {
        changed = changed || parted.covered[next] || parted.changed[next];
        if (parted.covered[next]) {
          covered_[b].insert(numbers_[b][p]);
          continue;
        }
        if (flat[next])
          warnings_[b].push_back(base::warning(
              "solid-simplified", "a part that shares ground with another one became a flat-roofed prism beside it"));
        if (parted.changed[next]) owned_.push_back(std::move(*parted.changed[next]));
        left.push_back(parted.changed[next] ? &owned_.back() : of_[b][p]);
        numbers.push_back(numbers_[b][p]);
      }
      if (changed)
        warnings_[b].push_back(base::warning(
            "solid-parted", "parts of it share ground; the higher one keeps it, and the other one is cut there"));
      of_[b] = std::move(left);
      numbers_[b] = std::move(numbers);
    }
    return true;
  }

  std::vector<std::vector<const LabelledSolid*>> given_, of_;
  std::vector<std::vector<std::uint32_t>> families_;
  std::vector<std::vector<std::size_t>> numbers_;  ///< of each part of of_, its place in given_
  std::vector<std::set<std::size_t>> covered_;     ///< of given_: by other parts, wholly
  std::vector<std::vector<base::Diagnostic>> warnings_;
  std::deque<LabelledSolid> owned_;
};

/// Ground at several heights comes to be at the lowest: what was cut is closed over one.
void level_ground(LabelledSolid& model) {
  std::set<std::uint32_t> ground;
  for (std::size_t f = 0; f < model.classes.size(); ++f)
    if (model.classes[f] == model::FaceClass::ground)
      for (const auto& loop : model.solid.faces[f].loops) ground.insert(loop.begin(), loop.end());
  auto& vertices = model.solid.vertices;
  double lowest = 1e300;
  for (const auto v : ground) lowest = std::min(lowest, vertices[v].z);
  for (const auto v : ground) vertices[v].z = lowest;
}

/// A solid that shares space with others of its building, cut back from them, if there is a valid one. With its roofs,
/// as little as rounding needs, else by twice what becomes one point or by 2 cm; else flat.
auto cut_back(const LabelledSolid& solid, std::span<const LabelledSolid* const> others) -> std::vector<One> {
  for (const bool flat : {false, true})
    for (const double gap : {3.0, 2.0 * model::least_apart, 200.0}) {
      auto rest = detail::without(solid, others, gap).solid;
      if (!rest) continue;
      level_ground(*rest);
      if (flat) rest = prism_over_ground(*rest, detail::roof_middle(*rest));
      if (rest->solid.faces.empty()) continue;
      for (const std::int64_t near : {std::int64_t{model::least_apart}, std::int64_t{50}}) {
        const std::array<const LabelledSolid*, 1> alone{&*rest};
        auto made = detail::united_by(alone, Reach{near});
        const auto is_apart = [&](const One& one) {
          return std::ranges::none_of(others, [&](auto* other) { return detail::overlap(*other, one.model); });
        };
        if (!made.solids.empty() && made.warnings.empty() && std::ranges::all_of(made.solids, is_apart))
          return std::move(made.solids);
      }
    }
  return {};
}

/// Of solids of a family that share space the larger one stays.
void let_give_way(const std::vector<std::uint32_t>& family, std::vector<United>& made) {
  struct Standing {
    std::uint32_t building = 0;
    One one;
    double volume = 0;
  };
  std::vector<Standing> all;
  for (const auto b : family) {
    for (One& one : made[b].solids) {
      const double size = volume(one.model.solid);
      all.push_back({b, std::move(one), size});
    }
    made[b].solids.clear();
  }
  std::ranges::stable_sort(all, std::greater(), &Standing::volume);
  std::vector<const LabelledSolid*> kept;
  std::deque<LabelledSolid> models;
  const auto keep = [&](std::uint32_t b, One one) {
    models.push_back(one.model);
    kept.push_back(&models.back());
    made[b].solids.push_back(std::move(one));
  };
  for (auto& [b, one, size] : all) {
    std::vector<const LabelledSolid*> others;
    for (const auto* other : kept)
      if (detail::overlap(*other, one.model)) others.push_back(other);
    if (others.empty()) {
      keep(b, std::move(one));
      continue;
    }
    auto pieces = cut_back(one.model, others);
    made[b].warnings.push_back(
        pieces.empty() ? base::warning("solid-left-out", "a solid of it overlaps another one, and cannot be cut back")
                       : base::warning("solid-simplified", "a solid of it overlapped another one, and was cut back"));
    for (One& piece : pieces) {
      piece.of = one.of;
      std::ranges::fill(piece.part_of_face, static_cast<std::uint32_t>(one.of.front()));
      keep(b, std::move(piece));
    }
  }
  for (const auto b : family)
    std::ranges::stable_sort(made[b].solids, {}, [](const One& one) { return one.of.front(); });
}

/// The first result without a warning, over plans in which ever more becomes one; else that with the fewest loose
/// solids, of those the one with the fewest parts simplified or left out, then with the fewest solids, then with the
/// fewest warnings. Where solids of a building share ground, its parts are parted before more becomes one: first where
/// they share more than rounding, and again, exactly, where no plan helps.
template <class Make>
auto best(Parts& parts, const Make& make) -> std::vector<United> {
  std::vector<United> chosen;
  const auto overlapping = [&](const std::vector<United>& made) {
    return std::ranges::any_of(parts.families(), [&](auto& family) { return Parts::overlap(family, made); });
  };
  /// Whether one was as asked. `to_part`: what to part by where one is not.
  const auto over_all_reaches = [&](std::optional<Shared> to_part) {
    std::array<std::size_t, 4> least{};
    bool any = false;
    for (std::size_t r = 0; r < reaches.size(); ++r) {
      const Reach& reach = reaches[r];
      if (reach.prisms && least[0] == 0) break;
      std::vector<United> made = make(parts, reach);
      std::array<std::size_t, 4> lacking{};
      bool as_asked = !overlapping(made);
      for (const United& one : made) {
        for (const auto& warning : one.warnings) lacking[1] += warning.code == "solid-not-united" ? 0 : 1;
        as_asked = as_asked && one.warnings.empty() && one.loose == 0;
        lacking[0] += one.loose;
        lacking[2] += one.solids.size();
        lacking[3] += one.warnings.size();
      }
      if (!as_asked && reach.corners && to_part && parts.part(made, *std::exchange(to_part, std::nullopt))) {
        any = false;
        r = static_cast<std::size_t>(-1);
        continue;
      }
      if (!any || lacking < least) chosen = std::move(made), least = lacking, any = true;
      if (as_asked) return true;
    }
    return false;
  };
  if (!over_all_reaches(Shared::wide) && overlapping(chosen) && parts.part(chosen, Shared::any))
    over_all_reaches(std::nullopt);
  for (const auto& family : parts.families())
    if (Parts::overlap_or_lean(family, chosen)) let_give_way(family, chosen);
  parts.finish(chosen);
  return chosen;
}

auto united_alone(std::span<const LabelledSolid* const> building) -> United {
  Parts parts({{building.begin(), building.end()}}, {{0}});
  return std::move(best(parts, [](const Parts& all, const Reach& reach) {
                     return std::vector<United>{detail::united_by(all.of().front(), reach)};
                   }).front());
}

/// What buildings are ordered by, so that their union does not depend on the order in which they are given.
auto content(const std::vector<const LabelledSolid*>& building) {
  geometry::Point3 least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
  std::size_t count = 0;
  for (const auto* part : building)
    for (const auto v : part->solid.vertices) {
      least = std::min(least, v);
      most = std::max(most, v);
      ++count;
    }
  return std::tuple(least, most, count);
}

/// Buildings that are united together: their parts in a row.
struct Group {
  std::vector<const LabelledSolid*> parts;
  std::vector<std::uint32_t> owner;   ///< of each part, by its place in `buildings`
  std::vector<std::uint32_t> number;  ///< of each part among its owner's
  std::vector<std::uint32_t> buildings;

  Group(std::span<const std::vector<const LabelledSolid*>> all, std::vector<std::uint32_t> which)
      : buildings(std::move(which)) {
    std::ranges::sort(buildings, {}, [&](std::uint32_t b) { return std::pair(content(all[b]), b); });
    for (std::uint32_t k = 0; k < buildings.size(); ++k)
      for (std::uint32_t p = 0; p < all[buildings[k]].size(); ++p) {
        parts.push_back(all[buildings[k]][p]);
        owner.push_back(k), number.push_back(p);
      }
  }
};

/// Buildings that touch, over one plan. By their order in the group.
auto united_over_one_plan(std::span<const std::vector<const LabelledSolid*>> buildings, const Group& group,
                          const Reach& reach, std::uint8_t pin) -> std::vector<United> {
  std::vector<United> out;
  auto all = detail::sheets_of(group.parts, reach.near);
  if (!all || !detail::conform(*all)) {
    for (const std::uint32_t b : group.buildings) {
      out.push_back(detail::united_by(buildings[b], reach));
      ++out.back().loose;
    }
    return out;
  }
  if (reach.corners) detail::cut_corners(*all, group.owner);
  std::vector<std::uint32_t> user(all->places.size(), UINT32_MAX);
  all->pinned.assign(all->places.size(), 0);
  for (const auto& sheet : all->sheets)
    for (const auto& path : sheet.paths)
      for (const auto& node : path) {
        if (user[node.at] == UINT32_MAX) user[node.at] = group.owner[sheet.solid];
        else if (user[node.at] != group.owner[sheet.solid]) all->pinned[node.at] = pin;
      }
  // The sheets of each building first: a copy of all for each would cost the square of the buildings.
  std::vector<std::vector<detail::Sheet>> sheets(group.buildings.size());
  for (auto& sheet : all->sheets) {
    auto& own = sheets[group.owner[sheet.solid]].emplace_back(std::move(sheet));
    own.solid = group.number[own.solid];
  }
  std::vector<std::vector<std::int64_t>> bases(group.buildings.size());
  for (std::size_t p = 0; p < group.parts.size(); ++p) bases[group.owner[p]].push_back(all->base[p]);
  all->sheets.clear();
  all->base.clear();
  for (std::uint32_t k = 0; k < group.buildings.size(); ++k) {
    detail::Sheets own = *all;
    own.sheets = std::move(sheets[k]);
    own.base = std::move(bases[k]);
    out.push_back(detail::united_by(buildings[group.buildings[k]], reach, std::move(own)));
  }
  return out;
}

/// Buildings whose boxes meet. Those with overhanging eaves stay by themselves.
void unite_group(std::span<const std::vector<const LabelledSolid*>> buildings, const std::vector<std::uint32_t>& which,
                 std::uint8_t pin, std::span<const std::size_t> families_of, std::vector<United>& out) {
  std::vector<std::uint32_t> fields;
  for (const std::uint32_t b : which) {
    if (which.size() > 1 && detail::sheets_of(buildings[b])) fields.push_back(b);
    else out[b] = united_alone(buildings[b]);
  }
  if (fields.empty()) return;
  const Group together(buildings, std::move(fields));
  const auto sets = detail::touching(*detail::sheets_of(together.parts), together.owner,
                                     static_cast<std::uint32_t>(together.buildings.size()));
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  for (std::size_t k = 0; k < sets.size(); ++k) groups[sets[k]].push_back(together.buildings[k]);
  for (auto& [name, group] : groups) {
    if (group.size() == 1) {
      out[group.front()] = united_alone(buildings[group.front()]);
      continue;
    }
    std::vector<std::vector<const LabelledSolid*>> own;
    std::map<std::size_t, std::vector<std::uint32_t>> by_name;
    for (std::uint32_t k = 0; k < group.size(); ++k) {
      own.push_back(buildings[group[k]]);
      by_name[pin == detail::of_a_solid ? 0 : families_of.empty() ? k : families_of[group[k]]].push_back(k);
    }
    std::vector<std::vector<std::uint32_t>> families;
    for (auto& [family, members] : by_name) families.push_back(std::move(members));
    Parts parts(std::move(own), std::move(families));
    auto made = best(parts, [&](const Parts& all, const Reach& reach) {
      std::vector<std::uint32_t> each(group.size());
      std::iota(each.begin(), each.end(), 0U);
      const Group one(all.of(), std::move(each));
      auto by_order = united_over_one_plan(all.of(), one, reach, pin);
      std::vector<United> out_of(group.size());
      for (std::size_t k = 0; k < by_order.size(); ++k) out_of[one.buildings[k]] = std::move(by_order[k]);
      return out_of;
    });
    for (std::size_t k = 0; k < made.size(); ++k) out[group[k]] = std::move(made[k]);
  }
}

auto unite_groups(std::span<const std::vector<const LabelledSolid*>> buildings, std::uint8_t pin,
                  std::span<const std::size_t> families_of = {}) -> std::vector<United> {
  std::vector<geometry::Box2> boxes(buildings.size());
  std::vector<std::uint32_t> order;
  for (std::uint32_t b = 0; b < buildings.size(); ++b) {
    for (const auto* part : buildings[b])
      for (const auto v : part->solid.vertices) boxes[b].add(geometry::xy(v));
    if (!boxes[b].empty()) order.push_back(b);
  }
  std::ranges::sort(order, {}, [&](std::uint32_t b) { return std::pair(boxes[b].least.x, b); });
  base::DisjointSets sets(buildings.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto box = boxes[order[i]].grown(2e-3);
    for (std::size_t k = i + 1; k < order.size() && boxes[order[k]].least.x <= box.most.x; ++k)
      if (box.overlaps(boxes[order[k]])) sets.join(order[i], order[k]);
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
  for (std::uint32_t b = 0; b < buildings.size(); ++b) groups[sets.of(b)].push_back(b);
  std::vector<std::vector<std::uint32_t>> list;
  for (auto& [name, group] : groups) list.push_back(std::move(group));
  std::vector<United> out(buildings.size());
  base::parallel_for(list.size(), [&](std::size_t g) { unite_group(buildings, list[g], pin, families_of, out); });
  return out;
}

}  // namespace

auto share_walls(std::span<const LabelledSolid* const> parts) -> bool {
  for (const auto* part : parts)
    if (!check(part->solid, written_rules()).empty()) return false;
  auto sheets = detail::sheets_of(parts);
  if (!sheets) return true;
  const detail::Sheets before = *sheets;
  return detail::conform(*sheets) && detail::only_broken(before, *sheets);
}

auto unite(std::span<const LabelledSolid* const> parts) -> United { return united_alone(parts); }

auto overlapping(std::span<const LabelledSolid* const> solids) -> std::vector<Overlapping> {
  std::vector<Overlapping> out;
  const auto near = detail::near_each(solids);
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (const std::uint32_t k : near[i])
      if (k < i && detail::overlap(*solids[k], *solids[i])) {
        out.push_back({i, base::error("solid-overlap",
                                      "it shares space with solid " + std::to_string(k + 1) + " of its building")});
        break;
      }
  return out;
}

auto unite_all(std::span<const std::vector<const LabelledSolid*>> buildings, std::span<const std::size_t> families)
    -> std::vector<United> {
  return unite_groups(buildings, detail::of_a_building, families);
}

auto unite_each(std::span<const LabelledSolid* const> parts) -> std::vector<United> {
  std::vector<std::vector<const LabelledSolid*>> each;
  for (const auto* part : parts) each.push_back({part});
  return unite_groups(each, detail::of_a_solid);
}

}  // namespace mansard::solid
