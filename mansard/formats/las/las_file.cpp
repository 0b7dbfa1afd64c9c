#include "mansard/formats/las/las_file.hpp"

#include <algorithm>
#include <array>

#include "mansard/base/text.hpp"
#include "mansard/formats/copc/hierarchy.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/las/chunk_table.hpp"
#include "mansard/formats/las/las_crs.hpp"
#include "mansard/formats/las/laz_sandbox.hpp"
#include "mansard/formats/las/wave_layers.hpp"

namespace mansard::formats {
namespace {

constexpr std::uint32_t variable_chunks = 0xffffffffU;
constexpr std::uint64_t records_of_a_piece = 65536;

enum Item : std::uint16_t {
  byte = 0,
  point10 = 6,
  gps_time = 7,
  rgb = 8,
  point14 = 10,
  rgb14 = 11,
  rgb_nir = 12,
  wave_packet14 = 13,
  byte14 = 14
};
struct ItemSize {
  std::uint16_t type, size;
};

/// What LASzip compresses a record of the format as. Formats 4 and 5 are not read.
auto items_of(int format, std::size_t extra) -> std::vector<ItemSize> {
  std::vector<ItemSize> items{format < 6 ? ItemSize{point10, 20} : ItemSize{point14, 30}};
  if (format == 1 || format == 3) items.push_back({gps_time, 8});
  if (format == 2 || format == 3) items.push_back({rgb, 6});
  if (format == 7) items.push_back({rgb14, 6});
  if (format == 8 || format == 10) items.push_back({rgb_nir, 8});
  if (has_wave_packet(format)) items.push_back({wave_packet14, wave_packet_bytes});
  if (extra > 0) items.push_back({format < 6 ? byte : byte14, static_cast<std::uint16_t>(extra)});
  return items;
}

auto has_colour(int format) -> bool {
  return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}
auto colour_at(int format) -> std::size_t { return format == 2 ? 20 : format == 3 || format == 5 ? 28 : 30; }

}  // namespace

auto LasFile::open(const std::filesystem::path& path) -> base::Result<std::unique_ptr<LasFile>> {
  auto out = std::make_unique<LasFile>();
  out->path_ = path;
  out->name_ = path.string();
  auto file = RangeFile::open(path);
  if (!file) return file.failure();
  out->file_ = std::move(*file);
  auto header = read_las_header(*out->file_, out->name_);
  if (!header) return header.failure();
  out->header_ = std::move(*header);
  if (auto found = out->find_pieces(); !found) return found.failure();
  out->describe();
  return out;
}

auto LasFile::find_pieces() -> base::Result<void> {
  if (!header_.compressed) return plain_pieces();
  const auto* record = header_.find("laszip encoded", 22204);
  if (record == nullptr || record->content.size() < 34)
    return base::error("ingest-points-format",
                       "the file is compressed and lacks the record that says how; copy or export it again", name_);
  if (auto checked = check_items(*record); !checked) return checked;
  if (!has_laz_decoder())
    if (auto decoded = decode_chunk({}, 0, 0, 0, name_); !decoded) return decoded.failure();
  const auto compressor = number_at<std::uint16_t>(record->content, 0);
  if (number_at<std::uint16_t>(record->content, 2) != 0)
    return base::error("ingest-points-unsupported", "it is compressed with an unknown coder; convert to LAS", name_);
  if (compressor == 1) {  // one sequence, without chunks
    if (header_.points > 0)
      pieces_.push_back({header_.point_offset, file_->size() - header_.point_offset, header_.points, {}});
    return {};
  }
  if (compressor != (header_.format < 6 ? 2 : 3))
    return base::error("ingest-points-unsupported",
                       "compressor " + std::to_string(compressor) + " is not read for point format " +
                           std::to_string(header_.format) + "; convert to LAS",
                       name_);
  if (nodes()) return {};
  return chunks(number_at<std::uint32_t>(record->content, 12));
}

/// Other versions of an item are decoded wrongly without an error.
auto LasFile::check_items(const LasRecord& record) const -> base::Result<void> {
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-points-format", "the record of its compression " + what + "; copy or export it again",
                       name_);
  };
  const auto& content = record.content;
  const auto count = number_at<std::uint16_t>(content, 32);
  if (content.size() < 34 + std::size_t{6} * count) return bad("is cut off");
  const auto expected = items_of(header_.format, header_.record_length - length_of_format(header_.format));
  if (count != expected.size())
    return bad("has " + std::to_string(count) + " items, and point format " + std::to_string(header_.format) + " has " +
               std::to_string(expected.size()));
  const int version = header_.format < 6 ? 2 : 3;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = 34 + 6 * i;
    if (number_at<std::uint16_t>(content, at) != expected[i].type ||
        number_at<std::uint16_t>(content, at + 2) != expected[i].size)
      return bad("does not fit point format " + std::to_string(header_.format));
    if (const auto own = number_at<std::uint16_t>(content, at + 4); own != version)
      return base::error("ingest-points-unsupported",
                         "it is compressed with version " + std::to_string(own) + " of LASzip's items, and version " +
                             std::to_string(version) + " is read; convert to LAS, or with LASzip 3.4",
                         name_);
  }
  return {};
}

