// What an attribute that models carry means. Every room that gives models attributes lists them; the lists are what
// `mansard options --attributes` and the docs are made of, and the tests hold the written files against them.
#pragma once

#include <string>
#include <vector>

namespace mansard::formats {

/// One attribute of a city's objects, beside those of their source.
struct Attribute {
  std::string name;             ///< "ms_h_ground"
  std::string room;             ///< the room whose work it tells of
  std::vector<std::string> of;  ///< the CityJSON objects and surfaces that have it: "Building", "RoofSurface"
  std::string type;             ///< "number", "text", "flag" or "object"; "text?" may be null
  std::string unit;             ///< "m", "m²", "m³", "°"; empty for none
  std::string meaning;          ///< a sentence, with the condition under which it is there
};

/// Those that the files themselves need.
[[nodiscard]] auto attributes() -> std::vector<Attribute>;

}  // namespace mansard::formats
