#include "mansard/formats/vector/attributes.hpp"

#include <iconv.h>
#include <ogrsf_frmts.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"
#include "mansard/base/utf8.hpp"
#include "mansard/model/value_text.hpp"

namespace mansard::formats {
namespace {

auto padded(int value, std::size_t width) -> std::string {
  std::string text = std::to_string(value);
  return std::string(width > text.size() ? width - text.size() : 0, '0') + text;
}

auto date_text(const OGRFeature& feature, int field, OGRFieldType type) -> std::string {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, zone = 0;
  float second = 0;
  feature.GetFieldAsDateTime(field, &year, &month, &day, &hour, &minute, &second, &zone);
  std::string date = padded(year, 4) + "-" + padded(month, 2) + "-" + padded(day, 2);
  if (type == OFTDate) return date;
  const auto milliseconds = static_cast<int>(std::lround(static_cast<double>(second) * 1000));
  std::string time = padded(hour, 2) + ":" + padded(minute, 2) + ":" + padded(milliseconds / 1000, 2);
  if (milliseconds % 1000 != 0) time += "." + padded(milliseconds % 1000, 3);
  // OGR's zones: 0 unknown, 1 local, 100 UTC and a step for each quarter of an hour.
  if (zone == 100) time += "Z";
  if (zone > 1 && zone != 100) {
    const int quarters = std::abs(zone - 100);
    time += (zone > 100 ? "+" : "-") + padded(quarters / 4, 2) + ":" + padded(quarters % 4 * 15, 2);
  }
  return type == OFTTime ? time : date + "T" + time;
}

auto quoted(std::string_view text) -> std::string {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      static constexpr std::string_view digits = "0123456789abcdef";
      out += "\\u00";
      out += digits[static_cast<unsigned char>(c) >> 4];
      out += digits[static_cast<unsigned char>(c) & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

template <class T, class Text>
auto list_text(const T* values, int count, Text text) -> std::string {
  std::string out = "[";
  for (int i = 0; i < count; ++i) out += (i > 0 ? "," : "") + text(values[i]);
  return out + "]";
}

auto real_text(double value) -> std::string { return std::isfinite(value) ? base::to_text(value) : "null"; }

auto value_of(const OGRFeature& feature, int field) -> model::Value {
  if (feature.IsFieldSetAndNotNull(field) == 0) return {};
  const OGRFieldDefn* definition = feature.GetFieldDefnRef(field);
  const OGRFieldType type = definition->GetType();
  int count = 0;
  switch (type) {
    case OFTInteger:
      if (definition->GetSubType() == OFSTBoolean) return feature.GetFieldAsInteger(field) != 0;
      return std::int64_t{feature.GetFieldAsInteger(field)};
    case OFTInteger64: return static_cast<std::int64_t>(feature.GetFieldAsInteger64(field));
    case OFTReal: {
      double value = feature.GetFieldAsDouble(field);
      if (!std::isfinite(value)) return {};
      if (definition->GetSubType() == OFSTFloat32) {
        // 0.1 stored as a float is meant to be 0.1, not 0.10000000149.
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(value)).ptr;
        value = base::to_number({text.data(), end}).value_or(value);
      }
      return value;
    }
    case OFTDate:
    case OFTTime:
    case OFTDateTime: return date_text(feature, field, type);
    case OFTIntegerList: {
      const int* values = feature.GetFieldAsIntegerList(field, &count);
      return list_text(values, count, [](int value) { return std::to_string(value); });
    }
    case OFTInteger64List: {
      const GIntBig* values = feature.GetFieldAsInteger64List(field, &count);
      return list_text(values, count, [](GIntBig value) { return std::to_string(value); });
    }
    case OFTRealList: {
      const double* values = feature.GetFieldAsDoubleList(field, &count);
      return list_text(values, count, real_text);
    }
    case OFTStringList: {
      char** values = feature.GetFieldAsStringList(field);
      return list_text(values, CSLCount(values), [](const char* value) { return quoted(value); });
    }
    case OFTBinary: {
      const GByte* bytes = feature.GetFieldAsBinary(field, &count);
      char* text = CPLBase64Encode(count, bytes);
      std::string out = text;
      CPLFree(text);
      return out;
    }
    default: return std::string(feature.GetFieldAsString(field));
  }
}

/// The attribute's texts, empty where it is null or missing. Most sources have the same attributes at the same places.
auto column(const std::vector<RawFeature>& features, const std::string& name) -> std::vector<std::string> {
  std::vector<std::string> out;
  out.reserve(features.size());
  std::size_t place = 0;
  for (const auto& feature : features) {
    const auto& all = feature.attributes;
    if (place >= all.size() || all[place].first != name)
      place =
          static_cast<std::size_t>(std::ranges::find(all, name, &model::Attributes::value_type::first) - all.begin());
    out.push_back(place < all.size() ? model::text_of(all[place].second) : std::string());
  }
  return out;
}

/// Of all features, in the order in which they come first.
auto names_of(const std::vector<RawFeature>& features) -> std::vector<std::string> {
  std::vector<std::string> names;
  std::set<std::string, std::less<>> known;
  const model::Attributes* before = nullptr;
  for (const auto& feature : features) {
    const auto& own = feature.attributes;
    if (before == nullptr || !std::ranges::equal(own, *before, {}, &model::Attributes::value_type::first,
                                                 &model::Attributes::value_type::first))
      for (const auto& [name, value] : own)
        if (known.insert(name).second) names.push_back(name);
    before = &own;
  }
  return names;
}

auto all_different(const std::vector<std::string>& ids) -> bool {
  if (std::ranges::find(ids, "") != ids.end()) return false;
  std::vector<std::string_view> sorted(ids.begin(), ids.end());  // not a set, which takes four times the memory
  std::ranges::sort(sorted);
  return std::ranges::adjacent_find(sorted) == sorted.end();
}

auto numbers_of(const std::vector<RawFeature>& features) -> std::vector<std::string> {
  std::vector<std::string> out;
  out.reserve(features.size());
  for (const auto& feature : features) out.push_back(std::to_string(feature.number));
  return out;
}

/// Appends ~2, ~3 … to ids that came before, so that what was given stays readable. An id that was given is never taken
/// for another feature. Returns how many were changed, and the first ones in words.
auto make_different(std::vector<std::string>& ids) -> std::pair<std::size_t, std::string> {
  std::set<std::string> taken(ids.begin(), ids.end());
  std::set<std::string> seen;
  std::map<std::string, std::size_t> next;
  std::pair<std::size_t, std::string> changed{0, {}};
  constexpr std::size_t examples = 3;
  for (auto& id : ids) {
    if (seen.insert(id).second) continue;
    std::size_t& n = next.try_emplace(id, 2).first->second;
    std::string other;
    do other = id + "~" + std::to_string(n++);
    while (!taken.insert(other).second);
    if (changed.first++ < examples) changed.second += (changed.second.empty() ? "" : ", ") + other;
    id = other;
    seen.insert(id);
  }
  return changed;
}

/// Ids as given, where they are all different; otherwise changed, with a warning that says how.
auto as_given(std::vector<std::string> ids, const std::vector<RawFeature>& features, const std::string& attribute,
              const std::string& subject, std::vector<base::Diagnostic>& warnings) -> std::vector<std::string> {
  std::size_t missing = 0;
  const std::set<std::string> given(ids.begin(), ids.end());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (!ids[i].empty()) continue;
    const auto name = "feature-" + std::to_string(features[i].number);
    ids[i] = name;
    for (int n = 2; given.contains(ids[i]); ++n) ids[i] = name + "~" + std::to_string(n);
    ++missing;
  }
  if (missing > 0)
    warnings.push_back(base::warning("ingest-id-duplicate",
                                     std::to_string(missing) + " of " + std::to_string(features.size()) +
                                         " features have no '" + attribute +
                                         "'; they are named by their number in the file, as 'feature-12'",
                                     subject));
  if (const auto [count, first] = make_different(ids); count > 0)
    warnings.push_back(base::warning("ingest-id-duplicate",
                                     std::to_string(count) + " of " + std::to_string(features.size()) +
                                         " features have the '" + attribute +
                                         "' of an earlier one; they got ~2, ~3 … appended (" + first +
                                         "); --ingest-id-attribute chooses another attribute",
                                     subject));
  return ids;
}

/// The id as every format can hold it.
auto holdable(const std::string& id) -> std::string {
  std::string out;
  for (std::size_t i = 0; i < id.size();) {
    const auto length = base::utf8_length(std::string_view(id).substr(i));
    const auto code = static_cast<unsigned char>(id[i]);
    if (length == 0 || code < 0x20 || code == 0x7F) out += "\xEF\xBF\xBD";
    else out += id.substr(i, length);
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

/// Whether the ids name features, though not each its own: half of the features have one, and at most ten share one on
/// average. Parts of a building do; a kind of building is shared by more.
auto name_features(const std::vector<std::string>& ids) -> bool {
  constexpr std::size_t most_sharing = 10;
  const auto given = ids.size() - static_cast<std::size_t>(std::ranges::count(ids, ""));
  std::set<std::string_view> distinct(ids.begin(), ids.end());
  distinct.erase("");
  return distinct.size() > 1 && 2 * given >= ids.size() && most_sharing * distinct.size() >= given;
}

auto chosen_ids(const std::vector<RawFeature>& features, const std::string& attribute, const std::string& subject,
                std::vector<base::Diagnostic>& warnings) -> base::Result<std::vector<std::string>> {
  const std::vector<std::string> names = names_of(features);
  const auto find = [&names](std::string_view wanted) -> std::optional<std::string> {
    for (const auto& name : names)
      if (base::lower(name) == base::lower(wanted)) return name;
    return std::nullopt;
  };

  if (!attribute.empty()) {
    const auto at = find(attribute);
    // Drivers keep the number of a feature apart from its attributes, where others show it as a column.
    if (!at && base::lower(attribute) == "fid")
      if (auto numbers = numbers_of(features); all_different(numbers)) return numbers;
    if (!at) {
      const auto nearest = base::nearest_word(attribute, names);
      std::string all;
      for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
      return base::error(
          "ingest-id-attribute",
          "there is no attribute '" + attribute + "'" + base::did_you_mean(nearest) + "; the layer has: " + all,
          subject);
    }
    return as_given(column(features, *at), features, *at, subject, warnings);
  }

  if (std::ranges::none_of(features, [](const auto& feature) { return feature.own_id.empty(); })) {
    std::vector<std::string> own;
    own.reserve(features.size());
    for (const auto& feature : features) own.push_back(feature.own_id);
    if (all_different(own)) return own;
  }

  // Names under which GML, Dutch registers, OpenStreetMap and common tools keep identities; the last one is what a
  // Shapefile makes of "identificatie".
  static constexpr std::array<std::string_view, 15> known{
      "gml_id",   "id",          "identificatie", "lokaal_id", "lokaalid", "bag_id",     "uuid",      "guid",
      "globalid", "building_id", "objectid",      "fid",       "osm_id",   "osm_way_id", "identifica"};
  for (const auto name : known)
    if (const auto at = find(name))
      if (auto ids = column(features, *at); all_different(ids)) return ids;
  // None is unique: the first that names features stays, since users look for these ids in the results.
  for (const auto name : known)
    if (const auto at = find(name))
      if (auto ids = column(features, *at); name_features(ids))
        return as_given(std::move(ids), features, *at, subject, warnings);
  auto ids = numbers_of(features);
  // Some sources number every feature alike, or not at all.
  if (!all_different(ids))
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = std::to_string(i);
  return ids;
}

}  // namespace

auto attributes_of(const OGRFeature& feature) -> model::Attributes {
  model::Attributes out;
  out.reserve(static_cast<std::size_t>(feature.GetFieldCount()));
  for (int i = 0; i < feature.GetFieldCount(); ++i)
    out.emplace_back(feature.GetFieldDefnRef(i)->GetNameRef(), value_of(feature, i));
  return out;
}

auto OtherStrings::check() const -> base::Result<void> {
  if (encoding_.empty()) return {};
  const iconv_t found = ::iconv_open("UTF-8", encoding_.c_str());
  if (found == iconv_t(-1))
    return base::error(
        "ingest-encoding",
        "'" + encoding_ + "' is not a known encoding; expected one of those that 'iconv -l' lists, such as ISO-8859-1",
        "ingest.encoding");
  ::iconv_close(found);
  return {};
}

void OtherStrings::take(std::string& text, const std::string& name, std::int64_t number) {
  for (std::string_view rest = text; !rest.empty();) {
    const auto length = base::utf8_length(rest);
    rest.remove_prefix(length);
    if (length > 0) continue;
    if (encoding_.empty()) {
      if (count_++ == 0) first_ = "'" + name + "' of feature " + std::to_string(number);
      return;
    }
    char* decoded = CPLRecode(text.c_str(), encoding_.c_str(), CPL_ENC_UTF8);
    text = decoded;
    CPLFree(decoded);
    return;
  }
}

auto OtherStrings::warning(const std::string& subject) const -> std::optional<base::Diagnostic> {
  if (count_ == 0) return std::nullopt;
  return base::warning("ingest-text",
                       std::to_string(count_) + " strings of attributes are not UTF-8, the first is " + first_ +
                           "; give their encoding with --ingest-encoding, such as ISO-8859-1, or characters are lost "
                           "where models are written",
                       subject);
}

auto ids_of(const std::vector<RawFeature>& features, const std::string& attribute, const std::string& subject,
            std::vector<base::Diagnostic>& warnings) -> base::Result<std::vector<std::string>> {
  auto ids = chosen_ids(features, attribute, subject, warnings);
  if (!ids) return ids;
  std::size_t changed = 0;
  std::string first;
  for (auto& id : *ids) {
    auto out = holdable(id);
    if (out == id) continue;
    if (changed++ == 0) first = out;
    id = std::move(out);
  }
  if (changed == 0) return ids;
  warnings.push_back(
      base::warning("ingest-id-characters",
                    std::to_string(changed) + " of " + std::to_string(features.size()) +
                        " ids have characters that are not UTF-8, or control characters; each became U+FFFD, as in '" +
                        first + "'; give the encoding of the file with --ingest-encoding",
                    subject));
  (void)make_different(*ids);  // two of them can have become one
  return ids;
}

auto part_prefixes_of(const std::vector<std::string>& ids) -> std::map<std::string, std::string> {
  std::vector<std::string_view> sorted(ids.begin(), ids.end());
  std::ranges::sort(sorted);
  const auto is_id = [&](std::string_view name) { return std::ranges::binary_search(sorted, name); };
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
  };
  // An id that is another one, "-" and a number: that other needs a longer prefix.
  std::map<std::string, std::string> out;
  for (const auto id : sorted) {
    const auto dash = id.rfind('-');
    if (dash != id.npos && is_number(id.substr(dash + 1)) && is_id(id.substr(0, dash)))
      out.emplace(id.substr(0, dash), std::string());
  }
  std::set<std::string> chosen;
  const auto is_taken = [&](const std::string& prefix) {
    if (chosen.contains(prefix)) return true;
    // By another's parts, or by an id.
    if (is_id(std::string_view(prefix).substr(0, prefix.size() - 1))) return true;
    for (auto at = std::ranges::lower_bound(sorted, std::string_view(prefix));
         at != sorted.end() && at->starts_with(prefix); ++at)
      if (is_number(at->substr(prefix.size()))) return true;
    return false;
  };
  for (auto& [id, prefix] : out) {
    for (prefix = id + "--"; is_taken(prefix); prefix += '-') continue;
    chosen.insert(prefix);
  }
  return out;
}

}  // namespace mansard::formats
