#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "mansard/geometry/change.hpp"
#include "mansard/model/file_grid.hpp"
#include "mansard/solid/detail/uniting.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::solid {

using model::LabelledSolid;

namespace {

using geometry::Polygon;

auto grown(const std::vector<Polygon>& polygons, double by) -> std::optional<std::vector<Polygon>> {
  std::vector<Polygon> all;
  for (const auto& polygon : polygons) {
    const auto one = geometry::buffer(polygon, by);
    if (!one) return std::nullopt;
    all.insert(all.end(), one->begin(), one->end());
  }
  auto united = geometry::unite(all);
  if (!united) return std::nullopt;
  return std::move(*united);
}

/// On the grid of files, without corners that become one there. No corners where nothing is left.
auto rounded(const geometry::Ring& ring) -> geometry::Ring {
  geometry::Ring out;
  constexpr double near = model::least_apart / model::quanta_per_metre;
  for (const auto p : ring) {
    const geometry::Point2 q{std::round(p.x * model::quanta_per_metre) / model::quanta_per_metre,
                             std::round(p.y * model::quanta_per_metre) / model::quanta_per_metre};
    if (out.empty() || length(q - out.back()) > near) out.push_back(q);
  }
  while (out.size() > 1 && length(out.front() - out.back()) <= near) out.pop_back();
  if (out.size() < 3) out.clear();
  return out;
}

auto prism_over(const Polygon& outline, double base, double z) -> LabelledSolid {
  LabelledSolid ground;
  model::Face face{{}, model::FaceKind::base, {}, {0, 0, -1}};
  const auto add = [&](const geometry::Ring& ring) {
    const auto own = rounded(ring);
    if (own.empty()) return;
    auto& loop = face.loops.emplace_back();
    for (const auto p : own) {
      loop.push_back(static_cast<std::uint32_t>(ground.solid.vertices.size()));
      ground.solid.vertices.push_back({p.x, p.y, base});
    }
    std::ranges::reverse(loop);
  };
  add(outline.outer);
  if (face.loops.empty()) return {};
  for (const auto& hole : outline.holes) add(hole);
  ground.solid.faces.push_back(std::move(face));
  ground.classes.push_back(model::FaceClass::ground);
  return prism_over_ground(ground, z);
}

/// m: half of how wide a place of an outline is that is closed or opened, the narrowest first.
constexpr std::array half_widths{2e-3, 1e-2, 5e-2};

struct Ground {
  std::vector<Polygon> polygons;
  double base = 0;  ///< m: z of its lowest corner
};
auto ground_polygons(const LabelledSolid& model, double z) -> Ground {
  Ground out{{}, z};
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    if (model.classes[f] != model::FaceClass::ground) continue;
    out.polygons.push_back(geometry::oriented(geometry::polygon_of(model.solid.faces[f].loops, [&](std::uint32_t v) {
      out.base = std::min(out.base, model.solid.vertices[v].z);
      return geometry::xy(model.solid.vertices[v]);
    })));
  }
  return out;
}

/// Grown, and shrunk again to the same outline.
auto without_gaps(const std::vector<Polygon>& polygons, double by) -> std::optional<std::vector<Polygon>> {
  const auto wide = grown(polygons, by);
  return wide ? grown(*wide, -by) : std::nullopt;
}

/// Shrunk, and grown again but for a millimetre: what falls apart stays apart.
auto without_necks(const std::vector<Polygon>& polygons, double by) -> std::optional<std::vector<Polygon>> {
  constexpr double apart = 1e-3;
  const auto narrow = grown(polygons, -by);
  return narrow ? grown(*narrow, by - apart) : std::nullopt;
}

auto area_of(const std::vector<Polygon>& polygons) -> double {
  double sum = 0;
  for (const auto& polygon : polygons) sum += geometry::area(polygon);
  return sum;
}

