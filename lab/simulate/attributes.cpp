#include "lab/simulate/attributes.hpp"

namespace mansard::simulate {

auto attributes() -> std::vector<formats::Attribute> {
  return {{"ms_role",
           "simulate",
           {"BuildingPart"},
           "string",
           "",
           "What the part is to its building: house, annex, extension, wing, bay window, dormer, plant room, podium, "
           "tower, "
           "garage or parapet."},
          {"ms_eaves", "simulate", {"BuildingPart"}, "number", "m", "z at which the roof begins."}};
}

}  // namespace mansard::simulate
