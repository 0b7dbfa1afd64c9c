#include "mansard/formats/detail/flat_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "mansard/solid/flat_roof.hpp"
#include "mansard/solid/unite.hpp"

namespace mansard::formats::detail {
namespace {

using model::FaceClass;

/// The prisms over the ground surfaces at each of some heights, as one solid. Empty where they are none. `lowered`: all
/// stand as low as the lowest.
auto prisms_over(const model::LabelledSolid& model, const std::set<double>& levels, double top, bool lowered)
    -> std::vector<Surface> {
  std::vector<model::LabelledSolid> prisms;
  for (const double level : levels) {
    auto& part = prisms.emplace_back(model);
    for (std::size_t f = part.classes.size(); f-- > 0;) {
      if (part.classes[f] != FaceClass::ground) continue;
      auto& faces = part.solid.faces;
      if (part.solid.vertices[faces[f].loops[0][0]].z == level) continue;
      faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(f));
      part.classes.erase(part.classes.begin() + static_cast<std::ptrdiff_t>(f));
    }
    if (lowered)
      for (auto& v : part.solid.vertices) v.z = *levels.begin();
    part = solid::prism_over_ground(part, top);
    if (part.solid.faces.empty()) return {};
  }
  std::vector<const model::LabelledSolid*> all;
  for (const auto& prism : prisms) all.push_back(&prism);
  const auto united = solid::unite(all);
  if (united.solids.size() != 1 || !united.warnings.empty()) return {};
  return quantised(united.solids.front().model);
}

/// Whether solid::check finds nothing by the rules for files.
auto is_valid(const std::vector<Surface>& surfaces) -> bool {
  return solid::check(solid_of(surfaces).solid, solid::written_rules()).empty();
}

/// In plan.
auto ground_corners(const std::vector<Surface>& surfaces) -> std::set<std::array<std::int64_t, 2>> {
  std::set<std::array<std::int64_t, 2>> out;
  for (const Surface& surface : surfaces)
    if (surface.kind == FaceClass::ground)
      for (const auto& loop : surface.loops)
        for (const Vertex& v : loop) out.insert({v[0], v[1]});
  return out;
}

}  // namespace

auto solid_of(const std::vector<Surface>& surfaces) -> model::LabelledSolid {
  model::LabelledSolid out;
  std::map<Vertex, std::uint32_t> numbers;
  for (const Surface& surface : surfaces) {
    auto& face = out.solid.faces.emplace_back();
    face.normal = surface.normal;
    face.kind = surface.kind == FaceClass::ground                          ? model::FaceKind::base
                : surface.kind == FaceClass::roof && surface.normal.z == 1 ? model::FaceKind::cap
                                                                           : model::FaceKind::side;
    out.classes.push_back(surface.kind);
    for (const auto& corners : surface.loops) {
      auto& loop = face.loops.emplace_back();
      for (const Vertex& v : corners) {
        const auto [entry, added] = numbers.try_emplace(v, static_cast<std::uint32_t>(out.solid.vertices.size()));
        if (added)
          out.solid.vertices.push_back({static_cast<double>(v[0]) / quanta_per_metre,
                                        static_cast<double>(v[1]) / quanta_per_metre,
                                        static_cast<double>(v[2]) / quanta_per_metre});
        loop.push_back(entry->second);
      }
    }
  }
  return out;
}

auto flat_model(const model::LabelledSolid& model, const std::vector<Surface>& fine, double top)
    -> std::vector<Surface> {
  std::set<double> levels;
  for (std::size_t f = 0; f < model.classes.size(); ++f)
    if (model.classes[f] == FaceClass::ground) levels.insert(model.solid.vertices[model.solid.faces[f].loops[0][0]].z);
  if (levels.size() > 1 && std::isfinite(top))
    for (const bool lowered : {false, true})
      if (auto made = prisms_over(model, levels, top, lowered); !made.empty() && is_valid(made)) return made;
  if (std::isfinite(top) && levels.size() == 1)
    if (const auto flat = solid::flat_roof(solid_of(fine), top); !flat.solid.faces.empty()) return quantised(flat);
  if (auto prism = flat_prism(fine, top); is_valid(prism)) return prism;
  if (!std::isfinite(top)) return {};
  return quantised(solid::prism_over_outline(model, std::round(top * quanta_per_metre) / quanta_per_metre));
}

auto roof_height(const std::vector<Surface>& surfaces, const model::Attributes& attributes, std::int64_t origin)
    -> double {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double least = infinity, most = -infinity, bottom = infinity;
  for (const Surface& surface : surfaces)
    for (const auto& loop : surface.loops)
      for (const Vertex& v : loop) {
        const double z = static_cast<double>(v[2]) / quanta_per_metre;
        bottom = std::min(bottom, z);
        if (surface.kind != FaceClass::roof) continue;
        least = std::min(least, z);
        most = std::max(most, z);
      }
  for (const auto& [name, value] : attributes)
    if (const double* height = std::get_if<double>(&value); height != nullptr && name == "ms_h_roof_70p")
      if (const double z = *height - static_cast<double>(origin); z > bottom && z <= most) return z;
  return 0.5 * (least + most);
}

