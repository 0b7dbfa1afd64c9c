#include "mansard/crs/candidates.hpp"

#include <gdal/ogr_srs_api.h>
#include <algorithm>
#include <memory>
#include <tuple>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"

namespace mansard::crs {

auto candidates(const std::string& from, geometry::Point2 at, const geometry::Box2& box) -> std::vector<Candidate> {
  const GdalMessages messages;
  const auto source = from_words(from);
  const auto degrees = from_words("EPSG:4326");
  if (!source || !degrees) return {};
  const auto to_degrees = transformation(*source, *degrees);
  double longitude = at.x, latitude = at.y;
  if (!to_degrees || to_degrees->Transform(1, &longitude, &latitude) == 0) return {};

  int count = 0;
  const std::unique_ptr<OSRCRSInfo*, void (*)(OSRCRSInfo**)> list(
      OSRGetCRSInfoListFromDatabase("EPSG", nullptr, &count), OSRDestroyCRSInfoList);
  std::vector<Candidate> all;
  for (int i = 0; i < count; ++i) {
    const auto& info = *list.get()[i];
    if (info.eType != OSR_CRS_TYPE_PROJECTED || info.bDeprecated != 0 || info.bBboxValid == 0) continue;
    const bool across = info.dfWestLongitudeDeg > info.dfEastLongitudeDeg;  // the date line
    const bool within = across ? longitude >= info.dfWestLongitudeDeg || longitude <= info.dfEastLongitudeDeg
                               : longitude >= info.dfWestLongitudeDeg && longitude <= info.dfEastLongitudeDeg;
    if (!within || latitude < info.dfSouthLatitudeDeg || latitude > info.dfNorthLatitudeDeg) continue;
    Candidate candidate{std::string("EPSG:") + info.pszCode, info.pszName, at, 0};
    const auto system = from_words(candidate.name);
    if (!system || !in_metres(system->system)) continue;
    const auto way = transformation(*source, *system);
    if (!way || way->Transform(1, &candidate.at.x, &candidate.at.y) == 0) continue;
    if (!(candidate.at.x >= box.least.x && candidate.at.x <= box.most.x && candidate.at.y >= box.least.y &&
          candidate.at.y <= box.most.y))
      continue;
    const double width = info.dfEastLongitudeDeg - info.dfWestLongitudeDeg + (across ? 360 : 0);
    candidate.area = width * (info.dfNorthLatitudeDeg - info.dfSouthLatitudeDeg);
    all.push_back(std::move(candidate));
  }
  std::ranges::sort(all, {}, [](const Candidate& c) { return std::tuple(c.area, c.name.size(), c.name); });
  return all;
}

}  // namespace mansard::crs
