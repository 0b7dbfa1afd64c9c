// The report as one HTML page that is XML too: no scripts, no network, light and dark.
#pragma once

#include <string>

#include "lab/explore/explore.hpp"
#include "lab/explore/sensitivity.hpp"

namespace mansard::explore::detail {

[[nodiscard]] auto index_html(const Study& study) -> std::string;
[[nodiscard]] auto sensitivity_html(const Sensitivity& result) -> std::string;

}  // namespace mansard::explore::detail
