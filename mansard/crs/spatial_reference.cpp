#include "mansard/crs/spatial_reference.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include "mansard/base/text.hpp"

namespace mansard::crs {
namespace {

auto authority_code(const OGRSpatialReference& system) -> std::optional<std::string> {
  const char* authority = system.GetAuthorityName(nullptr);
  const char* code = system.GetAuthorityCode(nullptr);
  if (authority == nullptr || code == nullptr || std::string_view(authority) != "EPSG") return std::nullopt;
  return "EPSG:" + std::string(code);
}

/// The defining numbers of a projection, by their names in WKT 1.
constexpr std::array<const char*, 12> parameters{SRS_PP_CENTRAL_MERIDIAN,
                                                 SRS_PP_SCALE_FACTOR,
                                                 SRS_PP_STANDARD_PARALLEL_1,
                                                 SRS_PP_STANDARD_PARALLEL_2,
                                                 SRS_PP_LONGITUDE_OF_CENTER,
                                                 SRS_PP_LATITUDE_OF_CENTER,
                                                 SRS_PP_LONGITUDE_OF_ORIGIN,
                                                 SRS_PP_LATITUDE_OF_ORIGIN,
                                                 SRS_PP_FALSE_EASTING,
                                                 SRS_PP_FALSE_NORTHING,
                                                 SRS_PP_AZIMUTH,
                                                 SRS_PP_RECTIFIED_GRID_ANGLE};

/// Photogrammetry programs alter a projection and leave the register's number on it, which then names another place.
/// Compared by numbers, since files disagree with the register about the order of the axes.
auto is_what_it_says(const OGRSpatialReference& system, const std::string& code) -> bool {
  if (system.IsProjected() == 0) return true;
  OGRSpatialReference flat_one(system);
  if (flat_one.IsCompound() != 0) flat_one.StripVertical();
  OGRSpatialReference registered;
  if (registered.SetFromUserInput(code.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
      OGRERR_NONE)
    return false;
  if (registered.IsCompound() != 0) registered.StripVertical();
  if (std::abs(flat_one.GetLinearUnits() - registered.GetLinearUnits()) > 1e-9) return false;
  for (const char* name : parameters)
    if (std::abs(flat_one.GetNormProjParm(name, 0) - registered.GetNormProjParm(name, 0)) > 1e-6) return false;
  return true;
}

/// The same CRS without the register's number, which WKT 1 has at its end.
auto without_code(const OGRSpatialReference& system, const std::string& code) -> OGRSpatialReference {
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT1_GDAL", "MULTILINE=NO", nullptr};
  std::string wkt = system.exportToWkt(&text, options) == OGRERR_NONE && text != nullptr ? text : "";
  CPLFree(text);
  const std::string tail = R"(,AUTHORITY["EPSG",")" + code.substr(code.find(':') + 1) + "\"]]";
  if (!wkt.ends_with(tail)) return system;
  wkt.replace(wkt.size() - tail.size(), tail.size(), "]");
  OGRSpatialReference out;
  return out.importFromWkt(wkt.c_str()) == OGRERR_NONE ? out : system;
}

}  // namespace

auto from_wkt(const std::string& wkt) -> std::optional<Crs> {
  Crs crs;
  if (crs.system.importFromWkt(wkt.c_str()) != OGRERR_NONE || grid_elsewhere(crs.system)) return std::nullopt;
  return crs;
}

auto from_words(const std::string& words) -> std::optional<Crs> {
  Crs crs;
  if (crs.system.SetFromUserInput(words.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
          OGRERR_NONE ||
      grid_elsewhere(crs.system))
    return std::nullopt;
  return crs;
}

auto number_of_name(const std::string& name) -> std::optional<std::string> {
  int count = 0;
  OSRCRSInfo** all = OSRGetCRSInfoListFromDatabase("EPSG", nullptr, &count);
  std::optional<std::string> found;
  bool several = false;
  for (int i = 0; i < count; ++i) {
    const OSRCRSInfo& one = *all[i];
    if (one.eType != OSR_CRS_TYPE_PROJECTED || one.bDeprecated != 0 || base::lower(one.pszName) != base::lower(name))
      continue;
    several = found.has_value();
    found = "EPSG:" + std::string(one.pszCode);
  }
  OSRDestroyCRSInfoList(all);
  return several ? std::nullopt : found;
}

auto hint_for(const std::string& name) -> std::string {
  const auto number = number_of_name(name);
  return number ? "; " + *number + " has this name" : std::string();
}

auto grid_elsewhere(const OGRSpatialReference& system) -> std::optional<std::string> {
  // WKT: PARAMETERFILE["Latitude and longitude difference file","grid.gsb"], or EXTENSION["PROJ4","+nadgrids=…"].
  const auto wkt = wkt_of(system);
  const auto reaches = [](std::string_view grids) {
    return grids.find('/') != grids.npos || grids.find('\\') != grids.npos;
  };
  for (auto at = wkt.find("PARAMETERFILE["); at != wkt.npos; at = wkt.find("PARAMETERFILE[", at + 1)) {
    const auto from = wkt.find("\",\"", at);
    const auto end = from == wkt.npos ? from : wkt.find('"', from + 3);
    if (end == wkt.npos) break;
    if (auto grids = wkt.substr(from + 3, end - from - 3); reaches(grids)) return grids;
  }
  for (const std::string_view key : {"grids=", "+init=", "+file="})
    for (auto at = wkt.find(key); at != wkt.npos; at = wkt.find(key, at + 1)) {
      const auto from = at + key.size();
      if (auto grids = wkt.substr(from, wkt.find_first_of(" \"", from) - from); reaches(grids)) return grids;
    }
  return std::nullopt;
}

auto wkt_of(const OGRSpatialReference& system) -> std::string {
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  const OGRErr failed = system.exportToWkt(&text, options);
  std::string wkt = failed == OGRERR_NONE && text != nullptr ? text : "";
  CPLFree(text);
  return wkt;
}

auto name_of(const OGRSpatialReference& system) -> std::string {
  OGRSpatialReference copy(system);
  if (auto code = authority_code(system))
    return is_what_it_says(system, *code) ? *code : wkt_of(without_code(system, *code));
  if (copy.AutoIdentifyEPSG() == OGRERR_NONE)
    if (auto code = authority_code(copy)) return *code;
  int count = 0;
  int* confidences = nullptr;
  OGRSpatialReferenceH* matches = OSRFindMatches(OGRSpatialReference::ToHandle(&copy), nullptr, &count, &confidences);
  std::optional<std::string> found;
  // 90 %: equal but for the names.
  if (count > 0 && confidences[0] >= 90) found = authority_code(*OGRSpatialReference::FromHandle(matches[0]));
  OSRFreeSRSArray(matches);
  CPLFree(confidences);
  return found ? *found : wkt_of(system);
}

auto in_metres(const OGRSpatialReference& system) -> bool { return std::abs(system.GetLinearUnits() - 1) < 1e-9; }

auto title_of(const OGRSpatialReference& system) -> std::string {
  const auto code = authority_code(system);
  const char* name = system.GetName();
  return (code ? *code + " " : std::string()) + (name != nullptr ? name : "");
}

auto wanted_crs(const std::string& option) -> base::Result<Crs> {
  auto crs = from_words(option);
  if (!crs)
    return base::error(
        "ingest-crs-option",
        "'" + option + "' is not a known CRS" + hint_for(option) + "; write EPSG:n, a WKT text, or local",
        "ingest.crs");
  if (crs->system.IsProjected() == 0 || !in_metres(crs->system))
    return base::error("ingest-crs-option",
                       "'" + option + "' (" + title_of(crs->system) + ") is not a projected CRS in metres; give one",
                       "ingest.crs");
  return std::move(*crs);
}

auto flat(const OGRSpatialReference& system) -> Crs {
  Crs crs;
  crs.system = system;
  crs.system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (crs.system.IsCompound() != 0) crs.system.StripVertical();
  crs.system.DemoteTo2D(nullptr);
  return crs;
}

auto transformation(const Crs& from, const Crs& to) -> Transformation {
  return Transformation(OGRCreateCoordinateTransformation(&from.system, &to.system));
}

}  // namespace mansard::crs
