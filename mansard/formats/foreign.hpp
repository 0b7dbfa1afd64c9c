// Models of other producers with their attributes, as writers take them.
#pragma once

#include <filesystem>

#include "mansard/formats/stream.hpp"

namespace mansard::formats {

struct ForeignCity {
  model::City city;                        ///< made by nobody: the version is empty. Parts have models and no plans
  std::string lods;                        ///< those that the models are of: "2.2", or several: "1.2, 2.2"
  std::vector<base::Diagnostic> warnings;  ///< "write-foreign": what has no place in the city, with counts
};

/// The buildings of a CityJSON 1.0 to 2.0 or CityJSONSeq of any producer, each at its finest level of detail: faces
/// with their classes, or by their direction where the file has none; attributes of buildings and parts, those that are
/// no plain values as JSON. Corners are rounded to the grid of files. The footprint is LoD 0, or else the ground.
/// Models are taken as they are: neither closed nor checked. Fails with "ingest-model-format", "file-…".
[[nodiscard]] auto read_foreign(const std::filesystem::path& path) -> base::Result<ForeignCity>;

/// Whether a format can hold models without plans.
[[nodiscard]] auto takes_foreign(Format format) -> bool;

/// Whether a file with that header has no plans, so that nothing can be read back from it.
[[nodiscard]] inline auto is_foreign(const Header& header) -> bool { return header.made_by.version.empty(); }

}  // namespace mansard::formats
