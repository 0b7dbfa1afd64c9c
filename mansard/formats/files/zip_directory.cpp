#include "mansard/formats/files/zip_directory.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::formats {
namespace {

auto number_at(std::string_view bytes, std::uint64_t at, std::size_t count) -> std::uint64_t {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

struct Directory {
  std::string_view bytes;
  std::uint64_t entries = 0;
};

/// Between the last file and the record at the end, or that of ZIP64 before it.
auto directory_of(std::string_view bytes) -> std::optional<Directory> {
  constexpr std::size_t end_size = 22, locator_size = 20, end_size_64 = 56, most_comment = 0xFFFF;
  if (bytes.size() < end_size) return std::nullopt;
  const std::size_t first = bytes.size() - std::min(bytes.size(), end_size + most_comment);
  const auto end = bytes.substr(first).rfind("PK\x05\x06");
  if (end == bytes.npos || first + end + end_size > bytes.size()) return std::nullopt;
  std::uint64_t at = first + end, entries = number_at(bytes, at + 10, 2), size = number_at(bytes, at + 12, 4);
  if (at >= locator_size && bytes.substr(at - locator_size, 4) == "PK\x06\x07") {
    const auto large = number_at(bytes, at - locator_size + 8, 8);
    if (large > bytes.size() || bytes.size() - large < end_size_64 || bytes.substr(large, 4) != "PK\x06\x06")
      return std::nullopt;
    at = large;
    entries = number_at(bytes, at + 32, 8);
    size = number_at(bytes, at + 40, 8);
  }
  if (size > at) return std::nullopt;
  return Directory{bytes.substr(at - size, size), entries};
}

auto is_plain(std::string_view name) -> bool {
  if (name.empty() || name.front() == '/') return false;
  if (!std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~' && c != '\\'; })) return false;
  for (std::size_t at = 0; at <= name.size();) {
    const auto end = std::min(name.find('/', at), name.size());
    const auto word = name.substr(at, end - at);
    if ((word.empty() && end != name.size()) || word == "." || word == "..") return false;
    at = end + 1;
  }
  return true;
}

}  // namespace

auto names_in_zip(const std::filesystem::path& archive) -> std::optional<std::vector<std::string>> {
  const auto bytes = Bytes::of(archive);
  if (!bytes) return std::nullopt;
  const auto directory = directory_of(bytes->view());
  if (!directory) return std::nullopt;
  constexpr std::size_t entry_size = 46;
  const auto all = directory->bytes;
  std::vector<std::string> names;
  std::uint64_t at = 0;
  for (std::uint64_t i = 0; i < directory->entries; ++i) {
    if (at + entry_size > all.size() || all.substr(at, 4) != "PK\x01\x02") return std::nullopt;
    const auto length = number_at(all, at + 28, 2);
    if (at + entry_size + length > all.size()) return std::nullopt;
    const auto name = all.substr(at + entry_size, length);
    if (!is_plain(name)) return std::nullopt;
    if (!name.ends_with('/')) names.emplace_back(name);
    at += entry_size + length + number_at(all, at + 30, 2) + number_at(all, at + 32, 2);
  }
  return names;
}

}  // namespace mansard::formats