auto LasFile::plain_pieces() -> base::Result<void> {
  const auto most = (file_->size() - header_.point_offset) / header_.record_length;
  if (header_.points > most)
    return base::error("ingest-points-truncated",
                       "the header counts " + std::to_string(header_.points) + " points, and the file has " +
                           std::to_string(most) + "; copy or export it again",
                       name_);
  for (std::uint64_t first = 0; first < header_.points; first += records_of_a_piece) {
    const auto count = std::min(records_of_a_piece, header_.points - first);
    pieces_.push_back({header_.point_offset + first * header_.record_length, count * header_.record_length, count, {}});
  }
  return {};
}

auto LasFile::chunks(std::uint32_t chunk_size) -> base::Result<void> {
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-points-format", what + "; copy or export it again", name_);
  };
  const std::uint64_t size = file_->size(), start = std::uint64_t{header_.point_offset} + 8;
  const auto beyond = [&] { return bad("its table of chunks is beyond the points or the file's end"); };
  const auto field = file_->read(header_.point_offset, 8);
  if (!field) return field.failure();
  if (field->view().size() < 8) {
    if (header_.points == 0) return {};
    return base::error("ingest-points-truncated", "the file ends before its points; copy or export it again", name_);
  }
  auto table_at = number_at<std::uint64_t>(field->view(), 0);
  if (table_at == ~std::uint64_t{0} && size >= start + 8) {  // written without seeking: the offset is at the end
    const auto last = file_->read(size - 8, 8);
    if (!last) return last.failure();
    table_at = number_at<std::uint64_t>(last->view(), 0);
  }
  if (table_at < start || table_at > size) return beyond();
  const bool variable = chunk_size == variable_chunks;
  if (chunk_size == 0) return bad("its chunks have no points");
  const auto table = file_->read(table_at, size - table_at);
  if (!table) return table.failure();
  const std::uint64_t space = table_at - start;
  // Every chunk starts with a record that is not compressed; a last one may be empty.
  auto listed = read_chunk_table(table->view(), variable, space / header_.record_length + 1, name_);
  if (!listed) return listed.failure();
  std::uint64_t at = start, points = 0;
  for (auto& chunk : *listed) {
    if (!variable) chunk.points = std::min<std::uint64_t>(chunk_size, header_.points - points);
    if (chunk.bytes > table_at - at) return beyond();
    if (chunk.points > 0) pieces_.push_back({at, chunk.bytes, chunk.points, {}});
    at += chunk.bytes;
    points += chunk.points;
  }
  if (points != header_.points)
    return bad("the header counts " + std::to_string(header_.points) + " points, and the " +
               std::to_string(listed->size()) + " chunks have " + std::to_string(points));
  return {};
}

/// The nodes of COPC in place of chunks, where its index is sound.
auto LasFile::nodes() -> bool {
  const auto* record = header_.find("copc", 1);
  if (record == nullptr || header_.format < 6) return false;
  auto hierarchy = read_copc_hierarchy(record->content, *file_, name_);
  std::string fault;
  if (!hierarchy) {
    fault = hierarchy.error().message;
  } else {
    std::uint64_t points = 0;
    for (const auto& node : hierarchy->nodes) points += node.points;
    if (points != header_.points)
      fault = "its nodes have " + std::to_string(points) + " points, and the header counts " +
              std::to_string(header_.points);
  }
  if (!fault.empty()) {
    header_.warnings.push_back(
        base::warning("ingest-points-index",
                      "the octree of COPC cannot be used (" + fault + "); the points are read without it", name_));
    return false;
  }
  is_copc_ = true;
  for (const auto& node : hierarchy->nodes)
    if (node.points > 0) pieces_.push_back({node.offset, node.bytes, node.points, node.box});
  std::ranges::sort(pieces_, {}, &Piece::offset);
  return true;
}

