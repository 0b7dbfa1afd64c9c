// The comment in which a CityGML that mansard wrote says how it was made.
#pragma once

#include <optional>
#include <string_view>

#include "mansard/model/city.hpp"

namespace mansard::formats {

/// How the comment starts. What follows is the JSON that other formats have as "made_by", in one line.
inline constexpr std::string_view citygml_made_by_start = "<!-- mansard ";

/// Of the text of a file; none where there is no such comment right behind the start of the root element, or it cannot
/// be read.
[[nodiscard]] auto citygml_made_by(std::string_view text) -> std::optional<model::MadeBy>;

}  // namespace mansard::formats
