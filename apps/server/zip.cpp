#include "apps/server/zip.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "mansard/base/files.hpp"

namespace mansard::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t longest = std::numeric_limits<std::uint32_t>::max() - 1, most = 65'534;
constexpr std::uint16_t needed = 20;                    // 2.0: files in folders
constexpr std::uint16_t day = (0 << 9) | (1 << 5) | 1;  // 1980-01-01, the earliest date of the format

auto crc_table() -> std::array<std::uint32_t, 256> {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    auto rest = i;
    for (int bit = 0; bit < 8; ++bit) rest = (rest & 1) != 0 ? (rest >> 1) ^ 0xEDB88320U : rest >> 1;
    table[i] = rest;
  }
  return table;
}

auto crc_of(std::string_view bytes) -> std::uint32_t {
  static const auto table = crc_table();
  std::uint32_t crc = ~0U;
  for (const char c : bytes) crc = table[(crc ^ static_cast<unsigned char>(c)) & 0xFF] ^ (crc >> 8);
  return ~crc;
}

void put(std::string& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
}

struct Entry {
  std::string name;
  std::uint32_t crc = 0;
  std::uint64_t size = 0, offset = 0;
};

/// The fields that a local header and its entry in the central directory share.
void put_common(std::string& bytes, const Entry& entry) {
  put(bytes, needed, 2);
  put(bytes, 0, 2);  // flags
  put(bytes, 0, 2);  // stored
  put(bytes, 0, 2);  // midnight
  put(bytes, day, 2);
  put(bytes, entry.crc, 4);
  put(bytes, entry.size, 4);  // compressed
  put(bytes, entry.size, 4);
  put(bytes, entry.name.size(), 2);
  put(bytes, 0, 2);  // extra
}

void put_file(std::string& bytes, const Entry& entry, std::string_view content) {
  bytes += "PK\x03\x04";
  put_common(bytes, entry);
  bytes += entry.name;
  bytes += content;
}

void put_directory(std::string& bytes, const std::vector<Entry>& entries) {
  const auto start = bytes.size();
  for (const auto& entry : entries) {
    bytes += "PK\x01\x02";
    put(bytes, needed, 2);  // made by
    put_common(bytes, entry);
    put(bytes, 0, 2);  // comment
    put(bytes, 0, 2);  // disk
    put(bytes, 0, 2);  // attributes
    put(bytes, 0, 4);
    put(bytes, entry.offset, 4);
    bytes += entry.name;
  }
  const auto size = bytes.size() - start;
  bytes += "PK\x05\x06";
  put(bytes, 0, 4);  // disks
  put(bytes, entries.size(), 2);
  put(bytes, entries.size(), 2);
  put(bytes, size, 4);
  put(bytes, start, 4);
  put(bytes, 0, 2);  // comment
}

}  // namespace

auto zip_of(const fs::path& folder) -> base::Result<std::string> {
  std::vector<std::string> names;
  std::error_code failure;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
    if (at->is_regular_file(failure)) names.push_back(at->path().lexically_relative(folder).generic_string());
  if (failure) return base::error("file-read", "cannot list the folder: " + failure.message(), folder.string());
  std::ranges::sort(names);
  std::string bytes;
  std::vector<Entry> entries;
  std::uint64_t directory = 22;  // its end record; an entry has 46 bytes and the name
  for (const auto& name : names) {
    const auto content = base::read_file(folder / name);
    if (!content) return content.error();
    Entry entry{name, crc_of(*content), content->size(), bytes.size()};
    directory += 46 + name.size();
    const auto file = 30 + name.size() + content->size();
    if (entries.size() >= most || bytes.size() + file + directory > longest)
      return base::error(
          "server-large",
          "the files exceed the limits of a ZIP file (4 GB, 65,535 files); export them into the project's folder",
          folder.filename().string());
    put_file(bytes, entry, *content);
    entries.push_back(std::move(entry));
  }
  put_directory(bytes, entries);
  return bytes;
}

}  // namespace mansard::server
