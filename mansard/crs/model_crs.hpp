// The CRS of a model, which is never projected.
#pragma once

#include <string>

#include "mansard/base/result.hpp"

namespace mansard::crs {

/// "EPSG:n" of the plane part of the CRS that a model names ("https://www.opengis.net/def/crs/EPSG/0/7415", a URN,
/// "EPSG:7415"), or its WKT; empty for none. Fails with "ingest-model-crs" where it is not known, or not projected
/// in metres.
[[nodiscard]] auto plane_crs(const std::string& spelt, const std::string& subject) -> base::Result<std::string>;

/// Whether two names from plane_crs mean the same.
[[nodiscard]] auto same_crs(const std::string& a, const std::string& b) -> bool;

}  // namespace mansard::crs
