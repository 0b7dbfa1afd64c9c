#include "mansard/ingest/join.hpp"

#include <ogrsf_frmts.h>
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <variant>

#include "mansard/base/files.hpp"
#include "mansard/base/options.hpp"
#include "mansard/base/text.hpp"
#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_frame.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/vector/attributes.hpp"

namespace mansard::ingest {
namespace {

/// "a, b, c and 4 more"
auto first_few(const std::vector<std::string>& names) -> std::string {
  constexpr std::size_t few = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(few, names.size()); ++i) out += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > few) out += " and " + std::to_string(names.size() - few) + " more";
  return out;
}

struct Row {
  model::Attributes attributes;
  bool used = false;
};

/// A number in a text of a table; not one with leading zeros or a plus, which is a code or a telephone number.
auto number_in(const std::string& text) -> std::optional<model::Value> {
  if (text.starts_with('+')) return std::nullopt;
  const std::size_t digits = text.starts_with('-') ? 1 : 0;
  if (text.size() > digits + 1 && text[digits] == '0' && text[digits + 1] != '.') return std::nullopt;
  if (const auto whole = base::to_integer(text)) return model::Value(*whole);
  if (const auto number = base::to_number(text)) return model::Value(*number);
  return std::nullopt;
}

/// CSV has texts only. A column in which every value is a number, or nothing, has numbers.
void find_numbers(std::map<std::string, Row>& rows) {
  struct Column {
    bool numbers = true, whole = true, any = false;
  };
  std::map<std::string, Column> columns;
  for (const auto& [id, row] : rows)
    for (const auto& [name, value] : row.attributes) {
      auto& column = columns[name];
      const auto* text = std::get_if<std::string>(&value);
      if (text == nullptr || text->empty()) continue;
      const auto number = number_in(*text);
      column.numbers = column.numbers && number;
      column.whole = column.whole && number && std::holds_alternative<std::int64_t>(*number);
      column.any = true;
    }
  for (auto& [id, row] : rows)
    for (auto& [name, value] : row.attributes) {
      const auto& column = columns[name];
      const auto* text = std::get_if<std::string>(&value);
      if (text == nullptr || !column.any || !column.numbers) continue;
      if (text->empty()) value = std::monostate();
      else if (column.whole) value = *number_in(*text);
      else value = *base::to_number(*text);
    }
}

/// The layer with that column, or the first one for the message about its columns.
auto layer_with(GDALDataset& file, const std::string& key) -> OGRLayer* {
  for (auto* layer : file.GetLayers())
    if (layer->GetLayerDefn()->GetFieldIndex(key.c_str()) >= 0) return layer;
  return file.GetLayerCount() > 0 ? file.GetLayer(0) : nullptr;
}

}  // namespace

