// The report as one HTML page that is XML too: no scripts, no network, light and dark.
#pragma once

#include <string>

#include "lab/explore/explore.hpp"

namespace mansard::explore::detail {

[[nodiscard]] auto index_html(const Study& study) -> std::string;

}  // namespace mansard::explore::detail
