// A table by the ids of buildings, joined to their footprints.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/scene.hpp"

namespace mansard::ingest {

/// Appends the columns of a table of any format that GDAL reads (CSV, GeoPackage, XLSX …) to the attributes of the
/// footprints whose id is the value of the column `key`. A column that a footprint has already gets "_2" appended.
/// `encoding` is that of strings that are not UTF-8, as iconv names it. Returns warnings: "ingest-join-unmatched" (rows
/// without a footprint), "ingest-join-missing" (footprints without a row), "ingest-text" (strings that are not UTF-8,
/// and no encoding). Fails with "ingest-join-table" (cannot be read), "ingest-join-key" (no such column),
/// "ingest-join-duplicate" (two rows with one id), "ingest-join-none" (no row matches), "ingest-encoding" (no such
/// encoding). Cost: linear in rows.
[[nodiscard]] auto join(model::Scene& scene, const std::filesystem::path& table, const std::string& key,
                        const std::string& encoding = {}) -> base::Result<std::vector<base::Diagnostic>>;

[[nodiscard]] auto join_codes() -> std::vector<base::Code>;

}  // namespace mansard::ingest
