// Waveforms in LAZ: chunks of point formats 9 and 10 as chunks of 6 and 8.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// A chunk of point format 9 or 10 without the wave packets of its points: a chunk of format 6 or 8 with the same
/// points. Nothing is decoded: every attribute has a layer of its own in the chunk, and those of the others stay as
/// they are. `record_length` is that of the file. Fails with "ingest-points-format" where the sizes of the layers, or
/// `count`, do not agree with the chunk; `name` is the subject.
/// Reference: the LASzip specification and its implementation (LASzip 3.5.1): a chunk has its first record, its number
/// of points (32 bits), the size of every layer in bytes (32 bits each) and the layers, in the order of the items. The
/// items are POINT14 (9 layers), RGBNIR14 (2), WAVEPACKET14 (1) and BYTE14 (1 for every extra byte).
[[nodiscard]] auto without_wave_packets(std::string_view chunk, int format, std::size_t record_length,
                                        std::uint64_t count, const std::string& name) -> base::Result<std::string>;

}  // namespace mansard::formats
