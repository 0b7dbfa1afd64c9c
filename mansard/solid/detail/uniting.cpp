#include "mansard/solid/detail/uniting.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mansard/base/disjoint_sets.hpp"
#include "mansard/solid/detail/disjoint.hpp"
#include "mansard/solid/detail/union_faces.hpp"

namespace mansard::solid::detail {
namespace {

using model::LabelledSolid;
using Parts = std::vector<std::size_t>;
using One = United::One;

/// m; what validators grant at their strictest is 1e-4. They find their own plane, and cut faces their own way.
constexpr double planar = 0.95e-4;

/// Solids without a common edge, one after the other.
auto apart(const LabelledSolid& model, const std::vector<std::uint32_t>& part_of_face) -> std::vector<One> {
  base::DisjointSets sets(model.solid.vertices.size());
  for (const auto& face : model.solid.faces)
    for (const auto& loop : face.loops)
      for (const auto v : loop) sets.join(v, face.loops[0][0]);
  std::map<std::uint32_t, One> found;
  std::vector<std::uint32_t> number(model.solid.vertices.size(), UINT32_MAX);
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    model::Face face = model.solid.faces[f];
    One& one = found[sets.of(face.loops[0][0])];
    for (auto& loop : face.loops)
      for (auto& v : loop) {
        if (number[v] == UINT32_MAX) {
          number[v] = static_cast<std::uint32_t>(one.model.solid.vertices.size());
          one.model.solid.vertices.push_back(model.solid.vertices[v]);
        }
        v = number[v];
      }
    one.model.solid.faces.push_back(std::move(face));
    one.model.classes.push_back(model.classes[f]);
    one.part_of_face.push_back(part_of_face[f]);
  }
  std::vector<One> all;
  for (auto& [name, one] : found) {
    const std::set<std::uint32_t> of(one.part_of_face.begin(), one.part_of_face.end());
    one.of.assign(of.begin(), of.end());
    all.push_back(std::move(one));
  }
  return all;
}

auto volume_of(const std::vector<One>& ones) -> double {
  double sum = 0;
  for (const One& one : ones) sum += volume(one.model.solid);
  return sum;
}

/// From the origin and level of sheets to where the parts are.
void place(model::Solid& solid, const Sheets& sheets) {
  const auto moved = [](double metres, std::int64_t by) {
    return static_cast<double>(std::llround(metres * quanta_per_metre) + by) / quanta_per_metre;
  };
  for (auto& v : solid.vertices)
    v = {moved(v.x, sheets.origin[0]), moved(v.y, sheets.origin[1]), moved(v.z, sheets.level)};
}

/// m³ between roofs and ground. Walls have no share in it: a part that was cut has none there.
auto volume_below_roofs(const model::Solid& solid) -> double {
  double sum = 0;
  const geometry::Point3 o = solid.vertices[solid.faces[0].loops[0][0]];
  for (const auto& face : solid.faces)
    for (const auto& loop : face.loops)
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        const auto a = solid.vertices[loop[0]] - o, b = solid.vertices[loop[i]] - o,
                   c = solid.vertices[loop[i + 1]] - o;
        sum += cross(xy(b - a), xy(c - a)) * (a.z + b.z + c.z) / 6;
      }
  return sum;
}

struct Attempt {
  std::vector<One> solids;
  std::string why;
};

/// Several solids keep the corners of each other that they have on their walls. `several`: they, in one.
auto pinned_between(const Sheets& sheets, const model::Solid& several) -> Sheets {
  Sheets out = sheets;
  out.pinned.resize(out.places.size(), 0);
  std::vector<std::uint32_t> user(out.places.size(), UINT32_MAX);
  for (const auto& sheet : out.sheets)
    for (const auto& path : sheet.paths)
      for (const auto& node : path) {
        auto& pinned = out.pinned[node.at];
        if (user[node.at] == UINT32_MAX) user[node.at] = sheet.solid;
        else if (user[node.at] != sheet.solid && pinned == 0) pinned = of_a_building;
      }
  base::DisjointSets sets(several.vertices.size());
  for (const auto& face : several.faces)
    for (const auto& loop : face.loops)
      for (const auto v : loop) sets.join(v, face.loops[0][0]);
  std::map<Place, std::uint32_t> owner;
  std::set<Place> of_several;
  for (std::uint32_t v = 0; v < several.vertices.size(); ++v) {
    const auto quanta = [](double metres) {
      return static_cast<std::int64_t>(std::llround(metres * quanta_per_metre));
    };
    const Place place{quanta(several.vertices[v].x), quanta(several.vertices[v].y)};
    if (owner.try_emplace(place, sets.of(v)).first->second != sets.of(v)) of_several.insert(place);
  }
  for (std::size_t p = 0; p < out.places.size(); ++p)
    if (of_several.contains(out.places[p])) out.pinned[p] = of_a_solid;
  return out;
}

