// What inputs are called: where they lie, whether they are there, and what of their names may be shown and kept.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mansard/base/result.hpp"

namespace mansard::formats {

/// Whether it is the name of a file or folder on disk: neither a database ("PG:…") nor one that GDAL alone understands
/// ("/vsizip/…", "/vsicurl/…").
[[nodiscard]] auto is_disk_name(const std::filesystem::path& path) -> bool;

/// Whether it is the address of a database: of footprints, never of a mesh or a raster.
[[nodiscard]] auto is_database_name(const std::filesystem::path& path) -> bool;

/// The file or folder on disk that holds the input: itself, or the archive that it lies in. None for a database and for
/// what lies on a server.
[[nodiscard]] auto disk_place_of(const std::filesystem::path& path) -> std::optional<std::filesystem::path>;

/// Whether there is such an input, by the rules of read_scene. Databases and servers are not asked: reading does that.
/// Fails with "file-missing", "file-read".
[[nodiscard]] auto check_input(const std::filesystem::path& path) -> base::Result<void>;

/// The name with "***" in place of a database's password: what may be shown.
[[nodiscard]] auto name_to_show(const std::filesystem::path& path) -> std::string;

/// The name without a database's password: what may be written down. The database then asks PGPASSWORD or ~/.pgpass.
[[nodiscard]] auto name_to_keep(const std::filesystem::path& path) -> std::string;

/// The input that is meant by `name`, which may be what name_to_show made of `known`: then that, password included.
/// Without such a one, "***" is no password.
[[nodiscard]] auto meant_by(const std::string& name, const std::string& known) -> std::string;

}  // namespace mansard::formats