void LasFile::describe() {
  info_.format = (is_copc_             ? "COPC 1.0, LAS 1."
                  : header_.compressed ? "LAZ 1."
                                       : "LAS 1.") +
                 std::to_string(header_.minor);
  info_.point_format = header_.format;
  info_.points = header_.points;
  info_.stated_bounds = header_.bounds;
  if (auto crs = crs_of_las(header_, name_)) {
    info_.crs = std::move(crs->crs);
    info_.crs_title = std::move(crs->title);
    info_.unit = crs->unit;
  }
  info_.has_classes = info_.has_returns = true;
  info_.has_colours = has_colour(header_.format);
  info_.warnings = header_.warnings;
}

auto LasFile::records(std::size_t i) const -> base::Result<std::string> {
  const Piece& piece = pieces_[i];
  const auto bytes = file_->read(piece.offset, piece.bytes);
  if (!bytes) return bytes.failure();
  if (bytes->view().size() < piece.bytes)
    return base::error("ingest-points-truncated", "the file ends in its points; copy or export it again", name_);
  if (!header_.compressed) return std::string(bytes->view());
  return decoded(bytes->view(), piece.points);
}

auto LasFile::decoded(std::string_view chunk, std::uint64_t points) const -> base::Result<std::string> {
  if (!has_wave_packet(header_.format))
    return decode_chunk(chunk, header_.format, header_.record_length, points, name_);
  const auto without = without_wave_packets(chunk, header_.format, header_.record_length, points, name_);
  if (!without) return without.failure();
  return decode_chunk(*without, header_.format == 9 ? 6 : 8, bytes_of_record(), points, name_);
}

auto LasFile::bytes_of_record() const -> std::size_t {
  const bool without = header_.compressed && has_wave_packet(header_.format);
  return header_.record_length - (without ? wave_packet_bytes : 0);
}

auto LasFile::read(std::size_t i) const -> base::Result<std::vector<CloudPoint>> {
  const auto bytes = records(i);
  if (!bytes) return bytes.failure();
  std::vector<CloudPoint> out(static_cast<std::size_t>(pieces_[i].points));
  const bool wide = header_.format >= 6;
  const std::size_t length = bytes_of_record();
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto record = std::string_view(*bytes).substr(k * length, length);
    CloudPoint& point = out[k];
    const auto along = [&](std::size_t axis) {
      return header_.offset[axis] + header_.scale[axis] * number_at<std::int32_t>(record, 4 * axis);
    };
    point.position = {along(0), along(1), along(2)};
    point.intensity = number_at<std::uint16_t>(record, 12);
    const auto returns = static_cast<unsigned char>(record[14]), flags = static_cast<unsigned char>(record[15]);
    point.return_number = wide ? returns & 15U : returns & 7U;
    point.returns = wide ? returns >> 4U : returns >> 3U & 7U;
    point.classification = wide ? static_cast<std::uint8_t>(record[16]) : flags & 31U;
    point.withheld = (wide ? flags & 4U : flags & 128U) != 0;
    const auto source = number_at<std::uint16_t>(record, wide ? 20 : 18);
    point.source = source != 0 ? source : header_.source;
    if (has_colour(header_.format))
      for (std::size_t c = 0; c < 3; ++c)
        point.colour[c] = number_at<std::uint16_t>(record, colour_at(header_.format) + 2 * c);
  }
  return out;
}

auto LasFile::inputs() const -> base::Result<std::vector<model::InputFile>> {
  auto whole = file_->hash();
  if (!whole) return whole.failure();
  if (const auto& hash = *whole) return std::vector{model::InputFile{name_, file_->size(), *hash}};
  const auto head = file_->read(0, header_.point_offset);
  if (!head) return head.failure();
  std::string known(head->view());
  for (const auto& piece : pieces_)
    known +=
        std::to_string(piece.offset) + " " + std::to_string(piece.bytes) + " " + std::to_string(piece.points) + "\n";
  return std::vector{model::InputFile{name_, file_->size(), sha256(known)}};
}

}  // namespace mansard::formats
