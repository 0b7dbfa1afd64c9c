#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "mansard/crs/gdal_messages.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/las_points.hpp"

namespace mansard::formats {
namespace {

constexpr std::size_t header_size = 375, record_head = 54, plain_size = 30, coloured_size = 36;
constexpr double scale = 0.001;

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}
void put_text(std::string& bytes, std::size_t at, std::string_view text) {
  std::memcpy(bytes.data() + at, text.data(), text.size());
}

/// WKT 1, as LAS 1.4 asks for; empty for a local frame.
auto wkt_of_frame(const model::Frame& frame) -> std::string {
  if (frame.crs.empty()) return {};
  const crs::GdalMessages messages;
  const auto system = crs::from_words(frame.crs);
  if (!system) return {};
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT1_GDAL", "MULTILINE=NO", nullptr};
  std::string wkt = system->system.exportToWkt(&text, options) == OGRERR_NONE && text != nullptr ? text : "";
  CPLFree(text);
  return wkt;
}

}  // namespace

auto las(std::span<const CloudPoint> points, const model::Frame& frame) -> base::Result<std::string> {
  const std::string wkt = wkt_of_frame(frame);
  const bool coloured = std::ranges::any_of(points, [](const CloudPoint& p) { return std::ranges::max(p.colour) > 0; });
  const std::size_t record_size = coloured ? coloured_size : plain_size;
  const std::size_t record = wkt.empty() ? 0 : record_head + wkt.size() + 1;
  const std::size_t first = header_size + record;
  std::string out(first, '\0');
  out.reserve(first + points.size() * record_size);
  std::array<std::int32_t, 3> least{}, most{};
  least.fill(std::numeric_limits<std::int32_t>::max());
  most.fill(std::numeric_limits<std::int32_t>::min());
  std::array<std::uint64_t, 15> by_return{};
  std::string bytes(record_size, '\0');
  for (const auto& p : points) {
    const std::array<double, 3> at{p.position.x, p.position.y, p.position.z};
    bytes.assign(record_size, '\0');
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double units = std::floor(at[axis] / scale + 0.5);
      if (!(std::abs(units) < std::numeric_limits<std::int32_t>::max()))
        return base::error("write-las", "a point is not finite, or too far from the origin of its frame");
      const auto unit = static_cast<std::int32_t>(units);
      least[axis] = std::min(least[axis], unit);
      most[axis] = std::max(most[axis], unit);
      std::memcpy(bytes.data() + 4 * axis, &unit, 4);
    }
    std::memcpy(bytes.data() + 12, &p.intensity, 2);
    bytes[14] = static_cast<char>((p.return_number & 15U) | (p.returns & 15U) << 4U);
    bytes[15] = static_cast<char>(p.withheld ? 4 : 0);
    bytes[16] = static_cast<char>(p.classification);
    put(bytes, 20, p.source);
    for (std::size_t c = 0; coloured && c < 3; ++c) put(bytes, plain_size + 2 * c, p.colour[c]);
    out.append(bytes);
    if (p.return_number >= 1 && p.return_number <= by_return.size()) ++by_return[p.return_number - 1U];
  }

  put_text(out, 0, "LASF");
  put<std::uint16_t>(out, 6, 16U);  // the CRS is WKT
  out[24] = 1;
  out[25] = 4;
  put_text(out, 58, "mansard");
  put<std::uint16_t>(out, 94, header_size);
  put<std::uint32_t>(out, 96, static_cast<std::uint32_t>(first));
  put<std::uint32_t>(out, 100, wkt.empty() ? 0U : 1U);
  out[104] = static_cast<char>(coloured ? 7 : 6);
  put(out, 105, static_cast<std::uint16_t>(record_size));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto origin = static_cast<double>(frame.origin[axis]);
    put(out, 131 + 8 * axis, scale);
    put(out, 155 + 8 * axis, origin);
    if (points.empty()) continue;
    put(out, 179 + 16 * axis, origin + scale * most[axis]);
    put(out, 187 + 16 * axis, origin + scale * least[axis]);
  }
  put<std::uint64_t>(out, 247, points.size());
  for (std::size_t i = 0; i < by_return.size(); ++i) put(out, 255 + 8 * i, by_return[i]);
  if (!wkt.empty()) {
    put_text(out, header_size + 2, "LASF_Projection");
    put<std::uint16_t>(out, header_size + 18, 2112);
    put<std::uint16_t>(out, header_size + 20, static_cast<std::uint16_t>(wkt.size() + 1));
    put_text(out, header_size + record_head, wkt);
  }
  return out;
}

}  // namespace mansard::formats
