// What `mansard doctor` and `mansard new` check of the machine.
#pragma once

#include <string>
#include <vector>

namespace mansard::cli {

enum class Found { fine, note, problem };

struct Finding {
  Found found = Found::fine;
  std::string subject, what;
  std::string remedy{};  ///< a command or a setting; empty for none
};

/// "ok", "note" or "problem".
[[nodiscard]] auto word_of(Found found) -> const char*;
/// "note     memory: 0.5 GB available", with the remedy on a second line.
[[nodiscard]] auto line_of(const Finding& finding) -> std::string;

/// Processor, memory and the folder of temporary files.
[[nodiscard]] auto machine() -> std::vector<Finding>;
/// The drivers of GDAL and the data of PROJ.
[[nodiscard]] auto libraries() -> std::vector<Finding>;

}  // namespace mansard::cli
