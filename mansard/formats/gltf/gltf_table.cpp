#include "mansard/formats/gltf/gltf_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "mansard/base/utf8.hpp"
#include "mansard/formats/detail/parts.hpp"
#include "mansard/model/value_text.hpp"

namespace mansard::formats::detail {
namespace {

using Kind = PartColumns::Kind;
using Column = PartColumns::Column;

/// What stands for an absent value. A double cannot be told from its text to the last bit by every reader, so whole
/// numbers of 64 bits have one that every double holds.
constexpr std::int32_t no_int32 = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t no_int64 = -9007199254740991;  // −(2^53 − 1)
constexpr double no_real = -1e300;
constexpr std::uint8_t no_flag = 2;

template <class T>
void append_raw(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
auto take_raw(std::string_view& bytes) -> T {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

auto kind_of(const Column& column) -> Kind {
  const auto& [none, flags, whole, reals, texts] = column.counts;
  if (texts > 0 || (flags > 0 && whole + reals > 0)) return Kind::text;
  if (flags > 0) return column.absent ? Kind::flag : Kind::boolean;
  if (reals > 0) return Kind::real;
  if (whole > 0) return column.narrow ? Kind::int32 : Kind::int64;
  return Kind::text;
}

/// Letters, digits and underscores, no digit first: what a property may be called.
auto identifier_of(const std::string& name) -> std::string {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    out += plain ? c : '_';
  }
  if (out.empty() || (out[0] >= '0' && out[0] <= '9')) out.insert(0, "_");
  return out;
}

auto real_of(const model::Value& value) -> double {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::get<double>(value);
}

void append_type(JsonText& json, const Column& column) {
  const auto scalar = [&](const char* component) {
    json.key("type").text("SCALAR").key("componentType").text(component);
  };
  switch (column.kind) {
    case Kind::boolean: json.key("type").text("BOOLEAN"); return;
    case Kind::flag: json.key("type").text("ENUM").key("enumType").text("flag").key("noData").text("absent"); return;
    case Kind::int32: scalar("INT32"); break;
    case Kind::int64: scalar("INT64"); break;
    case Kind::real: scalar("FLOAT64"); break;
    case Kind::text: json.key("type").text("STRING"); break;
  }
  if (!column.absent) return;
  json.key("noData");
  if (column.kind == Kind::int32) json.whole(no_int32);
  if (column.kind == Kind::int64) json.whole(no_int64);
  if (column.kind == Kind::real) json.number(no_real);
  if (column.kind == Kind::text) json.text("");
}

void append_property(JsonText& json, const Column& column) {
  json.key(column.identifier).begin_object();
  if (!column.name.empty()) json.key("name").text(column.name);
  if (!column.description.empty()) json.key("description").text(column.description);
  append_type(json, column);
  json.end_object();
}

void append_surface_class(JsonText& json) {
  const auto number = [&](const char* name, const char* meaning) -> JsonText& {
    json.key(name).begin_object().key("description").text(meaning).key("type").text("SCALAR");
    return json.key("componentType").text("FLOAT32");
  };
  json.key("surface").begin_object().key("name").text("Surface of a part").key("properties").begin_object();
  json.key("class").begin_object().key("type").text("ENUM").key("enumType").text("surface_class").end_object();
  number("slope", "Angle from the horizontal, in degrees.").end_object();
  number("azimuth", "Where it looks, in degrees clockwise from north; none where it is level.")
      .key("noData")
      .number(-1);
  json.end_object().end_object().end_object();
}

void append_enum(JsonText& json, const char* name, const std::vector<std::string_view>& values) {
  json.key(name).begin_object().key("valueType").text("UINT8").key("values").begin_array();
  for (std::size_t i = 0; i < values.size(); ++i)
    json.begin_object().key("name").text(values[i]).key("value").whole(static_cast<std::int64_t>(i)).end_object();
  json.end_array().end_object();
}

/// Every row that was put aside, in pieces of a megabyte.
auto for_each_row(base::Spool& rows, const std::function<void(const Row&)>& look) -> base::Result<void> {
  constexpr std::uint64_t piece = 1 << 20;
  std::string rest;
  for (std::uint64_t at = 0; at < rows.size();) {
    const auto bytes = rows.read(at, static_cast<std::size_t>(std::min(piece, rows.size() - at)));
    if (!bytes) return bytes.error();
    at += bytes->size();
    rest += *bytes;
    std::string_view view = rest;
    for (;;) {
      std::string_view ahead = view;
      if (ahead.size() < sizeof(std::uint32_t)) break;
      const auto length = take_raw<std::uint32_t>(ahead);
      if (ahead.size() < length) break;
      std::string_view row = ahead.substr(0, length);
      look(take_row(row));
      view = ahead.substr(length);
    }
    rest = std::string(view);
  }
  return {};
}

/// The values of a column as bytes, a megabyte at most before they go on.
class ColumnWriter {
 public:
  ColumnWriter(TableBytes& bytes, Kind kind) : bytes_(&bytes), kind_(kind) {}

  void add(const model::Value* value) {
    switch (kind_) {
      case Kind::boolean:
        if (count_ % 8 == 0) held_ += '\0';
        if (std::get<bool>(*value)) held_.back() = static_cast<char>(held_.back() | (1 << (count_ % 8)));
        break;
      case Kind::flag:
        append_raw(held_, value == nullptr ? no_flag : static_cast<std::uint8_t>(std::get<bool>(*value)));
        break;
      case Kind::int32:
        append_raw(held_, value == nullptr ? no_int32 : static_cast<std::int32_t>(std::get<std::int64_t>(*value)));
        break;
      case Kind::int64: append_raw(held_, value == nullptr ? no_int64 : std::get<std::int64_t>(*value)); break;
      case Kind::real: append_raw(held_, value == nullptr ? no_real : real_of(*value)); break;
      case Kind::text:
        if (value != nullptr) {
          const std::string text = base::as_utf8(model::text_of(*value));
          held_ += text;
          length_ += text.size();
        }
        offsets_.push_back(static_cast<std::uint32_t>(length_));
        break;
    }
    ++count_;
    if (held_.size() >= 1U << 20U && count_ % 8 == 0) flush();
  }
  void flush() {
    bytes_->append(held_);
    held_.clear();
  }
  [[nodiscard]] auto length() const -> std::uint64_t { return length_; }
  [[nodiscard]] auto offsets() const -> const std::vector<std::uint32_t>& { return offsets_; }

 private:
  TableBytes* bytes_;
  Kind kind_;
  std::string held_;
  std::vector<std::uint32_t> offsets_{0};
  std::uint64_t count_ = 0, length_ = 0;
};

}  // namespace

PartColumns::PartColumns() {
  columns_.push_back(
      {"building_id", "building_id", "The feature that the part belongs to.", false, {}, true, false, Kind::text});
  columns_.push_back({"part_id", "part_id", "The part.", true, {}, true, false, Kind::text});
  columns_.push_back({"order",
                      "order",
                      "The place of the building in the order of its source, from 0.",
                      false,
                      {},
                      true,
                      false,
                      Kind::int32});
}

auto PartColumns::column(bool of_part, const std::string& name) -> std::uint32_t {
  const auto [at, added] = number_of_.try_emplace({of_part, name}, static_cast<std::uint32_t>(columns_.size()));
  if (added) {
    Column& fresh = columns_.emplace_back();
    fresh.name = base::as_utf8(name);
    fresh.of_part = of_part;
  }
  return at->second;
}

void PartColumns::add(Row& row, bool of_part, const std::string& name, const model::Value& value) {
  const std::uint32_t number = column(of_part, name);
  // What is no number is absent, as in JSON. Of two values of one name the last is kept: ours come after the source's.
  const auto* real = std::get_if<double>(&value);
  const bool absent = value.index() == 0 || (real != nullptr && !std::isfinite(*real));
  const auto before = std::ranges::find(row, number, [](const auto& cell) { return cell.first; });
  if (before != row.end()) row.erase(before);
  if (!absent) row.emplace_back(number, value);
}

auto PartColumns::row(const model::Building& building, const std::string& building_key, std::int64_t order,
                      const model::Part* part, const std::string& part_key) -> Row {
  Row row{{0, base::as_utf8(building_key)}, {2, order}};
  if (part != nullptr) row.emplace_back(1, base::as_utf8(part_key));
  for (const auto& [name, value] : building.attributes) add(row, false, name, value);
  if (part != nullptr)
    for (const auto& [name, value] : part->attributes) add(row, true, name, value);
  for (const auto& [number, value] : row) {
    Column& column = columns_[number];
    ++column.counts[value.index()];
    if (const auto* whole = std::get_if<std::int64_t>(&value))
      column.narrow = column.narrow && std::abs(static_cast<double>(*whole)) < 2147483648.0;
  }
  ++rows_;
  return row;
}

void PartColumns::settle() {
  std::set<std::string> taken;
  for (Column& column : columns_) {
    std::uint64_t present = 0;
    for (const auto count : column.counts) present += count;
    column.absent = present < rows_;
    column.kind = kind_of(column);
    std::string wanted = identifier_of(column.name);
    if (column.of_part && taken.contains(wanted)) wanted.insert(0, "part_");  // its building has it too
    column.identifier = wanted;
    for (int n = 2; !taken.insert(column.identifier).second; ++n) column.identifier = wanted + "_" + std::to_string(n);
  }
}

void PartColumns::append_schema(JsonText& json) const {
  json.key("classes").begin_object().key("part").begin_object().key("name").text("Part of a building");
  json.key("properties").begin_object();
  for (const Column& column : columns_) append_property(json, column);
  json.end_object().end_object();
  json.key(record_class).begin_object().key("name").text("What mansard reads models back from");
  json.key("properties").begin_object().key(record).begin_object().key("name").text(record).key("description");
  json.text("The building as a plans.json has it, at the first of its parts.").key("type").text("STRING");
  json.key("noData").text("").end_object().end_object().end_object();
  append_surface_class(json);
  json.end_object().key("enums").begin_object();
  std::vector<std::string_view> classes;
  for (std::size_t c = 0; c < class_count; ++c) classes.push_back(class_name(static_cast<model::FaceClass>(c)));
  append_enum(json, "surface_class", classes);
  append_enum(json, "flag", {"false", "true", "absent"});
  json.end_object();
}

void append_row(std::string& bytes, const Row& row) {
  append_raw(bytes, static_cast<std::uint32_t>(row.size()));
  for (const auto& [number, value] : row) {
    append_raw(bytes, number);
    append_raw(bytes, static_cast<std::uint8_t>(value.index()));
    if (const auto* flag = std::get_if<bool>(&value)) append_raw(bytes, static_cast<std::uint8_t>(*flag));
    if (const auto* whole = std::get_if<std::int64_t>(&value)) append_raw(bytes, *whole);
    if (const auto* real = std::get_if<double>(&value)) append_raw(bytes, *real);
    if (const auto* text = std::get_if<std::string>(&value)) {
      append_raw(bytes, static_cast<std::uint32_t>(text->size()));
      bytes += *text;
    }
  }
}

auto take_row(std::string_view& bytes) -> Row {
  Row row(take_raw<std::uint32_t>(bytes));
  for (auto& [number, value] : row) {
    number = take_raw<std::uint32_t>(bytes);
    switch (take_raw<std::uint8_t>(bytes)) {
      case 1: value = take_raw<std::uint8_t>(bytes) != 0; break;
      case 2: value = take_raw<std::int64_t>(bytes); break;
      case 3: value = take_raw<double>(bytes); break;
      case 4: {
        const auto length = take_raw<std::uint32_t>(bytes);
        value = std::string(bytes.substr(0, length));
        bytes.remove_prefix(length);
        break;
      }
      default: break;
    }
  }
  return row;
}

void TableBytes::begin() {
  if (const auto over = spool_->size() % 8; over != 0) spool_->append(std::string(8 - over, '\0'));
  views_.push_back({spool_->size(), 0});
}

auto TableBytes::end() -> std::size_t {
  views_.back().bytes = spool_->size() - views_.back().offset;
  return views_.size() - 1;
}

auto TableBytes::add(const Column& column, std::uint32_t number, base::Spool& rows, std::uint64_t count)
    -> base::Result<void> {
  const auto value_in = [&](const Row& row) -> const model::Value* {
    const auto cell = std::ranges::find(row, number, [](const auto& c) { return c.first; });
    return cell == row.end() ? nullptr : &cell->second;
  };
  bool any = false;
  const auto looked = for_each_row(rows, [&](const Row& row) {
    const model::Value* value = value_in(row);
    any = any || (value != nullptr && !model::text_of(*value).empty());
  });
  if (!looked) return looked.error();
  // A view must not be empty, and texts without a value would be one. Numbers are written even so: readers, the 3D
  // Tiles validator among them, expect a column of every property that the class declares.
  if (count == 0 || (!any && column.kind == Kind::text)) return {};
  begin();
  ColumnWriter writer(*this, column.kind);
  if (auto written = for_each_row(rows, [&](const Row& row) { writer.add(value_in(row)); }); !written)
    return written.error();
  writer.flush();
  TableColumn made{column.identifier, end(), 0, false};
  if (writer.length() > std::numeric_limits<std::uint32_t>::max())
    return base::error("write-glb-size", "an attribute is larger than the 4 GB a GLB can hold", column.name);
  if (column.kind == Kind::text) {
    begin();
    append({reinterpret_cast<const char*>(writer.offsets().data()), writer.offsets().size() * sizeof(std::uint32_t)});
    made.offsets = end();
    made.has_offsets = true;
  }
  columns_.push_back(std::move(made));
  return {};
}

auto TableBytes::add_texts(std::string_view identifier, base::Spool& texts, const std::vector<std::uint32_t>& offsets)
    -> base::Result<void> {
  if (texts.size() == 0) return {};
  begin();
  if (auto copied = texts.copy_to(*spool_); !copied) return copied;
  const std::size_t values = end();
  begin();
  append({reinterpret_cast<const char*>(offsets.data()), offsets.size() * sizeof(std::uint32_t)});
  columns_.push_back({std::string(identifier), values, end(), true});
  return {};
}

auto TableBytes::add_values(std::string_view identifier, base::Spool& values) -> base::Result<void> {
  begin();
  if (auto copied = values.copy_to(*spool_); !copied) return copied;
  columns_.push_back({std::string(identifier), end(), 0, false});
  return {};
}

}  // namespace mansard::formats::detail