auto join(model::Scene& scene, const std::filesystem::path& table, const std::string& key, const std::string& encoding)
    -> base::Result<std::vector<base::Diagnostic>> {
  formats::OtherStrings strings(encoding);
  if (auto known = strings.check(); !known) return known.failure();
  crs::register_gdal();
  const crs::GdalMessages messages;
  std::error_code status;
  if (!std::filesystem::exists(table, status))
    return base::error("ingest-join-table", "there is no such file; check the path", table.string());
  if (auto checked = base::check_no_pipe(table); !checked) return checked.failure();
  const formats::Confined confined(table);
  const GDALDatasetUniquePtr file(GDALDataset::Open(table.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  OGRLayer* layer = file ? layer_with(*file, key) : nullptr;
  if (auto done = confined.check(); !done) return done.error();
  if (layer == nullptr)
    return base::error("ingest-join-table",
                       "GDAL reads no table in this file" + crs::gdal_words() +
                           "; give CSV with a header line, a GeoPackage, or another table",
                       table.string());
  const OGRFeatureDefn& columns = *layer->GetLayerDefn();
  const int key_column = columns.GetFieldIndex(key.c_str());
  if (key_column < 0) {
    std::vector<std::string> names;
    for (int i = 0; i < columns.GetFieldCount(); ++i) names.emplace_back(columns.GetFieldDefn(i)->GetNameRef());
    return base::error("ingest-join-key",
                       "the table has no column '" + key + "'; its columns are " +
                           (names.empty() ? std::string("none") : first_few(names)) +
                           base::did_you_mean(base::nearest_word(key, names)),
                       table.string());
  }
  const std::string key_name = columns.GetFieldDefn(key_column)->GetNameRef();
  std::map<std::string, Row> rows;
  std::vector<std::string> twice;
  for (const auto& feature : *layer) {
    if (!feature->IsFieldSetAndNotNull(key_column)) continue;
    std::string id = feature->GetFieldAsString(key_column);
    strings.take(id, key_name, feature->GetFID());
    auto attributes = formats::attributes_of(*feature);
    std::erase_if(attributes, [&](const auto& one) { return one.first == key_name; });
    for (auto& [name, value] : attributes)
      if (auto* text = std::get_if<std::string>(&value)) strings.take(*text, name, feature->GetFID());
    if (!rows.try_emplace(id, Row{std::move(attributes), false}).second) twice.push_back(id);
  }
  if (auto done = confined.check(); !done) return done.error();
  if (std::string_view(file->GetDriverName()) == "CSV") find_numbers(rows);
  if (CPLGetLastErrorType() >= CE_Failure)
    return base::error("ingest-join-table", "the table cannot be read to its end" + crs::gdal_words(), table.string());
  if (!twice.empty())
    return base::error("ingest-join-duplicate",
                       "the column '" + key + "' has values more than once (" + first_few(twice) +
                           "); give a table with one row for each building",
                       table.string());
  std::vector<std::string> without;
  std::size_t matched = 0;
  for (auto& footprint : scene.footprints) {
    const auto found = rows.find(footprint.id);
    if (found == rows.end()) {
      without.push_back(footprint.id);
      continue;
    }
    ++matched;
    found->second.used = true;
    std::set<std::string> taken;
    for (const auto& [name, value] : footprint.attributes) taken.insert(name);
    for (const auto& [name, value] : found->second.attributes) {
      std::string own = name;
      for (int n = 2; !taken.insert(own).second; ++n) own = name + "_" + std::to_string(n);
      footprint.attributes.emplace_back(std::move(own), value);
    }
  }
  if (matched == 0) {
    std::vector<std::string> ids;
    for (const auto& [id, row] : rows) ids.push_back(id);
    return base::error("ingest-join-none",
                       "no value of the column '" + key + "' (" + (ids.empty() ? "it has none" : first_few(ids)) +
                           ") is the id of a footprint (" + (without.empty() ? "there are none" : first_few(without)) +
                           "); --ingest-id-attribute names the attribute that is the id",
                       table.string());
  }
  std::vector<base::Diagnostic> warnings;
  if (auto warning = strings.warning(table.string())) warnings.push_back(*std::move(warning));
  std::vector<std::string> unused;
  for (const auto& [id, row] : rows)
    if (!row.used) unused.push_back(id);
  if (!unused.empty())
    warnings.push_back(base::warning(
        "ingest-join-unmatched",
        std::to_string(unused.size()) + " rows have the id of no footprint: " + first_few(unused), table.string()));
  if (!without.empty())
    warnings.push_back(
        base::warning("ingest-join-missing",
                      std::to_string(without.size()) + " footprints have no row in the table: " + first_few(without),
                      table.string()));
  return warnings;
}

auto join_codes() -> std::vector<base::Code> {
  return {
      {"ingest-join-table", "A table that was to be joined to the footprints cannot be read.",
       "Give a format that GDAL reads as a table: CSV with a header line, GeoPackage, XLSX.", 3},
      {"ingest-join-key", "A table that was to be joined has no column of the name that --on gives.",
       "The message lists its columns.", 2},
      {"ingest-join-duplicate", "A table that was to be joined has two rows with one id.",
       "Give a table with one row for each building.", 3},
      {"ingest-join-none", "No row of a table that was to be joined has the id of a footprint.",
       "Name the attribute that is the id with --ingest-id-attribute, or another column with --on.", 3},
      {"ingest-join-unmatched", "Rows of a table that was joined have the id of no footprint.",
       "Nothing, where the table is of a larger area.", 0},
      {"ingest-join-missing", "Footprints have no row in a table that was joined.",
       "Nothing, where the table is incomplete.", 0},
  };
}

}  // namespace mansard::ingest
