// What an experiment shows beside its numbers: plots over its axes, and a figure per dataset.
#pragma once

#include <string>

#include "lab/explore/explore.hpp"

namespace mansard::explore::detail {

/// `<tag attributes>inner</tag>`; the inner text is HTML already, attribute values are escaped here.
[[nodiscard]] auto tag(std::string_view name, std::string_view inner,
                       const std::vector<std::pair<std::string, std::string>>& attributes = {}) -> std::string;

/// Lines over the only axis, or colours over both; nothing for any other number of axes.
[[nodiscard]] auto plots(const Study& study) -> std::string;

/// Plans in the order of the axes, pictures, profiles: what the experiment has of this dataset.
[[nodiscard]] auto dataset_figure(const Study& study, std::size_t dataset) -> std::string;

}  // namespace mansard::explore::detail