auto LevelSurfaces::at(Lod lod) const -> const std::vector<Surface>& {
  switch (lod) {
    case Lod::lod12: return lod12;
    case Lod::lod13: return lod13;
    case Lod::lod20: return lod20;
    default: return lod22;
  }
}

auto level_surfaces(const model::LabelledSolid& model, const model::Attributes& attributes, const model::Frame& frame,
                    const Lods& wanted, const solid::LevelOptions& options, bool alone) -> LevelSurfaces {
  const auto has = [&](Lod lod) { return std::ranges::find(wanted, lod) != wanted.end(); };
  LevelSurfaces out;
  auto fine = quantised(model);
  if (has(Lod::lod12) || has(Lod::lod13))
    out.lod12 = flat_model(model, fine, roof_height(fine, attributes, frame.origin[2]));
  if (has(Lod::lod13) || has(Lod::lod20)) {
    // From what is written, so that what was read back gives the same.
    const auto main = solid::main_roofs(solid_of(fine), options);
    if (has(Lod::lod20)) out.lod20 = quantised(main);
    if (has(Lod::lod13)) out.lod13 = quantised(solid::flat_pieces(main, options));
    if (has(Lod::lod13) && out.lod13.empty()) out.lod13 = out.lod12;
  }
  if (!alone) {
    const auto ground = ground_corners(fine);
    const auto lacks_some = [&](const std::vector<Surface>& level) {
      return !level.empty() && ground_corners(level) != ground;
    };
    if (lacks_some(out.lod12))
      if (auto prism = flat_prism(fine, roof_height(fine, attributes, frame.origin[2])); is_valid(prism))
        out.lod12 = std::move(prism);
    if (lacks_some(out.lod13)) out.lod13 = out.lod12;
    if (lacks_some(out.lod20)) out.lod20 = fine;
  }
  if (!has(Lod::lod12)) out.lod12.clear();
  if (has(Lod::lod22)) out.lod22 = std::move(fine);
  return out;
}

namespace {

auto lowest(const model::LabelledSolid& model) -> double {
  double z = std::numeric_limits<double>::infinity();
  for (const auto& v : model.solid.vertices) z = std::min(z, v.z);
  return z;
}

/// A solid at a level of detail, and as it is at LoD 2.2.
struct AtLevel {
  std::vector<Surface>* level;
  const std::vector<Surface>* fine;
};

/// Makes those that share space as they are at LoD 2.2.
void keep_apart(const std::vector<AtLevel>& solids) {
  std::vector<model::LabelledSolid> models;
  for (const auto& one : solids) models.push_back(solid_of(*one.level));
  std::vector<bool> is_fine(solids.size(), false);
  const auto make_fine = [&](std::size_t i) {
    if (is_fine[i]) return false;
    is_fine[i] = true;
    *solids[i].level = *solids[i].fine;
    models[i] = solid_of(*solids[i].fine);
    return true;
  };
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < models.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const std::array<const model::LabelledSolid*, 2> two{&models[k], &models[i]};
        if (solid::overlapping(two).empty()) continue;
        const bool first = make_fine(i), second = make_fine(k);
        again = again || first || second;
      }
  }
}

}  // namespace

auto level_surfaces(const Drawn& drawn, const model::Frame& frame, const Lods& wanted,
                    const solid::LevelOptions& options) -> std::vector<LevelSurfaces> {
  std::vector<LevelSurfaces> out;
  bool stacked = false;
  for (const auto& [part, parts] : drawn.solids) {
    out.push_back(level_surfaces(part.model, part.attributes, frame, wanted, options, drawn.solids.size() == 1));
    stacked = stacked || lowest(part.model) != lowest(drawn.solids.front().part.model);
  }
  if (!stacked) return out;
  std::vector<std::vector<Surface>> fine;
  for (const auto& [part, parts] : drawn.solids) fine.push_back(quantised(part.model));
  for (auto level : {&LevelSurfaces::lod12, &LevelSurfaces::lod13, &LevelSurfaces::lod20}) {
    std::vector<AtLevel> all;
    for (std::size_t i = 0; i < out.size(); ++i)
      if (!(out[i].*level).empty()) all.push_back({&(out[i].*level), &fine[i]});
    keep_apart(all);
  }
  return out;
}

auto LevelOf::of(const WriteOptions& options, Format format) -> base::Result<LevelOf> {
  const auto lods = lods_of(options.lod, format);
  if (!lods) return lods.failure();
  return LevelOf{lods->back(), options.levels};
}

void LevelOf::apply(Drawn& drawn, const model::Frame& frame) const {
  if (lod == Lod::lod22) return;
  const auto made = level_surfaces(drawn, frame, {lod}, options);
  for (std::size_t i = 0; i < made.size(); ++i)
    if (!made[i].at(lod).empty()) drawn.solids[i].part.model = solid_of(made[i].at(lod));
}

}  // namespace mansard::formats::detail
