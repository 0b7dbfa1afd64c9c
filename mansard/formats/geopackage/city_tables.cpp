#include "mansard/formats/geopackage/city_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mansard/formats/detail/parts.hpp"
#include "mansard/solid/solid.hpp"

namespace mansard::formats::detail {
namespace {

using enum FieldType;
using model::Value;

auto as_integer(std::size_t number) -> Value { return static_cast<std::int64_t>(number); }

constexpr double degrees = 180 / std::numbers::pi;

/// Degrees from the horizontal.
auto slope_of(const FaceRow& row) -> double { return std::acos(std::clamp(row.face().normal.z, -1.0, 1.0)) * degrees; }

/// Degrees clockwise from north; absent below half a degree of slope, as in CityJSON.
auto azimuth_of(const FaceRow& row) -> Value {
  constexpr double level = 0.5;
  if (slope_of(row) < level) return {};
  const double azimuth = std::atan2(row.face().normal.x, row.face().normal.y) * degrees;
  return azimuth < 0 ? azimuth + 360 : azimuth;
}

auto area_of(const FaceRow& row) -> Value { return solid::area(row.model.solid, row.face()); }

auto roof_class(const FaceRow& row) -> Value {
  constexpr double flat = 5;  // degrees, as of ms_area_roof_flat
  return std::string(slope_of(row) <= flat ? "flat" : "sloped");
}

auto profile_json(const model::Profile& profile) -> std::string {
  JsonText json;
  json.begin_array();
  for (const auto& point : profile) json.begin_array().number(point.inward).number(point.height).end_array();
  return std::move(json.end_array()).str();
}

}  // namespace

const CityTable<BuildingRow> gis_footprints_table{
    "gis_footprints",
    "The footprints as they were read, with their own attributes and those of the buildings",
    wkbMultiPolygon,
    {{"building_id", string, [](const BuildingRow& row) -> Value { return row.building.id; }},
     {"parts", integer, [](const BuildingRow& row) -> Value { return as_integer(row.building.parts.size()); }},
     {"ground", real, [](const BuildingRow& row) -> Value { return row.pen.height(row.building.ground); }}}};

const CityTable<PartRow> footprints_table{
    "footprints",
    "The plans of the parts, with the attributes of their models",
    wkbPolygon,
    {{"building_id", string, [](const PartRow& row) -> Value { return row.building; }},
     {"part_id", string, [](const PartRow& row) -> Value { return row.part.id; }},
     {"base", real, [](const PartRow& row) -> Value { return row.pen.height(row.part.plan.base); }},
     {"top", real, [](const PartRow& row) -> Value { return row.pen.height(row.part.plan.base + row.part.plan.cap); }},
     {"area", real, [](const PartRow& row) -> Value { return geometry::area(row.outline); }}}};

const CityTable<EdgeRow> edges_table{
    "edges",
    "The edges of the plans; the part is on their left",
    wkbLineString,
    {{"building_id", string, [](const EdgeRow& row) -> Value { return row.building; }},
     {"part_id", string, [](const EdgeRow& row) -> Value { return row.part; }},
     {"ring", integer, [](const EdgeRow& row) -> Value { return as_integer(row.ring_number); }},
     {"edge", integer, [](const EdgeRow& row) -> Value { return as_integer(row.edge); }},
     {"profile", integer, [](const EdgeRow& row) -> Value { return as_integer(row.ring.profile_of_edge[row.edge]); }},
     {"length", real,
      [](const EdgeRow& row) -> Value {
        const auto& points = row.ring.points;
        return length(points[(row.edge + 1) % points.size()] - points[row.edge]);
      }},
     {"party", boolean, [](const EdgeRow& row) { return row.party; }}}};

const CityTable<FaceRow> roof_planes_table{
    "roof_planes",
    "The faces of the roofs",
    wkbMultiPolygon25D,
    {{"building_id", string, [](const FaceRow& row) -> Value { return row.building; }},
     {"part_id", string, [](const FaceRow& row) -> Value { return row.part; }},
     {"face", integer, [](const FaceRow& row) -> Value { return as_integer(row.number); }},
     {"class", string, roof_class},
     {"slope", real, [](const FaceRow& row) -> Value { return slope_of(row); }},
     {"azimuth", real, azimuth_of},
     {"area", real, area_of}}};

const CityTable<FaceRow> walls_table{
    "walls",
    "The walls, which stand upright: in plan they are lines",
    wkbMultiPolygon25D,
    {{"building_id", string, [](const FaceRow& row) -> Value { return row.building; }},
     {"part_id", string, [](const FaceRow& row) -> Value { return row.part; }},
     {"face", integer, [](const FaceRow& row) -> Value { return as_integer(row.number); }},
     {"class", string,
      [](const FaceRow& row) -> Value { return std::string(class_name(row.model.classes[row.number])); }},
     {"azimuth", real, azimuth_of},
     {"area", real, area_of},
     {"ring", integer,
      [](const FaceRow& row) { return row.face().provenance ? as_integer(row.face().provenance->ring) : Value(); }},
     {"edge", integer,
      [](const FaceRow& row) { return row.face().provenance ? as_integer(row.face().provenance->edge) : Value(); }}}};

const CityTable<ProfileRow> profiles_table{
    "profiles",
    "The profiles that edges rise along: [inward, height] in metres from the foot of the edge",
    wkbNone,
    {{"building_id", string, [](const ProfileRow& row) -> Value { return row.building; }},
     {"part_id", string, [](const ProfileRow& row) -> Value { return row.part; }},
     {"profile", integer, [](const ProfileRow& row) -> Value { return as_integer(row.number); }},
     {"points", string, [](const ProfileRow& row) -> Value { return profile_json(row.profile); }}}};

const CityTable<MadeByRow> made_by_table{"made_by",
                                         "How this file was made",
                                         wkbNone,
                                         {{"name", string, [](const MadeByRow& row) -> Value { return row.name; }},
                                          {"value", string, [](const MadeByRow& row) -> Value { return row.value; }}}};

const CityTable<RecordRow> records_table{
    "mansard_records",
    "What mansard reads this file back from: plan + profiles",
    wkbNone,
    {{record_kind, string, [](const RecordRow& row) -> Value { return std::string(row.kind); }},
     {"id", string, [](const RecordRow& row) { return row.id; }},
     {record_json, string, [](const RecordRow& row) -> Value { return row.json; }}}};

}  // namespace mansard::formats::detail
