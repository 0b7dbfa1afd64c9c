// Tags of OpenStreetMap, whatever a source makes of their names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mansard/model/attributes.hpp"

namespace mansard::formats {

/// The value of a tag as text, or nothing: as an attribute of that name in any case, with '_' for ':', cut to the ten
/// letters of a Shapefile; else in the text of other_tags, all_tags or tags, which is hstore or JSON.
[[nodiscard]] auto tag_of(const model::Attributes& attributes, std::string_view tag) -> std::string;

/// What a feature is to a building with parts. One that is tagged as both is an outline, and one of its parts.
struct BuildingRole {
  bool outline = false;  ///< `building` is there and not "no"
  bool part = false;     ///< `building:part` is
};
[[nodiscard]] auto role_of(const model::Attributes& attributes) -> BuildingRole;

/// A relation type=building that a feature is a member of.
struct BuildingRelation {
  std::string id;    ///< "relation/4"
  std::string role;  ///< "outline", "part", or empty where that is not known
};
/// From the attribute "@relations", as exports of Overpass have it: a JSON list of objects with rel, role and reltags.
[[nodiscard]] auto relations_of(const model::Attributes& attributes) -> std::vector<BuildingRelation>;
/// The same attribute for the relations of one feature.
[[nodiscard]] auto relations_text(const std::vector<BuildingRelation>& relations) -> std::string;

inline constexpr const char* relations_attribute = "@relations";

}  // namespace mansard::formats
