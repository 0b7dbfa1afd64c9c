#include "mansard/formats/files/named_file.hpp"

#include <algorithm>

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

auto named_beside(const std::filesystem::path& folder, std::string name) -> std::filesystem::path {
  std::ranges::replace(name, '\\', '/');
  auto given = folder / name;
  if (is_there(given)) return given;
  auto here = folder / std::filesystem::path(name).filename();
  return is_there(here) ? here : given;
}

}  // namespace mansard::formats
