#include "mansard/formats/las/las_header.hpp"

#include <algorithm>
#include <cmath>

#include "mansard/base/text.hpp"

namespace mansard::formats {
namespace {

constexpr std::array<std::size_t, 11> lengths{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::uint64_t largest_record = 16U << 20;

/// The text before the first zero.
auto text_at(std::string_view bytes, std::size_t at, std::size_t most) -> std::string {
  const auto field = bytes.substr(at, most);
  return std::string(field.substr(0, field.find('\0')));
}

/// Of 1.0–1.2, of 1.3, of 1.4.
auto header_length(int minor) -> std::size_t { return minor < 3 ? 227 : minor == 3 ? 235 : 375; }

struct Records {
  const RangeFile& file;
  LasHeader& header;
  const std::string& name;

  void warn(const std::string& what) const {
    header.warnings.push_back(base::warning(
        "ingest-points-records", what + "; the points are read all the same, maybe without their CRS", name));
  }

  /// Those between the header and the points.
  [[nodiscard]] auto plain(std::uint64_t at, std::uint32_t count) const -> base::Result<void> {
    constexpr std::size_t head = 54;
    const auto end = std::min<std::uint64_t>(header.point_offset, file.size());
    const auto block = file.read(at, end > at ? end - at : 0);
    if (!block) return block.failure();
    auto bytes = block->view();
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto length = bytes.size() < head ? 0 : number_at<std::uint16_t>(bytes, 20);
      if (bytes.size() < head + length) {
        warn("record " + std::to_string(i + 1) + " of " + std::to_string(count) +
             " of the header runs into the points");
        return {};
      }
      header.records.push_back(
          {text_at(bytes, 2, 16), number_at<std::uint16_t>(bytes, 18), std::string(bytes.substr(head, length))});
      bytes.remove_prefix(head + length);
    }
    return {};
  }

  /// Those behind the points.
  [[nodiscard]] auto extended(std::uint64_t at, std::uint32_t count) const -> base::Result<void> {
    constexpr std::size_t head = 60;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto first = file.read(at, head);
      if (!first) return first.failure();
      const auto bytes = first->view();
      const auto length = bytes.size() < head ? 0 : number_at<std::uint64_t>(bytes, 20);
      if (bytes.size() < head || length > file.size() || at + head + length > file.size()) {
        warn("extended record " + std::to_string(i + 1) + " of " + std::to_string(count) + " is beyond the file's end");
        return {};
      }
      LasRecord record{text_at(bytes, 2, 16), number_at<std::uint16_t>(bytes, 18), {}};
      if (length <= largest_record && record.user == "LASF_Projection") {
        const auto content = file.read(at + head, length);
        if (!content) return content.failure();
        record.content = std::string(content->view());
      }
      header.records.push_back(std::move(record));
      at += head + length;
    }
    return {};
  }
};

}  // namespace

auto LasHeader::find(std::string_view user, std::uint16_t id) const -> const LasRecord* {
  const auto at = std::ranges::find_if(records, [&](const LasRecord& r) { return r.user == user && r.id == id; });
  return at == records.end() ? nullptr : &*at;
}

auto length_of_format(int format) -> std::size_t {
  return format >= 0 && format < static_cast<int>(lengths.size()) ? lengths[static_cast<std::size_t>(format)] : 0;
}

auto has_wave_packet(int format) -> bool { return format == 4 || format == 5 || format == 9 || format == 10; }

