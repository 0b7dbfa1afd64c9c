// Footprints out of city models: CityJSON 1.0 to 2.0 and CityJSONSeq as a source of features.
#pragma once

#include <string>
#include <string_view>

#include "mansard/formats/vector/features.hpp"

namespace mansard::formats {

/// Whether a text says of itself that it is CityJSON. No proof that it is sound.
[[nodiscard]] auto looks_like_cityjson(std::string_view bytes) -> bool;

/// A feature per Building, with its id and attributes; without those that mansard itself gives to models (`ms_…`),
/// which are of the model, not of the building. Its polygons, of itself or else of its parts: the surfaces of LoD 0;
/// else those that are GroundSurface, of the highest LoD that has any; else the lowest level ones. Objects of other
/// kinds are left out. Fails with "ingest-footprints-format".
[[nodiscard]] auto read_cityjson_footprints(std::string_view bytes, const std::string& subject)
    -> base::Result<FeatureFile>;

}  // namespace mansard::formats
