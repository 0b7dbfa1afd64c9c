// The tables that a city makes in a GeoPackage: each column once, with its name, its type and where its value is from.
// A column more is a line more in city_tables.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mansard/formats/geopackage/geopackage_tables.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats::detail {

template <class Row>
struct TableColumnOf {
  const char* name;
  FieldType type;
  model::Value (*value)(const Row&);
};

template <class Row>
struct CityTable {
  const char *name, *meaning;
  OGRwkbGeometryType geometry;
  std::vector<TableColumnOf<Row>> columns;

  [[nodiscard]] auto fields() const -> std::vector<Field> {
    std::vector<Field> out;
    for (const auto& column : columns) out.push_back({column.name, column.type});
    return out;
  }
  [[nodiscard]] auto values(const Row& row) const -> std::vector<model::Value> {
    std::vector<model::Value> out;
    for (const auto& column : columns) out.push_back(column.value(row));
    return out;
  }
};

// What a row of each table is made from.
struct BuildingRow {
  const model::Building& building;
  const Pen& pen;
};
struct PartRow {
  const std::string& building;
  const model::Part& part;
  const geometry::Polygon& outline;
  const Pen& pen;
};
struct EdgeRow {
  const std::string &building, &part;
  const model::PlanRing& ring;
  std::size_t ring_number, edge;
  model::Value party;  ///< whether most of the wall above touches another solid; absent without a wall
};
struct FaceRow {
  const std::string &building, &part;
  const model::LabelledSolid& model;
  std::size_t number;

  const Pen& pen;

  [[nodiscard]] auto face() const -> const model::Face& { return model.solid.faces[number]; }
};
/// A solid of a building at one level of detail.
struct LevelRow {
  const std::string& building;
  std::size_t number;  ///< among those of the building
  const model::LabelledSolid& model;
  const Pen& pen;
};
struct ProfileRow {
  const std::string &building, &part;
  std::size_t number;
  const model::Profile& profile;
};
struct MadeByRow {
  const std::string &name, &value;
};
struct RecordRow {
  std::string_view kind;  ///< record_header or record_building
  model::Value id;        ///< absent for the header
  const std::string& json;
};

inline constexpr const char *record_header = "header", *record_building = "building";
/// The columns that a file is read back from.
inline constexpr const char *record_kind = "kind", *record_json = "json";

extern const CityTable<BuildingRow> gis_footprints_table;  ///< with a column for each attribute of the buildings
extern const CityTable<PartRow> footprints_table;          ///< with a column for each attribute of the parts
extern const CityTable<EdgeRow> edges_table;
extern const CityTable<FaceRow> roof_planes_table, walls_table;
/// Of every level of detail that is written: its solids, their ground and their roofs in plan.
extern const CityTable<LevelRow> solids_table, grounds_table;
inline constexpr const char *solids_name = "solids_", *grounds_name = "ground_";
extern const CityTable<ProfileRow> profiles_table;
extern const CityTable<MadeByRow> made_by_table;
extern const CityTable<RecordRow> records_table;

/// Calls `work` with each table, in their order in the file.
template <class Work>
void each_city_table(Work work) {
  work(gis_footprints_table);
  work(footprints_table);
  work(edges_table);
  work(roof_planes_table);
  work(walls_table);
  work(profiles_table);
  work(made_by_table);
  work(records_table);
}

}  // namespace mansard::formats::detail