/// The union of those solids of which there are sheets. It is made and checked near the origin, where no coordinate has
/// more digits than another. `level`: roofs are made planar where corners may move in height.
auto made_of(const Sheets& sheets, std::span<const LabelledSolid* const> parts, bool alone = true, bool level = true)
    -> Attempt {
  auto made = union_of(sheets, parts);
  if (!made.why.empty()) return {{}, made.why};
  const model::Solid before = made.model.solid;
  if (!finish(made, planar, level)) {
    if (level) return made_of(sheets, parts, alone, false);
    return {{}, "a face crosses itself"};
  }
  auto solids = apart(made.model, made.solid_of_face);
  if (solids.size() > 1 && alone) return made_of(pinned_between(sheets, before), parts, false);
  for (One& one : solids)
    if (!check(one.model.solid, written_rules()).empty()) {
      if (level) return made_of(sheets, parts, alone, false);
      place(one.model.solid, sheets);  // so that the message names a place that can be found
      const auto faults = check(one.model.solid, written_rules());
      return {{}, faults.empty() ? std::string("rounding") : faults.front().message};
    }
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (share_ground(solids[k].model, solids[i].model)) return {{}, "parts overlap"};
  std::set<std::uint32_t> of;
  for (const auto& sheet : sheets.sheets) of.insert(sheet.solid);
  double whole = 0, surface = 0;
  for (const std::uint32_t p : of) {
    whole += volume_below_roofs(parts[p]->solid);
    for (const auto& face : parts[p]->solid.faces) surface += area(parts[p]->solid, face);
  }
  constexpr double thickness = 1.2e-3;  // m; by which merging points may move a face, on average
  if (std::abs(volume_of(solids) - whole) > thickness * surface) return {{}, "parts overlap"};
  for (One& one : solids) place(one.model.solid, sheets);
  return {std::move(solids), ""};
}

class Uniting {
 public:
  Uniting(std::span<const LabelledSolid* const> parts, const Reach& reach) : parts_(parts), reach_(reach) {}
  /// `plan` is that of the parts and their neighbours.
  Uniting(std::span<const LabelledSolid* const> parts, const Reach& reach, Sheets plan)
      : parts_(parts), reach_(reach), plan_(std::move(plan)) {}

  auto run() -> United {
    const Parts all = all_of(parts_.size());
    if (all.empty()) return {};
    Attempt attempt = united(all);
    if (attempt.why.empty()) take(std::move(attempt.solids));
    else if (all.size() == 1) alone(0, attempt.why);
    else neighbour_by_neighbour(attempt.why);
    if (out_.solids.empty() && out_.warnings.empty())
      out_.warnings.push_back(base::warning("solid-left-out", "its ground is narrower than what becomes one point"));
    std::ranges::stable_sort(out_.solids, {}, [](const One& one) { return one.of.front(); });
    return std::move(out_);
  }

 private:
  void take(std::vector<One> solids) {
    for (One& one : solids) out_.solids.push_back(std::move(one));
  }

  /// The union of some parts, or what is wrong with it: over the plan of all where that can be made.
  auto united(const Parts& which, bool pinned = false) -> Attempt {
    if (!plan_) {
      plan_ = detail::sheets_of(parts_, reach_.near);
      if (!plan_) why_ = "it has overhanging eaves";
      else if (!conform(*plan_)) why_ = "edges cross again and again";
      else if (reach_.corners) cut_corners(*plan_, std::vector<std::uint32_t>(parts_.size(), 0));
    }
    if (plan_ && why_.empty()) return made_of(sheets_of(*plan_, which, pinned), parts_);
    if (which.size() == parts_.size()) return {{}, why_};
    std::vector<const LabelledSolid*> parts;
    for (const std::size_t p : which) parts.push_back(parts_[p]);
    Attempt made = Uniting(parts, reach_).united(all_of(parts.size()));
    for (One& one : made.solids) {
      for (auto& p : one.of) p = which[p];
      for (auto& p : one.part_of_face) p = static_cast<std::uint32_t>(which[p]);
    }
    return made;
  }

