// Relations type=building of OpenStreetMap's files, which OGR shows without the names of their members.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mansard/formats/vector/features.hpp"

class OGRGeometry;

namespace mansard::formats {

/// Where OGR reads how to read OpenStreetMap's files: as by default, but for closed ways with `building:part` alone,
/// which are areas too. The file is in memory.
[[nodiscard]] auto osm_configuration() -> std::string;

/// Members that are ways are known by their corners. Members that are relations are not known: OGR leaves them out.
class BuildingRelations {
 public:
  /// The members of a relation, as OGR has their geometries.
  void add(const std::string& id, const OGRGeometry& members);
  /// Gives every feature that is a member the attribute "@relations".
  void mark(std::vector<RawFeature>& features) const;
  void clear() { of_way_.clear(); }

 private:
  using Corners = std::vector<std::pair<double, double>>;  ///< sorted, none twice
  std::map<Corners, std::vector<std::string>> of_way_;
};

}  // namespace mansard::formats
