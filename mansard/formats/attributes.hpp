// The meaning of the attributes of models. Every module that gives models attributes lists them. `mansard options
// --attributes` and the docs are made from these lists, and the tests compare the written files with them.
#pragma once

#include <string>
#include <vector>

namespace mansard::formats {

/// One attribute of a city's objects, beside those of their source.
struct Attribute {
  std::string name;             ///< "ms_h_ground"
  std::string module;           ///< the module that the value comes from
  std::vector<std::string> of;  ///< the CityJSON objects and surfaces that have it: "Building", "RoofSurface"
  std::string type;             ///< "number", "text", "flag" or "object"; "text?" may be null
  std::string unit;             ///< "m", "m²", "m³", "°"; empty for none
  std::string meaning;          ///< a sentence, with the condition under which models have it
};

/// Those that the formats themselves write.
[[nodiscard]] auto attributes() -> std::vector<Attribute>;

}  // namespace mansard::formats
