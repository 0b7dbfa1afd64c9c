#include "mansard/formats/input_name.hpp"

#include <algorithm>

#include "mansard/formats/files/address.hpp"
#include "mansard/formats/files/virtual_files.hpp"

namespace mansard::formats {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view gdals = "/vsi";

/// Without the passwords, and without the keyword or the colon before each.
auto without_passwords(std::string name) -> std::string {
  const auto spans = passwords_in(name);
  for (auto span = spans.rbegin(); span != spans.rend(); ++span) {
    auto [start, size] = *span;
    if (name[start - 1] == ':') {  // user:password@host
      name.erase(start - 1, size + 1);
      continue;
    }
    const auto end = start + size;
    start = name.find_last_not_of(" \t", name.rfind('=', start) - 1) + 1;
    start = name.find_last_of(" \t:?&", start - 1) + 1;  // of the keyword
    const bool last = end >= name.size();
    name.erase(start, end + (last ? 0 : 1) - start);
    if (last && start > 0 && (name.back() == ' ' || name.back() == '?' || name.back() == '&')) name.pop_back();
  }
  return name;
}

}  // namespace

auto is_database_name(const fs::path& path) -> bool { return is_database(path); }

auto is_disk_name(const fs::path& path) -> bool { return !is_database_name(path) && !path.string().starts_with(gdals); }

auto disk_place_of(const fs::path& path) -> std::optional<fs::path> {
  if (is_disk_name(path)) return path;
  if (is_elsewhere(path)) return std::nullopt;
  auto archive = archive_of(path.string()).first;
  return archive.empty() ? std::nullopt : std::optional(std::move(archive));
}

auto check_input(const fs::path& path) -> base::Result<void> {
  if (is_elsewhere(path) || is_there(path)) return {};
  return why_missing(path);
}

auto name_to_show(const fs::path& path) -> std::string { return shown_name(path); }

auto name_to_keep(const fs::path& path) -> std::string {
  return is_database_name(path) ? without_passwords(path.string()) : path.string();
}

auto meant_by(const std::string& name, const std::string& known) -> std::string {
  if (!is_database_name(name)) return name;
  const auto spans = passwords_in(name);
  const bool shown =
      std::ranges::any_of(spans, [&](const auto& span) { return name.compare(span.first, span.second, "***") == 0; });
  if (!shown) return name;
  return name_to_show(known) == name ? known : name_to_keep(name);
}

}  // namespace mansard::formats
