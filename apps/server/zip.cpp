#include "apps/server/zip.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

#include "mansard/base/files.hpp"
#include "mansard/base/text.hpp"

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

auto number_at(std::string_view bytes, std::size_t at, std::size_t count) -> std::uint64_t {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

auto refused(const std::string& why, const fs::path& zip) -> base::Diagnostic {
  return base::error("server-archive", why, zip.string());
}

/// A relative path below the folder, with '/' between its parts.
auto stays_inside(std::string_view name) -> bool {
  if (name.empty() || name.front() == '/' || name.find('\\') != name.npos || name.find('\0') != name.npos) return false;
  for (const auto& word : fs::path(name))
    if (word == ".." || word == "." || word.empty()) return false;
  return true;
}

struct Stored {
  std::string name;
  std::uint32_t crc = 0;
  std::string_view content;
};

/// The files that the central directory lists. All places are checked against the length of the archive.
auto stored_in(std::string_view bytes, const fs::path& zip) -> base::Result<std::vector<Stored>> {
  const auto damaged = [&] { return refused("the ZIP file is damaged or incomplete; copy or download it again", zip); };
  constexpr std::size_t end_size = 22, entry_size = 46, local_size = 30;
  const auto end = bytes.rfind("PK\x05\x06");
  if (end == bytes.npos || end + end_size > bytes.size()) return damaged();
  const auto count = number_at(bytes, end + 10, 2);
  std::uint64_t at = number_at(bytes, end + 16, 4);
  std::vector<Stored> files;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (at + entry_size > end || bytes.substr(at, 4) != "PK\x01\x02") return damaged();
    const auto flags = number_at(bytes, at + 8, 2), method = number_at(bytes, at + 10, 2);
    const auto size = number_at(bytes, at + 24, 4), name_size = number_at(bytes, at + 28, 2);
    const auto local = number_at(bytes, at + 42, 4);
    if (at + entry_size + name_size > end) return damaged();
    const std::string name(bytes.substr(at + entry_size, name_size));
    const auto crc = static_cast<std::uint32_t>(number_at(bytes, at + 16, 4));
    at += entry_size + name_size + number_at(bytes, at + 30, 2) + number_at(bytes, at + 32, 2);
    if (name.ends_with('/')) continue;  // a folder
    if (!stays_inside(name)) return refused("the ZIP file has a file with a name that is not valid", zip);
    if (method != 0 || (flags & 1) != 0)
      return refused("the ZIP file is compressed or encrypted; unpack it, and open what was in it", zip);
    if (local + local_size > bytes.size() || bytes.substr(local, 4) != "PK\x03\x04") return damaged();
    const auto start = local + local_size + number_at(bytes, local + 26, 2) + number_at(bytes, local + 28, 2);
    if (start > bytes.size() || size > bytes.size() - start) return damaged();
    files.push_back({name, crc, bytes.substr(start, size)});
  }
  std::uint64_t all = 0;  // entries that share their bytes would make more files than the archive has bytes
  for (const auto& file : files) all += file.content.size();
  if (all > bytes.size()) return damaged();
  return files;
}

}  // namespace

auto is_zip(const fs::path& path) -> bool { return base::lower(path.extension().string()) == ".zip"; }

auto names_in_zip(const fs::path& zip) -> base::Result<std::vector<std::string>> {
  const auto bytes = base::read_file(zip);
  if (!bytes) return bytes.error();
  const auto files = stored_in(*bytes, zip);
  if (!files) return files.error();
  std::vector<std::string> names;
  for (const auto& file : *files) names.push_back(file.name);
  return names;
}

auto unzip(const fs::path& zip, const fs::path& folder) -> base::Result<void> {
  const auto bytes = base::read_file(zip);
  if (!bytes) return bytes.error();
  const auto files = stored_in(*bytes, zip);
  if (!files) return files.error();
  for (const auto& file : *files) {
    if (crc_of(file.content) != file.crc)
      return refused("the ZIP file is damaged: the check sum of '" + file.name + "' is wrong; copy it again", zip);
    const auto path = folder / file.name;
    std::error_code failure;
    fs::create_directories(path.parent_path(), failure);
    if (std::ofstream out(path, std::ios::binary); !out.write(file.content.data(), std::ssize(file.content)).flush())
      return base::error("file-write", "cannot be written; check the disk's free space", path.string());
  }
  return {};
}

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