  /// Those of some parts; what they share with others pinned.
  [[nodiscard]] static auto sheets_of(const Sheets& plan, const Parts& which, bool pinned) -> Sheets {
    Sheets own = plan;
    const auto is_own = [&](const Sheet& sheet) { return std::ranges::binary_search(which, sheet.solid); };
    own.pinned.resize(own.places.size(), 0);
    for (const auto& sheet : own.sheets)
      if (pinned && !is_own(sheet))
        for (const auto& path : sheet.paths)
          for (const auto& node : path) own.pinned[node.at] = of_a_solid;
    std::erase_if(own.sheets, [&](const auto& sheet) { return !is_own(sheet); });
    return own;
  }

  static auto all_of(std::size_t count) -> Parts {
    Parts all;
    for (std::size_t p = 0; p < count; ++p) all.push_back(p);
    return all;
  }

  /// Joins what can be: one corner that no solid can have leaves the others whole.
  void neighbour_by_neighbour(const std::string& why) {
    std::vector<Attempt> heaps;
    std::vector<Parts> members;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      heaps.push_back(united({p}));
      members.push_back({p});
    }
    std::size_t joined = 0;
    for (std::size_t p = 1; p < parts_.size(); ++p) {
      if (!heaps[p].why.empty()) continue;
      for (std::size_t q = 0; q < p; ++q) {
        if (members[q].empty() || members[p].empty() || !heaps[q].why.empty()) continue;
        if (!boxes_meet(members[q], members[p])) continue;
        Parts both = members[q];
        both.insert(both.end(), members[p].begin(), members[p].end());
        std::ranges::sort(both);
        Attempt attempt = united(both);
        if (!attempt.why.empty() || attempt.solids.size() >= heaps[q].solids.size() + heaps[p].solids.size()) continue;
        heaps[p] = std::move(attempt);
        members[p] = std::move(both);
        heaps[q] = {};
        members[q].clear();
        ++joined;
      }
    }
    out_.warnings.push_back(base::warning("solid-not-united", std::to_string(parts_.size()) + " parts are written as " +
                                                                  std::to_string(parts_.size() - joined) +
                                                                  " solids and not as one: " + why));
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (members[p].empty()) continue;
      if (Attempt shared = united(members[p], true); shared.why.empty()) heaps[p] = std::move(shared);
      else ++out_.loose;
      if (heaps[p].why.empty()) take(std::move(heaps[p].solids));
      else alone(p, heaps[p].why);
    }
  }

  [[nodiscard]] auto box_of(const Parts& parts) const -> geometry::Box2 {
    geometry::Box2 box;
    for (const std::size_t p : parts)
      for (const auto v : parts_[p]->solid.vertices) box.add(geometry::xy(v));
    return box;
  }
  [[nodiscard]] auto boxes_meet(const Parts& a, const Parts& b) const -> bool {
    return box_of(a).grown(2e-3).overlaps(box_of(b));
  }

  /// A part that cannot be finished: as it is where it is valid, else its ground as a prism.
  void alone(std::size_t p, const std::string& why) {
    const LabelledSolid& part = *parts_[p];
    if (parts_.size() > 1) {
      if (reach_.prisms && over_plan(p, why)) return;
      ++out_.loose;
    }
    if (auto one = as_it_is(p)) {
      out_.solids.push_back(std::move(*one));
      return;
    }
    const LabelledSolid flat = prism_of(part);
    const std::array<const LabelledSolid*, 1> one{&flat};
    Attempt attempt = Uniting(one, reach_).united({0});
    if (!attempt.why.empty()) {
      out_.warnings.push_back(base::warning("solid-left-out", "no valid solid can be made of a part: " + why));
      return;
    }
    for (One& solid : attempt.solids) {
      solid.of = {p};
      std::ranges::fill(solid.part_of_face, static_cast<std::uint32_t>(p));
    }
    take(std::move(attempt.solids));
    out_.simplified.push_back(p);
    out_.warnings.push_back(base::warning("solid-simplified", "a part became a flat-roofed prism: " + why));
  }

  /// A part's solid, with its narrow faces cut into triangles if it is valid then.
  [[nodiscard]] auto as_it_is(std::size_t p) const -> std::optional<One> {
    const LabelledSolid& part = *parts_[p];
    const auto number = static_cast<std::uint32_t>(p);
    if (check(part.solid, written_rules()).empty())
      return One{{p}, part, std::vector<std::uint32_t>(part.solid.faces.size(), number)};
    Union cut{part,
              std::vector<std::uint32_t>(part.solid.faces.size(), number),
              std::vector<std::uint8_t>(part.solid.vertices.size(), of_a_building),
              {}};
    if (!check(part.solid).empty() || !finish(cut, planar) || !check(cut.model.solid, written_rules()).empty())
      return std::nullopt;
    return One{{p}, std::move(cut.model), std::move(cut.solid_of_face)};
  }

  /// A prism on the corners that the plan of all has of its ground. False where that is no valid solid.
  auto over_plan(std::size_t p, const std::string& why) -> bool {
    if (!plan_ || !why_.empty()) return false;
    LabelledSolid ground;
    for (const auto& sheet : plan_->sheets) {
      if (sheet.solid != p || sheet.facing != Facing::down) continue;
      model::Face face{{}, model::FaceKind::base, {}, {0, 0, -1}};
      for (const auto& path : sheet.paths) {
        auto& loop = face.loops.emplace_back();
        for (const auto& node : path) {
          const auto& at = plan_->places[node.at];
          const auto metres = [](std::int64_t quanta) { return static_cast<double>(quanta) / quanta_per_metre; };
          loop.push_back(static_cast<std::uint32_t>(ground.solid.vertices.size()));
          ground.solid.vertices.push_back({metres(at[0]), metres(at[1]), metres(node.z - plan_->level)});
        }
      }
      ground.solid.faces.push_back(std::move(face));
      ground.classes.push_back(model::FaceClass::ground);
    }
    const double level = static_cast<double>(plan_->level) / quanta_per_metre;
    const auto height = [](double z) { return std::round(z * quanta_per_metre) / quanta_per_metre; };
    LabelledSolid flat = prism_over_ground(ground, height(roof_middle(*parts_[p]) - level));
    if (flat.solid.faces.empty() || !check(flat.solid, written_rules()).empty()) return false;
    place(flat.solid, *plan_);
    const std::vector<std::uint32_t> from(flat.solid.faces.size(), static_cast<std::uint32_t>(p));
    out_.solids.push_back({{p}, std::move(flat), from});
    out_.simplified.push_back(p);
    out_.warnings.push_back(base::warning("solid-simplified", "a part became a flat-roofed prism: " + why));
    return true;
  }

  /// The ground of a part raised to half-way between its lowest and its highest roof corner.
  static auto prism_of(const LabelledSolid& part) -> LabelledSolid {
    return prism_over_ground(part, roof_middle(part));
  }

  std::span<const LabelledSolid* const> parts_;
  Reach reach_;
  std::optional<Sheets> plan_;  ///< of all parts
  std::string why_;             ///< there is no plan of all
  United out_;
};

}  // namespace

auto roof_middle(const LabelledSolid& solid) -> double {
  double least = 1e300, most = -1e300;
  for (std::size_t f = 0; f < solid.solid.faces.size(); ++f)
    if (solid.classes[f] == model::FaceClass::roof)
      for (const auto v : solid.solid.faces[f].loops[0]) {
        least = std::min(least, solid.solid.vertices[v].z);
        most = std::max(most, solid.solid.vertices[v].z);
      }
  return (least + most) / 2;
}

auto united_by(std::span<const LabelledSolid* const> parts, const Reach& reach, std::optional<Sheets> plan) -> United {
  if (plan) return Uniting(parts, reach, std::move(*plan)).run();
  return Uniting(parts, reach).run();
}

}  // namespace mansard::solid::detail
