// The one thing about GeoJSON that GDAL does not tell.
#pragma once

#include <optional>
#include <string_view>

namespace mansard::formats {

/// The text of the value that the outermost object of a JSON text has for this name; none where it has none, or null.
/// Text that is not JSON gives an answer too, without meaning.
[[nodiscard]] auto top_level_member(std::string_view json, std::string_view name) -> std::optional<std::string_view>;

}  // namespace mansard::formats
