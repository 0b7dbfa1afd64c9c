// Buildings into a PostGIS database.
#pragma once

#include "mansard/formats/detail/writers.hpp"

namespace mansard::formats::detail {

/// Into the database that `connection` names ("PG:dbname=city"), in one transaction, which finish() ends: rows of
/// buildings with the same ids are updated, others are added; nothing is deleted but the solids of these buildings, and
/// no table is touched but two: mansard_buildings (footprint, attributes) and mansard_solids (a solid of a building at
/// a level of detail). Columns that others added keep their values. Fails with "write-postgis".
[[nodiscard]] auto postgis_writer(const std::string& connection, const Header& header, const WriteOptions& options)
    -> WriterResult;

}  // namespace mansard::formats::detail
