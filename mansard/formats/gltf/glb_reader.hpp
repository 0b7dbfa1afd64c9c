// The records of buildings that travel in a GLB.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {

/// Where a record stands in its file.
struct RecordPlace {
  std::int64_t order = 0;  ///< of its building, in the whole city
  std::uint64_t offset = 0, bytes = 0;
};

struct GlbRecords {
  std::string header;                ///< that of a plans.json, as JSON; empty where there is none
  std::vector<RecordPlace> records;  ///< in the order of the table
};

/// What a GLB that mansard wrote carries. Fails with "write-read-format" (no GLB, or none whose tables can be
/// followed), "file-missing", "file-read".
[[nodiscard]] auto glb_records(const Path& path) -> base::Result<GlbRecords>;

/// The bytes of a record. Fails with "file-read".
[[nodiscard]] auto read_piece(const Path& path, std::uint64_t offset, std::uint64_t bytes) -> base::Result<std::string>;

}  // namespace mansard::formats::detail
