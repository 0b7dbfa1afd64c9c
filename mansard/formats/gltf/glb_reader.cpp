#include "mansard/formats/gltf/glb_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "mansard/formats/detail/records.hpp"
#include "mansard/formats/gltf/glb_container.hpp"
#include "mansard/formats/json/json_access.hpp"

namespace mansard::formats::detail {
namespace {

auto no_glb(const Path& path, const std::string& what) -> base::Diagnostic {
  return base::error("write-read-format", what + "; give a file that mansard wrote", path.string());
}

/// Bytes of a file, never beyond its end.
class File {
 public:
  static auto open(const Path& path) -> base::Result<File> {
    std::error_code failure;
    if (!std::filesystem::exists(path, failure))
      return base::error("file-missing", "there is no such file", path.string());
    File file(path);
    file.file_.reset(std::filesystem::is_directory(path, failure) ? nullptr : std::fopen(path.c_str(), "rb"));
    if (!file.file_) return base::error("file-read", "cannot read this file", path.string());
    file.size_ = std::filesystem::file_size(path, failure);
    return file;
  }
  [[nodiscard]] auto size() const -> std::uint64_t { return size_; }
  auto read(std::uint64_t offset, std::uint64_t count) -> base::Result<std::string> {
    if (offset > size_ || count > size_ - offset) return no_glb(path_, "the file is cut short");
    std::string bytes(static_cast<std::size_t>(count), '\0');
    if (::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0 ||
        std::fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
      return base::error("file-read", std::string("cannot read this file: ") + std::strerror(errno), path_.string());
    return bytes;
  }

 private:
  explicit File(Path path) : path_(std::move(path)) {}
  Path path_;
  base::OpenFile file_;
  std::uint64_t size_ = 0;
};

template <class T>
auto numbers(const std::string& bytes) -> std::vector<T> {
  std::vector<T> out(bytes.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

struct Chunks {
  Json json;
  ByteRange binary;
};

auto chunks_of(File& file, const Path& path) -> base::Result<Chunks> {
  const auto glb = read_glb(file.size(), [&](ByteRange range) { return file.read(range.offset, range.size); });
  if (!glb) return glb.error();
  if (!glb->is_glb) return no_glb(path, "this is no binary glTF");
  if (glb->size > file.size()) return no_glb(path, "this GLB is cut short");
  if (!glb->json_complete) return no_glb(path, "the file is cut short");
  const auto text = file.read(glb->json.offset, glb->json.size);
  if (!text) return text.error();
  Chunks chunks{parse_gltf(*text), glb->binary};
  if (!chunks.json.is_object()) return no_glb(path, "the JSON of this GLB is broken");
  return chunks;
}

/// A member reached through objects and lists; null where there is none.
auto at(const Json& json, std::initializer_list<const char*> names) -> const Json& {
  static const Json none;
  const Json* here = &json;
  for (const char* name : names) {
    if (!here->is_object() || !here->contains(name)) return none;
    here = &(*here)[name];
  }
  return *here;
}

auto whole_of(const Json& value) -> std::optional<std::uint64_t> {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 1ULL << 48U) return std::nullopt;
  return value.get<std::uint64_t>();
}

/// A view that a property of a table names, as a piece of the file.
auto view_of(const Chunks& chunks, const Json& number) -> std::optional<RecordPlace> {
  const auto index = whole_of(number);
  const Json& views = at(chunks.json, {"bufferViews"});
  if (!index || !views.is_array() || *index >= views.size()) return std::nullopt;
  const Json& view = views[static_cast<std::size_t>(*index)];
  const Json& offset_json = at(view, {"byteOffset"});
  const auto offset = offset_json.is_null() ? std::optional<std::uint64_t>(0) : whole_of(offset_json);
  const auto size = whole_of(at(view, {"byteLength"}));
  if (!offset || !size || *offset > chunks.binary.size || *size > chunks.binary.size - *offset) return std::nullopt;
  return RecordPlace{0, chunks.binary.offset + *offset, *size};
}

auto table_of(const Chunks& chunks, std::string_view name) -> const Json& {
  static const Json none;
  const Json& tables = at(chunks.json, {"extensions", "EXT_structural_metadata", "propertyTables"});
  if (!tables.is_array()) return none;
  for (const Json& table : tables)
    if (at(table, {"class"}) == Json(name)) return table;
  return none;
}

class GlbReader : public CityReader {
 public:
  GlbReader(Path path, Header header, std::vector<RecordPlace> records)
      : path_(std::move(path)), header_(std::move(header)), records_(std::move(records)) {}

  auto header() const -> const Header& override { return header_; }
  auto has_models() const -> bool override { return false; }
  auto next() -> base::Result<std::optional<model::Building>> override {
    if (at_ == records_.size()) return std::optional<model::Building>();
    const auto& place = records_[at_++];
    const auto text = read_piece(path_, place.offset, place.bytes);
    if (!text) return text.error();
    auto building = read_building_record(*text, path_.string());
    if (!building) return building.error();
    return std::optional<model::Building>(std::move(*building));
  }

 private:
  Path path_;
  Header header_;
  std::vector<RecordPlace> records_;
  std::size_t at_ = 0;
};

}  // namespace

auto read_piece(const Path& path, std::uint64_t offset, std::uint64_t bytes) -> base::Result<std::string> {
  auto file = File::open(path);
  if (!file) return file.error();
  return file->read(offset, bytes);
}

auto glb_records(const Path& path) -> base::Result<GlbRecords> {
  auto file = File::open(path);
  if (!file) return file.error();
  const auto chunks = chunks_of(*file, path);
  if (!chunks) return chunks.error();
  GlbRecords out;
  if (const Json& header = at(chunks->json, {"asset", "extras", "header"}); header.is_object())
    out.header = header.dump();
  const Json& properties = at(table_of(*chunks, "part"), {"properties"});
  // In older files the record is a property of parts.
  const Json& own = at(table_of(*chunks, "plans"), {"properties"});
  const Json& record = at(own.is_null() ? properties : own, {"record"});
  if (record.is_null()) return out;
  const auto texts = view_of(*chunks, at(record, {"values"}));
  const auto ends = view_of(*chunks, at(record, {"stringOffsets"}));
  const auto orders = view_of(*chunks, at(properties, {"order", "values"}));
  if (!texts || !ends || !orders) return no_glb(path, "the table of buildings of this GLB cannot be followed");
  const auto end_bytes = file->read(ends->offset, ends->bytes), order_bytes = file->read(orders->offset, orders->bytes);
  if (!end_bytes) return end_bytes.error();
  if (!order_bytes) return order_bytes.error();
  const auto end = numbers<std::uint32_t>(*end_bytes);
  const auto order = numbers<std::int32_t>(*order_bytes);
  for (std::size_t row = 0; row + 1 < end.size() && row < order.size(); ++row) {
    if (end[row + 1] < end[row] || end[row + 1] > texts->bytes)
      return no_glb(path, "the table of buildings of this GLB cannot be followed");
    if (end[row + 1] > end[row]) out.records.push_back({order[row], texts->offset + end[row], end[row + 1] - end[row]});
  }
  return out;
}

auto glb_reader(const Path& path) -> ReaderResult {
  auto records = glb_records(path);
  if (!records) return records.error();
  if (records->header.empty())
    return base::error("write-read-plans", "this GLB carries no plans; give one that mansard wrote", path.string());
  auto header = read_header_record(records->header, path.string());
  if (!header) return header.error();
  return std::unique_ptr<CityReader>(
      std::make_unique<GlbReader>(path, std::move(*header), std::move(records->records)));
}

}  // namespace mansard::formats::detail
