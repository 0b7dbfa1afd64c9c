// A second judge of solids: the rules that val3dity's error codes stand for (H. Ledoux, val3dity: validation of 3D GIS
// primitives according to the international standards, Open Geospatial Data, Software and Standards 3(1), 2018), from
// the text of a CityJSON file alone. It shares no code with solid::check() and decides on whole numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace val3dity {

struct Tolerances {
  double distance = 1e-4;  ///< m; of a corner from the plane fitted to its face: 203
  double angle = 20;       ///< degrees; of a triangle of a face from that plane: 204
};

struct Finding {
  int code = 0;
  std::string object;  ///< the key of the CityObject
  std::string what;
};

/// Codes 101, 102, 104, 201–208, 301–303, 305–307 of all solids. (103 cannot be in CityJSON, whose rings are closed.)
[[nodiscard]] auto findings(const nlohmann::json& city, const Tolerances& tolerances = {}) -> std::vector<Finding>;

/// Two solids of one level of detail whose plans overlap and whose heights do. The volume is at most `volume`: the
/// overlap in plan times that in height.
struct Overlap {
  int code = 0;  ///< 601 within a building, 501 between buildings
  std::string first, second;
  double area = 0, volume = 0;  ///< m², m³
  double width = 0;             ///< m; of the widest place that they share: its area over half of its perimeter
};
/// Pairs with more than `least` m³, by that bound. The solids must stand on GroundSurfaces that are their plans.
[[nodiscard]] auto overlaps(const nlohmann::json& city, const std::string& lod, double least) -> std::vector<Overlap>;

}  // namespace val3dity
