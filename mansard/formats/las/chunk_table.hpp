// The table of chunks of a LAZ file, which is compressed itself.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mansard/base/result.hpp"

namespace mansard::formats {

struct LazChunk {
  std::uint64_t points = 0;  ///< 0 where all chunks have the same number, which the file states elsewhere
  std::uint64_t bytes = 0;
};

/// `table` starts with the version and may be followed by other bytes. `most` is the largest number of chunks that the
/// file has space for. Fails with "ingest-points-format".
/// References: the LASzip specification (rapidlasso, "LASzip compressed LAS"): chunk table, integer compressor with 32
/// bits and two contexts; A. Said, "Introduction to Arithmetic Coding – Theory and Practice", HP Labs 2004: the
/// decoder.
[[nodiscard]] auto read_chunk_table(std::string_view table, bool with_counts, std::uint64_t most,
                                    const std::string& name) -> base::Result<std::vector<LazChunk>>;

}  // namespace mansard::formats
