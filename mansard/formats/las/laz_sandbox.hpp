// Decodes one chunk of LAZ in a sandbox: laz-perf as WebAssembly, translated to C at build time by Debian's wasm2c. The
// code can reach nothing but a memory of its own, and every access is checked.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Whether this program was built with the decoder (CMake option MANSARD_LAZ).
[[nodiscard]] auto has_laz_decoder() -> bool;

/// The records of a chunk of `count` points, one after the other, `record_length` bytes each, as uncompressed LAS has
/// them. `point_format` is one of 0–3 and 6–8. Each call has an instance of its own, which is discarded afterwards, so
/// that the result depends on the chunk alone. From any thread. The first fault ends the decoding: an access beyond the
/// chunk or the instance's memory, or an exception of the decoder. Fails with "ingest-points-format" (the words of the
/// fault), "ingest-memory", "ingest-points-unsupported" where there is no decoder; `name` is the subject.
/// Cost: 0.1 ms, and 0.6 to 1.5 µs a point.
[[nodiscard]] auto decode_chunk(std::string_view chunk, int point_format, std::size_t record_length,
                                std::uint64_t count, const std::string& name) -> base::Result<std::string>;

}  // namespace mansard::formats