/// Valid solids over polygons; none where one of these has none.
auto valid_prisms(const std::vector<Polygon>& polygons, double base, double z) -> std::vector<LabelledSolid> {
  std::vector<LabelledSolid> out;
  for (const auto& polygon : polygons) {
    const auto prism = prism_over(polygon, base, z);
    if (prism.solid.faces.empty()) return {};
    const std::array<const LabelledSolid*, 1> alone{&prism};
    auto made = detail::united_by(alone, detail::Reach{});
    if (made.solids.empty() || !made.warnings.empty()) return {};
    for (auto& one : made.solids) out.push_back(std::move(one.model));
  }
  return out;
}

}  // namespace

auto detail::prisms_without_narrow_places(const LabelledSolid& part) -> std::vector<LabelledSolid> {
  constexpr double most_change = 0.01;  // of the area, as where a footprint is repaired
  const double z = std::round(roof_middle(part) * model::quanta_per_metre) / model::quanta_per_metre;
  const auto [ground, base] = ground_polygons(part, z);
  const double area = area_of(ground);
  for (const double by : half_widths)
    for (const auto& wide_enough : {without_gaps(ground, by), without_necks(ground, by)}) {
      if (!wide_enough || std::abs(area_of(*wide_enough) - area) > most_change * area) continue;
      if (auto prisms = valid_prisms(*wide_enough, base, z); !prisms.empty()) return prisms;
    }
  return {};
}

auto prism_over_outline(const LabelledSolid& model, double z) -> LabelledSolid {
  const auto [ground, base] = ground_polygons(model, z);
  for (const double by : half_widths) {
    const auto outline = without_gaps(ground, by);
    if (!outline || outline->size() != 1) continue;
    const auto prism = prism_over(outline->front(), base, z);
    if (prism.solid.faces.empty()) continue;
    const std::array<const LabelledSolid*, 1> alone{&prism};
    if (auto made = unite(alone); made.solids.size() == 1 && made.warnings.empty())
      return std::move(made.solids.front().model);
  }
  return {};
}

auto prism_over_ground(const LabelledSolid& model, double z) -> LabelledSolid {
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> party;
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f)
    for (const auto& loop : model.solid.faces[f].loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (model.classes[f] == model::FaceClass::party_wall) party[{loop[i], loop[(i + 1) % loop.size()]}] = true;
  LabelledSolid out;
  std::map<std::uint32_t, std::uint32_t> low;
  const auto vertex = [&](std::uint32_t v) {  // of the ground; that of the roof is the next
    const auto [entry, added] = low.try_emplace(v, static_cast<std::uint32_t>(out.solid.vertices.size()));
    if (added) {
      const auto p = model.solid.vertices[v];
      out.solid.vertices.push_back(p);
      out.solid.vertices.push_back({p.x, p.y, z});
    }
    return entry->second;
  };
  const auto add = [&](model::Face face, model::FaceClass kind) {
    out.solid.faces.push_back(std::move(face));
    out.classes.push_back(kind);
  };
  for (std::size_t f = 0; f < model.solid.faces.size(); ++f) {
    if (model.classes[f] != model::FaceClass::ground) continue;
    model::Face ground{{}, model::FaceKind::base, {}, {0, 0, -1}}, roof{{}, model::FaceKind::cap, {}, {0, 0, 1}};
    for (const auto& loop : model.solid.faces[f].loops) {
      auto& below = ground.loops.emplace_back();
      auto& above = roof.loops.emplace_back();
      for (std::size_t i = 0; i < loop.size(); ++i) {
        if (model.solid.vertices[loop[i]].z >= z) return {};
        const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()], a = vertex(from), b = vertex(to);
        below.push_back(a);
        above.insert(above.begin(), a + 1);
        const auto along = out.solid.vertices[a] - out.solid.vertices[b];  // as the wall runs, seen from outside
        add({{{b, a, a + 1, b + 1}},
             model::FaceKind::side,
             {},
             geometry::normalised(geometry::Point3{along.y, -along.x, 0})},
            party.contains({to, from}) ? model::FaceClass::party_wall : model::FaceClass::wall);
      }
    }
    add(std::move(ground), model::FaceClass::ground);
    add(std::move(roof), model::FaceClass::roof);
  }
  return out;
}

}  // namespace mansard::solid
