#include "mansard/crs/gdal_frame.hpp"

#include <gdal_priv.h>
#include <algorithm>

namespace mansard::crs {

auto gdal_words() -> std::string {
  std::string words = CPLGetLastErrorMsg();
  std::ranges::replace(words, '\n', ' ');
  return words.empty() ? "" : " (" + words + ")";
}

auto crs_of(const model::Frame& frame) -> std::optional<OGRSpatialReference> {
  OGRSpatialReference crs;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const OGRErr failure =
      frame.crs.empty()
          ? crs.SetLocalCS("Undefined Cartesian SRS")
          : crs.SetFromUserInput(frame.crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get());
  if (failure != OGRERR_NONE) return std::nullopt;
  return crs;
}

}  // namespace mansard::crs
