// The container of binary glTF 2.0: a header, then a chunk of JSON and a binary one. It is parsed here for the reader
// of meshes, which has the file in memory, and for that of our own records, which reads pieces of it.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Bytes of a file.
struct ByteRange {
  std::uint64_t offset = 0, size = 0;
};

/// What the headers say. Which of it is an error is left to each reader.
struct Glb {
  bool is_glb = false;         ///< it begins as a GLB does whose first chunk is JSON
  bool json_complete = false;  ///< the JSON ends within the file
  std::uint32_t version = 0;
  std::uint64_t size = 0;  ///< of the file, as its header says
  ByteRange json;          ///< only if it is complete
  ByteRange binary;        ///< cut where the file ends; empty if there is none
};

/// `size` is that of the file; `read` returns the bytes of a range within it. Fails with what `read` fails with.
[[nodiscard]] auto read_glb(std::uint64_t size, const std::function<base::Result<std::string>(ByteRange)>& read)
    -> base::Result<Glb>;
/// Of a file in memory.
[[nodiscard]] auto read_glb(std::string_view bytes) -> Glb;

/// The JSON of a glTF; null for what is not an object, or nests too deep.
[[nodiscard]] auto parse_gltf(std::string_view json) -> nlohmann::ordered_json;

}  // namespace mansard::formats
