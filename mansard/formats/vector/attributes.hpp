// Attributes and ids of features.
#pragma once

#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/vector/features.hpp"

class OGRFeature;

namespace mansard::formats {

/// Every field in order. Dates become ISO 8601 text, lists JSON text, binary data base 64; unset, null and NaN nothing.
[[nodiscard]] auto attributes_of(const OGRFeature& feature) -> model::Attributes;

/// One id per feature, all different: the attribute asked for, else the source's own names, else the first well-known
/// attribute that is there for all and different for all, else the first that names features, else the feature numbers.
/// An id that an earlier feature has gets ~2, ~3 … appended, which never makes an id that was given; a feature without
/// one is "feature-" and its number. Warns "ingest-id-duplicate", fails with "ingest-id-attribute".
[[nodiscard]] auto ids_of(const std::vector<RawFeature>& features, const std::string& attribute,
                          const std::string& subject, std::vector<base::Diagnostic>& warnings)
    -> base::Result<std::vector<std::string>>;

}  // namespace mansard::formats
