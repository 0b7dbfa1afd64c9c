// Names of inputs that are more than a path: databases, servers, archives; and the passwords in them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mansard::formats {

/// Whether the words are the address of a database rather than the name of a file: "PG:…", "postgresql://…".
[[nodiscard]] auto is_database(const std::filesystem::path& path) -> bool;

/// Far away or not a file at all: its bytes are not fetched again to be hashed.
[[nodiscard]] auto is_elsewhere(const std::filesystem::path& path) -> bool;

/// Where passwords stand in a database's address, quotes included: start and size, in order.
[[nodiscard]] auto passwords_in(std::string_view words) -> std::vector<std::pair<std::size_t, std::size_t>>;

/// The source as it may be shown: the words of a database's address without its password.
[[nodiscard]] auto shown_name(const std::filesystem::path& path) -> std::string;

/// The text, where a library may have repeated the address or its password, as it may be shown.
[[nodiscard]] auto shown_text(std::string text, const std::filesystem::path& path) -> std::string;

}  // namespace mansard::formats
