// The one thing about GeoJSON that GDAL does not tell.
#pragma once

#include <string_view>

namespace mansard::formats {

/// Whether the outermost object of a JSON text has this member with a value other than null. Text that is not JSON
/// gives an answer too, without meaning.
[[nodiscard]] auto has_top_level_member(std::string_view json, std::string_view name) -> bool;

}  // namespace mansard::formats
