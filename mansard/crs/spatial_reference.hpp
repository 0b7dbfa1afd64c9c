// Coordinate systems as PROJ knows them, through GDAL. Whoever calls has a GdalMessages alive.
#pragma once

#include <ogr_spatialref.h>
#include <memory>
#include <optional>
#include <string>

#include "mansard/base/result.hpp"

namespace mansard::crs {

/// A CRS whose coordinates are always x (east, longitude) before y, as files keep them and as this engine works,
/// whatever the authority's axis order.
struct Crs {
  OGRSpatialReference system;
  Crs() { system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER); }
};

[[nodiscard]] auto from_wkt(const std::string& wkt) -> std::optional<Crs>;
/// "EPSG:n", "EPSG:n+m", WKT, and what else PROJ reads without the network; none where it names a grid by a path or an
/// address, which a file must not make PROJ open.
[[nodiscard]] auto from_words(const std::string& words) -> std::optional<Crs>;
/// The register's number of a projected CRS that has this name, "EPSG:28992" for "Amersfoort / RD New"; none where none
/// has, or several.
[[nodiscard]] auto number_of_name(const std::string& name) -> std::optional<std::string>;
/// What to say of words that name no known CRS: "; EPSG:28992 has this name", or nothing.
[[nodiscard]] auto hint_for(const std::string& name) -> std::string;
/// A grid that a CRS names by a path or an address; none where there is no such grid. Grids by name alone are looked
/// for in PROJ's own folders.
[[nodiscard]] auto grid_elsewhere(const OGRSpatialReference& system) -> std::optional<std::string>;
[[nodiscard]] auto wkt_of(const OGRSpatialReference& system) -> std::string;
/// "EPSG:n" as the CRS says, where the register agrees, or as the register recognises it, else its WKT.
[[nodiscard]] auto name_of(const OGRSpatialReference& system) -> std::string;
/// For messages: number and name.
[[nodiscard]] auto title_of(const OGRSpatialReference& system) -> std::string;
[[nodiscard]] auto in_metres(const OGRSpatialReference& system) -> bool;
/// Without a vertical part: footprints are flat, and heights are never converted.
[[nodiscard]] auto flat(const OGRSpatialReference& system) -> Crs;
/// The CRS the user asked for: projected and metric, since the engine measures in metres. Fails with
/// "ingest-crs-option".
[[nodiscard]] auto wanted_crs(const std::string& option) -> base::Result<Crs>;

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;
/// None where there is no way.
[[nodiscard]] auto transformation(const Crs& from, const Crs& to) -> Transformation;

}  // namespace mansard::crs
