// CityGML 1.0 to 3.0 of any producer, building by building, as the documents that all readers of city models take.
#pragma once

#include <string>
#include <string_view>

#include "mansard/formats/cityjson/cityjson_document.hpp"

namespace mansard::formats {

/// Whether a text says of itself that it is CityGML. No proof that it is sound.
[[nodiscard]] auto looks_like_citygml(std::string_view bytes) -> bool;

/// Parses a file and calls `work` with a document for every Building: itself, its parts and installations, with
/// attributes, footprints and roof edges (LoD 0), solids and surfaces of LoD 1 to 4 with what they are. The file is
/// streamed: memory holds one building. Nothing is loaded that the file names: a file with a DOCTYPE is refused, and
/// entities are not replaced. Returns the reference system, "EPSG:25832" where it can be told, empty if there is none.
/// Fails with the code of `complaints` and with what `work` fails with.
[[nodiscard]] auto each_citygml_building(std::string_view bytes, const CityComplaints& complaints,
                                         const std::function<base::Result<void>(const CityDocument&)>& work)
    -> base::Result<std::string>;

}  // namespace mansard::formats
