#include "mansard/formats/files/named_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "mansard/formats/files/reach.hpp"

namespace mansard::formats {

auto bytes_of_named(const std::filesystem::path& path) -> base::Result<Bytes> {
  const std::string name = path.string();
  std::error_code failure;
  const auto type = std::filesystem::status(path, failure).type();
  using Type = std::filesystem::file_type;
  const bool endless = type == Type::character || type == Type::block || type == Type::fifo || type == Type::socket;
  if (endless || name.find("/vsistdin/") != name.npos)
    return base::error("file-read", "a file names this, which is no file but a device; check who made it", name);
  return Bytes::of(path);
}

namespace {

/// By the mark that such text begins with, or by the zeros around its first characters; empty for all else. "<" is XML.
auto wide_encoding(std::string_view start) -> std::string {
  using namespace std::string_view_literals;
  const auto is_letter = [&](std::size_t at) { return start[at] > ' ' && start[at] <= '~' && start[at] != '<'; };
  struct Mark {
    std::string_view bytes;
    const char* name;
    std::size_t first;  // of the first character
  };
  for (const auto& [bytes, name, first] : {Mark{"\xFF\xFE\0\0"sv, "UTF-32", 4}, Mark{"\0\0\xFE\xFF"sv, "UTF-32", 7},
                                           Mark{"\xFF\xFE"sv, "UTF-16", 2}, Mark{"\xFE\xFF"sv, "UTF-16", 3}})
    if (start.starts_with(bytes)) return start.size() > first && start[first] == '<' ? std::string() : name;
  if (start.size() < 8) return {};
  for (const std::size_t zero : {0U, 1U}) {
    bool wide = true;
    for (std::size_t i = 0; i < 8; i += 2) wide = wide && start[i + zero] == '\0' && is_letter(i + 1 - zero);
    if (wide) return "UTF-16";
  }
  return {};
}

}  // namespace

auto check_text(const std::filesystem::path& path) -> base::Result<void> {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return {};
  std::array<char, 16> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  const auto encoding = wide_encoding({start.data(), static_cast<std::size_t>(file.gcount())});
  if (encoding.empty()) return {};
  return base::error("file-read", "this is text in " + encoding + "; save it in UTF-8", path.string());
}

auto named_beside(const std::filesystem::path& given, const std::filesystem::path& from, std::string name)
    -> base::Result<std::filesystem::path> {
  std::ranges::replace(name, '\\', '/');
  const auto folder = from.parent_path();
  auto path = folder / name;
  const auto reach = check_reach(given, path);
  if (reach && is_there(path)) return path;
  auto here = folder / std::filesystem::path(name).filename();
  if (check_reach(given, here) && is_there(here)) return here;
  return reach ? base::Result<std::filesystem::path>(std::move(path)) : reach.failure();
}

}  // namespace mansard::formats
