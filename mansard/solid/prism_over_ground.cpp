#include <map>
#include <utility>

#include "mansard/solid/unite.hpp"

namespace mansard::solid {

using model::LabelledSolid;

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
