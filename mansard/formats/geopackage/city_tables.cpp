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

/// z, metres, of the lowest and the highest corner.
auto height_range(const FaceRow& row) -> std::pair<double, double> {
  const auto& corners = row.face().loops.front();
  const auto z = [&](std::uint32_t v) { return row.model.solid.vertices[v].z; };
  const auto [low, high] = std::ranges::minmax(corners, {}, z);
  return {z(low), z(high)};
}

auto surface_of(const LevelRow& row) -> double {
  double sum = 0;
  for (const auto& face : row.model.solid.faces) sum += solid::area(row.model.solid, face);
  return sum;
}

auto ground_of(const LevelRow& row) -> double {
  double sum = 0;
  for (std::size_t f = 0; f < row.model.classes.size(); ++f)
    if (row.model.classes[f] == model::FaceClass::ground) sum += solid::area(row.model.solid, row.model.solid.faces[f]);
  return sum;
}

auto extreme_height(const LevelRow& row, bool highest) -> Value {
  const auto& all = row.model.solid.vertices;
  const auto [low, high] = std::ranges::minmax(all, {}, &geometry::Point3::z);
  return row.pen.height(highest ? high.z : low.z);
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
     {"bottom", real, [](const FaceRow& row) -> Value { return row.pen.height(height_range(row).first); }},
     {"top", real, [](const FaceRow& row) -> Value { return row.pen.height(height_range(row).second); }},
     {"azimuth", real, azimuth_of},
     {"area", real, area_of}}};

const CityTable<FaceRow> walls_table{
    "walls",
    "The walls: where they stand in plan, from left to right as seen from outside",
    wkbLineString,
    {{"building_id", string, [](const FaceRow& row) -> Value { return row.building; }},
     {"part_id", string, [](const FaceRow& row) -> Value { return row.part; }},
     {"face", integer, [](const FaceRow& row) -> Value { return as_integer(row.number); }},
     {"class", string,
      [](const FaceRow& row) -> Value { return std::string(class_name(row.model.classes[row.number])); }},
     {"azimuth", real, azimuth_of},
     {"area", real, area_of},
     {"bottom", real, [](const FaceRow& row) -> Value { return row.pen.height(height_range(row).first); }},
     {"top", real, [](const FaceRow& row) -> Value { return row.pen.height(height_range(row).second); }},
     {"ring", integer,
      [](const FaceRow& row) { return row.face().provenance ? as_integer(row.face().provenance->ring) : Value(); }},
     {"edge", integer,
      [](const FaceRow& row) { return row.face().provenance ? as_integer(row.face().provenance->edge) : Value(); }}}};

const CityTable<LevelRow> solids_table{
    solids_name,
    "The solids of this level of detail",
    wkbPolyhedralSurfaceZ,
    {{"building_id", string, [](const LevelRow& row) -> Value { return row.building; }},
     {"solid", integer, [](const LevelRow& row) -> Value { return as_integer(row.number); }},
     {"volume", real, [](const LevelRow& row) -> Value { return solid::volume(row.model.solid); }},
     {"surface", real, [](const LevelRow& row) -> Value { return surface_of(row); }},
     {"faces", integer, [](const LevelRow& row) -> Value { return as_integer(row.model.solid.faces.size()); }},
     {"bottom", real, [](const LevelRow& row) { return extreme_height(row, false); }},
     {"top", real, [](const LevelRow& row) { return extreme_height(row, true); }}}};

const CityTable<LevelRow> grounds_table{
    grounds_name,
    "The ground of the solids of this level of detail",
    wkbMultiPolygon25D,
    {{"building_id", string, [](const LevelRow& row) -> Value { return row.building; }},
     {"solid", integer, [](const LevelRow& row) -> Value { return as_integer(row.number); }},
     {"area", real, [](const LevelRow& row) -> Value { return ground_of(row); }},
     {"bottom", real, [](const LevelRow& row) { return extreme_height(row, false); }},
     {"top", real, [](const LevelRow& row) { return extreme_height(row, true); }}}};

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
