#include "mansard/crs/model_crs.hpp"

#include <ogr_spatialref.h>
#include <cmath>
#include <optional>

#include "mansard/base/text.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"

namespace mansard::crs {
namespace {

/// CityJSON names a CRS by a URL, older versions by a URN; both end in the register's number.
auto without_address(const std::string& spelt) -> std::string {
  const auto at = spelt.find_last_of("/:");
  if (spelt.find("EPSG") == spelt.npos || at == spelt.npos) return spelt;
  const auto number = base::to_integer(spelt.substr(at + 1));
  return number ? "EPSG:" + std::to_string(*number) : spelt;
}

auto known(const std::string& words) -> std::optional<OGRSpatialReference> {
  OGRSpatialReference crs;
  if (crs.SetFromUserInput(words.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) != OGRERR_NONE)
    return std::nullopt;
  if (crs.IsCompound() != 0) crs.StripVertical();
  crs.DemoteTo2D(nullptr);
  return crs;
}

}  // namespace

auto plane_crs(const std::string& spelt, const std::string& subject) -> base::Result<std::string> {
  if (spelt.empty()) return std::string();
  const GdalMessages messages;
  const auto words = without_address(spelt);
  const auto crs = known(words);
  if (!crs)
    return base::error("ingest-model-crs",
                       "the CRS '" + spelt + "' is not known" + hint_for(spelt) + "; correct it, or say --crs local",
                       subject);
  if (crs->IsProjected() == 0 || std::abs(crs->GetLinearUnits() - 1) > 1e-9)
    return base::error("ingest-model-crs",
                       "its CRS '" + words + "' is not a projected one in metres; convert the model to one that is",
                       subject);
  const char* authority = crs->GetAuthorityName(nullptr);
  const char* code = crs->GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr && std::string_view(authority) == "EPSG")
    return "EPSG:" + std::string(code);
  return words;
}

auto same_crs(const std::string& a, const std::string& b) -> bool {
  if (a == b) return true;
  const GdalMessages messages;
  const auto first = known(a), second = known(b);
  return first && second && first->IsSame(&*second) != 0;
}

}  // namespace mansard::crs
