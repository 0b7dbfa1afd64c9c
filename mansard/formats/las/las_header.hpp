// Headers and records of LAS, versions 1.0 to 1.4.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/formats/files/ranges.hpp"
#include "mansard/geometry/points.hpp"

namespace mansard::formats {

/// A little-endian number at a place that exists. LAS is little endian; so are the machines that this runs on.
template <class T>
[[nodiscard]] auto number_at(std::string_view bytes, std::size_t at) -> T {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A variable length record (VLR), or an extended one.
struct LasRecord {
  std::string user;
  std::uint16_t id = 0;
  std::string content;
};

struct LasHeader {
  int minor = 0;             ///< LAS 1.minor
  std::uint16_t source = 0;  ///< file source ID: that of points whose own is 0
  std::uint32_t point_offset = 0;
  int format = 0;
  bool compressed = false;
  bool wkt = false;  ///< the flag that the CRS is WKT
  std::size_t record_length = 0;
  std::uint64_t points = 0;
  std::array<double, 3> scale{}, offset{};
  std::optional<geometry::Box3> bounds;  ///< none where not finite or upside down
  std::vector<LasRecord> records;        ///< of both kinds; none of more than 16 MB
  std::vector<base::Diagnostic> warnings;

  [[nodiscard]] auto find(std::string_view user, std::uint16_t id) const -> const LasRecord*;
};

/// Bytes of a record of the format, without extra ones; 0 for formats that are not known.
[[nodiscard]] auto length_of_format(int format) -> std::size_t;

/// Whether records of the format say where the waveform of the return is, in this many bytes before the extra ones.
[[nodiscard]] auto has_wave_packet(int format) -> bool;
inline constexpr std::size_t wave_packet_bytes = 29;

/// What is in the header is checked by itself and against the size of the file; records that run past the points are
/// left out with the warning "ingest-points-records". Fails with "ingest-points-format", "ingest-points-truncated",
/// "ingest-points-unsupported", "file-read".
[[nodiscard]] auto read_las_header(const RangeFile& file, const std::string& name) -> base::Result<LasHeader>;

}  // namespace mansard::formats
