// What a later run has to know of an earlier one: read from its run.json.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/result.hpp"
#include "mansard/model/accuracy.hpp"
#include "mansard/model/frame.hpp"

namespace mansard::report {

struct EarlierRun {
  std::vector<model::InputFile> inputs;
  std::vector<std::pair<std::string, std::string>> options;  ///< module.name → value
  std::optional<model::Accuracy> accuracy;                   ///< of its scan
};
/// Members that are missing or of another type are left out. Fails with "report-run" where it is no JSON object.
[[nodiscard]] auto read_run(std::string_view json, const std::string& subject) -> base::Result<EarlierRun>;

}  // namespace mansard::report
