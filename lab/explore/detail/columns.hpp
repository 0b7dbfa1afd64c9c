// What is told of a run, once: the table, the CSV and the JSON take it from here.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/explore/explore.hpp"

namespace mansard::explore::detail {

struct Column {
  std::string key;      ///< in CSV and JSON; "_s" at its end for seconds
  std::string heading;  ///< with its unit
  int decimals = 0;     ///< in the table
  bool shown = true;    ///< in the table too
  std::function<double(const Numbers&)> value;
  [[nodiscard]] auto seconds() const -> bool { return key.ends_with("_s"); }
};

[[nodiscard]] auto columns() -> const std::vector<Column>&;
/// The column of that key, which must be there.
[[nodiscard]] auto column(std::string_view key) -> const Column&;

/// "2" for counts, the shortest exact text for the rest.
[[nodiscard]] auto exact(const Column& column, const Numbers& numbers) -> std::string;

}  // namespace mansard::explore::detail
