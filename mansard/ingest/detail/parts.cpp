#include "mansard/ingest/detail/parts.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "mansard/formats/osm/tags.hpp"
#include "mansard/geometry/box_index.hpp"

namespace mansard::ingest::detail {
namespace {

using geometry::Polygon;
using model::Footprint;

/// What a feature is to others.
struct Member {
  Footprint* footprint = nullptr;
  formats::BuildingRole role;
  std::vector<formats::BuildingRelation> relations;
  double area = 0;  ///< m²

  [[nodiscard]] auto is_usable() const -> bool { return !footprint->polygons.empty(); }
};

auto area_of(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

/// m² that two have in common. Where that cannot be computed, by the corners of the first.
auto shared_area(const Footprint& part, const Footprint& outline) -> double {
  double sum = 0;
  for (const auto& a : part.polygons)
    for (const auto& b : outline.polygons) {
      if (!geometry::bounds(a.outer).overlaps(geometry::bounds(b.outer))) continue;
      if (const auto both = geometry::intersect(a, b)) {
        sum += area_of(*both);
      } else {
        const auto inside = std::ranges::count_if(a.outer, [&](auto p) { return geometry::contains(b, p); });
        sum += geometry::area(a) * static_cast<double>(inside) / static_cast<double>(a.outer.size());
      }
    }
  return sum;
}

class Joining {
 public:
  explicit Joining(model::Scene& scene) {
    for (auto* list : {&scene.footprints, &scene.surroundings})
      for (auto& footprint : *list)
        members_.push_back({&footprint, formats::role_of(footprint.attributes),
                            formats::relations_of(footprint.attributes), area_of(footprint.polygons)});
    std::vector<geometry::Box2> boxes;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      auto& member = members_[m];
      for (const auto& [id, role] : member.relations) {
        if (role == "outline") member.role.outline = true;
        if (role == "part" && !member.role.outline) member.role.part = true;
      }
      const bool is_outline = member.role.outline && member.is_usable();
      boxes.push_back(is_outline ? geometry::bounds(member.footprint->polygons) : geometry::Box2());
      if (!is_outline) continue;
      for (const auto& [id, role] : member.relations)
        if (role != "part") outlines_of_[id].push_back(m);
    }
    index_ = geometry::BoxIndex(boxes);
  }

  /// The outline of every feature that is a part of another one.
  auto owners() -> std::vector<std::optional<std::size_t>> {
    std::vector<std::optional<std::size_t>> out(members_.size());
    for (std::size_t m = 0; m < members_.size(); ++m)
      if (is_part(members_[m])) out[m] = owner_of(m);
    return out;
  }

  [[nodiscard]] auto members() -> std::vector<Member>& { return members_; }
  [[nodiscard]] static auto is_part(const Member& member) -> bool {
    return member.role.part && !member.role.outline && member.is_usable();
  }

 private:
  auto owner_of(std::size_t m) const -> std::optional<std::size_t> {
    const Member& part = members_[m];
    // What a relation says, wherever the part is: it may overhang the outline, or be beside it.
    for (const auto& [id, role] : part.relations)
      if (const auto found = outlines_of_.find(id); found != outlines_of_.end())
        return std::ranges::max(found->second, {}, [&](std::size_t o) {
          return std::pair(shared_area(*part.footprint, *members_[o].footprint), members_.size() - o);
        });
    constexpr double least = 0.5, same = 0.05;  // shares of the part
    double most = 0;
    std::vector<std::pair<double, std::size_t>> found;
    for (const auto o : index_.overlapping(geometry::bounds(part.footprint->polygons))) {
      const double share = shared_area(*part.footprint, *members_[o].footprint) / part.area;
      most = std::max(most, share);
      found.emplace_back(share, o);
    }
    if (most < least) return std::nullopt;
    std::erase_if(found, [&](const auto& one) { return one.first < most - same; });
    return std::ranges::min(found, {},
                            [&](const auto& one) { return std::pair(members_[one.second].area, one.second); })
        .second;
  }

  std::vector<Member> members_;
  std::map<std::string, std::vector<std::size_t>> outlines_of_;  ///< by relation
  geometry::BoxIndex index_;
};

}  // namespace

void join_parts(model::Scene& scene, const std::string& subject, std::vector<base::Diagnostic>& warnings) {
  Joining joining(scene);
  auto& members = joining.members();
  if (std::ranges::none_of(members, Joining::is_part)) return;
  const auto owners = joining.owners();
  std::vector<bool> gone(members.size(), false);
  constexpr std::size_t shown = 5;
  std::size_t parts = 0, buildings = 0, alone = 0;
  std::string names;
  const std::size_t asked = scene.footprints.size();
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!Joining::is_part(members[m])) continue;
    if (owners[m] && m < asked && *owners[m] >= asked) continue;  // asked for by itself
    auto& part = *members[m].footprint;
    if (!owners[m]) {
      if (m < asked && alone++ < shown) names += (names.empty() ? "" : ", ") + part.id;
      continue;
    }
    auto& outline = *members[*owners[m]].footprint;
    if (outline.parts.empty()) {
      if (*owners[m] < asked) ++buildings;
      if (members[*owners[m]].role.part) outline.parts.push_back({outline.id, outline.polygons, outline.attributes});
    }
    if (*owners[m] < asked) ++parts;
    outline.parts.push_back({part.id, std::move(part.polygons), std::move(part.attributes)});
    gone[m] = true;
  }
  std::size_t next = 0;
  for (auto* list : {&scene.footprints, &scene.surroundings})
    std::erase_if(*list, [&](const auto&) { return gone[next++]; });
  if (parts > 0)
    warnings.push_back(base::warning("ingest-parts",
                                     std::to_string(parts) + " features tagged building:part are parts of " +
                                         std::to_string(buildings) + " buildings, and no buildings of their own",
                                     subject));
  if (alone > 0)
    warnings.push_back(base::warning("ingest-part-alone",
                                     std::to_string(alone) +
                                         " features tagged building:part are in no outline of a building; each is a "
                                         "building of its own: " +
                                         names + (alone > shown ? ", …" : ""),
                                     subject));
}

}  // namespace mansard::ingest::detail
