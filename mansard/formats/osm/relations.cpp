#include "mansard/formats/osm/relations.hpp"

#include <ogrsf_frmts.h>
#include <algorithm>
#include <mutex>
#include <string_view>

#include "mansard/formats/osm/tags.hpp"

namespace mansard::formats {
namespace {

// The sections and attributes of GDAL's own osmconf.ini that matter to areas.
constexpr std::string_view configuration =
    "closed_ways_are_polygons=aeroway,amenity,boundary,building,building:part,craft,geological,historic,landuse,"
    "leisure,military,natural,office,place,shop,sport,tourism,highway=platform,public_transport=platform\n"
    "[multipolygons]\nosm_id=yes\n"
    "attributes=name,type,aeroway,amenity,admin_level,barrier,boundary,building,craft,geological,historic,land_area,"
    "landuse,leisure,man_made,military,natural,office,place,shop,sport,tourism\n"
    "ignore=area,created_by,converted_by,source,time,ele,note,todo,openGeoDB:,fixme,FIXME\n"
    "[other_relations]\nosm_id=yes\nattributes=name,type\n";

template <class Points>
auto corners_of(const Points& points) {
  std::vector<std::pair<double, double>> out;
  for (const auto& p : points) out.emplace_back(p.x, p.y);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

auto points_of(const OGRSimpleCurve& line) -> geometry::Ring {
  geometry::Ring out;
  for (int i = 0; i < line.getNumPoints(); ++i) out.push_back({line.getX(i), line.getY(i)});
  return out;
}

void collect_ways(const OGRGeometry& geometry, std::vector<geometry::Ring>& ways) {
  const auto type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbLineString) ways.push_back(points_of(*geometry.toLineString()));
  if (type == wkbPolygon)
    if (const auto* ring = geometry.toPolygon()->getExteriorRing()) ways.push_back(points_of(*ring));
  if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != 0)
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) collect_ways(*part, ways);
}

}  // namespace

auto osm_configuration() -> std::string {
  static const std::string path = "/vsimem/mansard/osmconf.ini";
  static std::once_flag once;
  std::call_once(once, [] {
    VSILFILE* file = VSIFOpenL(path.c_str(), "wb");
    if (file == nullptr) return;
    VSIFWriteL(configuration.data(), 1, configuration.size(), file);
    VSIFCloseL(file);
  });
  return path;
}

void BuildingRelations::add(const std::string& id, const OGRGeometry& members) {
  std::vector<geometry::Ring> ways;
  collect_ways(members, ways);
  for (const auto& way : ways) {
    auto& relations = of_way_[corners_of(way)];
    if (std::ranges::find(relations, id) == relations.end()) relations.push_back(id);
  }
}

void BuildingRelations::mark(std::vector<RawFeature>& features) const {
  if (of_way_.empty()) return;
  for (auto& feature : features) {
    if (feature.parts.size() != 1 || feature.parts.front().size() != 1) continue;  // no closed way
    const auto found = of_way_.find(corners_of(feature.parts.front().front()));
    if (found == of_way_.end()) continue;
    std::vector<BuildingRelation> relations;
    for (const auto& id : found->second) relations.push_back({id, {}});
    feature.attributes.emplace_back(relations_attribute, relations_text(relations));
  }
}

}  // namespace mansard::formats
