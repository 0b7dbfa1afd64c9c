#include "mansard/label/label.hpp"
#include "mansard/solid/solid.hpp"

#include <cmath>

#include "mansard/geometry/angles.hpp"
#include "mansard/label/detail/walls.hpp"

namespace mansard::label {
namespace {

auto class_of(const model::Face& face, double lean) -> model::FaceClass {
  switch (face.kind) {
    case model::FaceKind::base: return model::FaceClass::ground;
    case model::FaceKind::soffit: return model::FaceClass::soffit;
    case model::FaceKind::connector: return model::FaceClass::wall;
    case model::FaceKind::side:
      return std::abs(face.normal.z) <= lean ? model::FaceClass::wall : model::FaceClass::roof;
    case model::FaceKind::terrace:
    case model::FaceKind::cap: return model::FaceClass::roof;
  }
  return model::FaceClass::roof;
}

}  // namespace

auto option_list(Options& o) -> base::OptionList {
  base::OptionList list("label");
  list.number("wall_angle", o.wall_angle, "rad", {0, 1.5},
              "Maximum angle from vertical of a wall; a side that leans more is roof.")
      .source("reference implementation chordatlas: 0.2 rad");
  list.number("party_distance", o.party_distance, "m", {0, 2},
              "Maximum distance of a party wall from a neighbour's opposite wall.")
      .source("as block.touch; not measured");
  list.number("party_share", o.party_share, "", {0, 1},
              "Share of a wall's area that must face opposite walls for it to be a party wall.")
      .advanced("most of it: one class a face is all that files can say");
  list.number("party_cosine", o.party_cosine, "", {0, 1},
              "Cosine of the maximum angle between a wall and the reverse of an opposite one.")
      .advanced("chosen by hand; not measured");
  return list;
}

auto classify(std::vector<model::Solid> solids, const Options& options, const base::Run& run)
    -> std::vector<model::LabelledSolid> {
  run.report("label", {}, 0);
  // A face leaning by a from vertical has a normal with |z| = sin a.
  const double lean = geometry::sine(options.wall_angle);
  std::vector<model::LabelledSolid> labelled(solids.size());
  std::vector<std::vector<bool>> is_wall(solids.size());
  for (std::size_t s = 0; s < solids.size(); ++s) {
    for (const auto& face : solids[s].faces) {
      labelled[s].classes.push_back(class_of(face, lean));
      is_wall[s].push_back(labelled[s].classes.back() == model::FaceClass::wall);
    }
  }

  const auto walls = detail::walls_of(solids, is_wall);
  std::vector<double> shares(walls.all.size(), 0);
  base::parallel_for(shares.size(), [&](std::size_t i) {
    if (!run.cancelled()) shares[i] = detail::covered_share(walls.all[i], walls, solids, options);
  });
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (const auto& wall = walls.all[i]; shares[i] > options.party_share)
      labelled[wall.solid].classes[wall.face] = model::FaceClass::party_wall;

  for (std::size_t s = 0; s < solids.size(); ++s) labelled[s].solid = std::move(solids[s]);
  run.report("label", {}, 1);
  return labelled;
}

auto areas(const model::LabelledSolid& labelled) -> Areas {
  constexpr double flat = 0.9962;  // cosine of 5°: 3DBAG's definition of a flat roof
  Areas sum;
  for (std::size_t f = 0; f < labelled.solid.faces.size(); ++f) {
    const auto& face = labelled.solid.faces[f];
    const double area = solid::area(labelled.solid, face);
    switch (labelled.classes[f]) {
      case model::FaceClass::wall: sum.wall += area; break;
      case model::FaceClass::party_wall: sum.party_wall += area; break;
      case model::FaceClass::ground: sum.ground += area; break;
      case model::FaceClass::soffit: sum.soffit += area; break;
      case model::FaceClass::roof: (face.normal.z >= flat ? sum.roof_flat : sum.roof_sloped) += area; break;
    }
  }
  return sum;
}

}  // namespace mansard::label
