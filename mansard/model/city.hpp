// A city of building models: features, their parts with plan and profiles, and the solids made of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mansard/geometry/polygon.hpp"
#include "mansard/model/attributes.hpp"
#include "mansard/model/frame.hpp"
#include "mansard/model/plan.hpp"
#include "mansard/model/solid.hpp"
#include "mansard/model/texture.hpp"

namespace mansard::model {

/// One footprint of the segmentation, raised.
struct Part {
  std::string id;
  Plan plan;
  LabelledSolid model;
  Attributes attributes;  ///< with prefix ms_
};

/// A solid made of parts.
struct PartsSolid {
  std::vector<std::size_t> parts;  ///< by their place in the building, rising
  LabelledSolid model;
  std::vector<std::uint32_t> part_of_face{};  ///< the part that each face comes from; empty where that is not known
};

/// One GIS feature with the parts that overlap it most.
struct Building {
  std::string id;
  Attributes attributes;                     ///< the source's own, then those with prefix ms_
  std::vector<geometry::Polygon> footprint;  ///< the GIS polygons, for LoD 0
  double ground = 0;                         ///< z, metres
  std::vector<Part> parts;
  std::vector<PartsSolid> solids{};  ///< what is written of it: the union of its parts; empty where it was not made
  std::optional<BuildingTexture> texture{};  ///< of the solids as they are written; none: without textures
};

/// How the city was made, repeated in every file.
struct MadeBy {
  std::string version;
  /// module.name → value, as text: all ordinary options, and those advanced ones that are not at their default.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<InputFile> inputs;
  std::vector<std::pair<std::string, std::string>> every_option;  ///< all options, for run.json only
};

struct City {
  Frame frame;
  MadeBy made_by;
  std::vector<Building> buildings;
};

}  // namespace mansard::model
