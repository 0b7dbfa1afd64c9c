// Attributes and ids of features.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/vector/features.hpp"

class OGRFeature;

namespace mansard::formats {

/// Every field in order. Dates become ISO 8601 text, lists JSON text, binary data base 64; unset, null and NaN nothing.
[[nodiscard]] auto attributes_of(const OGRFeature& feature) -> model::Attributes;

/// The strings of a source that are not UTF-8.
class OtherStrings {
 public:
  /// `encoding`: what they are in, as iconv names it; empty where nobody says.
  explicit OtherStrings(std::string encoding) : encoding_(std::move(encoding)) {}
  /// Fails with "ingest-encoding" where there is no such encoding here.
  [[nodiscard]] auto check() const -> base::Result<void>;
  /// Makes a string UTF-8, or counts it where its encoding is not known. `name` and `number` say where it is.
  void take(std::string& text, const std::string& name, std::int64_t number);
  /// "ingest-text", where any was counted.
  [[nodiscard]] auto warning(const std::string& subject) const -> std::optional<base::Diagnostic>;

 private:
  std::string encoding_, first_;
  std::size_t count_ = 0;
};

/// One id per feature, all different: the attribute asked for, else the source's own names, else the first well-known
/// attribute that is there for all and different for all, else the first that names features, else the feature numbers.
/// An id that an earlier feature has gets ~2, ~3 … appended, which never makes an id that was given; a feature without
/// one is "feature-" and its number. Characters that some format cannot hold, which are bytes that are no UTF-8 and
/// control characters, become U+FFFD. Warns "ingest-id-duplicate", "ingest-id-characters", fails with
/// "ingest-id-attribute".
[[nodiscard]] auto ids_of(const std::vector<RawFeature>& features, const std::string& attribute,
                          const std::string& subject, std::vector<base::Diagnostic>& warnings)
    -> base::Result<std::vector<std::string>>;

/// What the names of the parts of a feature begin with, by its id: only for those where "id-" and a number could be the
/// id of another feature, or the name of another's part. The ids are all different.
[[nodiscard]] auto part_prefixes_of(const std::vector<std::string>& ids) -> std::map<std::string, std::string>;

}  // namespace mansard::formats