auto read_las_header(const RangeFile& file, const std::string& name) -> base::Result<LasHeader> {
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-points-format", what + "; copy or export it again", name);
  };
  const auto unsupported = [&](const std::string& what) {
    return base::error("ingest-points-unsupported", what, name);
  };
  if (file.size() == 0) return bad("the file is empty");
  const auto first = file.read(0, header_length(4));
  if (!first) return first.failure();
  const auto bytes = first->view();
  if (!bytes.starts_with("LASF")) return bad("the file is not LAS or LAZ, which begin with LASF");
  const auto truncated = [&] {
    return base::error("ingest-points-truncated", "the file ends in its header; copy or export it again", name);
  };
  if (bytes.size() < header_length(0)) return truncated();

  LasHeader header;
  const int major = static_cast<unsigned char>(bytes[24]);
  header.minor = static_cast<unsigned char>(bytes[25]);
  if (major != 1 || header.minor > 4)
    return unsupported("LAS " + std::to_string(major) + "." + std::to_string(header.minor) +
                       " is not read; convert to one of 1.0 to 1.4");
  if (bytes.size() < header_length(header.minor)) return truncated();
  const auto header_size = number_at<std::uint16_t>(bytes, 94);
  if (header.minor > 0) header.source = number_at<std::uint16_t>(bytes, 4);  // reserved in LAS 1.0
  header.wkt = (number_at<std::uint16_t>(bytes, 6) & 16U) != 0;
  header.point_offset = number_at<std::uint32_t>(bytes, 96);
  const auto kind = static_cast<unsigned char>(bytes[104]);
  header.compressed = (kind & 0xc0U) != 0;
  header.format = kind & 0x3f;
  header.record_length = number_at<std::uint16_t>(bytes, 105);
  header.points = number_at<std::uint32_t>(bytes, 107);
  if (header.minor >= 4)
    if (const auto wide = number_at<std::uint64_t>(bytes, 247); wide != 0) header.points = wide;

  if (length_of_format(header.format) == 0)
    return bad("point format " + std::to_string(header.format) + " does not exist; the formats are 0 to 10");
  // Of the formats with waveforms a record is that of another one with 29 bytes more, which are not read. In LAZ they
  // are a layer of formats 9 and 10; in 4 and 5 they are coded between the other attributes, and the decoder lacks
  // them.
  if (header.compressed && header.format < 6 && has_wave_packet(header.format))
    return unsupported("point format " + std::to_string(header.format) +
                       " has waveforms, and is not read from LAZ; convert it to LAS with laszip, or to point format " +
                       (header.format == 4 ? "1" : "3") + " with las2las");
  if (header.record_length < length_of_format(header.format))
    return bad("its points have " + std::to_string(header.record_length) + " bytes each, and format " +
               std::to_string(header.format) + " has " + std::to_string(length_of_format(header.format)));
  if (header_size < header_length(header.minor < 3 ? 0 : header.minor) && header_size < header_length(0))
    return bad("its header is " + std::to_string(header_size) + " bytes long");
  if (header.point_offset < header_size || header.point_offset > file.size())
    return bad("its points begin at byte " + std::to_string(header.point_offset) + ", and the file has " +
               std::to_string(file.size()));

  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale[axis] = number_at<double>(bytes, 131 + 8 * axis);
    header.offset[axis] = number_at<double>(bytes, 155 + 8 * axis);
    if (!std::isfinite(header.scale[axis]) || header.scale[axis] == 0 || !std::isfinite(header.offset[axis]))
      return bad("scale " + base::to_text(header.scale[axis]) + " and offset " + base::to_text(header.offset[axis]) +
                 " give no coordinates");
  }
  const geometry::Box3 box{
      {number_at<double>(bytes, 187), number_at<double>(bytes, 203), number_at<double>(bytes, 219)},
      {number_at<double>(bytes, 179), number_at<double>(bytes, 195), number_at<double>(bytes, 211)}};
  const auto finite = [](geometry::Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  if (finite(box.least) && finite(box.most) && box.least.x <= box.most.x && box.least.y <= box.most.y &&
      box.least.z <= box.most.z)
    header.bounds = box;

  const Records records{file, header, name};
  if (auto done = records.plain(header_size, number_at<std::uint32_t>(bytes, 100)); !done) return done.failure();
  if (header.minor >= 4)
    if (auto done = records.extended(number_at<std::uint64_t>(bytes, 235), number_at<std::uint32_t>(bytes, 243)); !done)
      return done.failure();
  return header;
}

}  // namespace mansard::formats
