// What URIs that files name may have in them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mansard::formats {

/// "%20" as a blank (RFC 3986, 2.1). A '%' that no two digits follow stays.
[[nodiscard]] auto without_percent(std::string_view uri) -> std::string;

/// The bytes in a data URI (RFC 2397): "data:", a media type or none, ";base64" or not, a comma, and the data.
struct DataUri {
  std::string data;
  bool base64 = false;  ///< whether `data` are base64, without escapes, rather than the bytes
};
/// None for any other URI.
[[nodiscard]] auto data_uri(std::string_view uri) -> std::optional<DataUri>;

}  // namespace mansard::formats
