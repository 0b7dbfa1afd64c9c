// A field on a grid as colours.
#pragma once

#include <span>
#include <string>

#include "mansard/picture/picture.hpp"

namespace mansard::picture::detail {

/// Blue at −1, white at 0, red at 1, clamped beyond; grey for NaN.
[[nodiscard]] auto diverging(double value) -> Colour;

[[nodiscard]] auto map_image(std::span<const float> values, std::size_t columns, std::size_t rows, double limit,
                             const std::string& title) -> Image;

}  // namespace mansard::picture::detail
