#include "mansard/formats/gltf/glb_container.hpp"

#include <algorithm>

#include "mansard/base/nesting.hpp"

namespace mansard::formats {
namespace {

constexpr std::uint64_t header = 12, chunk_header = 8;

/// Little endian.
auto word_at(std::string_view bytes, std::size_t at) -> std::uint32_t {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return word;
}

}  // namespace

auto read_glb(std::uint64_t size, const std::function<base::Result<std::string>(ByteRange)>& read)
    -> base::Result<Glb> {
  Glb glb;
  const auto head = read({0, std::min(header + chunk_header, size)});
  if (!head) return head.error();
  if (head->size() >= header) glb.version = word_at(*head, 4), glb.size = word_at(*head, 8);
  if (head->size() < header + chunk_header) return glb;
  glb.is_glb = head->starts_with("glTF") && head->ends_with("JSON");
  const std::uint64_t json = header + chunk_header, json_size = word_at(*head, header);
  glb.json_complete = json_size <= size - json;
  if (!glb.json_complete) return glb;
  glb.json = {json, json_size};
  const std::uint64_t next = json + json_size, binary = next + chunk_header;
  if (size < binary) return glb;
  const auto word = read({next, 4});
  if (!word) return word.error();
  glb.binary = {binary, std::min<std::uint64_t>(word_at(*word, 0), size - binary)};
  return glb;
}

auto read_glb(std::string_view bytes) -> Glb {
  const auto glb = read_glb(bytes.size(), [bytes](ByteRange range) {
    return base::Result<std::string>(std::string(bytes.substr(range.offset, range.size)));
  });
  return glb ? *glb : Glb();  // memory is always read
}

auto parse_gltf(std::string_view json) -> nlohmann::ordered_json {
  using Json = nlohmann::ordered_json;
  if (base::nests_too_deep(json)) return {};
  Json parsed = Json::parse(json, nullptr, false);
  return parsed.is_object() ? parsed : Json();
}

}  // namespace mansard::formats
